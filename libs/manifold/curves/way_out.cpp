#include "manifold/curves/way_out.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/sort_once.hpp"
#include "geometry/aabb.hpp"
#include "geometry/vector.hpp"

namespace supple {
namespace {

/// Depths within this ratio count as equal.
constexpr double equal = 1 + 0x1p-36;

}  // namespace

bool is_before(const Vec3d& p, const Vec3d& q) {
  const auto rounded = [](double x) { return std::floor(std::fabs(x) * 0x1p20 + 0.5); };
  return std::tuple(rounded(q.x), rounded(q.y), rounded(q.z)) <
         std::tuple(rounded(p.x), rounded(p.y), rounded(p.z));
}

void WayOut::start(const PenetratedObject& a, const PenetratedObject& b) {
  bodies_ = {&a, &b};
  for (std::size_t side = 0; side < 2; ++side) {
    queries_[side].start();
    for (const std::uint32_t t : triangles_[side]) is_listed_[side][t] = 0;
    triangles_[side].clear();
    is_listed_[side].resize(std::max(is_listed_[side].size(), bodies_[side]->surface.octree->id_count()), 0);
  }
}

void WayOut::clear(double scale, const Vec3d& origin) {
  scale_ = scale;
  origin_ = origin;
  parts_.clear();
  beside_count_ = 0;
  for (std::size_t side = 0; side < 2; ++side) {
    for (const std::uint32_t t : triangles_[side]) is_listed_[side][t] = 0;
    triangles_[side].clear();
    probes_[side].clear();
  }
}

void WayOut::add_triangle(std::size_t side, std::uint32_t triangle) {
  if (is_listed_[side][triangle] != 0) return;
  triangles_[side].push_back(triangle);
  is_listed_[side][triangle] = 1;
  parts_.add(side, triangle, scaled_corners(side, triangle));
}

TrianglePoints WayOut::scaled_corners(std::size_t side, std::uint32_t triangle) const {
  TrianglePoints corners = bodies_[side]->surface.corners(triangle);
  for (Vec3d& p : corners) p = scale_ * p - origin_;
  return corners;
}

/// Leaves the outermost probes where there are many.
void WayOut::choose_probes(std::size_t side) {
  constexpr std::size_t few = 24;
  std::vector<Vec3d>& probes = probes_[side];
  if (probes.size() <= few) return;
  chosen_.clear();
  for (int direction = 0; direction < 27; ++direction) {
    const Vec3d n{direction % 3 - 1.0, direction / 3 % 3 - 1.0, direction / 9 - 1.0};
    const auto height = [&](const Vec3d& p) { return dot(n, scale_ * p - origin_); };
    const Vec3d& farthest = *std::max_element(
        probes.begin(), probes.end(), [&](const Vec3d& p, const Vec3d& q) { return height(p) < height(q); });
    if (std::find(chosen_.begin(), chosen_.end(), farthest) == chosen_.end()) chosen_.push_back(farthest);
  }
  probes.swap(chosen_);
}

/// How far a point is from where it leaves the other body along `normal`, scaled; less than 0 when it does
/// not meet its surface from inside. The triangle that it meets becomes one of the parts. A point that is
/// known to be inside also leaves where it meets an edge of which the first triangle is parallel to the ray.
double WayOut::cast(std::size_t side, const Vec3d& point, const Vec3d& normal, bool is_inside) {
  const PenetratedObject& other = *bodies_[1 - side];
  const Vec3d direction = side == 0 ? normal : Vec3d{} - normal;
  const auto hit = queries_[1 - side].cast(std::span(&other.queried, 1), {point, direction}, false);
  if (!hit) return -1;
  const double outwards = dot(unit_normal(other.surface.corners(hit->triangle)), direction);
  if (!(is_inside ? outwards >= 0 : outwards > 0)) return -1;
  if (is_listed_[1 - side][hit->triangle] == 0) {
    for (const std::uint32_t v : other.surface.triangle(hit->triangle)) {
      for (const std::uint32_t t : other.surface.around->around(v)) add_triangle(1 - side, t);
    }
  }
  return scale_ * hit->t;
}

/// Ends early when the depth exceeds the limit.
WayOut::Tried WayOut::try_along(const Vec3d& normal, double limit) {
  double way = parts_.way_along(normal, limit * equal), depth = way == none ? -1 : way;
  std::size_t part_count = triangle_count();
  for (std::size_t side = 0; side < 2 && casts_rays() && depth <= limit * equal; ++side) {
    for (const Vec3d& probe : probes_[side]) {
      if (way != none && parts_.is_covered(side, scale_ * probe - origin_, way)) continue;
      const double exit = cast(side, probe, normal, true);
      if (exit <= depth) continue;
      // The triangle through which the probe leaves is a part now.
      if (exit <= limit * equal) {
        way = parts_.way_along(normal, limit * equal);
        part_count = triangle_count();
      }
      depth = std::max(exit, way == none ? -1 : way);
      if (depth > limit * equal) break;
    }
  }
  return {{normal, depth < 0 ? none : depth}, depth > limit * equal, false, way, parts_.ends(), part_count};
}

double WayOut::least_depth() const {
  double least = none;
  for (const Tried& tried : tried_) least = tried.is_pruned ? least : std::min(least, tried.way.depth);
  return least;
}

/// Tries the shortest moves after which nothing is behind two or three faces: out of a corner.
void WayOut::try_corners(std::span<const WayCandidate> candidates) {
  const auto try_move = [&](const Vec3d& move) {
    const double length = norm(move);
    if (length > 0 && length * equal < least_depth())
      tried_.push_back(try_along((1 / length) * move, least_depth()));
  };
  constexpr double least_angle = 0x1p-20;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const auto& [n_i, behind_i] = candidates[i];
    for (std::size_t k = 0; k < i && behind_i < least_depth(); ++k) {
      const auto& [n_k, behind_k] = candidates[k];
      const double c = dot(n_i, n_k), sine = 1 - c * c;
      if (!(behind_k < least_depth()) || sine < least_angle) continue;
      try_move(((behind_i - c * behind_k) / sine) * n_i + ((behind_k - c * behind_i) / sine) * n_k);
      for (std::size_t m = 0; m < k; ++m) {
        const auto& [n_m, behind_m] = candidates[m];
        const double volume = dot(n_i, cross(n_k, n_m));
        if (!(behind_m < least_depth()) || std::fabs(volume) < least_angle) continue;
        try_move((1 / volume) *
                 (behind_i * cross(n_k, n_m) + behind_k * cross(n_m, n_i) + behind_m * cross(n_i, n_k)));
      }
    }
  }
}

