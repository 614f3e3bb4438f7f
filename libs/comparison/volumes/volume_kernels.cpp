#include "comparison/volumes/volume_kernels.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "comparison/volumes/volume_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/packed_lanes-inl.hpp"
#include "octree/refit_bottom_up.hpp"

HWY_BEFORE_NAMESPACE();
namespace supple {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using SlabTag = hn::CappedTag<float, 4>;
constexpr std::size_t slab_lanes = hn::MaxLanes(SlabTag());
/// Directions are padded to whole vectors of four.
constexpr std::size_t most_directions = 12;

/// The directions by coordinates.
struct DirectionLanes {
  HWY_ALIGN float x[most_directions] = {}, y[most_directions] = {}, z[most_directions] = {};
};

/// The slabs of some points; one direction per lane. V vectors.
template <std::size_t V>
struct SlabSums {
  hn::Vec<SlabTag> low[V], high[V];

  HWY_INLINE SlabSums() {
    for (std::size_t v = 0; v < V; ++v) {
      low[v] = hn::Set(SlabTag(), std::numeric_limits<float>::infinity());
      high[v] = hn::Set(SlabTag(), -std::numeric_limits<float>::infinity());
    }
  }
  template <class Scalar>
  HWY_INLINE void extend(const DirectionLanes& directions, const Scalar* vertex) {
    extend(directions, static_cast<float>(vertex[0]), static_cast<float>(vertex[1]),
           static_cast<float>(vertex[2]));
  }
  HWY_INLINE void extend(const DirectionLanes& directions, float vertex_x, float vertex_y, float vertex_z) {
    const SlabTag tag;
    const auto x = hn::Set(tag, vertex_x), y = hn::Set(tag, vertex_y), z = hn::Set(tag, vertex_z);
    for (std::size_t v = 0; v < V; ++v) {
      const std::size_t i = v * slab_lanes;
      const auto along = hn::Add(
          hn::Add(hn::Mul(x, hn::Load(tag, directions.x + i)), hn::Mul(y, hn::Load(tag, directions.y + i))),
          hn::Mul(z, hn::Load(tag, directions.z + i)));
      low[v] = hn::Min(low[v], along);
      high[v] = hn::Max(high[v], along);
    }
  }
};

/// Sums of the coordinates have an error of at most 2^-22 of this; infinite when the slabs are unbounded.
HWY_INLINE float magnitude_of(const Aabb& box) {
  float sum = 0;
  for (int axis = 0; axis < 3; ++axis) sum += std::max(std::abs(box.min[axis]), std::abs(box.max[axis]));
  return sum < 0x1p120f ? sum : std::numeric_limits<float>::infinity();
}

template <std::size_t V, class Scalar>
HWY_NOINLINE void refit_leaf(const RefittedOctree& octree, std::uint32_t n, int child, float* slabs,
                             const DirectionLanes& directions, std::size_t direction_count,
                             VertexArray<Scalar> positions) {
  SlabSums<V> sums;
  if (octree.inert.empty()) {
    const std::uint32_t* const first = octree.leaves.first + std::size_t{n} * node_width + child;
    for (std::uint32_t i = first[0]; i < first[1]; ++i)
      sums.extend(directions, positions[octree.leaves.vertices[i]]);
  } else {
    const std::uint32_t* const first = octree.nodes[n].first_triangle + child;
    for (std::uint32_t t = first[0]; t < first[1]; ++t) {
      if (octree.inert[t] != 0) continue;
      for (const std::uint32_t vertex : octree.triangles[t]) sums.extend(directions, positions[vertex]);
    }
  }
  HWY_ALIGN float low[most_directions] = {}, high[most_directions] = {};
  for (std::size_t v = 0; v < V; ++v) {
    hn::Store(sums.low[v], SlabTag(), low + v * slab_lanes);
    hn::Store(sums.high[v], SlabTag(), high + v * slab_lanes);
  }
  constexpr float inf = std::numeric_limits<float>::infinity();
  const Aabb box = child_box(octree.boxes[n], child);
  // A leaf without a finite triangle has inverted slabs, which do not enlarge those of its ancestors.
  const float magnitude = box.empty() ? 0 : magnitude_of(box);
  const bool bounded = magnitude < inf;
  const float margin = magnitude * 0x1p-21f + std::numeric_limits<float>::min();
  for (std::size_t d = 0; d < direction_count; ++d) {
    slabs[d * floats_per_slab + static_cast<std::size_t>(child)] = bounded ? low[d] - margin : -inf;
    slabs[d * floats_per_slab + static_cast<std::size_t>(node_width + child)] =
        bounded ? high[d] + margin : inf;
  }
}

DirectionLanes lanes_of(std::span<const Vec3f> directions) {
  DirectionLanes lanes;
  for (std::size_t d = 0; d < directions.size(); ++d) {
    lanes.x[d] = directions[d].x;
    lanes.y[d] = directions[d].y;
    lanes.z[d] = directions[d].z;
  }
  return lanes;
}

template <std::size_t V, class Scalar>
void refit_nodes(const RefittedOctree& octree, std::span<const Vec3f> directions, float* slabs,
                 VertexArray<Scalar> positions, std::uint32_t begin, std::uint32_t end) {
  const DirectionLanes lanes = lanes_of(directions);
  const std::size_t stride = floats_per_slab * directions.size();
  refit_bottom_up(
      octree.nodes.data(), begin, end,
      [&](std::uint32_t n, int child) HWY_ATTR {
        refit_leaf<V>(octree, n, child, slabs + n * stride, lanes, directions.size(), positions);
      },
      [&](std::uint32_t n) HWY_ATTR {
        const OctreeNode& node = octree.nodes[n];
        if (node.parent == n) return;
        unite_slabs(slabs + n * stride, node.child_count, directions.size(), slabs + node.parent * stride,
                    node.index_in_parent);
      });
}

void RefitSlabs(const RefittedOctree& octree, std::span<const Vec3f> directions, float* slabs,
                std::uint32_t begin, std::uint32_t end) {
  const auto refit = [&]<class Scalar>(VertexArray<Scalar> positions) {
    const auto refit_some = directions.size() <= 4   ? refit_nodes<4 / slab_lanes, Scalar>
                            : directions.size() <= 8 ? refit_nodes<8 / slab_lanes, Scalar>
                                                     : refit_nodes<12 / slab_lanes, Scalar>;
    refit_some(octree, directions, slabs, positions, begin, end);
  };
  octree.vertices.is_double() ? refit(octree.vertices.doubles()) : refit(octree.vertices.floats());
}

template <class Scalar>
void extend_by(const AxisFrame& frame, VertexArray<Scalar> positions, std::span<const std::uint32_t> vertices,
               AxisExtents& extents) {
  constexpr std::size_t vector_count = 4 / slab_lanes;
  const DirectionLanes lanes = lanes_of(frame.axes);
  SlabSums<vector_count> sums;
  for (const std::uint32_t vertex : vertices) {
    const Scalar* const p = positions[vertex];
    sums.extend(lanes, static_cast<float>(p[0] - frame.origin.x), static_cast<float>(p[1] - frame.origin.y),
                static_cast<float>(p[2] - frame.origin.z));
  }
  HWY_ALIGN float low[vector_count * slab_lanes], high[vector_count * slab_lanes];
  for (std::size_t v = 0; v < vector_count; ++v) {
    hn::Store(sums.low[v], SlabTag(), low + v * slab_lanes);
    hn::Store(sums.high[v], SlabTag(), high + v * slab_lanes);
  }
  for (std::size_t k = 0; k < 3; ++k) {
    extents.low[k] = std::min(extents.low[k], low[k]);
    extents.high[k] = std::max(extents.high[k], high[k]);
  }
}

void ExtendExtents(const AxisFrame& frame, const VertexBuffer& positions,
                   std::span<const std::uint32_t> vertices, AxisExtents& extents) {
  positions.is_double() ? extend_by(frame, positions.doubles(), vertices, extents)
                        : extend_by(frame, positions.floats(), vertices, extents);
}

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

/// The separating axis test of one oriented box against a vector of others. The margin covers the rounding of
/// all sums, at most 2^-20 of the lengths in them, and the axes' deviation from right angles. Comparisons
/// with infinity and NaN separate nothing.
class OrientedBoxTest {
 public:
  HWY_INLINE OrientedBoxTest(const ChildOrientedBoxes& a, int i, const ChildOrientedBoxes& b, std::size_t j,
                             const RelativePlacement& placement) {
    const ChildTag tag;
    Floats axes_a[3][3], axes_b[3][3], between[3];
    Floats size = hn::Zero(tag);
    for (int k = 0; k < 3; ++k) {
      half_a_[k] = hn::Set(tag, a.half_lengths[k][i]);
      half_b_[k] = hn::Load(tag, b.half_lengths[k] + j);
      between[k] = hn::Sub(hn::Add(hn::Load(tag, b.center[k] + j), hn::Set(tag, placement.offset[k])),
                           hn::Set(tag, a.center[k][i]));
      size = hn::Add(hn::Add(size, hn::Abs(between[k])), hn::Add(half_a_[k], half_b_[k]));
      for (int c = 0; c < 3; ++c) {
        axes_a[k][c] = hn::Set(tag, a.axes[k][c][i]);
        axes_b[k][c] = hn::Load(tag, b.axes[k][c] + j);
      }
    }
    margin_ = hn::Add(hn::Mul(size, hn::Set(tag, 0x1p-18f)), hn::Set(tag, 2 * placement.slop));
    for (int p = 0; p < 3; ++p) {
      along_a_[p] = dot3(between, axes_a[p]);
      along_b_[p] = dot3(between, axes_b[p]);
      for (int q = 0; q < 3; ++q) {
        cosine_[p][q] = dot3(axes_a[p], axes_b[q]);
        absolute_[p][q] = hn::Abs(cosine_[p][q]);
      }
    }
  }

