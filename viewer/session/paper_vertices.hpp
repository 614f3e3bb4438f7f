#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "scene_view.hpp"
#include "source.hpp"

namespace supple::viewer {

/// The paper's output: of each object the vertices in the leaves that collide with another's. Only a scene
/// made for them gives these, so they have one of their own, which costs another detection while they are
/// asked for and nothing otherwise.
class PaperVertices {
 public:
  /// By object, ascending, each vertex once. They last until the next call. The show is always the same until
  /// `forget`.
  const std::vector<std::vector<std::uint32_t>>& find(const SceneView& show, const Source& source);
  void forget();

 private:
  std::optional<Scene> scene_;
  std::vector<ObjectId> ids_;
  std::vector<std::uint64_t> versions_;
  std::vector<std::vector<std::uint32_t>> vertices_;
};

}  // namespace supple::viewer
