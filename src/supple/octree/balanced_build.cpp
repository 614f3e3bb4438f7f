#include "octree/balanced_build.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "geometry/aabb.hpp"
#include "geometry/vector.hpp"
#include "mesh/vertex_sets.hpp"

namespace supple {
namespace {

/// A range with a smaller extent gets new coordinates, so that floats can distinguish its points.
constexpr float least_extent = 0x1p-80f;
/// A cut may leave its wanted place by this part of all points, to use a gap.
constexpr std::size_t gap_reach = 16;
/// A cut between connected parts may cost this many times a cut in two halves, by the surface-area heuristic.
constexpr double most_part_cost = 1.5;
/// Smaller parts on average are treated as loose triangles.
constexpr std::size_t least_part_size = 4;

/// The median of three, which a single point far away does not move.
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
    // Compilers compare four coordinates at a time, so the triangle's number is the fourth.
    constexpr float inf = std::numeric_limits<float>::infinity();
    low = {inf, inf, inf, inf};
    high = {-inf, -inf, -inf, -inf};
    for (const Point& point : points) {
      const auto at = std::bit_cast<std::array<float, 4>>(point);
      for (std::size_t i = 0; i < 4; ++i) {
        low[i] = at[i] < low[i] ? at[i] : low[i];
        high[i] = at[i] > high[i] ? at[i] : high[i];
      }
    }
  }
  float extent(std::size_t axis) const { return high[axis] - low[axis]; }
  /// The first of equally long axes.
  std::size_t longest_axis() const {
    std::size_t longest = 0;
    for (std::size_t axis = 1; axis < 3; ++axis) longest = extent(axis) > extent(longest) ? axis : longest;
    return longest;
  }
};

/// The connected part of each triangle: triangles that share vertex ids are connected. A part is named by its
/// smallest vertex id. Empty when all triangles are connected.
std::vector<std::uint32_t> connected_parts(std::span<const Triangle> triangles) {
  std::size_t vertex_count = 0;
  for (const Triangle& t : triangles)
    vertex_count = std::max<std::size_t>(vertex_count, std::ranges::max(t) + 1);
  VertexSets sets(vertex_count);
  for (const Triangle& t : triangles) {
    sets.join(t[0], t[1]);
    sets.join(t[1], t[2]);
  }
  std::vector<std::uint32_t> parts;
  parts.reserve(triangles.size());
  for (const Triangle& t : triangles) parts.push_back(sets.root(t[0]));
  const bool is_one_part = std::ranges::adjacent_find(parts, std::not_equal_to{}) == parts.end();
  return is_one_part ? std::vector<std::uint32_t>() : parts;
}

class BalancedSplitter {
 public:
  BalancedSplitter(std::span<const Vec3d> centers, std::span<const Triangle> triangles,
                   const ObjectOctreeOptions& options)
      : centers_(centers),
        part_of_triangle_(connected_parts(triangles)),
        options_(options),
        fill_(options.leaf_size / 2 + options.leaf_size % 2),
        points_(centers.size()) {
    for (std::uint32_t t = 0; t < points_.size(); ++t) points_[t].triangle = t;
    if (!part_of_triangle_.empty())
      place_in_list_.assign(std::ranges::max(part_of_triangle_) + std::size_t{1}, none);
    if (!points_.empty()) set_coordinates({0, static_cast<std::uint32_t>(points_.size())});
  }

  bool should_split(TriangleRange range, std::uint32_t level) const {
    return range.size() > options_.leaf_size && level < options_.max_level;
  }

  /// Plans as few levels as possible. A node on the last level has a child for each leaf. Other nodes have
  /// two, four or eight children, because halves follow the rows of a grid better than sevenths.
  void split(TriangleRange range, std::uint32_t level, std::vector<TriangleRange>& children) {
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
    cut_into_children(range, static_cast<std::uint32_t>(std::clamp<std::uint64_t>(count, 2, node_width)),
                      children);
  }

