#include "commands/energy_table.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <string>

#include "base/text.hpp"

namespace supple::cli {
namespace {

void print_row(const std::string& name, double start, const MassSpringEnergy& end) {
  fmt::print("{:<20} {:>13.6g} {:>13.6g} {:>11.4g} {:>11.4g} {:>11.4g} {:>11.4g} {:>11.4g}\n", name, start,
             end.total(), end.kinetic, end.elastic, end.area, end.volume, end.gravity);
}

}  // namespace

void EnergyTable::print() const {
  if (end_.empty()) return;
  fmt::print("\n{:<20} {:>13} {:>13} {:>11} {:>11} {:>11} {:>11} {:>11}\n", "energy, J", "at the start",
             "at the end", "kinetic", "elastic", "area", "volume", "gravity");
  double all_at_start = 0;
  MassSpringEnergy all;
  for (std::size_t i = 0; i < end_.size(); ++i) {
    const MassSpringEnergy& energy = end_[i].energy;
    const double at_start = start_[i].energy.total();
    all_at_start += at_start;
    all.kinetic += energy.kinetic;
    all.elastic += energy.elastic;
    all.area += energy.area;
    all.volume += energy.volume;
    all.gravity += energy.gravity;
    if (i < most_rows) print_row(name_of(input_, end_[i].object), at_start, energy);
  }
  if (end_.size() > most_rows) fmt::print("and {} more\n", counted(end_.size() - most_rows, "object"));
  if (end_.size() > 1) print_row("all", all_at_start, all);
}

}  // namespace supple::cli
