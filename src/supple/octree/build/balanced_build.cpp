#include "octree/build/balanced_build.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "geometry/aabb.hpp"
#include "geometry/vector.hpp"
#include "mesh/vertex_sets.hpp"
#include "octree/build/cut_kernels.hpp"

namespace supple {
namespace {

/// A range with a smaller extent gets new coordinates, so that floats can distinguish its points.
constexpr float least_extent = 0x1p-80f;
/// A cut may leave its wanted place by this part of all points, to use a gap.
constexpr std::size_t gap_reach = 16;
/// A cut between connected parts may cost this many times a cut in two halves, by the surface-area heuristic.
/// A square bundle of long parts takes 1.5.
constexpr double most_part_cost = 1.6;
/// Smaller parts on average are treated as loose triangles.
constexpr std::size_t least_part_size = 4;

/// The median of three, which a single point far away does not move.
double median_of(double p, double q, double r) {
  return std::max(std::min(p, q), std::min(std::max(p, q), r));
}

/// The connected part of each triangle: triangles that share vertex ids are connected. A part is named by its
/// smallest vertex id. Empty when all triangles are connected.
std::vector<std::uint32_t> connected_parts(std::span<const Triangle> triangles) {
  std::size_t vertex_count = 0;
  for (const Triangle& t : triangles)
    vertex_count = std::max<std::size_t>(vertex_count, std::ranges::max(t) + 1);
  VertexSets sets(vertex_count);
  for (const Triangle& t : triangles) sets.join(sets.join(t[0], t[1]), t[2]);
  std::vector<std::uint32_t> parts;
  parts.reserve(triangles.size());
  for (const Triangle& t : triangles) parts.push_back(sets.root(t[0]));
  const bool is_one_part = std::ranges::adjacent_find(parts, std::not_equal_to{}) == parts.end();
  return is_one_part ? std::vector<std::uint32_t>() : parts;
}

/// The centres of triangles, one array per axis.
struct Points {
  std::array<std::vector<float>, 3> at;
  std::vector<std::uint32_t> triangles;

  void resize(std::size_t count) {
    for (std::vector<float>& coordinates : at) coordinates.resize(count);
    triangles.resize(count);
  }
  PointArrays arrays() { return {{at[0].data(), at[1].data(), at[2].data()}, triangles.data()}; }
};

/// The triangles of a connected part in a range.
struct Part {
  std::uint32_t name = 0, size = 0;
  Aabb box{};
  bool is_lower = false;

  float center(int axis) const { return box.min[axis] + box.max[axis]; }
};

constexpr std::uint32_t none = ~std::uint32_t{0};

/// Memory of one worker.
struct Scratch {
  std::vector<Part> parts;                   ///< of one range
  std::vector<std::uint32_t> place_in_list;  ///< in `parts`, by the name of the part
  std::vector<std::uint16_t> cell_of_point;
  std::vector<std::uint32_t> cell_counts;
  std::vector<float> coordinates;
  std::vector<std::uint32_t> leaf_triangles;
  Points upper;
};

int longest_axis(const Aabb& box) {
  const Vec3f extent{box.max.x - box.min.x, box.max.y - box.min.y, box.max.z - box.min.z};
  return extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
}

/// How many points come before a cut: between `least` and `most`, at best `wanted`.
struct CutGoal {
  std::uint64_t wanted, least, most;

  bool allows(std::uint64_t lower) const { return lower >= least && lower <= most; }
};

class BalancedSplitter {
 public:
  BalancedSplitter(std::span<const Vec3d> centers, std::span<const Triangle> triangles,
                   const ObjectOctreeOptions& options, const Parallel& parallel)
      : centers_(centers),
        options_(options),
        fill_(options.leaf_size / 2 + options.leaf_size % 2),
        parallel_(parallel),
        scratch_(parallel.worker_count()) {
    points_.resize(centers.size());
    std::iota(points_.triangles.begin(), points_.triangles.end(), 0u);
    if (centers.empty()) return;
    // The search for parts is serial, so the coordinates are set at the same time.
    parallel.for_ranges(2, 1, [&](std::size_t begin, std::size_t end, std::uint32_t) {
      for (std::size_t task = begin; task < end; ++task) {
        if (task == 0) part_of_triangle_ = connected_parts(triangles);
        if (task == 1) set_coordinates({0, static_cast<std::uint32_t>(centers.size())});
      }
    });
    if (!part_of_triangle_.empty()) name_limit_ = std::ranges::max(part_of_triangle_) + std::size_t{1};
  }

