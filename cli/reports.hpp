#pragma once

#include <optional>
#include <string>

#include "csv_report.hpp"
#include "json_report.hpp"
#include "options.hpp"
#include "report.hpp"
#include "supple/scene.hpp"
#include "text_report.hpp"

namespace supple::cli {

/// The reports that were asked for, and what decides the exit status.
class Reports {
 public:
  /// `noun` is what a frame is called in messages: `frame` or `step`.
  Reports(const DetectionOptions& options, const Input& input, const Scene& scene, std::string noun);

  /// Tables may be left out: standard output belongs to something else, or --quiet.
  bool has_tables() const { return text_.has_value(); }
  /// Tells people of the first difference of the run; the rest is in the JSON.
  void add(const Frame& frame);
  void finish();
  /// Of the frames so far.
  int exit_status() const;

 private:
  const DetectionOptions& options_;
  const Scene& scene_;
  std::optional<JsonReport> json_;
  std::optional<CsvReport> csv_;
  std::optional<TextReport> text_;
  bool touched_ = false, differed_ = false;
};

}  // namespace supple::cli
