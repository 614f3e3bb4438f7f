#include "table1/paper_table.hpp"

#include <algorithm>
#include <cmath>

#include "supple/option_descriptions.hpp"

namespace supple::experiments {
namespace {

constexpr double printed_run_seconds = 600;

// The numbers of the text are in section 7: 12.4 collisions, one every 48.38 seconds, and so on.
constexpr std::array<PaperRow, 6> printed_rows{
    PaperRow{3, BoundingVolume::aabb, {18, 35, 32, 17, 21}, {14, 22, 18, 10, 9}, 24.39, 41.09},
    PaperRow{3, BoundingVolume::sphere, {12, 18, 10, 15, 7}, {7, 8, 7, 4, 5}, 48.38, 96.77},
    PaperRow{6, BoundingVolume::aabb, {85, 69, 53, 43, 45}, {51, 45, 37, 29, 29}, 10.16, 15.70},
    PaperRow{6, BoundingVolume::sphere, {46, 53, 53, 49, 42}, {31, 29, 32, 30, 19}, 12.34, 21.27},
    PaperRow{9, BoundingVolume::aabb, {109, 78, 72, 66, 91}, {64, 42, 51, 45, 42}, 7.20, 12.29},
    PaperRow{9, BoundingVolume::sphere, {61, 84, 85, 86, 64}, {24, 37, 45, 44, 24}, 7.89, 17.24}};

/// Compares a number with the two decimals that the text gives.
std::string compared(double computed, double text) {
  if (std::fabs(std::round(computed * 100) / 100 - text) < 0.001) return "agrees";
  return std::fabs(std::floor(computed * 100) / 100 - text) < 0.001 ? "cut off, not rounded" : "differs";
}

}  // namespace

std::span<const PaperRow> paper_rows() {
  return printed_rows;
}

const PaperRow* paper_row(std::uint32_t objects, BoundingVolume volume) {
  const auto found = std::find_if(printed_rows.begin(), printed_rows.end(), [&](const PaperRow& row) {
    return row.objects == objects && row.volume == volume;
  });
  return found == printed_rows.end() ? nullptr : &*found;
}

std::optional<Estimate> paper_ratio(std::uint64_t objects, bool is_broad) {
  const auto number = static_cast<std::uint32_t>(objects);
  const PaperRow *const boxes = paper_row(number, BoundingVolume::aabb), *const spheres = paper_row(
                                                                             number, BoundingVolume::sphere);
  if (boxes == nullptr || spheres == nullptr) return std::nullopt;
  const auto of_phase = [&](const PaperRow& row) { return estimate_of(is_broad ? row.broad : row.narrow); };
  return quotient(of_phase(*spheres), of_phase(*boxes));
}

double mean(std::span<const double> values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return values.empty() ? 0 : sum / static_cast<double>(values.size());
}

double seconds_per_collision(std::span<const double> counts) {
  return printed_run_seconds / mean(counts);
}

Table paper_arithmetic() {
  Table table{"table1_paper",
              "The averages of the paper's Table 1, recomputed",
              {{"objects", "Objects"},
               {"volume", "Volume"},
               {"phase", "Phase"},
               {"mean", "Mean", 4},
               {"seconds_per_collision", "Seconds per collision", 5},
               {"text_seconds", "in the text", 4},
               {"comparison", "Comparison"}}};
  for (const PaperRow& row : printed_rows) {
    for (const bool broad : {true, false}) {
      const auto& counts = broad ? row.broad : row.narrow;
      const double text = broad ? row.text_seconds_broad : row.text_seconds_narrow;
      const double computed = seconds_per_collision(counts);
      table.add({std::uint64_t{row.objects}, std::string(word_of(row.volume)),
                 std::string(broad ? "broad" : "narrow"), mean(counts), computed, text,
                 compared(computed, text)});
    }
  }
  return table;
}

}  // namespace supple::experiments
