#include "broad_phase/octree/scene_octree.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace supple {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr std::uint32_t most_children = 8;
constexpr int most_halvings_allowed = 20;  // 64 bits can number 8^20 regions

/// By bit of a child's number: the children in the upper half along the axis of the bit.
constexpr std::array<std::uint32_t, 3> upper_half{0xaa, 0xcc, 0xf0};

/// Children that lie on the side of one plane that the box does not reach.
std::uint32_t missed_across(float middle, float min, float max, std::uint32_t upper) {
  // Masks of all bits or none, because a branch would be unpredictable.
  return (~upper & -static_cast<std::uint32_t>(!(min < middle))) |
         (upper & -static_cast<std::uint32_t>(!(max >= middle)));
}

}  // namespace

SceneOctree::SceneOctree(BoundingVolume bounding_volume, const SceneOctreeOptions& options)
    // The paper's test (is the centre in the grown region?) is the test of the box around the sphere.
    : by_sphere_(bounding_volume == BoundingVolume::sphere &&
                 options.region_sphere_test == RegionSphereTest::arvo),
      divides_large_(options.expand_for_large_objects),
      min_level_(options.min_level),
      max_level_(options.max_level),
      given_expand_at_(options.expand_at),
      arity_(options.arity),
      axes_per_level_(static_cast<int>(std::bit_width(options.arity)) - 1) {
  make_root();
}

std::uint32_t SceneOctree::children_touched(const Region& region, const ObjectVolume& volume) const {
  // The box of a sphere that is not finite is all of space, and touches all regions.
  return by_sphere_ && volume.box.min.x != -infinity ? children_of_sphere(region, volume.sphere)
                                                     : children_of_box(region, volume.box);
}

/// Children that the box touches. The box touches the region.
std::uint32_t SceneOctree::children_of_box(const Region& region, const Aabb& box) const {
  std::uint32_t missed = 0;
  for (int turn = 0; turn < axes_per_level_; ++turn) {
    const int axis = split_axis(region.level, turn);
    missed |= missed_across(region.middle[axis], box.min[axis], box.max[axis],
                            upper_half[static_cast<std::size_t>(turn)]);
  }
  return ~missed & ((1u << arity_) - 1);
}

/// Children whose closest point to the centre lies within the sphere (Arvo 1990).
///
/// Two spheres that `overlap` reports share a leaf. Let d <= (r1 + r2)(1 + 2^-48) be the distance of their
/// centres, and p the point that divides the segment between the centres as r1 : r2. Then p is within
/// r (1 + 2^-48) of each centre. p is in one leaf and in each region above it, and each of these regions is
/// no farther from a centre than p. Distances are differences of floats in double, with a relative error of
/// 2^-53 (no square underflows), and their sum has an error below 2^-50. So each of these regions passes the
/// test against r² (1 + 2^-40).
std::uint32_t SceneOctree::children_of_sphere(const Region& region, const BoundingSphere& sphere) const {
  const double limit = double{sphere.radius} * sphere.radius * (1 + 0x1p-40);
  std::array<std::array<double, 2>, 3> squared{};  // by turn, of the lower and the upper half
  for (int turn = 0; turn < 3; ++turn) {
    const int axis = split_axis(region.level, turn);
    const double center = sphere.center[axis], middle = region.middle[axis];
    const double below = std::max(region.lower[axis] - center, center - middle);
    const double above = std::max(middle - center, center - region.upper[axis]);
    auto& [lower, upper] = squared[static_cast<std::size_t>(turn)];
    lower = below > 0 ? below * below : 0;
    upper = above > 0 ? above * above : 0;
    if (turn >= axes_per_level_) lower = upper = !(lower > upper) ? lower : upper;  // not halved
  }
  std::uint32_t touched = 0;
  for (std::uint32_t child = 0; child < arity_; ++child) {
    const double distance = squared[0][child & 1] + squared[1][child >> 1 & 1] + squared[2][child >> 2 & 1];
    touched |= static_cast<std::uint32_t>(!(distance > limit)) << child;
  }
  return touched;
}

/// Up to 64 objects are divided until each is alone, as in the paper; this takes microseconds. A leaf of more
/// than 96 objects takes longer to test than to divide. With 64 instead of 96, dense scenes divide once too
/// often.
std::uint32_t SceneOctree::chosen_expand_at() const {
  return given_expand_at_ != 0 ? given_expand_at_ : object_count_ <= 64 ? 2 : 96;
}

bool SceneOctree::should_expand(const Region& region) const {
  return region.level < deepest_level_ &&
         (region.divided >= expand_at_ || (region.level < levels_of(min_level_) && object_count_ > 0));
}