  bool should_split(TriangleRange range, std::uint32_t level) const {
    return range.size() > options_.leaf_size && level < options_.max_level;
  }

  /// Cuts the ranges of all nodes of a level in rounds, so that workers share the cuts of a large node.
  void split(std::span<NodeDivision> nodes, std::uint32_t level) {
    pieces_.clear();
    for (std::uint32_t n = 0; n < nodes.size(); ++n) pieces_.push_back(planned(nodes[n].range, n, level));
    const auto can_be_cut = [&](const Piece& piece) { return piece.count > 1 && piece.range.size() > fill_; };
    while (std::ranges::any_of(pieces_, can_be_cut)) {
      cuts_.assign(pieces_.size(), {});
      for_many(pieces_, [&](std::size_t i, Scratch& scratch) {
        if (can_be_cut(pieces_[i])) cuts_[i] = cut(pieces_[i], scratch);
      });
      next_pieces_.clear();
      for (std::size_t i = 0; i < pieces_.size(); ++i) {
        const Piece& piece = pieces_[i];
        const std::uint32_t middle = piece.range.begin + cuts_[i].lower;
        if (cuts_[i].lower > 0)
          next_pieces_.push_back(
              {{piece.range.begin, middle}, piece.node, cuts_[i].lower_count, piece.child_limit});
        next_pieces_.push_back(
            {{middle, piece.range.end}, piece.node, piece.count - cuts_[i].lower_count, piece.child_limit});
      }
      pieces_.swap(next_pieces_);
    }
    for (const Piece& piece : pieces_) nodes[piece.node].push_child(piece.range);
  }

  std::vector<std::uint32_t> finish(std::span<const TriangleRange> leaves) {
    for_many(leaves, [&](std::size_t i, Scratch& scratch) { sort_leaf(leaves[i], scratch); });
    return std::move(points_.triangles);
  }

 private:
  /// A part of the range of a node, which becomes `count` children. None may get more triangles than
  /// `child_limit`.
  struct Piece {
    TriangleRange range{};
    std::uint32_t node = 0;
    std::uint32_t count = 0;
    std::uint64_t child_limit = 0;
  };
  /// The first `lower` triangles of a piece become `lower_count` children.
  struct Cut {
    std::uint32_t lower = 0, lower_count = 0;
  };

  /// Calls `body(index, scratch)` for all items, in parallel.
  template <class Items, class Body>
  void for_many(const Items& items, const Body& body) {
    constexpr std::size_t triangles_per_task = 8192;
    const std::size_t grain = 1 + items.size() * triangles_per_task / (points_.triangles.size() + 1);
    parallel_.for_ranges(items.size(), grain, [&](std::size_t begin, std::size_t end, std::uint32_t worker) {
      for (std::size_t i = begin; i < end; ++i) body(i, scratch_[worker]);
    });
  }

  /// Plans as few levels as possible. A node on the last level has a child for each leaf. Other nodes have
  /// two, four or eight children, because halves follow the rows of a grid better than sevenths.
  Piece planned(TriangleRange range, std::uint32_t node, std::uint32_t level) const {
    const std::uint32_t most = fill_ + (options_.leaf_size - fill_) / 2;
    std::uint64_t leaves_of_child = 1;
    std::uint32_t levels = 1;
    while (range.size() > leaves_of_child * (level == 0 ? most : options_.leaf_size) * node_width) {
      leaves_of_child *= node_width;
      ++levels;
    }
    std::uint64_t count = (range.size() + leaves_of_child * most - 1) / (leaves_of_child * most);
    count = levels > 1 ? std::bit_ceil(count)
                       : std::max<std::uint64_t>(count, (range.size() + fill_ / 2) / fill_);
    if (level + levels > options_.max_level) count = node_width;
    return {range, node, static_cast<std::uint32_t>(std::clamp<std::uint64_t>(count, 2, node_width)),
            leaves_of_child * options_.leaf_size};
  }

