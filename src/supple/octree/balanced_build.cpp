#include "octree/balanced_build.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "geometry/vector.hpp"

namespace supple {
namespace {

/// A range that is shorter than this gets new coordinates, so that floats can tell its points apart.
constexpr float least_extent = 0x1p-80f;
/// A cut is searched among this many coordinates first.
constexpr std::size_t most_samples = 1024;

/// The median, so that one point far away does not count.
double median_of(double p, double q, double r) {
  return std::max(std::min(p, q), std::min(std::max(p, q), r));
}

/// The centre of a triangle.
struct alignas(16) Point {
  float at[3];
  std::uint32_t triangle;
};

struct PointBox {
  std::array<float, 4> low, high;

  explicit PointBox(std::span<const Point> points) {
    // The triangle's number is compared as a fourth coordinate, so that four are compared at a time.
    constexpr float inf = std::numeric_limits<float>::infinity();
    low = {inf, inf, inf, inf};
    high = {-inf, -inf, -inf, -inf};
    for (const Point& point : points) {
      const auto at = std::bit_cast<std::array<float, 4>>(point);
      for (std::size_t lane = 0; lane < 4; ++lane) {
        low[lane] = at[lane] < low[lane] ? at[lane] : low[lane];
        high[lane] = at[lane] > high[lane] ? at[lane] : high[lane];
      }
    }
  }
  float extent(std::size_t axis) const { return high[axis] - low[axis]; }
  /// The first of equal ones.
  std::size_t longest_axis() const {
    std::size_t longest = 0;
    for (std::size_t axis = 1; axis < 3; ++axis) longest = extent(axis) > extent(longest) ? axis : longest;
    return longest;
  }
};

/// Points that become a node or a leaf.
struct Range {
  std::uint32_t begin, end;

  std::uint32_t size() const { return end - begin; }
};

class BalancedBuilder {
 public:
  BalancedBuilder(std::span<const Vec3d> centers, const ObjectOctreeOptions& options)
      : centers_(centers),
        options_(options),
        fill_(options.leaf_size / 2 + options.leaf_size % 2),
        points_(centers.size()) {}

  OctreeTopology build() {
    if (!points_.empty()) {
      for (std::uint32_t t = 0; t < points_.size(); ++t) points_[t].triangle = t;
      const Range all{0, static_cast<std::uint32_t>(points_.size())};
      set_coordinates(all);
      push_node(all, 0);
      for (std::size_t n = 0; n < topology_.nodes.size(); ++n) split(n);
    }
    topology_.level_begin.push_back(static_cast<std::uint32_t>(topology_.nodes.size()));
    topology_.order.reserve(points_.size());
    for (const Point& point : points_) topology_.order.push_back(point.triangle);
    return std::move(topology_);
  }

 private:
  bool should_split(const Range& range, std::uint32_t level) const {
    return range.size() > options_.leaf_size && level < options_.max_level;
  }

  void push_node(const Range& range, std::uint8_t level) {
    if (topology_.level_begin.size() == level) {
      topology_.level_begin.push_back(static_cast<std::uint32_t>(topology_.nodes.size()));
    }
    topology_.nodes.emplace_back();
    topology_.nodes.back().level = level;
    ranges_.push_back(range);
  }

  /// Appends inner children to the array, which keeps the nodes in order of level.
  void split(std::size_t n) {
    const Range range = ranges_[n];
    OctreeNode node = topology_.nodes[n];
    node.first_child = static_cast<std::uint32_t>(topology_.nodes.size());
    children_.clear();
    if (should_split(range, node.level)) {
      choose_children(range, node.level);
    } else {
      children_.push_back(range);
    }
    for (const Range& child : children_) {
      const std::uint8_t i = node.lane_count++;
      node.first_triangle[i] = child.begin;
      if (!should_split(child, node.level + 1u) || children_.size() == 1) {
        order_leaf(points_of(child));
        continue;
      }
      node.inner_mask = static_cast<std::uint8_t>(node.inner_mask | 1u << i);
      push_node(child, static_cast<std::uint8_t>(node.level + 1));
      topology_.nodes.back().parent = static_cast<std::uint32_t>(n);
      topology_.nodes.back().parent_lane = i;
    }
    std::fill(node.first_triangle + node.lane_count, node.first_triangle + node_width + 1, range.end);
    topology_.nodes[n] = node;
  }