  /// Bit j: the boxes are apart.
  HWY_INLINE std::uint64_t apart() const {
    const ChildTag tag;
    auto apart = hn::MaskFromVec(hn::Zero(tag));
    for (int p = 0; p < 3; ++p) {
      const Floats column[3] = {absolute_[0][p], absolute_[1][p], absolute_[2][p]};
      apart = hn::Or(apart, beyond(along_a_[p], hn::Add(half_a_[p], dot3(half_b_, absolute_[p]))));
      apart = hn::Or(apart, beyond(along_b_[p], hn::Add(half_b_[p], dot3(half_a_, column))));
    }
    for (int p = 0; p < 3; ++p) {
      const int p1 = (p + 1) % 3, p2 = (p + 2) % 3;
      for (int q = 0; q < 3; ++q) {
        const int q1 = (q + 1) % 3, q2 = (q + 2) % 3;
        const auto reach_a =
            hn::Add(hn::Mul(half_a_[p1], absolute_[p2][q]), hn::Mul(half_a_[p2], absolute_[p1][q]));
        const auto reach_b =
            hn::Add(hn::Mul(half_b_[q1], absolute_[p][q2]), hn::Mul(half_b_[q2], absolute_[p][q1]));
        const auto along =
            hn::Sub(hn::Mul(along_a_[p2], cosine_[p1][q]), hn::Mul(along_a_[p1], cosine_[p2][q]));
        apart = hn::Or(apart, beyond(along, hn::Add(reach_a, reach_b)));
      }
    }
    return mask_bits(tag, apart);
  }