/// Where a way begins in the front of a, or ends in the back of b, as seen along the normal, adds the other
/// side of the solid there. Returns whether it was missing.
bool WayOut::add_other_sides(const Vec3d& normal, const CurveParts::Ends& ends) {
  constexpr double upright = 0x1p-20, inwards = 0x1p-24;  // so far off the surface begins the ray
  const std::size_t before = triangle_count();
  for (std::size_t side = 0; side < 2; ++side) {
    const TrianglePoints own = scaled_corners(side, ends[side]);
    const double sign = side == 0 ? -1 : 1;
    if (!bodies_[side]->is_solid || sign * dot(unit_normal(own), normal) > -upright) continue;
    const auto middle = parts_.middle_of(own, scaled_corners(1 - side, ends[1 - side]), normal);
    if (middle) cast(1 - side, (1 / scale_) * (*middle + sign * inwards * normal + origin_), normal, true);
  }
  return triangle_count() > before;
}

/// Lists the triangles beside the ends of a way. Returns a bound on the ways between them.
double WayOut::list_beside(const Vec3d& normal, const CurveParts::Ends& ends) {
  beside_.clear();
  double lowest = none, highest = -none;
  for (std::size_t side = 0; side < 2; ++side) {
    around_.clear();
    for (const std::uint32_t v : bodies_[side]->surface.triangle(ends[side])) {
      const auto around = bodies_[side]->surface.around->around(v);
      around_.insert(around_.end(), around.begin(), around.end());
    }
    sort_once(around_);
    for (const std::uint32_t t : around_) {
      const TrianglePoints corners = scaled_corners(side, t);
      beside_.add(side, t, corners);
      for (const Vec3d& p : corners) {
        if (side == 0) lowest = std::min(lowest, dot(normal, p));
        if (side == 1) highest = std::max(highest, dot(normal, p));
      }
    }
    beside_count_ += around_.size();
  }
  return highest - lowest;
}

