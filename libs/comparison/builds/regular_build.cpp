#include "comparison/methods.hpp"

#include <algorithm>
#include <bit>
#include <cassert>

#include "octree/morton_curve.hpp"

namespace supple {
namespace {

/// A tree of fewer children reads two or one of the three bits of a level at a time, which halve z, y and x
/// in turn.
constexpr int bits_of_code = 3 * curve_bits_per_axis;

class RegularSplitter {
 public:
  static constexpr bool has_numbers = true;

  RegularSplitter(std::span<const Vec3d> centers, const ObjectOctreeOptions& options)
      : centers_(centers),
        leaf_size_(options.leaf_size),
        bits_per_level_(bits_per_level(options.arity)),
        deepest_(deepest_level(options)),
        coded_(centers.size()),
        is_coded_again_(centers.size(), false) {
    assert(options.arity == 2 || options.arity == 4 || options.arity == 8);
    for (std::uint32_t i = 0; i < coded_.size(); ++i) coded_[i] = {0, i};
    sort_along_curve(coded_, centers_, memory_);
  }

  bool should_split(TriangleRange range, std::uint32_t level) {
    if (range.size() <= leaf_size_ || level >= deepest_) return false;
    if (coded_[range.begin].code != coded_[range.end - 1].code) return true;
    // The codes are used up, but the centres may differ: the cube around them gives them new codes.
    sort_along_curve(std::span(coded_).subspan(range.begin, range.size()), centers_, memory_);
    std::fill_n(is_coded_again_.begin() + range.begin, range.size(), true);
    return coded_[range.begin].code != coded_[range.end - 1].code;
  }

  /// The children of a node are the octants, quarters or halves of the smallest regular cell that contains
  /// its range, without the empty ones.
  void split(std::span<NodeDivision> nodes, std::uint32_t) const {
    for (NodeDivision& node : nodes) {
      const TriangleRange range = node.range;
      const std::uint64_t differing = coded_[range.begin].code ^ coded_[range.end - 1].code;
      assert(differing != 0);
      const int level = (bits_of_code - static_cast<int>(std::bit_width(differing))) / bits_per_level_;
      const int shift = std::max(bits_of_code - (level + 1) * bits_per_level_, 0);
      for (std::uint32_t i = range.begin; i < range.end;) {
        const std::uint64_t octant = coded_[i].code >> shift;
        const auto past =
            std::partition_point(coded_.begin() + i, coded_.begin() + range.end,
                                 [&](const CurvePlace& c) { return c.code >> shift == octant; });
        const auto end = static_cast<std::uint32_t>(past - coded_.begin());
        node.push_child({i, end}, is_coded_again_[range.begin] ? no_number : number_of(level + 1, octant));
        i = end;
      }
    }
  }

  /// The number of the cell at the end of a path from the root, which are counted level by level.
  std::uint64_t number_of(int level, std::uint64_t path) const {
    const auto arity = std::uint64_t{1} << bits_per_level_;
    std::uint64_t first = 0;
    for (int k = 0; k < level; ++k) {
      if (first > (no_number - 1 - path) / arity - 1) return no_number;
      first = arity * first + 1;
    }
    return first + path;
  }

  std::vector<std::uint32_t> finish(std::span<const TriangleRange>) const {
    std::vector<std::uint32_t> order;
    order.reserve(coded_.size());
    for (const CurvePlace& place : coded_) order.push_back(place.triangle);
    return order;
  }

 private:
  std::span<const Vec3d> centers_;
  std::uint32_t leaf_size_;
  int bits_per_level_;
  std::uint32_t deepest_;  ///< level
  std::vector<CurvePlace> coded_, memory_;
  std::vector<bool> is_coded_again_;  ///< the code does not begin at the root
};

}  // namespace

OctreeTopology build_regular_octree(std::span<const Vec3d> centers, const ObjectOctreeOptions& options) {
  return build_octree(static_cast<std::uint32_t>(centers.size()), RegularSplitter(centers, options));
}

}  // namespace supple