  Cut cut(const Piece& piece, Scratch& scratch) {
    const std::uint32_t size = piece.range.size();
    const PointArrays points = points_.arrays().from(piece.range.begin);
    if (scratch.upper.triangles.size() < size + points_ahead) scratch.upper.resize(size + points_ahead);
    scratch.cell_of_point.resize(size);
    if (const std::uint32_t lower = cut_between_parts(points, size, scratch); lower > 0) {
      const std::uint64_t share = (2 * std::uint64_t{lower} * piece.count + size) / (2 * std::uint64_t{size});
      return {lower, static_cast<std::uint32_t>(std::clamp<std::uint64_t>(share, 1, piece.count - 1))};
    }
    return {cut_across(points, piece, scratch), piece.count / 2};
  }

  /// Puts the triangles of some connected parts first, about half of all, and returns their number. Parts
  /// move apart when the object deforms, and a leaf of two parts is large and cannot be culled. Returns 0
  /// when there is only one part, and when parts are so entangled that a cut through them is better.
  std::uint32_t cut_between_parts(const PointArrays& points, std::uint32_t count, Scratch& scratch) const {
    if (part_of_triangle_.empty()) return 0;
    list_parts(points, count, scratch);
    std::vector<Part>& parts = scratch.parts;
    if (parts.size() < 2 || count < least_part_size * parts.size()) return 0;
    Aabb all;
    for (const Part& part : parts) extend(all, part.box);
    const std::uint32_t lower = choose_lower_parts(parts, count);
    Aabb lower_box, upper_box, half = all;
    for (const Part& part : parts) extend(part.is_lower ? lower_box : upper_box, part.box);
    const int axis = longest_axis(all);
    half.max[axis] = half.min[axis] + (half.max[axis] - half.min[axis]) / 2;
    const double cost = half_surface(lower_box) * lower + half_surface(upper_box) * (count - lower);
    if (cost > most_part_cost * half_surface(half) * count) return 0;
    for (std::size_t i = 0; i < parts.size(); ++i)
      scratch.place_in_list[parts[i].name] = static_cast<std::uint32_t>(i);
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t part = scratch.place_in_list[part_of_triangle_[points.triangles[i]]];
      scratch.cell_of_point[i] = parts[part].is_lower ? 0 : 1;
    }
    return partition(points, count, 1, scratch);
  }

  void list_parts(const PointArrays& points, std::uint32_t count, Scratch& scratch) const {
    if (scratch.place_in_list.empty()) scratch.place_in_list.assign(name_limit_, none);
    for (const Part& part : scratch.parts) scratch.place_in_list[part.name] = none;
    scratch.parts.clear();
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t name = part_of_triangle_[points.triangles[i]];
      std::uint32_t& place = scratch.place_in_list[name];
      if (place == none) {
        place = static_cast<std::uint32_t>(scratch.parts.size());
        scratch.parts.push_back({.name = name});
      }
      const Vec3f at{points.at[0][i], points.at[1][i], points.at[2][i]};
      extend(scratch.parts[place].box, Aabb{at, at});
      ++scratch.parts[place].size;
    }
  }

  /// Chooses a part with over half of the triangles, or else the first along the longest axis of middles.
  static std::uint32_t choose_lower_parts(std::vector<Part>& parts, std::uint32_t size) {
    const auto largest = std::ranges::max_element(parts, {}, &Part::size);
    if (largest->size > size / 2) {
      largest->is_lower = true;
      return largest->size;
    }
    Aabb middles;
    for (const Part& part : parts) extend(middles, Vec3f{part.center(0), part.center(1), part.center(2)});
    const int axis = longest_axis(middles);
    std::ranges::sort(parts, {}, [&](const Part& part) { return std::pair(part.center(axis), part.name); });
    std::uint32_t lower = 0;
    for (Part& part : parts) {
      if (lower > 0 && 2 * (lower + part.size) > size + part.size)
        break;  // further from half than without it
      part.is_lower = true;
      lower += part.size;
    }
    return lower;
  }