/// The depth after which the surfaces around the contact do not overlap either: from its ends, the longest
/// way goes on to triangles beside them as long as they have a longer one. Above the common part of two
/// convex bodies, their distance along the normal is concave, so this finds their largest one.
double WayOut::depth_of_surfaces(const Tried& tried) {
  const Vec3d& normal = tried.way.normal;
  if (!casts_rays()) return tried.way.depth;
  double longest = tried.longest == none ? -none : tried.longest;
  CurveParts::Ends ends = tried.ends;
  const auto least = [&] { return longest * equal + CurveParts::rounding; };
  const auto go_on = [&](CurveParts& parts) {
    const double longer = parts.way_along(normal, none, least());
    if (longer == none) return false;
    longest = longer;
    ends = parts.ends();
    return true;
  };
  if (tried.part_count < triangle_count()) go_on(parts_);
  if (longest < 0) return tried.way.depth;
  do {
    while (list_beside(normal, ends) > least() && go_on(beside_)) {
    }
  } while (add_other_sides(normal, ends) && go_on(parts_));
  return std::max(tried.way.depth, longest);
}

/// The depth from which on no probe is inside: it may leave one part of the other body and enter the next
/// one. `parts` is how many of them may follow, before rounding decides.
double WayOut::depth_without_return(const Way& way, int& parts) {
  double depth = way.depth;
  bool is_free = !casts_rays();
  for (; parts > 0 && !is_free; --parts) {
    is_free = true;
    for (std::size_t side = 0; side < 2; ++side) {
      for (const Vec3d& probe : probes_[side]) {
        const double rounding = 0x1p-44 + 0x1p-50 * scale_ * largest_magnitude(probe);
        const double moved = depth * (1 + 0x1p-30) + rounding, sign = side == 0 ? 1 : -1;
        const Vec3d place = probe + (sign * moved / scale_) * way.normal;
        Aabb box;
        extend(box, place);
        const double exit =
            overlap(bodies_[1 - side]->queried.box, box) ? cast(side, place, way.normal, false) : -1;
        if (exit <= 0) continue;  // on the surface, it is not inside
        depth = moved + exit;
        is_free = false;
      }
    }
  }
  return depth;
}

WayOut::Way WayOut::find(std::span<const WayCandidate> candidates) {
  for (std::size_t side = 0; side < 2; ++side) choose_probes(side);
  tried_.clear();
  // No direction is better than one whose depth is rounding. Of those with depth 0, `is_before` chooses.
  const auto is_rounding = [&] { return least_depth() > 0 && least_depth() <= CurveParts::rounding; };
  for (const WayCandidate& candidate : candidates)
    tried_.push_back(is_rounding() ? Tried{{candidate.normal, 0}, true}
                                   : try_along(candidate.normal, least_depth()));
  if (!is_rounding()) try_corners(candidates);
  int parts = 64;  // of all candidates
  for (;;) {
    const double least = least_depth();
    Tried* best = nullptr;
    for (Tried& tried : tried_) {
      if (tried.is_pruned || tried.way.depth > least * equal) continue;
      if (best == nullptr || is_before(tried.way.normal, best->way.normal)) best = &tried;
    }
    if (least == none) return best->way;
    const double of_contact = best->is_whole ? best->way.depth : depth_of_surfaces(*best);
    best->is_whole = true;
    const double depth = depth_without_return({best->way.normal, of_contact}, parts);
    if (depth == best->way.depth) return best->way;
    best->way.depth = depth;
    for (Tried& tried : tried_) {
      if (tried.is_pruned && tried.way.depth < depth) tried = try_along(tried.way.normal, depth);
    }
  }
}

}  // namespace supple