  /// Sorts along the Morton curve of 64 cells of the cube around the leaf. Then triangles that are tested
  /// together are near each other, and most of their tests end at the same stage.
  void finish_leaf(TriangleRange range) {
    const std::span<Point> points = points_of(range);
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

  std::span<const Point> items() const { return points_; }

 private:
  void cut_into_children(TriangleRange range, std::uint32_t count, std::vector<TriangleRange>& children) {
    if (count == 1 || range.size() <= fill_) {
      children.push_back(range);
      return;
    }
    std::uint32_t lower_count = count / 2;
    std::uint32_t lower = cut_between_parts(range);
    if (lower > 0) {
      const std::uint64_t size = range.size(), share = (2 * std::uint64_t{lower} * count + size) / (2 * size);
      lower_count = static_cast<std::uint32_t>(std::clamp<std::uint64_t>(share, 1, count - 1));
    } else {
      lower = cut(range, lower_count, count);
    }
    const std::uint32_t middle = range.begin + lower;
    cut_into_children({range.begin, middle}, lower_count, children);
    cut_into_children({middle, range.end}, count - lower_count, children);
  }

  /// The triangles of a connected part in a range.
  struct Part {
    std::uint32_t name = 0, size = 0;
    Aabb box{};
    bool is_lower = false;

    float center(int axis) const { return box.min[axis] + box.max[axis]; }
  };

  /// Puts the triangles of some connected parts first, about half of all, and returns their number. Parts
  /// move apart when the object deforms, and a leaf of two parts is large and cannot be culled. Returns 0
  /// when there is only one part, and when parts are so entangled that a cut through them is better.
  std::uint32_t cut_between_parts(TriangleRange range) {
    if (part_of_triangle_.empty()) return 0;
    const std::span<Point> points = points_of(range);
    list_parts(points);
    if (parts_.size() < 2 || points.size() < least_part_size * parts_.size()) return 0;
    Aabb all;
    for (const Part& part : parts_) extend(all, part.box);
    const std::uint32_t lower = choose_lower_parts(all, range.size());
    Aabb lower_box, upper_box, half = all;
    for (const Part& part : parts_) extend(part.is_lower ? lower_box : upper_box, part.box);
    const int axis = longest_axis(all);
    half.max[axis] = half.min[axis] + (half.max[axis] - half.min[axis]) / 2;
    const double cost = half_surface(lower_box) * lower + half_surface(upper_box) * (range.size() - lower);
    if (cost > most_part_cost * half_surface(half) * range.size()) return 0;
    for (std::size_t i = 0; i < parts_.size(); ++i)
      place_in_list_[parts_[i].name] = static_cast<std::uint32_t>(i);
    return partition(points, [&](const Point& point) {
      return parts_[place_in_list_[part_of_triangle_[point.triangle]]].is_lower;
    });
  }

  void list_parts(std::span<const Point> points) {
    for (const Part& part : parts_) place_in_list_[part.name] = none;
    parts_.clear();
    for (const Point& point : points) {
      std::uint32_t& place = place_in_list_[part_of_triangle_[point.triangle]];
      if (place == none) {
        place = static_cast<std::uint32_t>(parts_.size());
        parts_.push_back({.name = part_of_triangle_[point.triangle]});
      }
      const Vec3f at{point.at[0], point.at[1], point.at[2]};
      extend(parts_[place].box, Aabb{at, at});
      ++parts_[place].size;
    }
  }

  /// Chooses a part that has more than half of the triangles, or else the first parts along the longest axis.
  std::uint32_t choose_lower_parts(const Aabb& all, std::uint32_t size) {
    const auto largest = std::ranges::max_element(parts_, {}, &Part::size);
    if (largest->size > size / 2) {
      largest->is_lower = true;
      return largest->size;
    }
    const int axis = longest_axis(all);
    std::ranges::sort(parts_, {}, [&](const Part& part) { return std::pair(part.center(axis), part.name); });
    std::uint32_t lower = 0;
    for (Part& part : parts_) {
      if (lower > 0 && 2 * (lower + part.size) > size + part.size)
        break;  // further from half than without it
      part.is_lower = true;
      lower += part.size;
    }
    return lower;
  }

  static int longest_axis(const Aabb& box) {
    const Vec3f extent{box.max.x - box.min.x, box.max.y - box.min.y, box.max.z - box.min.z};
    return extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  }

  /// How many points come before a cut: between `least` and `most`, at best `wanted`.
  struct CutGoal {
    std::uint64_t wanted, least, most;

    bool allows(std::uint64_t lower) const { return lower >= least && lower <= most; }
  };

  /// Puts the points of the first `lower` of `count` children first and returns their number. Cuts across the
  /// longest axis, in a gap near the wanted number. Points with the same coordinate are divided only when
  /// there are too many of them, in their present order.
  std::uint32_t cut(TriangleRange range, std::uint32_t lower, std::uint32_t count) {
    const std::span<Point> points = points_of(range);
    PointBox box(points);
    if (box.extent(box.longest_axis()) < least_extent) {
      set_coordinates(range);
      box = PointBox(points);
    }
    const std::size_t axis = box.longest_axis();
    const std::uint64_t size = range.size(), wanted = size * lower / count, slack = size / 8;
    // No child may get more triangles than it can hold, and no side an eighth more or less than wanted.
    const CutGoal goal{wanted,
                       std::max(size - std::min(size - 1, child_limit_ * (count - lower)), wanted - slack),
                       std::min({size - 1, child_limit_ * lower, wanted + slack})};
    const std::uint32_t in_gap = cut_in_gap(points, axis, box, goal);
    return in_gap != 0 ? in_gap : cut_at(points, axis, goal);
  }

  /// Cuts in a wide gap near the wanted number, so that rows of a grid and things that lie apart stay whole.
  /// For each point further away, the gap must be wider by the average distance between points. Counts the
  /// points in cells along the axis and takes gaps of whole cells. Returns 0 when too many points lie in one
  /// cell.
  std::uint32_t cut_in_gap(std::span<Point> points, std::size_t axis, const PointBox& box,
                           const CutGoal& goal) {
    const std::size_t size = points.size(), cells = size < 256 ? 64 : size < 2048 ? 256 : 1024;
    const float low = box.low[axis], scale = static_cast<float>(cells) / box.extent(axis);
    if (!(scale < std::numeric_limits<float>::infinity())) return 0;
    cell_counts_.assign(cells, 0);
    for (const Point& point : points) {
      ++cell_counts_[std::min(static_cast<std::size_t>((point.at[axis] - low) * scale), cells - 1)];
    }
    const auto reach = static_cast<std::int64_t>(1 + size / gap_reach);
    std::int64_t most = std::numeric_limits<std::int64_t>::min();
    std::size_t border = 0;  // the first cell of the upper side
    std::uint64_t lower = 0, empty_cells = 0;
    for (std::size_t cell = 0; cell < cells; ++cell) {
      if (cell_counts_[cell] == 0) {
        ++empty_cells;
        continue;
      }
      const std::int64_t distance = std::abs(static_cast<std::int64_t>(lower - goal.wanted));
      const std::int64_t merit =
          static_cast<std::int64_t>(empty_cells * size) - distance * static_cast<std::int64_t>(cells);
      if (distance <= reach && goal.allows(lower) && merit > most) {
        most = merit;
        border = cell;
      }
      lower += cell_counts_[cell];
      empty_cells = 0;
    }
    if (border == 0) return 0;
    return partition(points, [=](const Point& point) {
      return (point.at[axis] - low) * scale < static_cast<float>(border);
    });
  }

  /// Cuts at the wanted number, or where the coordinate changes next to there if that is allowed.
  std::uint32_t cut_at(std::span<Point> points, std::size_t axis, const CutGoal& goal) {
    coordinates_.clear();
    for (const Point& point : points) coordinates_.push_back(point.at[axis]);
    const auto middle = coordinates_.begin() + static_cast<std::ptrdiff_t>(goal.wanted);
    std::nth_element(coordinates_.begin(), middle, coordinates_.end());
    const float border = *middle;
    std::uint64_t less = 0, not_greater = 0;
    for (const Point& point : points) {
      less += point.at[axis] < border;
      not_greater += point.at[axis] <= border;
    }
    const std::uint64_t lower = goal.allows(less)          ? less
                                : goal.allows(not_greater) ? not_greater
                                                           : goal.wanted;
    // The points below the border, and the first of those on it.
    return partition(points, [&, room = lower - less](const Point& point) mutable {
      const bool is_taken = point.at[axis] == border && room > 0;
      room -= is_taken;
      return point.at[axis] < border || is_taken;
    });
  }

  /// Puts the points for which `is_lower(point)` is true first, keeps the order of both sides, and returns
  /// the number of these points.
  template <class IsLower>
  std::uint32_t partition(std::span<Point> points, IsLower is_lower) {
    if (upper_.size() < points.size()) upper_.resize(points.size());
    // Writes to both sides and advances one of them: a branch would be mispredicted half of the time.
    Point* lower = points.data();
    Point* upper = upper_.data();
    for (const Point& point : points) {
      const Point copy = point;
      const std::ptrdiff_t goes_down = is_lower(copy);
      *lower = copy;
      *upper = copy;
      lower += goes_down;
      upper += 1 - goes_down;
    }
    std::copy(upper_.data(), upper, lower);
    return static_cast<std::uint32_t>(lower - points.data());
  }

  /// Sets coordinates in units of the longest side of the points' box, relative to a point among them. So
  /// floats distinguish the points at any place and scale, and one point far away does not cost the others
  /// their precision.
  void set_coordinates(TriangleRange range) {
    const std::span<Point> points = points_of(range);
    const CenterBounds bounds(points, centers_);
    const double side = bounds.longest_side();
    const auto at = [&](const Point& point) {
      const Vec3d& c = centers_[point.triangle];
      return is_finite(c) ? c * CenterBounds::scale : bounds.lower;
    };
    const Vec3d p = at(points.front()), q = at(points[points.size() / 2]), r = at(points.back());
    const Vec3d origin{median_of(p.x, q.x, r.x), median_of(p.y, q.y, r.y), median_of(p.z, q.z, r.z)};
    for (Point& point : points) {
      const Vec3d place = at(point);
      for (int axis = 0; axis < 3; ++axis) {
        point.at[axis] = side > 0 ? static_cast<float>((place[axis] - origin[axis]) / side) : 0.0f;
      }
    }
  }

  std::span<Point> points_of(TriangleRange range) {
    return std::span(points_).subspan(range.begin, range.size());
  }

  static constexpr std::uint32_t none = ~std::uint32_t{0};

  std::span<const Vec3d> centers_;
  std::vector<std::uint32_t> part_of_triangle_;  ///< empty when the mesh is one part
  ObjectOctreeOptions options_;
  std::uint32_t fill_;             ///< triangles of a usual leaf
  std::vector<Point> points_;      ///< in the octree's order
  std::uint64_t child_limit_ = 0;  ///< triangles of a child of the node that is being split
  // Scratch memory.
  std::vector<Part> parts_;                   ///< of one range
  std::vector<std::uint32_t> place_in_list_;  ///< in `parts_`, by the name of the part
  std::vector<std::uint32_t> cell_counts_;
  std::vector<float> coordinates_;
  std::vector<Point> upper_;
  std::vector<std::uint8_t> leaf_cells_;
  std::vector<Point> leaf_points_;
};

}  // namespace

OctreeTopology build_balanced_octree(std::span<const Vec3d> centers, std::span<const Triangle> triangles,
                                     const ObjectOctreeOptions& options) {
  return build_octree(BalancedSplitter(centers, triangles, options));
}

}  // namespace supple
