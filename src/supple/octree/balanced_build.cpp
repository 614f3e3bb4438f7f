#include "octree/balanced_build.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "geometry/vector.hpp"
#include "octree/connected_parts.hpp"
#include "octree/median_cut.hpp"

namespace supple {
namespace {

/// Coordinates of a range that is less long than this say too little: it gets new ones.
constexpr float least_extent = 0x1p-80f;
/// Cuts between parts may cost so much more than a cut through them, by surfaces.
constexpr double most_overlap = 1.5;

/// Of the axis' coordinates of three points: one that is far from the others is not taken.
double median_of(double p, double q, double r) {
  return std::max(std::min(p, q), std::min(std::max(p, q), r));
}

/// Places of the octree's order that become a node or a leaf. While they are of several whole parts, these
/// are a range of the parts, and the places are not filled yet.
struct Range {
  std::uint32_t begin, end;
  std::uint32_t first_part = 0, parts = 0;

  std::uint32_t size() const { return end - begin; }
};

class BalancedBuilder {
 public:
  BalancedBuilder(std::span<const Vec3d> centers, std::span<const Triangle> triangles,
                  std::size_t vertex_count, const ObjectOctreeOptions& options, std::uint32_t first_level)
      : centers_(centers),
        parts_(connected_parts(triangles, vertex_count)),
        options_(options),
        deepest_(options.max_level - std::min(options.max_level, first_level)),
        fill_(options.leaf_size / 2 + options.leaf_size % 2),
        points_(centers.size()) {}

  OctreeTopology build() {
    if (!points_.empty()) {
      start();
      for (std::size_t n = 0; n < topology_.nodes.size(); ++n) split(n);
    }
    topology_.level_begin.push_back(static_cast<std::uint32_t>(topology_.nodes.size()));
    topology_.order.reserve(points_.size());
    for (const CutPoint& point : points_) topology_.order.push_back(point.id);
    return std::move(topology_);
  }

 private:
  /// Parts and their places.
  void start() {
    for (std::uint32_t t = 0; t < points_.size(); ++t) points_[t].id = t;
    const Range all{0, static_cast<std::uint32_t>(points_.size())};
    set_coordinates(all);
    push_node(parts_.count() > 1 ? sort_parts() : all, 0);
  }

  Range sort_parts() {
    given_ = points_;
    const auto count = static_cast<std::uint32_t>(parts_.count());
    part_boxes_.reserve(count);
    part_points_.reserve(count);
    for (std::uint32_t part = 0; part < count; ++part) {
      CutBox box = empty_cut_box();
      for (const std::uint32_t triangle : parts_.of(part)) extend(box, box_of({&points_[triangle], 1}));
      CutPoint center{{}, part};
      for (int axis = 0; axis < 3; ++axis) center.at[axis] = (box.low[axis] + box.high[axis]) / 2;
      part_boxes_.push_back(box);
      part_points_.push_back(center);
      part_sizes_.push_back(parts_.size(part));
    }
    part_cut_ = MedianCut(part_sizes_);
    return {0, static_cast<std::uint32_t>(points_.size()), 0, count};
  }

  bool should_split(const Range& range, std::uint32_t level) const {
    return range.size() > options_.leaf_size && level < deepest_;
  }

  void push_node(const Range& range, std::uint8_t level) {
    if (topology_.level_begin.size() == level) {
      topology_.level_begin.push_back(static_cast<std::uint32_t>(topology_.nodes.size()));
    }
    topology_.nodes.emplace_back();
    topology_.nodes.back().level = level;
    ranges_.push_back(range);
  }

  /// Lanes that go on become nodes at the end of the array: the nodes come level by level.
  void split(std::size_t n) {
    const Range range = ranges_[n];
    OctreeNode node = topology_.nodes[n];
    node.first_child = static_cast<std::uint32_t>(topology_.nodes.size());
    lanes_.clear();
    if (should_split(range, node.level)) {
      choose_lanes(range, node.level);
    } else {
      lanes_.push_back(range);
    }
    for (const Range& lane : lanes_) {
      const std::uint8_t i = node.lane_count++;
      node.first_triangle[i] = lane.begin;
      if (!should_split(lane, node.level + 1u) || lanes_.size() == 1) {
        fill_places(lane);
        order_leaf(std::span(points_).subspan(lane.begin, lane.size()));
        continue;
      }
      node.inner_mask = static_cast<std::uint8_t>(node.inner_mask | 1u << i);
      push_node(lane, static_cast<std::uint8_t>(node.level + 1));
      topology_.nodes.back().parent = static_cast<std::uint32_t>(n);
      topology_.nodes.back().parent_lane = i;
    }
    std::fill(node.first_triangle + node.lane_count, node.first_triangle + node_width + 1, range.end);
    topology_.nodes[n] = node;
  }