 private:
  HWY_INLINE hn::Mask<ChildTag> beyond(Floats along, Floats reach) const {
    return hn::Gt(hn::Abs(along), hn::Add(reach, margin_));
  }

  Floats half_a_[3], half_b_[3], along_a_[3], along_b_[3], cosine_[3][3], absolute_[3][3], margin_;
};

void BoxesApart(std::span<const NodePair> pairs, const ChildOrientedBoxes* a, const ChildOrientedBoxes* b,
                const RelativePlacement& placement, std::uint64_t* masks) {
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const ChildOrientedBoxes& boxes_a = a[pairs[k].a];
    const ChildOrientedBoxes& boxes_b = b[pairs[k].b];
    clear_apart(masks[k], [&](int i, std::size_t j, std::uint64_t) HWY_ATTR {
      return OrientedBoxTest(boxes_a, i, boxes_b, j, placement).apart();
    });
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace supple
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace supple {

HWY_EXPORT(RefitSlabs);
HWY_EXPORT(ExtendExtents);
HWY_EXPORT(SlabsApart);
HWY_EXPORT(BoxesApart);

void refit_slabs(const RefittedOctree& octree, std::span<const Vec3f> directions, float* slabs,
                 std::uint32_t begin, std::uint32_t end) {
  HWY_DYNAMIC_DISPATCH(RefitSlabs)(octree, directions, slabs, begin, end);
}

void extend_extents(const AxisFrame& frame, const VertexBuffer& positions,
                    std::span<const std::uint32_t> vertices, AxisExtents& extents) {
  HWY_DYNAMIC_DISPATCH(ExtendExtents)(frame, positions, vertices, extents);
}

void unite_slabs(const float* children, int count, std::size_t directions, float* parent, int child) {
  for (std::size_t d = 0; d < directions; ++d) {
    const float* const low = children + d * floats_per_slab;
    const float* const high = low + node_width;
    float* const to = parent + d * floats_per_slab + child;
    to[0] = *std::min_element(low, low + count);
    to[node_width] = *std::max_element(high, high + count);
  }
}

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
