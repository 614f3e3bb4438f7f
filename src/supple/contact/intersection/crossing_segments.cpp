#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "contact/intersection/crossing_segments.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "contact/intersection/chords-inl.hpp"
#include "contact/intersection/crossing_segments.hpp"
#include "contact/intersection/meeting_point.hpp"
#include "contact/intersection/separating_normal-inl.hpp"
#include "core/packed_lanes-inl.hpp"
#include "geometry/vector3-inl.hpp"
#include "mesh/corner_loads-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace supple::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// The steps are those of triangle_intersection.cpp and of meeting_point.cpp for an edge and a face. The
// results have the same bits.

using Tag = hn::CappedTag<double, 8>;
using Doubles = hn::Vec<Tag>;
using Mask = hn::Mask<Tag>;
using Vector = Vector3<Tag>;

struct Bounds {
  Vector low, high;

  HWY_INLINE explicit Bounds(const Corners<Tag>& p)
      : low{hn::Min(hn::Min(p[0].x, p[1].x), p[2].x), hn::Min(hn::Min(p[0].y, p[1].y), p[2].y),
            hn::Min(hn::Min(p[0].z, p[1].z), p[2].z)},
        high(larger<Tag>(larger<Tag>(p[0], p[1]), p[2])) {}
  HWY_INLINE Bounds(Mask mask, const Bounds& yes, const Bounds& no)
      : low(select<Tag>(mask, yes.low, no.low)), high(select<Tag>(mask, yes.high, no.high)) {}

  HWY_INLINE Vector clamp(const Vector& p) const {
    return {hn::Min(hn::Max(p.x, low.x), high.x), hn::Min(hn::Max(p.y, low.y), high.y),
            hn::Min(hn::Max(p.z, low.z), high.z)};
  }
};

/// Where a segment ends: on an edge of one triangle, within the other one.
struct SegmentEnd {
  Doubles edge;
  Vector point;
  Mask is_known;

  /// `bound` is that of the sides of the edge's corners, `face` the box of the triangle that the edge
  /// pierces.
  HWY_INLINE SegmentEnd(const SidedCorner<Tag>& p, const SidedCorner<Tag>& q, Doubles bound,
                        const Bounds& face, Doubles edge_number)
      : edge(edge_number) {
    const Tag d;
    const Doubles from_p = hn::Abs(p.side), from_q = hn::Abs(q.side), sum = hn::Add(from_p, from_q);
    const Mask is_nearer = hn::Lt(from_p, from_q);
    const Vector from = select<Tag>(is_nearer, p.position, q.position);
    const Vector extent = subtract<Tag>(select<Tag>(is_nearer, q.position, p.position), from);
    const Doubles part = hn::Div(hn::Min(from_p, from_q), sum);
    // The part is at most 1/2, so rounding does not take the point past the end of the edge.
    const Vector on_edge{hn::Add(from.x, hn::Mul(part, extent.x)), hn::Add(from.y, hn::Mul(part, extent.y)),
                         hn::Add(from.z, hn::Mul(part, extent.z))};
    // Adding 0 turns -0 into 0, because the minimum of 0 and -0 depends on the processor.
    const Doubles zero = hn::Zero(d);
    point = face.clamp(on_edge);
    point = {hn::Add(point.x, zero), hn::Add(point.y, zero), hn::Add(point.z, zero)};
    // Where both ends are equally far, the scalar code starts from the lexicographically smaller one.
    const Mask is_accurate =
        hn::And(hn::Lt(bound, hn::Mul(hn::Set(d, accepted_distance_error), sum)), hn::Ne(from_p, from_q));
    const Doubles size = hn::Add(hn::Add(hn::Abs(extent.x), hn::Abs(extent.y)), hn::Abs(extent.z));
    is_known = hn::And(is_accurate, hn::And(hn::IsFinite(sum), hn::IsFinite(size)));
  }
};

/// The edges on which a chord starts and ends.
struct ChordEdges {
  Doubles start, end;

  HWY_INLINE explicit ChordEdges(const Chord<Tag>& chord) {
    const Tag d;
    const auto zero = hn::Zero(d), one = hn::Set(d, 1.0), two = hn::Set(d, 2.0);
    // An edge has the number of the corner before it.
    const auto apex = hn::IfThenElse(chord.first_alone, zero, hn::IfThenElse(chord.second_alone, one, two));
    const auto last = hn::IfThenElse(chord.first_alone, two, hn::IfThenElse(chord.second_alone, zero, one));
    start = hn::IfThenElse(chord.forward, apex, last);
    end = hn::IfThenElse(chord.forward, last, apex);
  }
};

