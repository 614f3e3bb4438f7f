#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "fit.hpp"
#include "supple/options.hpp"
#include "table.hpp"

namespace supple::experiments {

/// A row of the paper's Table 1 (five runs of ten minutes) and its numbers in section 7.
struct PaperRow {
  std::uint32_t objects;
  BoundingVolume volume;
  std::array<double, 5> broad, narrow;             ///< collisions of each run
  double text_seconds_broad, text_seconds_narrow;  ///< seconds per collision in the text
};

std::span<const PaperRow> paper_rows();
/// Null when the paper has no such row.
const PaperRow* paper_row(std::uint32_t objects, BoundingVolume volume);

/// The ratio of the mean numbers with spheres and with boxes; the runs are independent of each other. Nothing
/// when the paper has no such rows.
std::optional<Estimate> paper_ratio(std::uint64_t objects, bool is_broad);

double mean(std::span<const double> values);
/// Ten minutes divided by the mean number.
double seconds_per_collision(std::span<const double> counts);

/// The averages recomputed from the table, those of the text, and their differences.
Table paper_arithmetic();

}  // namespace supple::experiments
