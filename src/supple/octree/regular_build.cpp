#include "octree/regular_build.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

#include "geometry/vector.hpp"

namespace supple {
namespace {

constexpr int bits_per_axis = 21;
constexpr int bits_of_code = 3 * bits_per_axis;

/// Place of a triangle in the octree: three bits a level, the first level highest. A tree of fewer children
/// reads two or one of the bits at a time, which halve z, y and x in turn.
struct Coded {
  std::uint64_t code;
  std::uint32_t triangle;

  bool operator<(const Coded& other) const {
    return code != other.code ? code < other.code : triangle < other.triangle;
  }
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

/// Options count levels of eight children.
std::uint32_t deepest_level(const ObjectOctreeOptions& options) {
  return options.max_level * 3 / static_cast<std::uint32_t>(bits_per_level(options));
}

class RegularSplitter {
 public:
  RegularSplitter(std::span<const Vec3d> centers, const ObjectOctreeOptions& options)
      : centers_(centers),
        leaf_size_(options.leaf_size),
        bits_per_level_(bits_per_level(options)),
        deepest_(deepest_level(options)),
        coded_(centers.size()) {
    assert(options.arity == 2 || options.arity == 4 || options.arity == 8);
    for (std::uint32_t i = 0; i < coded_.size(); ++i) coded_[i] = {0, i};
    assign_codes({0, static_cast<std::uint32_t>(coded_.size())});
  }

  bool should_split(TriangleRange range, std::uint32_t level) {
    if (range.size() <= leaf_size_ || level >= deepest_) return false;
    if (coded_[range.begin].code != coded_[range.end - 1].code) return true;
    // The codes are used up, but the centres may differ: the cube around them gives them new codes.
    assign_codes(range);
    return coded_[range.begin].code != coded_[range.end - 1].code;
  }

  /// The octants, quarters or halves of the smallest regular cell that contains the range, without the empty
  /// ones.
  void split(TriangleRange range, std::uint32_t, std::vector<TriangleRange>& children) const {
    const std::uint64_t differing = coded_[range.begin].code ^ coded_[range.end - 1].code;
    assert(differing != 0);
    const int level = (bits_of_code - static_cast<int>(std::bit_width(differing))) / bits_per_level_;
    const int shift = std::max(bits_of_code - (level + 1) * bits_per_level_, 0);
    for (std::uint32_t i = range.begin; i < range.end; i = children.back().end) {
      const std::uint64_t octant = coded_[i].code >> shift;
      const auto past = std::partition_point(coded_.begin() + i, coded_.begin() + range.end,
                                             [&](const Coded& c) { return c.code >> shift == octant; });
      children.push_back({i, static_cast<std::uint32_t>(past - coded_.begin())});
    }
  }

  void finish_leaf(TriangleRange) const {}
  std::span<const Coded> items() const { return coded_; }

 private:
  /// Codes the centres of the range in the cube around them and sorts the range.
  void assign_codes(TriangleRange range) {
    const std::span<Coded> coded = std::span(coded_).subspan(range.begin, range.size());
    const CenterBounds bounds(coded, centers_);
    const double side = bounds.longest_side();
    for (Coded& item : coded) {
      const Vec3d& c = centers_[item.triangle];
      item.code = 0;
      if (!(side > 0) || !is_finite(c)) continue;
      for (int axis = 0; axis < 3; ++axis) {
        item.code |= spread_bits(cell((c[axis] * CenterBounds::scale - bounds.lower[axis]) / side)) << axis;
      }
    }
    std::sort(coded.begin(), coded.end());
  }

  static std::uint64_t cell(double fraction) {
    constexpr double cells = 1 << bits_per_axis;
    return static_cast<std::uint64_t>(std::clamp(fraction * cells, 0.0, cells - 1));
  }

  std::span<const Vec3d> centers_;
  std::uint32_t leaf_size_;
  int bits_per_level_;
  std::uint32_t deepest_;  ///< level
  std::vector<Coded> coded_;
};

}  // namespace

OctreeTopology build_regular_octree(std::span<const Vec3d> centers, const ObjectOctreeOptions& options) {
  return build_octree(RegularSplitter(centers, options));
}

}  // namespace supple
