#include "supple/broad_phase.hpp"

#include "broad_phase/object_volume.hpp"
#include "broad_phase/pair_finder.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"
#include "supple/option_descriptions.hpp"

namespace supple {

class BroadPhase::Implementation {
 public:
  explicit Implementation(const BroadPhaseOptions& options)
      : options_((check(options), options)),
        parallel_(options.threads),
        finder_(make(BoundingVolume::aabb)) {}

  std::span<const IndexPair> find(BoundingVolume kind, const ObjectVolumes& volumes) {
    if (kind != kind_) {
      finder_ = make(kind);
      kind_ = kind;
    }
    return finder_->find_pairs(volumes, parallel_);
  }

  /// Told of changes.
  std::span<const IndexPair> find(BoundingVolume kind, ObjectVolumes volumes,
                                  std::span<const std::uint32_t> changed) {
    const std::size_t count = slot_count(volumes, kind);
    for (const std::uint32_t index : changed)
      if (index >= count)
        fail("broad phase: the list of changed volumes has " + std::to_string(index) + ", but there are " +
             std::to_string(count) + " volumes; list indices into them");
    // After volumes of the other kind there is nothing to which changes could be told.
    if (kind == kind_) volumes.changed = changed;
    return find(kind, volumes);
  }

  const PairFinder& finder() const { return *finder_; }

 private:
  std::unique_ptr<PairFinder> make(BoundingVolume kind) const {
    return make_pair_finder(options_.method, kind, options_.scene_octree);
  }

  BroadPhaseOptions options_;
  Parallel parallel_;
  BoundingVolume kind_ = BoundingVolume::aabb;
  std::unique_ptr<PairFinder> finder_;
};

BroadPhase::BroadPhase(const BroadPhaseOptions& options)
    : implementation_(std::make_unique<Implementation>(options)) {}
BroadPhase::~BroadPhase() = default;
BroadPhase::BroadPhase(BroadPhase&&) noexcept = default;
BroadPhase& BroadPhase::operator=(BroadPhase&&) noexcept = default;

std::span<const IndexPair> BroadPhase::find_object_pairs(std::span<const Aabb> boxes) {
  return implementation_->find(BoundingVolume::aabb, {.boxes = boxes, .spheres = {}});
}

std::span<const IndexPair> BroadPhase::find_object_pairs(std::span<const BoundingSphere> spheres) {
  return implementation_->find(BoundingVolume::sphere, {.boxes = {}, .spheres = spheres});
}

std::span<const IndexPair> BroadPhase::find_object_pairs(std::span<const Aabb> boxes,
                                                         std::span<const std::uint32_t> changed) {
  return implementation_->find(BoundingVolume::aabb, {.boxes = boxes, .spheres = {}}, changed);
}

std::span<const IndexPair> BroadPhase::find_object_pairs(std::span<const BoundingSphere> spheres,
                                                         std::span<const std::uint32_t> changed) {
  return implementation_->find(BoundingVolume::sphere, {.boxes = {}, .spheres = spheres}, changed);
}

const BroadPhaseStats& BroadPhase::stats() const {
  return implementation_->finder().stats();
}
std::vector<SceneRegion> BroadPhase::regions() const {
  return implementation_->finder().regions();
}
std::string BroadPhase::validate() const {
  return implementation_->finder().validate();
}

}  // namespace supple