  /// Plans as few levels as possible below a node. A node on the last level has a child for each leaf. Other
  /// nodes have two, four or eight children, because halves follow the rows of a grid better than sevenths.
  void choose_children(const Range& range, std::uint32_t level) {
    const std::uint32_t most = fill_ + (options_.leaf_size - fill_) / 2;
    std::uint64_t leaves_of_child = 1;
    std::uint32_t levels = 1;
    while (range.size() > leaves_of_child * (level == 0 ? most : options_.leaf_size) * node_width) {
      leaves_of_child *= node_width;
      ++levels;
    }
    child_limit_ = leaves_of_child * options_.leaf_size;
    std::uint64_t count = (range.size() + leaves_of_child * most - 1) / (leaves_of_child * most);
    if (levels == 1) {
      count = std::max<std::uint64_t>(count, (range.size() + fill_ / 2) / fill_);
    } else {
      count = count <= 2 ? 2 : count <= 4 ? 4 : 8;
    }
    if (level + levels > options_.max_level) count = node_width;
    cut_into_children(range, static_cast<std::uint32_t>(std::clamp<std::uint64_t>(count, 2, node_width)));
  }

  void cut_into_children(const Range& range, std::uint32_t count) {
    if (count == 1 || range.size() <= fill_) {
      children_.push_back(range);
      return;
    }
    const std::uint32_t middle = range.begin + cut(range, count / 2, count);
    cut_into_children({range.begin, middle}, count / 2);
    cut_into_children({middle, range.end}, count - count / 2);
  }

  /// Puts the points of the first `lower` of `count` children first and returns how many these are. Cuts
  /// across the longest axis where the coordinate changes, as near to the wanted number as possible. Where
  /// too many points have the same coordinate, these are cut in the order in which they are.
  std::uint32_t cut(const Range& range, std::uint32_t lower, std::uint32_t count) {
    const std::span<Point> points = points_of(range);
    PointBox box(points);
    if (box.extent(box.longest_axis()) < least_extent) {
      set_coordinates(range);
      box = PointBox(points);
    }
    const std::size_t axis = box.longest_axis();
    const std::uint64_t size = range.size(), wanted = size * lower / count, slack = size / 8;
    // No child may get more triangles than it can hold, nor its side an eighth more or less than wanted.
    const std::uint64_t least =
        std::max(size - std::min(size - 1, child_limit_ * (count - lower)), wanted - slack);
    const std::uint64_t most = std::min({size - 1, child_limit_ * lower, wanted + slack});
    const auto is_allowed = [&](std::uint64_t n) { return n >= least && n <= most; };
    const auto error = [&](std::uint64_t n) { return n < wanted ? wanted - n : n - wanted; };
    for (std::size_t stride = 1 + points.size() / most_samples;; stride = 1) {
      const float border =
          coordinate_at(points, axis, stride, static_cast<double>(wanted) / static_cast<double>(size));
      std::uint64_t less = 0, not_greater = 0;
      for (const Point& point : points) {
        less += point.at[axis] < border;
        not_greater += point.at[axis] <= border;
      }
      std::uint64_t taken = error(less) <= error(not_greater) ? less : not_greater;
      if (!is_allowed(taken)) taken = less + not_greater - taken;
      if (!is_allowed(taken)) taken = wanted;
      // Samples can miss the wanted number altogether.
      if (taken < less || taken > not_greater) continue;
      return partition(points, axis, border, static_cast<std::uint32_t>(taken - less));
    }
  }

  /// A coordinate of every `stride`-th point, such that `share` of these are smaller.
  float coordinate_at(std::span<const Point> points, std::size_t axis, std::size_t stride, double share) {
    coordinates_.clear();
    for (std::size_t i = 0; i < points.size(); i += stride) coordinates_.push_back(points[i].at[axis]);
    const auto place = static_cast<std::ptrdiff_t>(share * static_cast<double>(coordinates_.size()));
    std::nth_element(coordinates_.begin(), coordinates_.begin() + place, coordinates_.end());
    return coordinates_[static_cast<std::size_t>(place)];
  }