  /// Below a node are as few levels as may be: children fill up what their parent planned for, however its
  /// cuts came out. A node on the last has a lane for each leaf; others have two, four or eight, as halves
  /// follow grids and the like better than sevenths, and nodes of leaves are well filled all the same.
  void choose_lanes(const Range& range, std::uint32_t level) {
    const std::uint32_t most = fill_ + (options_.leaf_size - fill_) / 2;
    std::uint64_t under_lane = 1;  // leaves
    std::uint32_t levels = 1;
    while (range.size() > under_lane * (level == 0 ? most : options_.leaf_size) * node_width) {
      under_lane *= node_width;
      ++levels;
    }
    lane_limit_ = under_lane * options_.leaf_size;
    std::uint64_t lanes = (range.size() + under_lane * most - 1) / (under_lane * most);
    if (levels == 1) {
      lanes = std::max<std::uint64_t>(lanes, (range.size() + fill_ / 2) / fill_);
    } else {
      lanes = lanes <= 2 ? 2 : lanes <= 4 ? 4 : 8;
    }
    if (level + levels > deepest_) lanes = node_width;
    cut_into_lanes(range, static_cast<std::uint32_t>(std::clamp<std::uint64_t>(lanes, 2, node_width)));
  }

  void cut_into_lanes(const Range& range, std::uint32_t lanes) {
    if (lanes == 1 || range.size() <= (range.parts == 1 ? options_.leaf_size : fill_)) {
      lanes_.push_back(range);
      return;
    }
    Range lower = range, upper = range;
    std::uint32_t lower_lanes = lanes / 2;
    if (cut_parts(lower, upper)) {
      const std::uint64_t share = (std::uint64_t{lower.size()} * lanes * 2 + range.size()) / range.size() / 2;
      lower_lanes = static_cast<std::uint32_t>(std::clamp<std::uint64_t>(share, 1, lanes - 1));
    } else {
      fill_places(range);
      const std::uint32_t count = cut_triangles(range, lower_lanes, lanes);
      lower = {range.begin, range.begin + count};
      upper = {lower.end, range.end};
    }
    cut_into_lanes(lower, lower_lanes);
    cut_into_lanes(upper, lanes - lower_lanes);
  }

  /// Between whole parts, unless there is one only or they are too much entangled: says whether.
  bool cut_parts(Range& lower, Range& upper) {
    const Range range = lower;
    if (range.parts < 2) return false;
    const std::span<CutPoint> points = parts_of(range);
    const CutBox all = box_of_parts(points);
    // Triangles can have new coordinates.
    if (all.extent(all.longest_axis()) < least_extent) return false;
    const std::size_t count = order_parts(points, range.size());
    const auto lower_parts = points.first(count), upper_parts = points.subspan(count);
    std::uint32_t size = 0;
    for (const CutPoint& part : lower_parts) size += part_sizes_[part.id];
    CutBox half = all;
    half.high[half.longest_axis()] -= half.extent(half.longest_axis()) / 2;
    const double cost = box_of_parts(lower_parts).surface() * size +
                        box_of_parts(upper_parts).surface() * (range.size() - size);
    if (cost > most_overlap * half.surface() * range.size()) return false;
    lower.end = upper.begin = range.begin + size;
    lower.parts = static_cast<std::uint32_t>(count);
    upper.first_part += lower.parts;
    upper.parts -= lower.parts;
    return true;
  }

  /// Those of the lower side first; a part that is more than half of all by itself. Returns their number.
  std::size_t order_parts(std::span<CutPoint> points, std::uint32_t size) {
    const auto largest = std::max_element(points.begin(), points.end(), [&](auto& p, auto& q) {
      return part_sizes_[p.id] < part_sizes_[q.id];
    });
    if (part_sizes_[largest->id] > size / 2) {
      std::rotate(points.begin(), largest, largest + 1);
      return 1;
    }
    const CutBox box = box_of(points);
    return part_cut_.cut(points, box.longest_axis(), box, {size / 2, 1, size - 1});
  }

  std::uint32_t cut_triangles(const Range& range, std::uint32_t lower_lanes, std::uint32_t lanes) {
    const auto points = std::span(points_).subspan(range.begin, range.size());
    CutBox box = box_of(points);
    if (box.extent(box.longest_axis()) < least_extent) {
      set_coordinates(range);
      box = box_of(points);
    }
    const std::uint64_t size = range.size();
    const auto target = static_cast<std::uint32_t>(size * lower_lanes / lanes);
    // No lane may get more than what it can hold, nor an eighth more or less than wanted.
    const std::uint64_t slack = size / 8, below = lane_limit_ * lower_lanes,
                        above = lane_limit_ * (lanes - lower_lanes);
    CutGoal goal{target, 1, 1};
    goal.least = static_cast<std::uint32_t>(std::max(size - std::min(size - 1, above), target - slack));
    goal.most = static_cast<std::uint32_t>(std::min({size - 1, below, target + slack}));
    return static_cast<std::uint32_t>(cut_.cut(points, box.longest_axis(), box, goal));
  }

