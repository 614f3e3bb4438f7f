#include "supple/broad_phase.hpp"

#include "broad_phase/pair_finder.hpp"
#include "core/parallel.hpp"

namespace supple {

class BroadPhase::Implementation {
 public:
  explicit Implementation(const BroadPhaseOptions& options)
      : options_(options), parallel_(options.threads), finder_(make(BoundingVolume::aabb)) {}

  std::span<const IndexPair> find(BoundingVolume kind, const ObjectVolumes& volumes) {
    if (kind != kind_) {
      finder_ = make(kind);
      kind_ = kind;
    }
    return finder_->find_pairs(volumes, parallel_);
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
  return implementation_->find(BoundingVolume::aabb, {.boxes = boxes, .spheres = {}, .changed = {}});
}

std::span<const IndexPair> BroadPhase::find_object_pairs(std::span<const BoundingSphere> spheres) {
  return implementation_->find(BoundingVolume::sphere, {.boxes = {}, .spheres = spheres, .changed = {}});
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
