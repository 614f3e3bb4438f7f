#include "supple/broad_phase.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "broad_phase/pair_finder.hpp"
#include "core/error.hpp"
#include "core/float_rounding.hpp"
#include "core/parallel.hpp"
#include "supple/option_descriptions.hpp"

namespace supple {
namespace {

const BroadPhaseOptions& checked(const BroadPhaseOptions& options) {
  check(options);
  for (const KindPair& pair : options.kind_pairs) {
    if (const std::uint32_t kind = std::max(pair.a, pair.b); kind >= volume_kind_count)
      fail("broad phase: kind_pairs has the kind " + std::to_string(kind) + "; kinds are below " +
           std::to_string(volume_kind_count));
  }
  return options;
}

/// The largest float that is at most `value - radius`, or up to 3 units below.
float lower_bound_of(double value, double radius) {
  if (radius == 0) return round_down(value);
  double difference = value - radius;
  if (std::isnan(difference)) return -std::numeric_limits<float>::infinity();  // both are infinite
  // The rounding error of the difference (Knuth's sum); a NaN where infinities need none.
  const double part = difference - value;
  const double error = (value - (difference - part)) - (radius + part);
  if (error < 0) difference = std::nextafter(difference, -std::numeric_limits<double>::infinity());
  return round_down(difference);
}

}  // namespace

Aabb enclosing_box(const Vec3d& lowest, const Vec3d& highest, double radius) {
  if (!(radius >= 0))
    fail("enclosing box: the radius is " + std::to_string(radius) + "; it must be 0 or more");
  Aabb box;
  if (!(lowest.x <= highest.x && lowest.y <= highest.y && lowest.z <= highest.z)) return box;
  for (int axis = 0; axis < 3; ++axis) {
    box.min[axis] = lower_bound_of(lowest[axis], radius);
    box.max[axis] = -lower_bound_of(-highest[axis], radius);
  }
  return box;
}

Aabb enclosing_box(std::span<const Vec3d> points, double radius) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Vec3d lowest{infinity, infinity, infinity}, highest = -lowest;
  for (const Vec3d& point : points) {
    for (int axis = 0; axis < 3; ++axis) {
      // A NaN stays, because no number is less.
      if (point[axis] < lowest[axis] || std::isnan(point[axis])) lowest[axis] = point[axis];
      highest[axis] = std::max(highest[axis], point[axis]);
    }
  }
  return enclosing_box(lowest, highest, radius);
}

class BroadPhase::Implementation {
 public:
  explicit Implementation(const BroadPhaseOptions& options)
      : options_(checked(options)),
        wanted_(options.kind_pairs),
        parallel_(options.threads),
        finder_(make(BoundingVolume::aabb)) {}

  template <class Volume>
  std::span<const IndexPair> find(std::span<const Volume> volumes,
                                  std::optional<std::span<const std::uint8_t>> kinds,
                                  std::optional<std::span<const std::uint32_t>> dirty) {
    ObjectVolumes given;
    check_kinds(kinds, volumes.size());
    given.kinds = kinds.value_or(std::span<const std::uint8_t>());
    for (const std::uint32_t index : dirty.value_or(std::span<const std::uint32_t>()))
      if (index >= volumes.size())
        fail("broad phase: the dirty list has index " + std::to_string(index) + ", but there are " +
             std::to_string(volumes.size()) + " volumes; list indices of volumes");
    constexpr bool are_boxes = std::is_same_v<Volume, Aabb>;
    constexpr BoundingVolume shape = are_boxes ? BoundingVolume::aabb : BoundingVolume::sphere;
    if constexpr (are_boxes)
      given.boxes = volumes;
    else
      given.spheres = volumes;
    // When the shape of volumes changes, all volumes are new.
    if (shape == shape_) given.dirty = dirty;
    if (shape != shape_) finder_ = make(shape);
    shape_ = shape;
    return finder_->find_pairs(given, parallel_);
  }

  const PairFinder& finder() const { return *finder_; }

 private:
  std::unique_ptr<PairFinder> make(BoundingVolume shape) const {
    return std::make_unique<PairFinder>(options_.method, shape, options_.scene_octree, wanted_);
  }

  void check_kinds(std::optional<std::span<const std::uint8_t>> kinds, std::size_t volume_count) const {
    if (!kinds) {
      if (wanted_.has_kinds())
        fail("broad phase: the options have kind_pairs, but the call has no kinds; pass one for each volume");
      return;
    }
    if (!wanted_.has_kinds())
      fail("broad phase: kinds have no effect without BroadPhaseOptions::kind_pairs; set the wanted pairs");
    if (kinds->size() != volume_count)
      fail("broad phase: there are " + std::to_string(kinds->size()) + " kinds, but " +
           std::to_string(volume_count) + " volumes; pass one kind for each volume");
    std::uint8_t bits = 0;  // kinds are below a power of two
    for (const std::uint8_t kind : *kinds) bits = static_cast<std::uint8_t>(bits | kind);
    if (bits < volume_kind_count) return;
    const auto wrong =
        std::find_if(kinds->begin(), kinds->end(), [](auto kind) { return kind >= volume_kind_count; });
    fail("broad phase: volume " + std::to_string(wrong - kinds->begin()) + " has the kind " +
         std::to_string(*wrong) + "; kinds are below " + std::to_string(volume_kind_count));
  }

  BroadPhaseOptions options_;
  WantedKinds wanted_;
  Parallel parallel_;
  BoundingVolume shape_ = BoundingVolume::aabb;
  std::unique_ptr<PairFinder> finder_;
};

BroadPhase::BroadPhase(const BroadPhaseOptions& options)
    : implementation_(std::make_unique<Implementation>(options)) {}
BroadPhase::~BroadPhase() = default;
BroadPhase::BroadPhase(BroadPhase&&) noexcept = default;
BroadPhase& BroadPhase::operator=(BroadPhase&&) noexcept = default;

std::span<const IndexPair> BroadPhase::find_object_pairs(std::span<const Aabb> boxes) {
  return implementation_->find(boxes, {}, {});
}

std::span<const IndexPair> BroadPhase::find_object_pairs(std::span<const BoundingSphere> spheres) {
  return implementation_->find(spheres, {}, {});
}

std::span<const IndexPair> BroadPhase::find_object_pairs(std::span<const Aabb> boxes,
                                                         std::span<const std::uint32_t> dirty) {
  return implementation_->find(boxes, {}, dirty);
}

std::span<const IndexPair> BroadPhase::find_object_pairs(std::span<const BoundingSphere> spheres,
                                                         std::span<const std::uint32_t> dirty) {
  return implementation_->find(spheres, {}, dirty);
}

std::span<const IndexPair> BroadPhase::find_object_pairs(std::span<const Aabb> boxes,
                                                         std::span<const std::uint8_t> kinds) {
  return implementation_->find(boxes, kinds, {});
}

std::span<const IndexPair> BroadPhase::find_object_pairs(std::span<const BoundingSphere> spheres,
                                                         std::span<const std::uint8_t> kinds) {
  return implementation_->find(spheres, kinds, {});
}

std::span<const IndexPair> BroadPhase::find_object_pairs(std::span<const Aabb> boxes,
                                                         std::span<const std::uint8_t> kinds,
                                                         std::span<const std::uint32_t> dirty) {
  return implementation_->find(boxes, kinds, dirty);
}

std::span<const IndexPair> BroadPhase::find_object_pairs(std::span<const BoundingSphere> spheres,
                                                         std::span<const std::uint8_t> kinds,
                                                         std::span<const std::uint32_t> dirty) {
  return implementation_->find(spheres, kinds, dirty);
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
