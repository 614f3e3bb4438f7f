#include "plain/plain_broad_phase.hpp"

#include <algorithm>
#include <unordered_set>

namespace supple::experiments {
namespace {

bool overlap(const Aabb& a, const Aabb& b) {
  return a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y && b.min.y <= a.max.y &&
         a.min.z <= b.max.z && b.min.z <= a.max.z;
}

class BruteForce final : public PlainBroadPhase {
  std::size_t step(const std::vector<Aabb>& boxes) override {
    std::size_t pairs = 0;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      for (std::size_t j = i + 1; j < boxes.size(); ++j) pairs += overlap(boxes[i], boxes[j]);
    }
    tests_ = boxes.size() * (boxes.size() - 1) / 2;
    return pairs;
  }
};

class Sweep final : public PlainBroadPhase {
  std::size_t step(const std::vector<Aabb>& boxes) override {
    sorted_ = boxes;
    std::sort(sorted_.begin(), sorted_.end(), [](const Aabb& a, const Aabb& b) { return a.min.x < b.min.x; });
    std::size_t pairs = 0;
    tests_ = 0;
    for (std::size_t i = 0; i < sorted_.size(); ++i) {
      for (std::size_t j = i + 1; j < sorted_.size() && sorted_[j].min.x <= sorted_[i].max.x; ++j) {
        pairs += overlap(sorted_[i], sorted_[j]);
        ++tests_;
      }
    }
    return pairs;
  }
  std::vector<Aabb> sorted_;
};

/// [Bar92]: lists of all ends on three axes that stay sorted from step to step.
class ThreeLists final : public PlainBroadPhase {
  struct End {
    float value;
    std::uint32_t box;
    bool is_upper;
    bool operator<(const End& other) const {
      return value != other.value ? value < other.value : is_upper < other.is_upper;
    }
  };

  std::size_t step(const std::vector<Aabb>& boxes) override {
    tests_ = 0;
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<End>& ends = lists_[static_cast<std::size_t>(axis)];
      if (ends.empty()) {  // all lower ends, then all upper ones: the first sort meets every pair
        for (const bool is_upper : {true, false}) {
          for (std::uint32_t i = 0; i < boxes.size(); ++i) ends.push_back({0, i, is_upper});
        }
      }
      for (End& end : ends) end.value = (end.is_upper ? boxes[end.box].max : boxes[end.box].min)[axis];
      sort_by_insertion(ends, boxes);
    }
    return pairs_.size();
  }

  void sort_by_insertion(std::vector<End>& ends, const std::vector<Aabb>& boxes) {
    for (std::size_t i = 1; i < ends.size(); ++i) {
      const End moving = ends[i];
      std::size_t to = i;
      for (; to > 0 && moving < ends[to - 1]; --to) {
        const End passed = ends[to - 1];
        ends[to] = passed;
        ++tests_;
        if (moving.is_upper == passed.is_upper || moving.box == passed.box) continue;
        const std::uint64_t pair =
            std::uint64_t{std::min(moving.box, passed.box)} << 32 | std::max(moving.box, passed.box);
        if (moving.is_upper)
          pairs_.erase(pair);
        else if (overlap(boxes[moving.box], boxes[passed.box]))
          pairs_.insert(pair);
      }
      ends[to] = moving;
    }
  }

  std::array<std::vector<End>, 3> lists_;
  std::unordered_set<std::uint64_t> pairs_;
};

class Octree final : public PlainBroadPhase {
 public:
  Octree(const Vec3d& corner, double edge, std::uint32_t level_allowed)
      : corner_{static_cast<float>(corner.x), static_cast<float>(corner.y), static_cast<float>(corner.z)},
        edge_(static_cast<float>(edge)),
        level_allowed_(level_allowed) {}

  std::size_t step(const std::vector<Aabb>& boxes) override {
    boxes_ = &boxes;
    pairs_ = 0;
    tests_ = 0;
    objects_.resize(level_allowed_ + 1);
    objects_[0].resize(boxes.size());
    for (std::uint32_t i = 0; i < boxes.size(); ++i) objects_[0][i] = i;
    visit(corner_, edge_, 0, {true, true, true});
    return pairs_;
  }

