#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "contact/intersection/pair_filter.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "contact/intersection/chords-inl.hpp"
#include "contact/intersection/pair_filter.hpp"
#include "core/packed_lanes-inl.hpp"
#include "geometry/vector3-inl.hpp"
#include "mesh/corner_loads-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace supple::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// Verdicts on as many pairs as there are lanes.
template <class Tag>
HWY_INLINE void decide(const Corners<Tag>& a, const Corners<Tag>& b, std::size_t first,
                       PairVerdicts& verdicts) {
  const Tag d;
  const Sides<Tag> of_a(b, a), of_b(a, b);
  const auto separated = hn::Or(of_a.separated(), of_b.separated());
  const auto in_general_position = hn::AndNot(separated, hn::And(of_a.certain(), of_b.certain()));
  auto apart = separated;
  if (!hn::AllFalse(d, in_general_position)) {
    const Chord<Tag> chord_a(a, of_a, false), chord_b(b, of_b, true);
    const Order<Tag> b_start_to_a_end(chord_a, chord_a.end, chord_b, chord_b.start);
    const Order<Tag> b_end_to_a_start(chord_a, chord_a.start, chord_b, chord_b.end);
    const auto beyond = hn::Or(b_start_to_a_end.positive(), b_end_to_a_start.negative());
    const auto overlap = hn::And(b_start_to_a_end.negative(), b_end_to_a_start.positive());
    apart = hn::Or(apart, hn::And(in_general_position, beyond));
    verdicts.crossing |= mask_bits(d, hn::And(in_general_position, overlap)) << first;
  }
  verdicts.apart |= mask_bits(d, apart) << first;
}

template <class Scalar, class SourceA, class SourceB>
HWY_INLINE PairVerdicts filter(VertexArray<SourceA> vertices_a, VertexArray<SourceB> vertices_b,
                               const PlacedTriangles& a, const PlacedTriangles& b, const TrianglePair* pairs,
                               std::size_t count) {
  using Tag = hn::CappedTag<Scalar, 16>;
  PairVerdicts verdicts;
  for_each_vector(Tag(), pairs, count, [&](std::size_t first, const TrianglePair* part) HWY_ATTR {
    Corners<Tag> corners_a, corners_b;
    read_corners<&TrianglePair::a, Tag>(vertices_a, a, part, corners_a);
    read_corners<&TrianglePair::b, Tag>(vertices_b, b, part, corners_b);
    decide<Tag>(corners_a, corners_b, first, verdicts);
  });
  if (count < pair_filter_capacity) {
    const std::uint64_t in_use = (std::uint64_t{1} << count) - 1;
    verdicts.apart &= in_use;
    verdicts.crossing &= in_use;
  }
  return verdicts;
}

PairVerdicts filter_floats(const PlacedTriangles& a, const PlacedTriangles& b, const TrianglePair* pairs,
                           std::size_t count) {
  return filter<float>(a.arrays.floats, b.arrays.floats, a, b, pairs, count);
}
PairVerdicts filter_doubles(const PlacedTriangles& a, const PlacedTriangles& b, const TrianglePair* pairs,
                            std::size_t count) {
  if (a.arrays.doubles.data == nullptr && b.arrays.doubles.data == nullptr)
    return filter<double>(a.arrays.floats, b.arrays.floats, a, b, pairs, count);
  if (a.arrays.doubles.data == nullptr)
    return filter<double>(a.arrays.floats, b.arrays.doubles, a, b, pairs, count);
  if (b.arrays.doubles.data == nullptr)
    return filter<double>(a.arrays.doubles, b.arrays.floats, a, b, pairs, count);
  return filter<double>(a.arrays.doubles, b.arrays.doubles, a, b, pairs, count);
}

}  // namespace
}  // namespace supple::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace supple {

HWY_EXPORT(filter_floats);
HWY_EXPORT(filter_doubles);

PairVerdicts filter_pairs(const PlacedTriangles& a, const PlacedTriangles& b,
                          std::span<const TrianglePair> pairs) {
  const auto is_single = [](const PlacedTriangles& triangles) {
    return triangles.arrays.floats.data != nullptr && triangles.translation == Vec3d{};
  };
  if (is_single(a) && is_single(b))
    return HWY_DYNAMIC_DISPATCH(filter_floats)(a, b, pairs.data(), pairs.size());
  return HWY_DYNAMIC_DISPATCH(filter_doubles)(a, b, pairs.data(), pairs.size());
}

}  // namespace supple
#endif
