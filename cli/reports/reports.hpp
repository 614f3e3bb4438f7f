#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "options/options.hpp"
#include "reports/report.hpp"
#include "reports/tested_kinds.hpp"
#include "reports/text_report.hpp"

namespace supple::cli {

class MovingObjects;

/// The requested reports, and the results that decide the exit status.
class Reports {
 public:
  /// `noun` is the word for a frame in messages: `frame` or `step`.
  Reports(const DetectionOptions& options, const Input& input, const MovingObjects& objects,
          std::string noun);

  /// No tables are printed with --quiet, or when standard output has other data.
  bool has_tables() const { return text_.has_value(); }
  /// Prints the first difference of the run; the JSON has all of them.
  void add(const Frame& frame);
  /// `was_ended` says that a limit or a signal ended the run, so that frames are missing.
  void finish(bool was_ended = false);
  /// The exit status of a finished run. With --fail-on-contact, it reports on standard error what was not
  /// tested.
  int exit_status() const;

 private:
  void report_faults(const char* what) const;
  /// Whether what was not tested decides the exit status, which then reports it.
  bool is_failing() const { return options_.fail_on_contact && !touched_ && !differed_; }

  const DetectionOptions& options_;
  const Input& input_;
  const MovingObjects& objects_;
  std::string solid_parts_;
  std::optional<JsonReport> json_;
  std::optional<CsvReport> csv_;
  std::optional<TextReport> text_;
  TestedKinds tested_;
  std::uint64_t last_frame_ = 0, truncated_frames_ = 0;
  bool touched_ = false, differed_ = false, was_ended_ = false;
};

}  // namespace supple::cli
