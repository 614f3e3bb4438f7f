// Compiled once for each instruction set: include after hwy/highway.h, between HWY_BEFORE_NAMESPACE and
// HWY_AFTER_NAMESPACE of the including file's own namespace.
#if defined(SUPPLE_MESH_CORNER_LOADS_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef SUPPLE_MESH_CORNER_LOADS_INL_HPP
#undef SUPPLE_MESH_CORNER_LOADS_INL_HPP
#else
#define SUPPLE_MESH_CORNER_LOADS_INL_HPP
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "geometry/vector3-inl.hpp"
#include "mesh/vertex_arrays.hpp"
#include "mesh/vertex_loads-inl.hpp"
#include "supple/types.hpp"

HWY_BEFORE_NAMESPACE();
namespace supple {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Reading corners. A register has blocks of 16 bytes: four floats or two doubles. The functions below read
// corners into blocks and transpose them there, so that each register gets one coordinate of as many pairs as
// it has lanes.

#if HWY_TARGET == HWY_SCALAR

/// The corners of one triangle. The vector version below does the same for several pairs.
template <std::uint32_t TrianglePair::*side, class Tag, class Source>
HWY_INLINE void read_corners(VertexArray<Source> vertices, const PlacedTriangles& source,
                             const TrianglePair* pairs, Corners<Tag>& corners) {
  using Scalar = hn::TFromD<Tag>;
  const Vec3d& t = source.translation;
  for (int i = 0; i < 3; ++i) {
    const Source* const p = vertices[source.arrays.triangles[pairs->*side][i]];
    corners[i] = {hn::Set(Tag(), Scalar(p[0])), hn::Set(Tag(), Scalar(p[1])), hn::Set(Tag(), Scalar(p[2]))};
    if constexpr (std::is_same_v<Scalar, double>) {
      corners[i] = {hn::Add(corners[i].x, hn::Set(Tag(), t.x)), hn::Add(corners[i].y, hn::Set(Tag(), t.y)),
                    hn::Add(corners[i].z, hn::Set(Tag(), t.z))};
    }
  }
}

#else

/// One register for each corner.
template <class Tag>
struct CornerBlocks {
  hn::Vec<Tag> corner[3];
};

/// Reads the corners of every `step`th pair, one block for each, by `read(position)`.
template <std::uint32_t TrianglePair::*side, class Tag, std::size_t step, class Source, class Read>
HWY_INLINE CornerBlocks<Tag> read_blocks(VertexArray<Source> vertices, const Triangle* triangles,
                                         const TrianglePair* pairs, const Read& read) {
  constexpr std::size_t blocks = hn::MaxLanes(Tag()) * sizeof(hn::TFromD<Tag>) / 16;
  if constexpr (blocks == 1) {
    const Triangle& triangle = triangles[pairs->*side];
    return {{read(vertices[triangle[0]]), read(vertices[triangle[1]]), read(vertices[triangle[2]])}};
  } else {
    using Half = hn::Half<Tag>;
    const Tag d;
    const auto lower = read_blocks<side, Half, step>(vertices, triangles, pairs, read);
    const auto upper = read_blocks<side, Half, step>(vertices, triangles, pairs + step * (blocks / 2), read);
    return {{hn::Combine(d, upper.corner[0], lower.corner[0]),
             hn::Combine(d, upper.corner[1], lower.corner[1]),
             hn::Combine(d, upper.corner[2], lower.corner[2])}};
  }
}

// These are not lambdas, because builds without optimisation do not inline lambdas.

struct FourFloats {
  HWY_INLINE auto operator()(const float* position) const { return load_vertex(position); }
};
/// Reads x and y as doubles.
struct TwoDoubles {
  HWY_INLINE auto operator()(const double* position) const {
    return hn::LoadU(hn::FixedTag<double, 2>(), position);
  }
  HWY_INLINE auto operator()(const float* position) const {
    return hn::PromoteTo(hn::FixedTag<double, 2>(), hn::LoadU(hn::FixedTag<float, 2>(), position));
  }
};
/// Reads z into both lanes.
struct DoubleZ {
  template <class Source>
  HWY_INLINE auto operator()(const Source* position) const {
    return hn::Set(hn::FixedTag<double, 2>(), double{position[2]});
  }
};

template <std::uint32_t TrianglePair::*side, class Tag>
HWY_INLINE void read_floats(VertexArray<float> vertices, const Triangle* triangles, const TrianglePair* pairs,
                            Corners<Tag>& corners) {
  const Tag d;
  const FourFloats read;
  const auto v0 = read_blocks<side, Tag, 4>(vertices, triangles, pairs, read);
  const auto v1 = read_blocks<side, Tag, 4>(vertices, triangles, pairs + 1, read);
  const auto v2 = read_blocks<side, Tag, 4>(vertices, triangles, pairs + 2, read);
  const auto v3 = read_blocks<side, Tag, 4>(vertices, triangles, pairs + 3, read);
  for (int i = 0; i < 3; ++i) {
    const auto xy_even = hn::InterleaveLower(d, v0.corner[i], v2.corner[i]);
    const auto xy_odd = hn::InterleaveLower(d, v1.corner[i], v3.corner[i]);
    const auto z_even = hn::InterleaveUpper(d, v0.corner[i], v2.corner[i]);
    const auto z_odd = hn::InterleaveUpper(d, v1.corner[i], v3.corner[i]);
    corners[i] = {hn::InterleaveLower(d, xy_even, xy_odd), hn::InterleaveUpper(d, xy_even, xy_odd),
                  hn::InterleaveLower(d, z_even, z_odd)};
  }
}

template <std::uint32_t TrianglePair::*side, class Tag, class Source>
HWY_INLINE void read_doubles(VertexArray<Source> vertices, const Triangle* triangles,
                             const TrianglePair* pairs, Corners<Tag>& corners) {
  const Tag d;
  const TwoDoubles read_xy;
  const DoubleZ read_z;
  const auto xy_even = read_blocks<side, Tag, 2>(vertices, triangles, pairs, read_xy);
  const auto xy_odd = read_blocks<side, Tag, 2>(vertices, triangles, pairs + 1, read_xy);
  const auto z_even = read_blocks<side, Tag, 2>(vertices, triangles, pairs, read_z);
  const auto z_odd = read_blocks<side, Tag, 2>(vertices, triangles, pairs + 1, read_z);
  for (int i = 0; i < 3; ++i) {
    corners[i] = {hn::InterleaveLower(d, xy_even.corner[i], xy_odd.corner[i]),
                  hn::InterleaveUpper(d, xy_even.corner[i], xy_odd.corner[i]),
                  hn::InterleaveLower(d, z_even.corner[i], z_odd.corner[i])};
  }
}

template <std::uint32_t TrianglePair::*side, class Tag, class Source>
HWY_INLINE void read_corners(VertexArray<Source> vertices, const PlacedTriangles& source,
                             const TrianglePair* pairs, Corners<Tag>& corners) {
  const Tag d;
  const Triangle* const triangles = source.arrays.triangles;
  if constexpr (std::is_same_v<hn::TFromD<Tag>, float>) {
    read_floats<side, Tag>(vertices, triangles, pairs, corners);
  } else {
    if constexpr (std::is_same_v<Source, float> && hn::MaxLanes(Tag()) >= 4) {
      using Single = hn::Rebind<float, Tag>;
      Corners<Single> single;
      read_floats<side, Single>(vertices, triangles, pairs, single);
      for (int i = 0; i < 3; ++i) {
        corners[i] = {hn::PromoteTo(d, single[i].x), hn::PromoteTo(d, single[i].y),
                      hn::PromoteTo(d, single[i].z)};
      }
    } else {
      read_doubles<side, Tag>(vertices, triangles, pairs, corners);
    }
    const Vec3d& t = source.translation;
    const auto tx = hn::Set(d, t.x), ty = hn::Set(d, t.y), tz = hn::Set(d, t.z);
    for (int i = 0; i < 3; ++i)
      corners[i] = {hn::Add(corners[i].x, tx), hn::Add(corners[i].y, ty), hn::Add(corners[i].z, tz)};
  }
}

#endif

/// The same for triangles in either precision.
template <std::uint32_t TrianglePair::*side, class Tag>
HWY_INLINE void read_corners(const PlacedTriangles& source, const TrianglePair* pairs,
                             Corners<Tag>& corners) {
  if (source.arrays.doubles.data != nullptr) {
    read_corners<side, Tag>(source.arrays.doubles, source, pairs, corners);
  } else {
    read_corners<side, Tag>(source.arrays.floats, source, pairs, corners);
  }
}

/// Calls `visit(first, part)` for vectors of pairs, which begin at `part`, with the number of the first one.
/// In the last vector, the first pair fills lanes without a pair.
template <class Tag, class Visit>
HWY_INLINE void for_each_vector(Tag tag, const TrianglePair* pairs, std::size_t count, const Visit& visit) {
  const std::size_t lanes = hn::Lanes(tag);
  std::array<TrianglePair, hn::MaxLanes(Tag())> last;
  for (std::size_t first = 0; first < count; first += lanes) {
    const TrianglePair* part = pairs + first;
    if (count - first < lanes) {
      last.fill(pairs[first]);
      std::copy(part, pairs + count, last.begin());
      part = last.data();
    }
    visit(first, part);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace supple
HWY_AFTER_NAMESPACE();

#endif
