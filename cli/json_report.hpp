#pragma once

#include <optional>
#include <string>

#include "inputs.hpp"
#include "json_writer.hpp"
#include "node_pair_report.hpp"
#include "report.hpp"
#include "supple/scene.hpp"

namespace supple::cli {

/// Optional parts of the JSON.
struct JsonContent {
  /// Options, and the times and counts of each frame: the parts that may differ between two runs with the
  /// same results.
  bool stats = true;
  bool contact_details = false;               ///< points, normals and barycentric coordinates of each contact
  bool faces = false;                         ///< the triangles of each object
  std::optional<ObjectNumbers> node_pairs{};  ///< the objects whose colliding nodes are written
};

/// Writes the result of `supple detect` as docs/json.md describes, frame by frame.
class JsonReport {
 public:
  JsonReport(const std::string& file_name, const Input& input, const Scene& scene,
             const JsonContent& content);

  void add(const Frame& frame);
  /// `was_ended` says that frames are missing.
  void finish(bool was_ended);

 private:
  JsonWriter json_;
  void add_files(std::uint64_t frame);

  const Input& input_;
  const Scene& scene_;
  JsonContent content_;
  bool is_truncated_ = false;
};

}  // namespace supple::cli
