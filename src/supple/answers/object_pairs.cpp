#include "answers/object_pairs.hpp"

#include <algorithm>
#include <limits>

#include "core/float_rounding.hpp"
#include "geometry/aabb.hpp"

namespace supple {
namespace {

// When each volume grows by half the separation, or by its margin, the volumes of two objects overlap if the
// objects come within the separation or the sum of their margins. The growth is rounded up by more than its
// sums can lose.

double growth(double half_separation) {
  return half_separation > 0 ? half_separation * (1 + 0x1p-19) + std::numeric_limits<float>::min() : 0;
}

BoundingSphere grown(const BoundingSphere& sphere, double by) {
  if (by == 0 || sphere.empty()) return sphere;
  return {sphere.center, round_up(sphere.radius + by)};
}

/// The part of an object in the distance at which elements of two objects are of interest.
double half_separation_of(const ObjectOptions& object, const VertexWays* ways, const Question& question) {
  const double separation = question.impact.impact.min_separation / 2 + object.min_separation;
  if (!question.safe_step) return separation;
  return separation + kept_share(*question.safe_step) * ways->longest +
         safe_step_rounding * (ways->largest_coordinate + ways->longest);
}

}  // namespace

double growth_of(const ObjectOptions& object, const VertexWays* ways, const Question& question) {
  return std::max(question.is_continuous() ? growth(half_separation_of(object, ways, question)) : 0,
                  question.reads(SearchedShape::margins) ? growth(object.margin) : 0);
}

ObjectPairs::ObjectPairs(const World& world, BoundingVolume volume)
    : world_(world),
      volume_(volume),
      finder_(world.options.broad_phase, volume, world.options.scene_octree) {}

/// Lists the boxes and spheres that the broad phase reads.
void ObjectPairs::list_volumes(const Question& question, std::span<const VertexWays> ways) {
  boxes_.assign(world_.slot_count(), {});
  spheres_.assign(world_.slot_count(), {});
  for (std::uint32_t slot = 0; slot < world_.slot_count(); ++slot) {
    const WorldObject* const object = world_.at(slot);
    if (object == nullptr) continue;
    const double growth = growth_of(object->options, ways.empty() ? nullptr : &ways[slot], question);
    boxes_[slot] = grown(object->box(), growth);
    spheres_[slot] = grown(object->sphere(), growth);
  }
  searched_ = question.shapes();
}

void ObjectPairs::find(const Question& question, std::span<const VertexWays> ways) {
  list_volumes(question, ways);
  ObjectVolumes volumes;
  if (volume_ == BoundingVolume::sphere) {
    volumes.spheres = spheres_;
  } else {
    volumes.boxes = boxes_;
  }
  const std::span<const IndexPair> overlapping = finder_.find_pairs(volumes, world_.parallel);
  pairs_.clear();
  pairs_.reserve(overlapping.size());
  for (const IndexPair& pair : overlapping) {
    if (!are_apart(pair) && question.may_pair(world_, pair))
      pairs_.push_back({world_.id_of(pair.a), world_.id_of(pair.b)});
  }
  jobs_.clear();
  jobs_.reserve(pairs_.size());
  auto pair = pairs_.begin();
  for (std::uint32_t slot = 0; slot < world_.slot_count(); ++slot) {
    const WorldObject* const object = world_.at(slot);
    if (object == nullptr) continue;
    if (question.tests_itself(world_, slot)) jobs_.push_back({slot, slot});
    for (; pair != pairs_.end() && pair->a.index == slot; ++pair) jobs_.push_back({slot, pair->b.index});
  }
}

/// Whether the oriented boxes or k-DOPs of two objects are apart whose boxes overlap. They do not enclose the
/// path of an object.
bool ObjectPairs::are_apart(const IndexPair& pair) const {
  if (searched_.moving || searched_.near || !is_tested_after_boxes(volume_)) return false;
  return object_volumes_apart(pair_of(world_[pair.a].resting_view(), world_[pair.b].resting_view()));
}

}  // namespace supple
