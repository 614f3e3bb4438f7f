#include "contest/baselines/triangle_test.hpp"

#include <hwy/highway.h>

#include <algorithm>

#include "supple/triangle_intersection.hpp"

namespace supple::benchmarks {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Lanes = hn::CappedTag<float, 16>;
using Values = hn::Vec<Lanes>;
using Row = hn::Full128<float>;
constexpr std::size_t batch = 16;

/// The bounding box of a triangle. Reads one float past the last coordinate, which `DeformingCopies`
/// provides.
struct Box {
  hn::Vec<Row> low, high;
};

Box box_of(const Vec3f* positions, const Triangle& t) {
  const Row d;
  const auto p = hn::LoadU(d, &positions[t[0]].x), q = hn::LoadU(d, &positions[t[1]].x),
             r = hn::LoadU(d, &positions[t[2]].x);
  return {hn::Min(hn::Min(p, q), r), hn::Max(hn::Max(p, q), r)};
}

bool overlap(const Box& a, const Box& b) {
  const Row d;
  const auto apart = hn::Or(hn::Lt(a.high, b.low), hn::Lt(b.high, a.low));
  return hn::AllFalse(d, hn::And(apart, hn::FirstN(d, 3)));
}

struct Vectors {
  Values x, y, z;
};

Vectors operator-(const Vectors& a, const Vectors& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}

Vectors cross(const Vectors& a, const Vectors& b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)), hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}

Values dot(const Vectors& a, const Vectors& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}

Values larger_entry(const Values& so_far, const Vectors& v) {
  return hn::Max(hn::Max(so_far, hn::Abs(v.x)), hn::Max(hn::Abs(v.y), hn::Abs(v.z)));
}

/// Coordinates of sixteen pairs, by corner and axis.
struct Batch {
  alignas(64) float values[6][3][batch];
  const CopyPair* pairs[batch];
  std::size_t count = 0;

  void set(std::size_t corner, std::size_t lane, const Vec3f& p) {
    values[corner][0][lane] = p.x;
    values[corner][1][lane] = p.y;
    values[corner][2][lane] = p.z;
  }
};

/// One bit per pair.
struct Decisions {
  std::uint32_t apart = 0, meet = 0;
};

template <class Mask>
std::uint32_t bits_of(const Mask& mask) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(Lanes(), mask, bytes);
  return bytes[0] + 256u * bytes[1];
}

/// Two triangles in general position intersect exactly when an edge of one passes through the other: the
/// ends of the edge lie on different sides of the plane, and it passes the three edges on the same side. All
/// conditions are signs of volumes: six of a corner and a triangle, nine of an edge and an edge.
Decisions decide(const Batch& input, std::size_t first) {
  const Lanes d;
  Vectors p[6];
  for (std::size_t corner = 0; corner < 6; ++corner) {
    const auto& v = input.values[corner];
    p[corner] = {hn::Load(d, v[0] + first), hn::Load(d, v[1] + first), hn::Load(d, v[2] + first)};
  }
  const Vectors origin = p[0];
  Values largest = hn::Zero(d);
  for (Vectors& corner : p) {
    corner = corner - origin;
    largest = larger_entry(largest, corner);
  }
  // Entries are at most 2 m, where m is the largest coordinate, with an error of at most 2^-23 m. The error
  // of six products of three entries and their sums is below 6 * 8 m^3 * 8 * 2^-23 < 2^9 * 2^-23 m^3.
  const Values bound = hn::Add(hn::Mul(hn::Mul(hn::Mul(largest, largest), largest), hn::Set(d, 0x1p-14f)),
                               hn::Set(d, 0x1p-100f));
  const Values below = hn::Neg(bound);

  std::uint32_t above_a[3], under_a[3], above_b[3], under_b[3];
  const Vectors* const a = p;
  const Vectors* const b = p + 3;
  const Vectors normal_a = cross(a[1] - a[0], a[2] - a[0]), normal_b = cross(b[1] - b[0], b[2] - b[0]);
  for (int i = 0; i < 3; ++i) {
    const Values over_a = dot(normal_a, b[i] - a[0]), over_b = dot(normal_b, a[i] - b[0]);
    above_a[i] = bits_of(hn::Gt(over_a, bound));
    under_a[i] = bits_of(hn::Lt(over_a, below));
    above_b[i] = bits_of(hn::Gt(over_b, bound));
    under_b[i] = bits_of(hn::Lt(over_b, below));
  }
  Decisions result;
  const auto all = [](const std::uint32_t* bits) { return bits[0] & bits[1] & bits[2]; };
  result.apart = all(above_a) | all(under_a) | all(above_b) | all(under_b);
  std::uint32_t certain = ~0u;
  for (int i = 0; i < 3; ++i) certain &= (above_a[i] | under_a[i]) & (above_b[i] | under_b[i]);

  std::uint32_t left[3][3], right[3][3];  // edge i of a with edge j of b
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const Vectors edge_a = a[(i + 1) % 3] - a[i], edge_b = b[(j + 1) % 3] - b[j];
      const Values volume = dot(cross(edge_a, edge_b), b[j] - a[i]);
      left[i][j] = bits_of(hn::Gt(volume, bound));
      right[i][j] = bits_of(hn::Lt(volume, below));
      certain &= left[i][j] | right[i][j];
    }
  }
  std::uint32_t pierced = 0;
  for (int i = 0; i < 3; ++i) {
    const int next = (i + 1) % 3;
    const std::uint32_t through_a = (above_a[i] & under_a[next]) | (under_a[i] & above_a[next]);
    const std::uint32_t through_b = (above_b[i] & under_b[next]) | (under_b[i] & above_b[next]);
    pierced |=
        through_a & ((left[0][i] & left[1][i] & left[2][i]) | (right[0][i] & right[1][i] & right[2][i]));
    pierced |=
        through_b & ((left[i][0] & left[i][1] & left[i][2]) | (right[i][0] & right[i][1] & right[i][2]));
  }
  result.meet = certain & pierced;
  result.apart |= certain & ~pierced;
  return result;
}