  /// Puts the points below the border first, and then as many as `room` of those on it. Keeps the order of
  /// both sides. Returns how many points are first.
  std::uint32_t partition(std::span<Point> points, std::size_t axis, float border, std::uint32_t room) {
    if (upper_.size() < points.size()) upper_.resize(points.size());
    // Writes both and counts one, without a branch that is mispredicted half of the time.
    Point* lower = points.data();
    Point* upper = upper_.data();
    for (const Point& point : points) {
      const Point copy = point;
      const bool is_taken = copy.at[axis] == border && room > 0;
      room -= is_taken;
      const std::ptrdiff_t goes_down = copy.at[axis] < border || is_taken;
      *lower = copy;
      *upper = copy;
      lower += goes_down;
      upper += 1 - goes_down;
    }
    std::copy(upper_.data(), upper, lower);
    return static_cast<std::uint32_t>(lower - points.data());
  }

  /// Sorts along the Morton curve of 64 cells of the cube around the leaf. Triangles that are tested together
  /// are then near each other, and most of their tests end alike.
  void order_leaf(std::span<Point> points) {
    const PointBox box(points);
    const float scale = 4 / box.extent(box.longest_axis());
    if (!(scale < std::numeric_limits<float>::infinity())) return;
    std::array<std::uint32_t, 65> next{};
    leaf_cells_.clear();
    leaf_points_.assign(points.begin(), points.end());
    for (const Point& point : points) {
      constexpr std::uint8_t spread[4] = {0, 1, 8, 9};
      std::uint32_t cell = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        cell |= std::uint32_t{spread[std::min(static_cast<int>((point.at[axis] - box.low[axis]) * scale), 3)]}
                << axis;
      }
      leaf_cells_.push_back(static_cast<std::uint8_t>(cell));
      ++next[cell + 1];
    }
    for (std::size_t cell = 0; cell < 64; ++cell) next[cell + 1] += next[cell];
    for (std::size_t i = 0; i < points.size(); ++i) points[next[leaf_cells_[i]]++] = leaf_points_[i];
  }

  /// Sets coordinates in units of the longest side of the points' box, relative to a point among them, so
  /// that floats can tell the points apart whatever their place and size. One point far away does not cost
  /// the others their precision.
  void set_coordinates(const Range& range) {
    constexpr double inf = std::numeric_limits<double>::infinity();
    // Scaled down so that the difference of two coordinates cannot overflow.
    constexpr double scale = 0.25;
    const std::span<Point> points = points_of(range);
    Vec3d lower{inf, inf, inf}, upper{-inf, -inf, -inf};
    for (const Point& point : points) {
      const Vec3d& c = centers_[point.triangle];
      if (!is_finite(c)) continue;
      for (int axis = 0; axis < 3; ++axis) {
        lower[axis] = std::min(lower[axis], c[axis] * scale);
        upper[axis] = std::max(upper[axis], c[axis] * scale);
      }
    }
    const auto at = [&](const Point& point) {
      const Vec3d& c = centers_[point.triangle];
      return is_finite(c) ? c * scale : lower;
    };
    const Vec3d p = at(points.front()), q = at(points[points.size() / 2]), r = at(points.back());
    const Vec3d origin{median_of(p.x, q.x, r.x), median_of(p.y, q.y, r.y), median_of(p.z, q.z, r.z)};
    const double side = std::max({upper.x - lower.x, upper.y - lower.y, upper.z - lower.z});
    for (Point& point : points) {
      const Vec3d place = at(point);
      for (int axis = 0; axis < 3; ++axis) {
        point.at[axis] = side > 0 ? static_cast<float>((place[axis] - origin[axis]) / side) : 0.0f;
      }
    }
  }

  std::span<Point> points_of(const Range& range) {
    return std::span(points_).subspan(range.begin, range.size());
  }

  std::span<const Vec3d> centers_;
  ObjectOctreeOptions options_;
  std::uint32_t fill_;     ///< triangles of a usual leaf
  OctreeTopology topology_;
  std::vector<Range> ranges_;  ///< of the nodes
  std::vector<Point> points_;  ///< in the octree's order
  // Of the node that is being split.
  std::vector<Range> children_;
  std::uint64_t child_limit_ = 0;  ///< triangles
  std::vector<float> coordinates_;
  std::vector<Point> upper_;
  std::vector<std::uint8_t> leaf_cells_;
  std::vector<Point> leaf_points_;
};

}  // namespace

OctreeTopology build_balanced_octree(std::span<const Vec3d> centers, const ObjectOctreeOptions& options) {
  return BalancedBuilder(centers, options).build();
}

}  // namespace supple
