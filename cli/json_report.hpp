#pragma once

#include <string>

#include "json_writer.hpp"
#include "report.hpp"
#include "supple/scene.hpp"

namespace supple::cli {

/// What is written and may be left out.
struct JsonContent {
  bool stats = true;             ///< times and counts of each frame: all that may differ between two runs
  bool contact_details = false;  ///< where each continuous contact is
};

/// The result of `supple detect` as docs/json.md describes it, a frame at a time.
class JsonReport {
 public:
  JsonReport(const std::string& file_name, const Scene& scene, const JsonContent& content);

  void add(const Frame& frame);
  void finish();

 private:
  JsonWriter json_;
  SceneOptions options_;
  JsonContent content_;
};

}  // namespace supple::cli
