#include "octree/volumes/slab_kernels.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "octree/volumes/slab_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <limits>

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
HWY_NOINLINE void refit_leaf(const OctreeNode& node, int child, const Aabb& box, float* slabs,
                             const DirectionLanes& directions, std::size_t direction_count,
                             VertexArray<Scalar> positions, const TriangleArrays& arrays,
                             const std::uint32_t* first, const std::uint32_t* vertices) {
  SlabSums<V> sums;
  if (arrays.inert == nullptr) {
    for (std::uint32_t i = first[child]; i < first[child + 1]; ++i)
      sums.extend(directions, positions[vertices[i]]);
  } else {
    for (std::uint32_t t = node.first_triangle[child]; t < node.first_triangle[child + 1]; ++t) {
      if (arrays.inert[t] != 0) continue;
      for (const std::uint32_t vertex : arrays.triangles[t]) sums.extend(directions, positions[vertex]);
    }
  }
  HWY_ALIGN float low[most_directions] = {}, high[most_directions] = {};
  for (std::size_t v = 0; v < V; ++v) {
    hn::Store(sums.low[v], SlabTag(), low + v * slab_lanes);
    hn::Store(sums.high[v], SlabTag(), high + v * slab_lanes);
  }
  constexpr float inf = std::numeric_limits<float>::infinity();
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
void refit_nodes(const OctreeNode* nodes, const ChildBoxes* boxes, float* slabs,
                 std::span<const Vec3f> directions, VertexArray<Scalar> positions,
                 const TriangleArrays& arrays, const LeafVertexArrays& leaves, std::uint32_t begin,
                 std::uint32_t end) {
  const DirectionLanes lanes = lanes_of(directions);
  const std::size_t stride = floats_per_slab * directions.size();
  refit_bottom_up(
      nodes, begin, end,
      [&](std::uint32_t n, int child) HWY_ATTR {
        refit_leaf<V>(nodes[n], child, child_box(boxes[n], child), slabs + n * stride, lanes,
                      directions.size(), positions, arrays, leaves.first + std::size_t{n} * node_width,
                      leaves.vertices);
      },
      [&](std::uint32_t n) HWY_ATTR {
        const OctreeNode& node = nodes[n];
        if (node.parent == n) return;
        unite_slabs(slabs + n * stride, node.child_count, directions.size(), slabs + node.parent * stride,
                    node.index_in_parent);
      });
}

template <class Scalar>
void refit_all(const OctreeNode* nodes, const ChildBoxes* boxes, float* slabs,
               std::span<const Vec3f> directions, VertexArray<Scalar> positions, const TriangleArrays& arrays,
               const LeafVertexArrays& leaves, std::uint32_t begin, std::uint32_t end) {
  const auto refit = directions.size() <= 4   ? refit_nodes<4 / slab_lanes, Scalar>
                     : directions.size() <= 8 ? refit_nodes<8 / slab_lanes, Scalar>
                                              : refit_nodes<12 / slab_lanes, Scalar>;
  refit(nodes, boxes, slabs, directions, positions, arrays, leaves, begin, end);
}

void RefitSlabs(const OctreeNode* nodes, const ChildBoxes* boxes, float* slabs,
                std::span<const Vec3f> directions, const TriangleArrays& arrays,
                const LeafVertexArrays& leaves, std::uint32_t begin, std::uint32_t end) {
  if (arrays.doubles.data != nullptr) {
    refit_all(nodes, boxes, slabs, directions, arrays.doubles, arrays, leaves, begin, end);
  } else {
    refit_all(nodes, boxes, slabs, directions, arrays.floats, arrays, leaves, begin, end);
  }
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

void ExtendExtents(const AxisFrame& frame, const TriangleArrays& arrays,
                   std::span<const std::uint32_t> vertices, AxisExtents& extents) {
  if (arrays.doubles.data != nullptr) {
    extend_by(frame, arrays.doubles, vertices, extents);
  } else {
    extend_by(frame, arrays.floats, vertices, extents);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace supple
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace supple {

HWY_EXPORT(RefitSlabs);
HWY_EXPORT(ExtendExtents);

void refit_slabs(const OctreeNode* nodes, const ChildBoxes* boxes, float* slabs,
                 std::span<const Vec3f> directions, const TriangleArrays& arrays,
                 const LeafVertexArrays& leaves, std::uint32_t begin, std::uint32_t end) {
  HWY_DYNAMIC_DISPATCH(RefitSlabs)(nodes, boxes, slabs, directions, arrays, leaves, begin, end);
}

void extend_extents(const AxisFrame& frame, const TriangleArrays& arrays,
                    std::span<const std::uint32_t> vertices, AxisExtents& extents) {
  HWY_DYNAMIC_DISPATCH(ExtendExtents)(frame, arrays, vertices, extents);
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

}  // namespace supple
#endif