TrianglePoints points_of(const Batch& input, std::size_t first_corner, std::size_t lane) {
  TrianglePoints points;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& v = input.values[first_corner + i];
    points[i] = {v[0][lane], v[1][lane], v[2][lane]};
  }
  return points;
}

void decide_batch(Batch& input, std::vector<CopyPair>& intersecting) {
  const std::size_t lanes = hn::Lanes(Lanes());
  for (std::size_t first = 0; first < input.count; first += lanes) {
    const Decisions decisions = decide(input, first);
    for (std::size_t lane = first; lane < std::min(first + lanes, input.count); ++lane) {
      const std::uint32_t bit = 1u << (lane - first);
      if ((decisions.apart & bit) != 0) continue;
      if ((decisions.meet & bit) != 0 ||
          triangles_intersect(points_of(input, 0, lane), points_of(input, 3, lane)))
        intersecting.push_back(*input.pairs[lane]);
    }
  }
  input.count = 0;
}

}  // namespace

void keep_intersecting(const DeformingCopies& copies, std::span<const CopyPair> candidates,
                       std::vector<CopyPair>& intersecting) {
  intersecting.clear();
  Batch input{};
  for (const CopyPair& pair : candidates) {
    const Vec3f* const positions_a = copies.positions(pair.object_a).data();
    const Vec3f* const positions_b = copies.positions(pair.object_b).data();
    const Triangle& a = copies.triangles()[pair.triangle_a];
    const Triangle& b = copies.triangles()[pair.triangle_b];
    if (!overlap(box_of(positions_a, a), box_of(positions_b, b))) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      input.set(i, input.count, positions_a[a[i]]);
      input.set(3 + i, input.count, positions_b[b[i]]);
    }
    input.pairs[input.count++] = &pair;
    if (input.count == batch) decide_batch(input, intersecting);
  }
  decide_batch(input, intersecting);
}

std::vector<IndexPair> overlapping_copies(const DeformingCopies& copies, std::vector<Aabb>& boxes) {
  boxes.assign(copies.copies(), {});
  std::vector<IndexPair> pairs;
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    boxes[i] = copies.bounds(i);
    for (std::uint32_t j = 0; j < i; ++j) {
      const Aabb &a = boxes[i], &b = boxes[j];
      if (a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y && b.min.y <= a.max.y &&
          a.min.z <= b.max.z && b.min.z <= a.max.z)
        pairs.push_back({j, i});
    }
  }
  return pairs;
}

PairDigest digest_of(std::span<const CopyPair> pairs) {
  PairDigest digest;
  for (const CopyPair& pair : pairs) {
    digest.add(pair.object_a + (std::uint64_t{pair.triangle_a} << 32),
               pair.object_b + (std::uint64_t{pair.triangle_b} << 32));
  }
  return digest;
}

void CandidateContestant::frame(const DeformingCopies& copies) {
  const double start = cpu_milliseconds();
  update(copies);
  const double updated = cpu_milliseconds();
  candidates_.clear();
  find_candidates(copies);
  const double found = cpu_milliseconds();
  keep_intersecting(copies, candidates_, intersecting_);
  stages_ = {{"update", updated - start},
             {"traversal", found - updated},
             {"triangle tests", cpu_milliseconds() - found}};
}

}  // namespace supple::benchmarks
