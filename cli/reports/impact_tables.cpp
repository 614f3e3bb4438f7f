#include "reports/impact_tables.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "base/text.hpp"
#include "inputs/inputs.hpp"

namespace supple::cli {

void ImpactTables::Counts::add(const ContinuousContact& contact) {
  ++(contact.kind == ElementPairKind::edge_edge ? edge_edge : vertex_face);
}

void ImpactTables::add(const Frame& step) {
  const DetectResult& result = step.result;
  if (result.continuous_contacts.empty()) return;
  for (const ContactGroup& group : result.continuous_groups) {
    Pair& pair = pairs_[{group.a, group.b}];
    ++pair.steps;
    for (const ContinuousContact& contact : result.continuous_contacts_of(group)) pair.counts.add(contact);
  }
  ++steps_with_contacts_;
  Step row{step.number, {}, 1};
  for (const ContinuousContact& contact : result.continuous_contacts) {
    row.counts.add(contact);
    row.earliest = std::min(row.earliest, contact.toi);
    if (contact.certainty == ImpactCertainty::within_tolerance) ++within_tolerance_;
  }
  if (steps_.size() < most_rows) steps_.push_back(row);
}

void ImpactTables::print(const Input& input) const {
  if (pairs_.empty()) {
    fmt::print("Nothing touches.\n\n");
    return;
  }
  print_steps();
  print_pairs(input);
  if (within_tolerance_ > 0)
    fmt::print("{} of them within tolerance only: floating point cannot decide whether they touch\n\n",
               grouped(within_tolerance_));
}

void ImpactTables::print_steps() const {
  fmt::print("{:<20} {:>16} {:>16} {:>24}\n", "to frame", "vertex-face", "edge-edge", "earliest, 0 to 1");
  for (const Step& step : steps_) {
    fmt::print("{:<20} {:>16} {:>16} {:>24}\n", step.number, grouped(step.counts.vertex_face),
               grouped(step.counts.edge_edge), step.earliest);
  }
  if (steps_with_contacts_ > steps_.size())
    fmt::print("and {} in which something touches; --json lists all\n",
               counted(steps_with_contacts_ - steps_.size(), "step"));
  fmt::print("\n");
}

void ImpactTables::print_pairs(const Input& input) const {
  std::vector<std::pair<ObjectPair, Pair>> rows(pairs_.begin(), pairs_.end());
  std::sort(rows.begin(), rows.end(), [](const auto& x, const auto& y) {
    const std::uint64_t contacts_x = x.second.counts.all(), contacts_y = y.second.counts.all();
    return contacts_x != contacts_y ? contacts_x > contacts_y : x.first < y.first;
  });
  fmt::print("{:<20} {:<20} {:>8} {:>16} {:>16}\n", "object", "touches", "steps", "vertex-face", "edge-edge");
  std::uint64_t contacts = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto& [pair, summary] = rows[i];
    contacts += summary.counts.all();
    if (i >= most_rows) continue;
    fmt::print("{:<20} {:<20} {:>8} {:>16} {:>16}\n", name_of(input, pair.a),
               pair.a == pair.b ? "itself" : name_of(input, pair.b), grouped(summary.steps),
               grouped(summary.counts.vertex_face), grouped(summary.counts.edge_edge));
  }
  if (rows.size() > most_rows)
    fmt::print("and {} with fewer; --json lists all\n", counted(rows.size() - most_rows, "pair"));
  fmt::print("\n{} that touch within a step\n\n", counted(contacts, "pair of elements", "pairs of elements"));
}

}  // namespace supple::cli