using Rows = CrossingSegments::Rows;

HWY_INLINE void store(const Vector& v, double (*rows)[CrossingSegments::capacity], std::size_t first) {
  hn::StoreU(v.x, Tag(), rows[0] + first);
  hn::StoreU(v.y, Tag(), rows[1] + first);
  hn::StoreU(v.z, Tag(), rows[2] + first);
}

/// Returns the lanes in which both ends are known.
HWY_INLINE Mask find_ends(const Corners<Tag>& a, const Corners<Tag>& b, std::size_t first, Rows& rows) {
  const Sides<Tag> sides_a(b, a), sides_b(a, b);
  const Chord<Tag> chord_a(a, sides_a, false), chord_b(b, sides_b, true);
  const Order<Tag> starts(chord_a, chord_a.start, chord_b, chord_b.start);
  const Order<Tag> ends(chord_a, chord_a.end, chord_b, chord_b.end);
  const Mask starts_on_b = starts.positive(), ends_on_b = ends.negative();
  const ChordEdges edges_a(chord_a), edges_b(chord_b);
  const Bounds bounds_a(a), bounds_b(b);
  const auto end_of = [&](Mask on_b, const SidedCorner<Tag>& corner_a, const SidedCorner<Tag>& corner_b,
                          Doubles edge_a, Doubles edge_b) HWY_ATTR {
    return SegmentEnd(select<Tag>(on_b, chord_b.apex, chord_a.apex), select<Tag>(on_b, corner_b, corner_a),
                      hn::IfThenElse(on_b, sides_b.bound, sides_a.bound), Bounds(on_b, bounds_a, bounds_b),
                      hn::IfThenElse(on_b, hn::Add(edge_b, hn::Set(Tag(), 3.0)), edge_a));
  };
  const SegmentEnd start = end_of(starts_on_b, chord_a.start, chord_b.start, edges_a.start, edges_b.start);
  const SegmentEnd end = end_of(ends_on_b, chord_a.end, chord_b.end, edges_a.end, edges_b.end);
  // In the order of `TriangleIntersection::points`.
  const Mask swap = hn::Lt(end.edge, start.edge);
  store(select<Tag>(swap, end.point, start.point), rows.ends[0], first);
  store(select<Tag>(swap, start.point, end.point), rows.ends[1], first);
  hn::StoreU(hn::Min(start.edge, end.edge), Tag(), rows.edges[0] + first);
  hn::StoreU(hn::Max(start.edge, end.edge), Tag(), rows.edges[1] + first);
  const Mask sides_are_certain = hn::And(sides_a.certain(), sides_b.certain());
  const Mask order_is_certain =
      hn::And(hn::Or(starts_on_b, starts.negative()), hn::Or(ends_on_b, ends.positive()));
  return hn::And(hn::And(sides_are_certain, order_is_certain), hn::And(start.is_known, end.is_known));
}

std::uint64_t find_segments(const PlacedTriangles& a, const PlacedTriangles& b, const TrianglePair* pairs,
                            std::size_t count, Rows& rows) {
  std::uint64_t known = 0;
  for_each_vector(Tag(), pairs, count, [&](std::size_t first, const TrianglePair* part) HWY_ATTR {
    Corners<Tag> corners_a, corners_b;
    read_corners<&TrianglePair::a, Tag>(a, part, corners_a);
    read_corners<&TrianglePair::b, Tag>(b, part, corners_b);
    const Mask has_ends = find_ends(corners_a, corners_b, first, rows);
    Vector normal;
    const Mask has_normal = find_normals<Tag>(corners_a, corners_b, normal);
    store(normal, rows.normals, first);
    known |= mask_bits(Tag(), hn::And(has_ends, has_normal)) << first;
  });
  return known;
}

}  // namespace
}  // namespace supple::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace supple {

HWY_EXPORT(find_segments);

void CrossingSegments::find(const PlacedTriangles& a, const PlacedTriangles& b,
                            std::span<const TrianglePair> pairs) {
  known_ = HWY_DYNAMIC_DISPATCH(find_segments)(a, b, pairs.data(), pairs.size(), rows_);
}

}  // namespace supple
#endif
