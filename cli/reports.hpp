#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "csv_report.hpp"
#include "json_report.hpp"
#include "options.hpp"
#include "report.hpp"
#include "supple/scene.hpp"
#include "text_report.hpp"

namespace supple::cli {

/// The requested reports, and the results that decide the exit status.
class Reports {
 public:
  /// `noun` is the word for a frame in messages: `frame` or `step`.
  Reports(const DetectionOptions& options, const Input& input, const Scene& scene, std::string noun);

  /// No tables are printed with --quiet, or when standard output has other data.
  bool has_tables() const { return text_.has_value(); }
  /// Prints the first difference of the run; the JSON has all of them.
  void add(const Frame& frame);
  void finish();
  /// The exit status for the frames so far.
  int exit_status() const;

 private:
  const DetectionOptions& options_;
  const Scene& scene_;
  std::optional<JsonReport> json_;
  std::optional<CsvReport> csv_;
  std::optional<TextReport> text_;
  std::uint64_t last_frame_ = 0;
  bool touched_ = false, differed_ = false;
};

}  // namespace supple::cli