 private:
  /// `is_lowest`: per axis, whether no region lies below this one; boxes may begin outside of the cube.
  void visit(const Vec3f& low, float edge, std::uint32_t level, std::array<bool, 3> is_lowest) {
    const std::vector<std::uint32_t>& objects = objects_[level];
    if (level == level_allowed_ || (level > 0 && objects.size() < 2)) {
      count(low, is_lowest, objects);
      return;
    }
    const float half = edge / 2;
    const Vec3f middle{low.x + half, low.y + half, low.z + half};
    std::vector<std::uint32_t>& inside = objects_[level + 1];
    for (int child = 0; child < 8; ++child) {
      inside.clear();
      Vec3f child_low = low;
      std::array<bool, 3> is_child_lowest = is_lowest;
      for (int axis = 0; axis < 3; ++axis) {
        if ((child >> axis & 1) == 0) continue;
        child_low[axis] = middle[axis];
        is_child_lowest[static_cast<std::size_t>(axis)] = false;
      }
      for (const std::uint32_t object : objects) {
        const Aabb& box = (*boxes_)[object];
        bool is_in = true;
        for (int axis = 0; axis < 3; ++axis)
          is_in = is_in &&
                  ((child >> axis & 1) == 0 ? box.min[axis] < middle[axis] : box.max[axis] >= middle[axis]);
        if (is_in) inside.push_back(object);
      }
      visit(child_low, half, level + 1, is_child_lowest);
    }
  }

  /// A pair is in several regions: it counts in the one that has the lower corner of what both have in
  /// common.
  void count(const Vec3f& low, const std::array<bool, 3>& is_lowest,
             const std::vector<std::uint32_t>& objects) {
    for (std::size_t i = 0; i < objects.size(); ++i) {
      for (std::size_t j = i + 1; j < objects.size(); ++j) {
        const Aabb &a = (*boxes_)[objects[i]], &b = (*boxes_)[objects[j]];
        ++tests_;
        if (!overlap(a, b)) continue;
        bool is_here = true;
        for (int axis = 0; axis < 3; ++axis)
          is_here = is_here && (is_lowest[static_cast<std::size_t>(axis)] ||
                                std::max(a.min[axis], b.min[axis]) >= low[axis]);
        pairs_ += is_here;
      }
    }
  }

  Vec3f corner_;
  float edge_;
  std::uint32_t level_allowed_;
  const std::vector<Aabb>* boxes_ = nullptr;
  std::vector<std::vector<std::uint32_t>> objects_;  // of the region that is visited, by level
  std::size_t pairs_ = 0;
};

}  // namespace

std::unique_ptr<PlainBroadPhase> plain_brute_force() {
  return std::make_unique<BruteForce>();
}
std::unique_ptr<PlainBroadPhase> plain_sweep() {
  return std::make_unique<Sweep>();
}
std::unique_ptr<PlainBroadPhase> plain_three_lists() {
  return std::make_unique<ThreeLists>();
}
std::unique_ptr<PlainBroadPhase> plain_octree(const Vec3d& corner, double edge, std::uint32_t level_allowed) {
  return std::make_unique<Octree>(corner, edge, level_allowed);
}

std::uint32_t plain_overlapping_boxes(const VolumeArrays& v, std::size_t i) {
  std::uint32_t count = 0;
  for (std::size_t j = 0; j < v.radius.size(); ++j) {
    if (v.low[0][j] <= v.high[0][i] && v.high[0][j] >= v.low[0][i] && v.low[1][j] <= v.high[1][i] &&
        v.high[1][j] >= v.low[1][i] && v.low[2][j] <= v.high[2][i] && v.high[2][j] >= v.low[2][i])
      ++count;
  }
  return count;
}

std::uint32_t plain_overlapping_boxes_without_branches(const VolumeArrays& v, std::size_t i) {
  std::uint32_t count = 0;
  for (std::size_t j = 0; j < v.radius.size(); ++j) {
    count += static_cast<std::uint32_t>(
        static_cast<int>(v.low[0][j] <= v.high[0][i]) & static_cast<int>(v.high[0][j] >= v.low[0][i]) &
        static_cast<int>(v.low[1][j] <= v.high[1][i]) & static_cast<int>(v.high[1][j] >= v.low[1][i]) &
        static_cast<int>(v.low[2][j] <= v.high[2][i]) & static_cast<int>(v.high[2][j] >= v.low[2][i]));
  }
  return count;
}

std::uint32_t plain_overlapping_spheres(const VolumeArrays& v, std::size_t i) {
  std::uint32_t count = 0;
  for (std::size_t j = 0; j < v.radius.size(); ++j) {
    const float x = v.center[0][j] - v.center[0][i], y = v.center[1][j] - v.center[1][i],
                z = v.center[2][j] - v.center[2][i], reach = v.radius[j] + v.radius[i];
    if (x * x + y * y + z * z <= reach * reach) ++count;
  }
  return count;
}

}  // namespace supple::experiments
