#include "octree/octree_build.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>

#include "geometry/vector.hpp"

namespace supple {
namespace {

constexpr int bits_per_axis = 21;
constexpr int bits_of_code = 3 * bits_per_axis;

/// Place of a point in the octree: three bits a level, the first level highest. A tree of fewer children
/// reads two or one of the bits at a time, which halve z, y and x in turn.
struct Coded {
  std::uint64_t code;
  std::uint32_t index;

  bool operator<(const Coded& other) const {
    return code != other.code ? code < other.code : index < other.index;
  }
};

/// A range of the sorted points that becomes a node.
struct Range {
  std::uint32_t begin, end;
};

/// Puts two zero bits between each of the low 21 bits.
std::uint64_t spread_bits(std::uint64_t v) {
  v = (v | v << 32) & 0x001f00000000ffffu;
  v = (v | v << 16) & 0x001f0000ff0000ffu;
  v = (v | v << 8) & 0x100f00f00f00f00fu;
  v = (v | v << 4) & 0x10c30c30c30c30c3u;
  return (v | v << 2) & 0x1249249249249249u;
}

int bits_per_level(const ObjectOctreeOptions& options) {
  return static_cast<int>(std::bit_width(options.arity)) - 1;
}

/// In levels of a tree of that arity.
std::uint32_t deepest_level(const ObjectOctreeOptions& options) {
  return options.max_level * 3 / static_cast<std::uint32_t>(bits_per_level(options));
}

class Builder {
 public:
  Builder(std::span<const Vec3d> centers, const ObjectOctreeOptions& options)
      : centers_(centers),
        options_(options),
        bits_per_level_(bits_per_level(options)),
        deepest_(deepest_level(options)),
        coded_(centers.size()) {
    assert(options.arity == 2 || options.arity == 4 || options.arity == 8);
    for (std::uint32_t i = 0; i < coded_.size(); ++i) coded_[i] = {0, i};
  }

  OctreeTopology build() {
    OctreeTopology topology;
    if (!coded_.empty()) {
      add_root(topology);
      for (std::size_t n = 0; n < topology.nodes.size(); ++n) add_children(topology, n);
      for (std::uint32_t n = 0; n < topology.nodes.size(); ++n) {
        if (topology.nodes[n].level == topology.level_begin.size()) topology.level_begin.push_back(n);
      }
    }
    topology.level_begin.push_back(static_cast<std::uint32_t>(topology.nodes.size()));
    topology.order.reserve(coded_.size());
    for (const Coded& coded : coded_) topology.order.push_back(coded.index);
    return topology;
  }

 private:
  void add_root(OctreeTopology& topology) {
    const Range all{0, static_cast<std::uint32_t>(coded_.size())};
    assign_codes(all);
    topology.nodes.push_back(should_split(all, 0) ? split(all) : single_lane(all));
  }

  /// Lanes that go on become nodes at the end of the array: the nodes come level by level.
  void add_children(OctreeTopology& topology, std::size_t n) {
    OctreeNode node = topology.nodes[n];
    node.first_child = static_cast<std::uint32_t>(topology.nodes.size());
    const bool is_leaf_root = node.lane_count == 1;
    for (int lane = 0; lane < node.lane_count && !is_leaf_root; ++lane) {
      const Range range{node.first_triangle[lane], node.first_triangle[lane + 1]};
      if (!should_split(range, node.level + 1u)) continue;
      OctreeNode child = split(range);
      child.level = static_cast<std::uint8_t>(node.level + 1);
      child.parent = static_cast<std::uint32_t>(n);
      child.parent_lane = static_cast<std::uint8_t>(lane);
      node.inner_mask = static_cast<std::uint8_t>(node.inner_mask | 1u << lane);
      topology.nodes.push_back(child);
    }
    topology.nodes[n] = node;
  }

  bool should_split(Range range, std::uint32_t level) {
    if (range.end - range.begin <= options_.leaf_size || level >= deepest_) return false;
    if (coded_[range.begin].code != coded_[range.end - 1].code) return true;
    // The codes are used up while the points differ still: a cube of their own gives them new ones.
    assign_codes(range);
    return coded_[range.begin].code != coded_[range.end - 1].code;
  }

  /// Octants, quarters or halves of the smallest regular cell that holds the range; those without points are
  /// left out.
  OctreeNode split(Range range) const {
    const std::uint64_t differing = coded_[range.begin].code ^ coded_[range.end - 1].code;
    assert(differing != 0);
    const int level = (bits_of_code - static_cast<int>(std::bit_width(differing))) / bits_per_level_;
    const int shift = std::max(bits_of_code - (level + 1) * bits_per_level_, 0);
    OctreeNode node = empty_node();
    std::uint32_t i = range.begin;
    while (i < range.end) {
      const std::uint64_t octant = coded_[i].code >> shift;
      node.first_triangle[node.lane_count++] = i;
      const auto past = std::partition_point(coded_.begin() + i, coded_.begin() + range.end,
                                             [&](const Coded& c) { return c.code >> shift == octant; });
      i = static_cast<std::uint32_t>(past - coded_.begin());
    }
    std::fill(node.first_triangle + node.lane_count, node.first_triangle + node_width + 1, range.end);
    return node;
  }

  static OctreeNode single_lane(Range range) {
    OctreeNode node = empty_node();
    node.lane_count = 1;
    std::fill(node.first_triangle, node.first_triangle + node_width + 1, range.end);
    node.first_triangle[0] = range.begin;
    return node;
  }

  static OctreeNode empty_node() { return OctreeNode{}; }

  /// Codes the points of the range in the cube around them and sorts it.
  void assign_codes(Range range) {
    constexpr double inf = std::numeric_limits<double>::infinity();
    // Scaled down so that the difference of two coordinates cannot overflow.
    constexpr double scale = 0.25;
    Vec3d lower{inf, inf, inf}, upper{-inf, -inf, -inf};
    for (std::uint32_t i = range.begin; i < range.end; ++i) {
      const Vec3d& c = centers_[coded_[i].index];
      if (!is_finite(c)) continue;
      for (int axis = 0; axis < 3; ++axis) {
        lower[axis] = std::min(lower[axis], c[axis] * scale);
        upper[axis] = std::max(upper[axis], c[axis] * scale);
      }
    }
    const double side = std::max({upper.x - lower.x, upper.y - lower.y, upper.z - lower.z});
    const bool flat = !(side > 0);
    for (std::uint32_t i = range.begin; i < range.end; ++i) {
      const Vec3d& c = centers_[coded_[i].index];
      std::uint64_t code = 0;
      if (!flat && is_finite(c)) {
        for (int axis = 0; axis < 3; ++axis)
          code |= spread_bits(cell((c[axis] * scale - lower[axis]) / side)) << axis;
      }
      coded_[i].code = code;
    }
    std::sort(coded_.begin() + range.begin, coded_.begin() + range.end);
  }

  static std::uint64_t cell(double fraction) {
    constexpr double cells = 1 << bits_per_axis;
    return static_cast<std::uint64_t>(std::clamp(fraction * cells, 0.0, cells - 1));
  }

  std::span<const Vec3d> centers_;
  ObjectOctreeOptions options_;
  int bits_per_level_;
  std::uint32_t deepest_;  ///< level
  std::vector<Coded> coded_;
};

}  // namespace

OctreeTopology build_octree(std::span<const Vec3d> centers, const ObjectOctreeOptions& options) {
  return Builder(centers, options).build();
}

}  // namespace supple
