#include "supple/broad_phase.hpp"

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

  template <class Volume>
  std::span<const IndexPair> find(ObjectVolumes given, std::span<const Volume> volumes,
                                  std::optional<std::span<const std::uint32_t>> dirty) {
    for (const std::uint32_t index : dirty.value_or(std::span<const std::uint32_t>()))
      if (index >= volumes.size())
        fail("broad phase: the dirty list has index " + std::to_string(index) + ", but there are " +
             std::to_string(volumes.size()) + " volumes; list indices of volumes");
    constexpr bool boxes = std::is_same_v<Volume, Aabb>;
    constexpr BoundingVolume kind = boxes ? BoundingVolume::aabb : BoundingVolume::sphere;
    // When the kind of volume changes, all volumes are new.
    if (kind == kind_) given.dirty = dirty;
    if (kind != kind_) finder_ = make(kind);
    kind_ = kind;
    return finder_->find_pairs(given, parallel_);
  }

  const PairFinder& finder() const { return *finder_; }

 private:
  std::unique_ptr<PairFinder> make(BoundingVolume kind) const {
    return std::make_unique<PairFinder>(options_.method, kind, options_.scene_octree);
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
  return implementation_->find<Aabb>({.boxes = boxes}, boxes, {});
}

std::span<const IndexPair> BroadPhase::find_object_pairs(std::span<const BoundingSphere> spheres) {
  return implementation_->find<BoundingSphere>({.spheres = spheres}, spheres, {});
}

std::span<const IndexPair> BroadPhase::find_object_pairs(std::span<const Aabb> boxes,
                                                         std::span<const std::uint32_t> dirty) {
  return implementation_->find<Aabb>({.boxes = boxes}, boxes, dirty);
}

std::span<const IndexPair> BroadPhase::find_object_pairs(std::span<const BoundingSphere> spheres,
                                                         std::span<const std::uint32_t> dirty) {
  return implementation_->find<BoundingSphere>({.spheres = spheres}, spheres, dirty);
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