  /// Puts the points of the first half of the children first and returns their number. Cuts across the
  /// longest axis, in a gap near the wanted number. Points with the same coordinate are divided only when
  /// there are too many of them, in their present order.
  std::uint32_t cut_across(const PointArrays& points, const Piece& piece, Scratch& scratch) {
    PointBox box = box_of_points(points, piece.range.size());
    if (box.extent(box.longest_axis()) < least_extent) {
      set_coordinates(piece.range);
      box = box_of_points(points, piece.range.size());
    }
    const std::size_t axis = box.longest_axis();
    const std::uint64_t size = piece.range.size(), slack = size / 8;
    const std::uint64_t lower = piece.count / 2, wanted = size * lower / piece.count;
    // No child may get more triangles than it can hold, and no side an eighth more or less than wanted.
    const CutGoal goal{
        wanted,
        std::max(size - std::min(size - 1, piece.child_limit * (piece.count - lower)), wanted - slack),
        std::min({size - 1, piece.child_limit * lower, wanted + slack})};
    const std::uint32_t in_gap = cut_in_gap(points, piece.range.size(), axis, box, goal, scratch);
    return in_gap != 0 ? in_gap : cut_at(points, piece.range.size(), axis, goal, scratch);
  }

  /// Cuts in a wide gap near the wanted number, so that rows of a grid and things that lie apart stay whole.
  /// For each point further away, the gap must be wider by the average distance between points. Counts the
  /// points in cells along the axis and takes gaps of whole cells. Returns 0 when too many points lie in one
  /// cell.
  static std::uint32_t cut_in_gap(const PointArrays& points, std::uint32_t size, std::size_t axis,
                                  const PointBox& box, const CutGoal& goal, Scratch& scratch) {
    const std::uint32_t cells = size < 256 ? 64 : size < 2048 ? 256 : 1024;
    const float scale = static_cast<float>(cells) / box.extent(axis);
    if (!(scale < std::numeric_limits<float>::infinity())) return 0;
    number_cells(points.at[axis], size, box.low[axis], scale, cells, scratch.cell_of_point.data());
    scratch.cell_counts.assign(cells, 0);
    for (const std::uint16_t cell : scratch.cell_of_point) ++scratch.cell_counts[cell];
    const auto reach = static_cast<std::int64_t>(1 + size / gap_reach);
    std::int64_t most = std::numeric_limits<std::int64_t>::min();
    std::uint32_t border = 0;  // the first cell of the upper side
    std::uint64_t lower = 0, empty_cells = 0;
    for (std::uint32_t cell = 0; cell < cells; ++cell) {
      const std::uint32_t count = scratch.cell_counts[cell];
      if (count == 0) {
        ++empty_cells;
        continue;
      }
      const auto distance = static_cast<std::int64_t>(lower - goal.wanted);
      if (distance > reach) break;
      if (distance >= -reach && goal.allows(lower)) {
        const std::int64_t merit = static_cast<std::int64_t>(empty_cells * size) -
                                   std::abs(distance) * static_cast<std::int64_t>(cells);
        if (merit > most) {
          most = merit;
          border = cell;
        }
      }
      lower += count;
      empty_cells = 0;
    }
    return border == 0 ? 0 : partition(points, size, border, scratch);
  }

  /// Cuts at the wanted number, or where the coordinate changes next to there if that is allowed.
  static std::uint32_t cut_at(const PointArrays& points, std::uint32_t size, std::size_t axis,
                              const CutGoal& goal, Scratch& scratch) {
    const std::span<const float> along(points.at[axis], size);
    scratch.coordinates.assign(along.begin(), along.end());
    const auto middle = scratch.coordinates.begin() + static_cast<std::ptrdiff_t>(goal.wanted);
    std::nth_element(scratch.coordinates.begin(), middle, scratch.coordinates.end());
    const float border = *middle;
    std::uint64_t less = 0, not_greater = 0;
    for (const float coordinate : along) {
      less += coordinate < border;
      not_greater += coordinate <= border;
    }
    const std::uint64_t lower = goal.allows(less)          ? less
                                : goal.allows(not_greater) ? not_greater
                                                           : goal.wanted;
    // The points below the border, and the first of those on it.
    std::uint64_t room = lower - less;
    for (std::size_t i = 0; i < along.size(); ++i) {
      const bool is_taken = along[i] == border && room > 0;
      room -= is_taken;
      scratch.cell_of_point[i] = along[i] < border || is_taken ? 0 : 1;
    }
    return partition(points, size, 1, scratch);
  }

