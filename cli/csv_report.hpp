#pragma once

#include <fmt/format.h>

#include <string>

#include "output_file.hpp"
#include "report.hpp"
#include "supple/options.hpp"

namespace supple::cli {

/// Writes one row per contact, as docs/json.md describes: the frame, the objects, and their triangles or
/// elements. With colliding vertices also one row per vertex and per event of the narrow phase.
class CsvReport {
 public:
  CsvReport(const std::string& file_name, const SceneOptions& options);

  void add(const Frame& frame);
  /// Adds a row `truncated` with empty cells when the results are not complete.
  void finish(bool is_truncated);

 private:
  void add_narrow_phase(const Frame& frame, fmt::memory_buffer& rows);

  OutputFile file_;
  std::size_t columns_ = 0;
  bool has_penetration_ = false;
  bool has_kinds_;  ///< a column says what each row is
};

}  // namespace supple::cli