void SceneOctree::make_root() {
  regions_.clear();
  free_groups_.clear();
  lists_.clear();
  due_.clear();
  regions_.resize(arity_);
  Region& root = regions_[0];
  root.lower = {-infinity, -infinity, -infinity};
  root.upper = {infinity, infinity, infinity};
  root.middle = cube_.center;
  root.in_use = true;
}

std::uint32_t SceneOctree::make_children(std::uint32_t parent_index) {
  std::uint32_t first = static_cast<std::uint32_t>(regions_.size());
  if (free_groups_.empty()) {
    regions_.resize(regions_.size() + arity_);
  } else {
    first = free_groups_.back();
    free_groups_.pop_back();
  }
  Region& parent = regions_[parent_index];
  parent.first_child = first;
  for (std::uint32_t k = 0; k < arity_; ++k) {
    Region& child = regions_[first + k];
    child = {};
    child.in_use = true;
    child.number = arity_ * parent.number + 1 + k;
    child.level = static_cast<std::uint8_t>(parent.level + 1);
    child.lower = parent.lower;
    child.upper = parent.upper;
    child.middle = parent.middle;
    for (int turn = 0; turn < axes_per_level_; ++turn) {
      const int axis = split_axis(parent.level, turn);
      const float quarter = std::ldexp(cube_.edge, -halvings(axis, parent.level) - 2);
      const bool is_upper = (k >> turn & 1) != 0;
      if (is_upper)
        child.lower[axis] = std::max(parent.lower[axis], parent.middle[axis]);
      else
        child.upper[axis] = std::min(parent.upper[axis], parent.middle[axis]);
      child.middle[axis] = parent.middle[axis] + (is_upper ? quarter : -quarter);
    }
  }
  return first;
}

void SceneOctree::free_children(std::uint32_t parent_index) {
  const std::uint32_t first = regions_[parent_index].first_child;
  for (std::uint32_t k = 0; k < arity_; ++k) {
    lists_.release(regions_[first + k].objects);
    regions_[first + k].in_use = false;
  }
  free_groups_.push_back(first);
  regions_[parent_index].first_child = 0;
}

/// Stores the volume, with a stay range that no plane limits yet. Spheres and empty boxes have no range.
void SceneOctree::place(std::uint32_t slot, const ObjectVolume& volume) {
  placed_[slot] = volume;
  finest_level_[slot] = finest_level(volume.box);
  stay_[slot] = {};
  if (by_sphere_ || volume.box.empty()) return;
  stay_[slot].low.fill(-infinity);
  stay_[slot].high.fill(infinity);
}

void SceneOctree::narrow_stay_range(std::uint32_t slot, const Region& region) {
  if (by_sphere_) return;
  StayRange& range = stay_[slot];
  const Aabb& box = placed_[slot].box;
  const Vec3f& plane = region.middle;
  const std::array<float, 6> ends{box.min.x, box.min.y, box.min.z, box.max.x, box.max.y, box.max.z};
  const std::array<float, 6> planes{plane.x, plane.y, plane.z, plane.x, plane.y, plane.z};
  // Selections, because branches on the side of an end would be unpredictable.
  for (std::size_t k = 0; k < 6; ++k) {
    const bool below = ends[k] < planes[k];
    range.low[k] = std::max(range.low[k], below ? -infinity : planes[k]);
    range.high[k] = std::min(range.high[k], below ? planes[k] : infinity);
  }
}

void SceneOctree::build(const VolumeStore& volumes, const SceneCube& cube) {
  cube_ = cube;
  inverse_edge_ = 1.0 / cube.edge;
  const int useful_halvings = cube.finest_edge > 0 ? std::ilogb(cube.edge / cube.finest_edge) : 1;
  const int most_halvings = max_level_ != 0 ? static_cast<int>(max_level_) : most_halvings_allowed;
  deepest_level_ = levels_of(static_cast<std::uint32_t>(std::clamp(useful_halvings, 1, most_halvings)));
  make_root();
  object_count_ = 0;
  const auto boxes = volumes.boxes();
  resize(boxes.size());
  for (std::uint32_t slot = 0; slot < boxes.size(); ++slot) {
    place(slot, volumes.volume(slot));
    if (boxes[slot].empty()) continue;
    ++object_count_;
    lists_.push(regions_[0].objects, slot);
    regions_[0].divided += divides(0, finest_level_[slot]);
  }
  expand_at_ = chosen_expand_at();
  if (should_expand(regions_[0])) expand(volumes, 0);
}

void SceneOctree::resize(std::size_t slot_count) {
  placed_.resize(slot_count);
  stay_.resize(slot_count);
  finest_level_.resize(slot_count, 0);
  is_collected_.resize(slot_count, 0);
}

