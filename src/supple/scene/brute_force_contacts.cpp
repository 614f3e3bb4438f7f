#include "scene/brute_force_contacts.hpp"

#include <algorithm>
#include <cmath>

#include "mesh/share_vertex.hpp"
#include "supple/triangle_intersection.hpp"

namespace supple {
namespace {

struct BoxedTriangle {
  double min[3], max[3];
  std::uint32_t triangle;
};

TrianglePoints points_of(const PlainObject& object, std::uint32_t triangle) {
  const Triangle& ids = object.triangles[triangle];
  return {object.positions[ids[0]], object.positions[ids[1]], object.positions[ids[2]]};
}

/// The exact boxes of all finite triangles.
std::vector<BoxedTriangle> boxed_triangles(const PlainObject& object) {
  std::vector<BoxedTriangle> result;
  result.reserve(object.triangles.size());
  for (std::uint32_t t = 0; t < object.triangles.size(); ++t) {
    const TrianglePoints p = points_of(object, t);
    BoxedTriangle boxed{{}, {}, t};
    bool finite = true;
    for (int axis = 0; axis < 3; ++axis) {
      for (const Vec3d& corner : p) finite = finite && std::isfinite(corner[axis]);
      boxed.min[axis] = std::min({p[0][axis], p[1][axis], p[2][axis]});
      boxed.max[axis] = std::max({p[0][axis], p[1][axis], p[2][axis]});
    }
    if (finite) result.push_back(boxed);
  }
  return result;
}

bool boxes_overlap(const BoxedTriangle& p, const BoxedTriangle& q) {
  for (int axis = 0; axis < 3; ++axis) {
    if (p.min[axis] > q.max[axis] || q.min[axis] > p.max[axis]) return false;
  }
  return true;
}

}  // namespace

std::vector<TrianglePair> intersecting_pairs_by_brute_force(const PlainObject& a, const PlainObject& b,
                                                            bool same_object, const Parallel& parallel) {
  const std::vector<BoxedTriangle> boxes_a = boxed_triangles(a);
  std::vector<BoxedTriangle> boxes_b = boxed_triangles(b);
  std::sort(boxes_b.begin(), boxes_b.end(), [](const BoxedTriangle& p, const BoxedTriangle& q) {
    return p.min[0] != q.min[0] ? p.min[0] < q.min[0] : p.triangle < q.triangle;
  });
  // For each box, the largest max x of the boxes up to it. Where that is less than the min x of a box of a,
  // none of the boxes up to here overlaps it.
  std::vector<double> reach;
  reach.reserve(boxes_b.size());
  for (const BoxedTriangle& q : boxes_b)
    reach.push_back(reach.empty() ? q.max[0] : std::max(reach.back(), q.max[0]));

  std::vector<std::vector<TrianglePair>> found(parallel.worker_count());
  parallel.for_ranges(boxes_a.size(), 64, [&](std::size_t begin, std::size_t end, std::uint32_t worker) {
    for (std::size_t i = begin; i < end; ++i) {
      const BoxedTriangle& p = boxes_a[i];
      const auto first = std::lower_bound(reach.begin(), reach.end(), p.min[0]) - reach.begin();
      for (auto q = boxes_b.begin() + first; q != boxes_b.end() && q->min[0] <= p.max[0]; ++q) {
        if (same_object &&
            (q->triangle <= p.triangle || share_vertex(a.triangles[p.triangle], a.triangles[q->triangle]))) {
          continue;
        }
        if (boxes_overlap(p, *q) &&
            triangles_intersect_by_axes(points_of(a, p.triangle), points_of(b, q->triangle))) {
          found[worker].push_back({p.triangle, q->triangle});
        }
      }
    }
  });
  std::vector<TrianglePair> pairs;
  for (const auto& part : found) pairs.insert(pairs.end(), part.begin(), part.end());
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace supple
