#pragma once

#include <string>

#include "json_writer.hpp"
#include "report.hpp"
#include "supple/scene.hpp"

namespace supple::cli {

/// The result of `supple detect` as docs/json.md describes it, a frame at a time.
class JsonReport {
 public:
  /// `with_stats` adds the times and counts of each frame: all that may differ between two runs.
  JsonReport(const std::string& file_name, const Scene& scene, bool with_stats);

  void add(const Frame& frame);
  void finish();

 private:
  JsonWriter json_;
  bool with_points_;
  bool with_stats_;
};

}  // namespace supple::cli