void SceneOctree::expand(const VolumeStore& volumes, std::uint32_t index) {
  ++expanded_count_;
  const std::uint32_t first = make_children(index);
  const Region region = regions_[index];
  std::span<const std::uint32_t> slots = lists_.view(region.objects);
  child_masks_.resize(slots.size());
  std::array<std::uint32_t, most_children> counts{};
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const std::uint32_t slot = slots[i];
    placed_[slot] = volumes.volume(slot);
    narrow_stay_range(slot, region);
    std::uint32_t mask = children_touched(region, placed_[slot]);
    child_masks_[i] = static_cast<std::uint8_t>(mask);
    for (; mask != 0; mask &= mask - 1) ++counts[static_cast<std::size_t>(std::countr_zero(mask))];
  }
  for (std::uint32_t k = 0; k < arity_; ++k) lists_.reserve(regions_[first + k].objects, counts[k]);
  slots = lists_.view(region.objects);
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const std::uint32_t slot = slots[i];
    const bool divided_below = divides(region.level + 1u, finest_level_[slot]);
    for (std::uint32_t mask = child_masks_[i]; mask != 0; mask &= mask - 1) {
      Region& child = regions_[first + static_cast<std::uint32_t>(std::countr_zero(mask))];
      lists_.push(child.objects, slot);
      child.divided += divided_below;
    }
  }
  lists_.release(regions_[index].objects);
  for (std::uint32_t child = first; child < first + arity_; ++child)
    if (should_expand(regions_[child])) expand(volumes, child);
}

void SceneOctree::collect(std::uint32_t index) {
  const std::uint32_t first = regions_[index].first_child;
  for (std::uint32_t child = first; child < first + arity_; ++child) {
    if (!regions_[child].is_leaf()) {
      collect(child);
      continue;
    }
    for (const std::uint32_t slot : objects(regions_[child])) {
      if (is_collected_[slot] == 0) collected_.push_back(slot);
      is_collected_[slot] = 1;
    }
  }
  free_children(index);
}

void SceneOctree::reduce(std::uint32_t index) {
  ++reduced_count_;
  collected_.clear();
  collect(index);
  Region& region = regions_[index];
  lists_.reserve(region.objects, static_cast<std::uint32_t>(collected_.size()));
  for (const std::uint32_t slot : collected_) {
    lists_.push(region.objects, slot);
    is_collected_[slot] = 0;
  }
}

/// An object between its old and its new volume.
struct SceneOctree::Journey {
  std::uint32_t slot;
  ObjectVolume from, to;
  std::uint8_t finest_from, finest_to;
};

void SceneOctree::move(const VolumeStore& volumes, std::uint32_t slot) {
  if (slot >= stay_.size()) resize(volumes.slot_count());
  const ObjectVolume from = placed_[slot], to = volumes.volume(slot);
  const std::uint8_t finest_from = finest_level_[slot];
  place(slot, to);
  object_count_ += !to.box.empty();
  object_count_ -= !from.box.empty();
  if (!from.box.empty() || !to.box.empty())
    move_below(0, {slot, from, to, finest_from, finest_level_[slot]}, !from.box.empty(), !to.box.empty());
}

void SceneOctree::move_below(std::uint32_t index, const Journey& journey, bool was_here, bool is_here) {
  Region& region = regions_[index];
  region.divided -= was_here && divides(region.level, journey.finest_from);
  region.divided += is_here && divides(region.level, journey.finest_to);
  if (should_expand(region) == region.is_leaf()) due_.push_back(index);
  if (region.is_leaf()) {
    if (was_here && !is_here) lists_.erase(region.objects, journey.slot);
    if (!was_here && is_here) lists_.push(region.objects, journey.slot);
    return;
  }
  const auto touched = [&](bool here, const ObjectVolume& volume) -> std::uint32_t {
    return here ? children_touched(region, volume) : 0;
  };
  const std::uint32_t were = touched(was_here, journey.from), are = touched(is_here, journey.to);
  if (is_here) narrow_stay_range(journey.slot, region);
  const std::uint32_t first = region.first_child;
  for (std::uint32_t mask = were | are; mask != 0; mask &= mask - 1) {
    const auto k = static_cast<std::uint32_t>(std::countr_zero(mask));
    move_below(first + k, journey, (were >> k & 1) != 0, (are >> k & 1) != 0);
  }
}

void SceneOctree::settle(const VolumeStore& volumes) {
  for (const std::uint32_t index : due_) {
    // An earlier entry may have settled this region or reduced a region above it.
    const Region& region = regions_[index];
    if (!region.in_use || should_expand(region) != region.is_leaf()) continue;
    if (region.is_leaf())
      expand(volumes, index);
    else
      reduce(index);
  }
  due_.clear();
}

