#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "answers/detection.hpp"
#include "answers/impact/step_search.hpp"
#include "queries/queries.hpp"
#include "scene/events.hpp"
#include "supple/scene.hpp"
#include "world/world.hpp"

namespace supple {

/// The parts of a scene: the objects, the searches over them, and what lasts from step to step.
class Scene::Implementation {
 public:
  explicit Implementation(const SceneOptions& options);

  const DetectResult& detect(const DetectRequest& request);
  const DetectResult& search(const DetectRequest& request, const PairFilter& only);
  std::shared_ptr<const void> keep_result();
  void remove(ObjectId id);
  ImpactSearchOptions impact_options() const;
  /// Whether the objects are as in the last `detect` that succeeded.
  bool is_current() const { return detected_at_ == world.changes(); }

  World world;
  Detection detection{world};
  StepSearch step_search{world};
  Queries queries{world};
  DetectResult result;
  DetectObserver observer;

 private:
  /// Throws an error when the request is out of range.
  Question question_of(const DetectRequest& request) const;
  void check_vertex_groups() const;

  Events events_;
  std::optional<Detection> search_;  // of `search`
  DetectResult found_by_search_;
  std::uint64_t step_ = 0;
  std::uint64_t detected_at_ = 0;  // `World::changes` at the last `detect` that succeeded
};

/// Opens scenes for the libraries that verify and inspect them.
class SceneAccess {
 public:
  static const Scene::Implementation& of(const Scene& scene) { return *scene.implementation_; }
};

}  // namespace supple
