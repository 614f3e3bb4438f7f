#pragma once

#include <string>

#include "base/json_writer.hpp"
#include "options/json_content.hpp"
#include "reports/report.hpp"

namespace supple::cli {

struct Input;
class MovingObjects;

/// Writes the result of `supple detect` as docs/json.md describes, frame by frame.
class JsonReport {
 public:
  JsonReport(const std::string& file_name, const Input& input, const MovingObjects& objects,
             const JsonContent& content);

  void add(const Frame& frame);
  /// `was_ended` says that frames are missing.
  void finish(bool was_ended);

 private:
  JsonWriter json_;
  void add_files(std::uint64_t frame);

  const Input& input_;
  const MovingObjects& objects_;
  JsonContent content_;
  bool is_truncated_ = false;
};

}  // namespace supple::cli