  /// Along the Morton curve of 64 cells of the cube around it: neighbours follow each other, so that pairs of
  /// triangles that are tested together mostly end alike.
  void order_leaf(std::span<CutPoint> points) {
    const CutBox box = box_of(points);
    const float scale = 4 / box.extent(box.longest_axis());
    if (!(scale < std::numeric_limits<float>::infinity())) return;
    std::array<std::uint32_t, 65> next{};
    leaf_cells_.clear();
    leaf_points_.assign(points.begin(), points.end());
    for (const CutPoint& point : points) {
      constexpr std::uint8_t spread[4] = {0, 1, 8, 9};
      std::uint32_t cell = 0;
      for (int axis = 0; axis < 3; ++axis) {
        cell |= std::uint32_t{spread[std::min(static_cast<int>((point.at[axis] - box.low[axis]) * scale), 3)]}
                << axis;
      }
      leaf_cells_.push_back(static_cast<std::uint8_t>(cell));
      ++next[cell + 1];
    }
    for (std::size_t cell = 0; cell < 64; ++cell) next[cell + 1] += next[cell];
    for (std::size_t i = 0; i < points.size(); ++i) points[next[leaf_cells_[i]]++] = leaf_points_[i];
  }

  /// With the triangles of the range's parts.
  void fill_places(const Range& range) {
    std::uint32_t place = range.begin;
    for (const CutPoint& part : parts_of(range)) {
      for (const std::uint32_t triangle : parts_.of(part.id)) points_[place++] = given_[triangle];
    }
  }

  std::span<CutPoint> parts_of(const Range& range) {
    return std::span(part_points_).subspan(range.first_part, range.parts);
  }

  CutBox box_of_parts(std::span<const CutPoint> parts) const {
    CutBox box = empty_cut_box();
    for (const CutPoint& part : parts) extend(box, part_boxes_[part.id]);
    return box;
  }

  /// In units of the longest side of their box, from a point in their midst: wherever they are and however
  /// large, floats can tell them apart. A single one far away leaves the others their precision.
  void set_coordinates(const Range& range) {
    constexpr double inf = std::numeric_limits<double>::infinity();
    // Scaled down so that the difference of two coordinates cannot overflow.
    constexpr double scale = 0.25;
    const auto points = std::span(points_).subspan(range.begin, range.size());
    Vec3d lower{inf, inf, inf}, upper{-inf, -inf, -inf};
    for (const CutPoint& point : points) {
      const Vec3d& c = centers_[point.id];
      if (!is_finite(c)) continue;
      for (int axis = 0; axis < 3; ++axis) {
        lower[axis] = std::min(lower[axis], c[axis] * scale);
        upper[axis] = std::max(upper[axis], c[axis] * scale);
      }
    }
    const auto at = [&](const CutPoint& point) {
      const Vec3d& c = centers_[point.id];
      return is_finite(c) ? c * scale : lower;
    };
    const Vec3d p = at(points.front()), q = at(points[points.size() / 2]), r = at(points.back());
    const Vec3d origin{median_of(p.x, q.x, r.x), median_of(p.y, q.y, r.y), median_of(p.z, q.z, r.z)};
    const double side = std::max({upper.x - lower.x, upper.y - lower.y, upper.z - lower.z});
    for (CutPoint& point : points) {
      const Vec3d place = at(point);
      for (int axis = 0; axis < 3; ++axis) {
        point.at[axis] = side > 0 ? static_cast<float>((place[axis] - origin[axis]) / side) : 0.0f;
      }
    }
  }

  std::span<const Vec3d> centers_;
  ConnectedParts parts_;
  ObjectOctreeOptions options_;
  std::uint32_t deepest_;  ///< level
  std::uint32_t fill_;     ///< triangles of a leaf, mostly
  OctreeTopology topology_;
  std::vector<Range> ranges_;     // of the nodes
  std::vector<CutPoint> points_;  // in the octree's order
  std::vector<CutPoint> given_;   // in the order given, when there are several parts
  std::vector<CutPoint> part_points_;
  std::vector<CutBox> part_boxes_;
  std::vector<std::uint32_t> part_sizes_;
  MedianCut cut_, part_cut_;
  // Of the node that is being split.
  std::vector<Range> lanes_;
  std::uint64_t lane_limit_ = 0;  ///< triangles
  std::vector<std::uint8_t> leaf_cells_;
  std::vector<CutPoint> leaf_points_;
};

}  // namespace

OctreeTopology build_balanced_octree(std::span<const Vec3d> centers, std::span<const Triangle> triangles,
                                     std::size_t vertex_count, const ObjectOctreeOptions& options,
                                     std::uint32_t first_level) {
  return BalancedBuilder(centers, triangles, vertex_count, options, first_level).build();
}

}  // namespace supple
