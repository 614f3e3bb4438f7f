#include "comparison/volumes/volume_kernels.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "comparison/volumes/volume_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "core/packed_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace supple {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using ChildTag = hn::CappedTag<float, node_width>;
using Floats = hn::Vec<ChildTag>;

/// Calls `apart(child of a, first child of b)` for vectors of children of b, and clears the bits of those for
/// which it returns true.
template <class Apart>
HWY_INLINE void clear_apart(std::uint64_t& mask, const Apart& apart) {
  const ChildTag tag;
  constexpr std::size_t lanes = hn::MaxLanes(tag);
  for (int i = 0; i < node_width; ++i) {
    for (std::size_t j = 0; j < node_width; j += lanes) {
      const std::uint64_t place = node_width * static_cast<std::uint64_t>(i) + j;
      const std::uint64_t row = mask >> place & ((std::uint64_t{1} << lanes) - 1);
      if (row != 0) mask &= ~((apart(i, j, row) & row) << place);
    }
  }
}

/// The slabs of b move by `offset` along their direction and grow by `slop`. The slop of the placement bounds
/// the rounding of one coordinate; sums of three have at most four times as much.
struct SlabPlacement {
  float down, up;
};
HWY_INLINE SlabPlacement placement_along(const Vec3f& direction, const RelativePlacement& placement) {
  const float offset = dot(direction, placement.offset), slop = 4 * placement.slop;
  return {offset - slop, offset + slop};
}

void SlabsApart(std::span<const NodePair> pairs, std::span<const Vec3f> all_directions, const float* a,
                const float* b, const RelativePlacement& placement, std::uint64_t* masks) {
  const ChildTag tag;
  const std::size_t directions = all_directions.size(), stride = directions * floats_per_slab;
  std::array<SlabPlacement, slab_directions.size()> placements;
  for (std::size_t d = 0; d < directions; ++d) placements[d] = placement_along(all_directions[d], placement);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const float* const slabs_a = a + pairs[k].a * stride;
    const float* const slabs_b = b + pairs[k].b * stride;
    clear_apart(masks[k], [&](int i, std::size_t j, std::uint64_t row) HWY_ATTR {
      std::uint64_t apart = 0;
      for (std::size_t d = 0; d < directions && (row & ~apart) != 0; ++d) {
        const float* const one = slabs_a + d * floats_per_slab + i;
        const float* const others = slabs_b + d * floats_per_slab + j;
        const auto low = hn::Add(hn::LoadU(tag, others), hn::Set(tag, placements[d].down));
        const auto high = hn::Add(hn::LoadU(tag, others + node_width), hn::Set(tag, placements[d].up));
        apart |= mask_bits(
            tag, hn::Or(hn::Gt(low, hn::Set(tag, one[node_width])), hn::Lt(high, hn::Set(tag, one[0]))));
      }
      return apart;
    });
  }
}

HWY_INLINE Floats dot3(const Floats (&p)[3], const Floats (&q)[3]) {
  return hn::Add(hn::Add(hn::Mul(p[0], q[0]), hn::Mul(p[1], q[1])), hn::Mul(p[2], q[2]));
}

/// The separating axis test of one oriented box against a vector of others; bit j when they are apart. The
/// margin covers the rounding of all sums, at most 2^-20 of the lengths in them, and the axes' deviation from
/// right angles. Comparisons with infinity and NaN separate nothing.
HWY_INLINE std::uint64_t oriented_boxes_apart(const ChildOrientedBoxes& a, int i, const ChildOrientedBoxes& b,
                                              std::size_t j, const RelativePlacement& placement) {
  const ChildTag tag;
  Floats axes_a[3][3], axes_b[3][3], between[3], half_a[3], half_b[3], along_a[3], along_b[3];
  Floats cosine[3][3], absolute[3][3], size = hn::Zero(tag);
  for (int k = 0; k < 3; ++k) {
    half_a[k] = hn::Set(tag, a.half_lengths[k][i]);
    half_b[k] = hn::Load(tag, b.half_lengths[k] + j);
    between[k] = hn::Sub(hn::Add(hn::Load(tag, b.center[k] + j), hn::Set(tag, placement.offset[k])),
                         hn::Set(tag, a.center[k][i]));
    size = hn::Add(hn::Add(size, hn::Abs(between[k])), hn::Add(half_a[k], half_b[k]));
    for (int c = 0; c < 3; ++c) {
      axes_a[k][c] = hn::Set(tag, a.axes[k][c][i]);
      axes_b[k][c] = hn::Load(tag, b.axes[k][c] + j);
    }
  }
  const auto margin = hn::Add(hn::Mul(size, hn::Set(tag, 0x1p-18f)), hn::Set(tag, 2 * placement.slop));
  auto apart = hn::MaskFromVec(hn::Zero(tag));
  const auto test = [&](Floats along, Floats reach)
                        HWY_ATTR { apart = hn::Or(apart, hn::Gt(hn::Abs(along), hn::Add(reach, margin))); };
  for (int p = 0; p < 3; ++p) {
    along_a[p] = dot3(between, axes_a[p]);
    along_b[p] = dot3(between, axes_b[p]);
    for (int q = 0; q < 3; ++q) {
      cosine[p][q] = dot3(axes_a[p], axes_b[q]);
      absolute[p][q] = hn::Abs(cosine[p][q]);
    }
  }
  for (int p = 0; p < 3; ++p) {
    const Floats column[3] = {absolute[0][p], absolute[1][p], absolute[2][p]};
    test(along_a[p], hn::Add(half_a[p], dot3(half_b, absolute[p])));
    test(along_b[p], hn::Add(half_b[p], dot3(half_a, column)));
    const int p1 = (p + 1) % 3, p2 = (p + 2) % 3;
    for (int q = 0; q < 3; ++q) {
      const int q1 = (q + 1) % 3, q2 = (q + 2) % 3;
      const auto reach_a =
          hn::Add(hn::Mul(half_a[p1], absolute[p2][q]), hn::Mul(half_a[p2], absolute[p1][q]));
      const auto reach_b =
          hn::Add(hn::Mul(half_b[q1], absolute[p][q2]), hn::Mul(half_b[q2], absolute[p][q1]));
      test(hn::Sub(hn::Mul(along_a[p2], cosine[p1][q]), hn::Mul(along_a[p1], cosine[p2][q])),
           hn::Add(reach_a, reach_b));
    }
  }
  return mask_bits(tag, apart);
}

void BoxesApart(std::span<const NodePair> pairs, const ChildOrientedBoxes* a, const ChildOrientedBoxes* b,
                const RelativePlacement& placement, std::uint64_t* masks) {
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    clear_apart(masks[k], [&](int i, std::size_t j, std::uint64_t) HWY_ATTR {
      return oriented_boxes_apart(a[pairs[k].a], i, b[pairs[k].b], j, placement);
    });
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace supple
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace supple {

HWY_EXPORT(SlabsApart);
HWY_EXPORT(BoxesApart);

void clear_slabs_apart(std::span<const NodePair> pairs, std::span<const Vec3f> directions, const float* a,
                       const float* b, const RelativePlacement& placement, std::uint64_t* masks) {
  HWY_DYNAMIC_DISPATCH(SlabsApart)(pairs, directions, a, b, placement, masks);
}

void clear_boxes_apart(std::span<const NodePair> pairs, const ChildOrientedBoxes* a,
                       const ChildOrientedBoxes* b, const RelativePlacement& placement,
                       std::uint64_t* masks) {
  HWY_DYNAMIC_DISPATCH(BoxesApart)(pairs, a, b, placement, masks);
}

}  // namespace supple
#endif