std::vector<SceneRegion> SceneOctree::describe(std::optional<std::uint32_t> slot) const {
  const auto contains_slot = [&](const Region& region) {
    const auto slots = objects(region);
    return std::find(slots.begin(), slots.end(), *slot) != slots.end();
  };
  std::vector<SceneRegion> described;
  for (const Region& region : regions_) {
    if (!region.in_use || (slot && !contains_slot(region))) continue;
    SceneRegion entry{region.number, region.level, {}, region.is_leaf(), region.objects.count};
    for (int axis = 0; axis < 3; ++axis) {
      const float half = std::ldexp(cube_.edge, -halvings(axis, region.level) - 1);
      entry.box.min[axis] = region.middle[axis] - half;
      entry.box.max[axis] = region.middle[axis] + half;
    }
    described.push_back(entry);
  }
  // Numbers ascend from level to level, so the root is first.
  std::sort(described.begin(), described.end(),
            [](const SceneRegion& a, const SceneRegion& b) { return a.number < b.number; });
  return described;
}

std::string SceneOctree::validate(const VolumeStore& volumes) const {
  const auto boxes = volumes.boxes();
  if (!due_.empty()) return "scene octree: regions wait to be expanded or reduced";
  std::vector<std::uint32_t> live;
  for (std::uint32_t slot = 0; slot < boxes.size(); ++slot) {
    if (boxes[slot].empty()) continue;
    live.push_back(slot);
    if (finest_level_[slot] != finest_level(boxes[slot]))
      return "scene octree: slot " + std::to_string(slot) + " has a stale finest level";
  }
  std::size_t in_use = 0, list_capacity = lists_.free_capacity();
  for (const Region& region : regions_) {
    in_use += region.in_use;
    list_capacity += lists_.capacity(region.objects);
  }
  if (in_use + arity_ * free_groups_.size() + arity_ - 1 != regions_.size())
    return "scene octree: regions of the pool are neither in use nor free";
  if (list_capacity != lists_.size()) return "scene octree: runs of object lists are lost or used twice";
  return validate_below(volumes, 0, live);
}

/// `slots` are the objects that touch the region.
std::string SceneOctree::validate_below(const VolumeStore& volumes, std::uint32_t index,
                                        std::span<const std::uint32_t> slots) const {
  const Region& region = regions_[index];
  const std::string name = "scene octree: region " + std::to_string(region.number) + ": ";
  if (!region.in_use) return name + "is on the free list";
  std::uint32_t divided = 0;
  for (const std::uint32_t slot : slots) divided += divides(region.level, finest_level_[slot]);
  if (divided != region.divided)
    return name + "does not divide " + std::to_string(region.divided) + " objects";
  if (should_expand(region) == region.is_leaf())
    return name + (region.is_leaf() ? "should be expanded" : "should be reduced");
  if (region.is_leaf()) {
    const auto held = objects(region);
    std::vector<std::uint32_t> sorted(held.begin(), held.end());
    std::sort(sorted.begin(), sorted.end());
    if (!std::equal(sorted.begin(), sorted.end(), slots.begin(), slots.end()))
      return name + "does not hold exactly the objects that touch it";
    return {};
  }
  if (region.objects.count != 0) return name + "is expanded, but holds objects";
  std::array<std::vector<std::uint32_t>, most_children> inside;
  for (const std::uint32_t slot : slots) {
    const StayRange& range = stay_[slot];
    for (int turn = 0; turn < axes_per_level_; ++turn) {
      const int axis = split_axis(region.level, turn);
      const std::size_t k = static_cast<std::size_t>(axis);
      const float plane = region.middle[axis];
      if ((range.low[k] < plane && plane < range.high[k]) ||
          (range.low[k + 3] < plane && plane < range.high[k + 3]))
        return name + "slot " + std::to_string(slot) + " may cross the middle unnoticed";
    }
    const std::uint32_t mask = children_touched(region, volumes.volume(slot));
    if (children_touched(region, placed_[slot]) != mask)
      return name + "slot " + std::to_string(slot) + " was placed elsewhere";
    for (std::size_t k = 0; k < arity_; ++k)
      if ((mask >> k & 1) != 0) inside[k].push_back(slot);
  }
  for (std::uint32_t k = 0; k < arity_; ++k) {
    const Region& child = regions_[region.first_child + k];
    if (child.number != arity_ * region.number + 1 + k || child.level != region.level + 1)
      return name + "child " + std::to_string(k) + " has number " + std::to_string(child.number);
    if (auto wrong = validate_below(volumes, region.first_child + k, inside[k]); !wrong.empty()) return wrong;
  }
  return {};
}

}  // namespace supple
