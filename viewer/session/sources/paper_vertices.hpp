#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "scene_view.hpp"
#include "sources/source.hpp"

namespace supple::viewer {

/// The output defined by the paper: for each object, the vertices in leaves that collide with leaves of
/// another object. Only a scene with `colliding_vertices` computes it, so this class owns such a scene. It
/// costs one more detection per frame, but only while the page requests it.
class PaperVertices {
 public:
  /// Indexed by object; vertices ascend, each occurs once. Valid until the next call. `show` must not change
  /// until `forget`.
  const std::vector<std::vector<std::uint32_t>>& find(const SceneView& show, const Source& source);
  /// The pairs of different objects with such leaves, in the last call of `find`.
  const std::vector<ObjectPair>& pairs() const { return pairs_; }
  void forget();

 private:
  std::optional<Scene> scene_;
  std::vector<ObjectId> ids_;
  std::vector<std::uint64_t> versions_;
  std::vector<std::vector<std::uint32_t>> vertices_;
  std::vector<ObjectPair> pairs_;
};

}  // namespace supple::viewer