  static std::uint32_t partition(const PointArrays& points, std::uint32_t size, std::uint32_t border,
                                 Scratch& scratch) {
    return partition_points(points, size, scratch.cell_of_point.data(), border, scratch.upper.arrays());
  }

  /// Sets coordinates in units of the longest side of the points' box, relative to a point among them. So
  /// floats distinguish the points at any place and scale, and one point far away does not cost the others
  /// their precision.
  void set_coordinates(TriangleRange range) {
    const std::span<const std::uint32_t> triangles =
        std::span(points_.triangles).subspan(range.begin, range.size());
    CenterBounds bounds;
    for (const std::uint32_t triangle : triangles) bounds.add(centers_[triangle]);
    const double side = bounds.longest_side();
    const auto at = [&](std::uint32_t triangle) {
      const Vec3d& c = centers_[triangle];
      return is_finite(c) ? c * CenterBounds::scale : bounds.lower;
    };
    const Vec3d p = at(triangles.front()), q = at(triangles[triangles.size() / 2]), r = at(triangles.back());
    const Vec3d origin{median_of(p.x, q.x, r.x), median_of(p.y, q.y, r.y), median_of(p.z, q.z, r.z)};
    const PointArrays points = points_.arrays().from(range.begin);
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      const Vec3d place = at(triangles[i]);
      for (int axis = 0; axis < 3; ++axis) {
        points.at[static_cast<std::size_t>(axis)][i] =
            side > 0 ? static_cast<float>((place[axis] - origin[axis]) / side) : 0.0f;
      }
    }
  }

  /// Sorts along the Morton curve of 64 cells of the cube around the leaf. Then triangles that are tested
  /// together are near each other, and most of their tests end at the same stage. The points of the leaf are
  /// not used again, so only the triangles move.
  void sort_leaf(TriangleRange leaf, Scratch& scratch) {
    const std::size_t size = leaf.size();
    const PointArrays points = points_.arrays().from(leaf.begin);
    const PointBox box = box_of_points(points, size);
    const float scale = 4 / box.extent(box.longest_axis());
    if (!(scale < std::numeric_limits<float>::infinity())) return;
    scratch.cell_of_point.resize(3 * size);
    std::uint16_t* const cells[] = {scratch.cell_of_point.data(), scratch.cell_of_point.data() + size,
                                    scratch.cell_of_point.data() + 2 * size};
    for (std::size_t axis = 0; axis < 3; ++axis)
      number_cells(points.at[axis], size, box.low[axis], scale, 4, cells[axis]);
    std::array<std::uint32_t, 65> next{};
    for (std::size_t i = 0; i < size; ++i) {
      constexpr std::uint8_t spread[4] = {0, 1, 8, 9};
      cells[0][i] = static_cast<std::uint16_t>(spread[cells[0][i]] | spread[cells[1][i]] << 1 |
                                               spread[cells[2][i]] << 2);
      ++next[cells[0][i] + std::size_t{1}];
    }
    for (std::size_t cell = 0; cell < 64; ++cell) next[cell + 1] += next[cell];
    scratch.leaf_triangles.assign(points.triangles, points.triangles + size);
    for (std::size_t i = 0; i < size; ++i) points.triangles[next[cells[0][i]]++] = scratch.leaf_triangles[i];
  }

  std::span<const Vec3d> centers_;
  std::vector<std::uint32_t> part_of_triangle_;  ///< empty when the mesh is one part
  std::size_t name_limit_ = 0;                   ///< names of parts are smaller
  ObjectOctreeOptions options_;
  std::uint32_t fill_;                       ///< triangles of a usual leaf
  Points points_;                            ///< in the octree's order
  std::vector<Piece> pieces_, next_pieces_;  ///< of all nodes of a level, in their order
  std::vector<Cut> cuts_;                    ///< of each piece
  const Parallel& parallel_;
  std::vector<Scratch> scratch_;
};

}  // namespace

OctreeTopology build_balanced_octree(std::span<const Vec3d> centers, std::span<const Triangle> triangles,
                                     const ObjectOctreeOptions& options, const Parallel& parallel) {
  return build_octree(static_cast<std::uint32_t>(centers.size()),
                      BalancedSplitter(centers, triangles, options, parallel));
}

}  // namespace supple
