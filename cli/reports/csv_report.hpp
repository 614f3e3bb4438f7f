#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

#include "base/output_file.hpp"
#include "reports/report.hpp"
#include "supple/options.hpp"

namespace supple::cli {

/// The names of the columns for contacts of one kind, with or without those of `--contact-details`.
std::vector<std::string> csv_columns(ContactKinds kinds, bool details);

/// Writes one row per contact, as docs/json.md describes: the frame, and the members of the record; vectors
/// and weights only with `details`. With colliding vertices, one row per contact of triangles, per vertex and
/// per event of the narrow phase.
class CsvReport {
 public:
  CsvReport(const std::string& file_name, const SceneOptions& options, bool details);

  void add(const Frame& frame);
  /// Adds a row `truncated` with empty cells when the results are not complete.
  void finish(bool is_truncated);

 private:
  void add_narrow_phase(const Frame& frame, fmt::memory_buffer& rows);

  OutputFile file_;
  std::size_t columns_ = 0;
  ContactKinds kinds_;
  bool has_kinds_;  ///< a column says what each row is
  bool has_details_;
};

}  // namespace supple::cli
