#include "inspect/polytope.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "geometry/vector.hpp"

namespace supple {
namespace {

bool precedes(Vec3d p, Vec3d q) {
  return std::tie(p.x, p.y, p.z) < std::tie(q.x, q.y, q.z);
}

/// Where the segment meets the plane; the same bits for both orders of the ends, whose distances from the
/// plane have opposite signs.
Vec3d point_between(Vec3d p, double distance_p, Vec3d q, double distance_q) {
  if (precedes(q, p)) return point_between(q, distance_q, p, distance_p);
  return p + distance_p / (distance_p - distance_q) * (q - p);
}

/// Increases with the angle of (x, y), as `std::atan2` does, whose bits differ between C libraries.
double place_around(double x, double y) {
  const double size = std::fabs(x) + std::fabs(y);
  return size > 0 ? std::copysign(1 - x / size, y) : 0;
}

/// Puts the corners of a convex face into their order around it.
void sort_around(std::vector<Vec3d>& corners, Vec3d normal) {
  std::sort(corners.begin(), corners.end(), precedes);
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  if (corners.size() < 3) return;
  Vec3d center{};
  for (const Vec3d& corner : corners) center += corner / static_cast<double>(corners.size());
  const Vec3d u = corners.front() - center, v = cross(normal, u);
  const auto place = [&](Vec3d corner) {
    return place_around(dot(corner - center, u), dot(corner - center, v));
  };
  std::sort(corners.begin(), corners.end(), [&](Vec3d p, Vec3d q) { return place(p) < place(q); });
}

}  // namespace

Polytope::Polytope(std::span<const Slab> slabs) {
  if (slabs.size() < 3) return;
  for (const Slab& slab : slabs.first(3)) {
    if (!std::isfinite(slab.low) || !std::isfinite(slab.high)) return;
  }
  const auto corner = [&](int bits) {
    Vec3d p{};
    for (int k = 0; k < 3; ++k) {
      const Slab& slab = slabs[static_cast<std::size_t>(k)];
      p += double{(bits >> k & 1) != 0 ? slab.high : slab.low} * in_double(slab.direction);
    }
    return p;
  };
  for (int k = 0; k < 3; ++k) {
    const int side = 1 << k, u = 1 << (k + 1) % 3, v = 1 << (k + 2) % 3;
    faces_.push_back({corner(0), corner(u), corner(u | v), corner(v)});
    faces_.push_back({corner(side), corner(side | u), corner(side | u | v), corner(side | v)});
  }
  for (const Slab& slab : slabs.subspan(3)) {
    cut(in_double(slab.direction), slab.high);
    cut(-in_double(slab.direction), -double{slab.low});
  }
}

/// Keeps the points p with dot(direction, p) <= high.
void Polytope::cut(Vec3d direction, double high) {
  if (!std::isfinite(high)) return;
  Face cap;
  for (Face& face : faces_) {
    Face kept;
    for (std::size_t i = 0; i < face.size(); ++i) {
      const Vec3d p = face[i], q = face[(i + 1) % face.size()];
      const double distance_p = dot(direction, p) - high, distance_q = dot(direction, q) - high;
      if (distance_p <= 0) kept.push_back(p);
      if (distance_p == 0) cap.push_back(p);
      if ((distance_p < 0 && distance_q > 0) || (distance_p > 0 && distance_q < 0)) {
        kept.push_back(point_between(p, distance_p, q, distance_q));
        cap.push_back(kept.back());
      }
    }
    face = std::move(kept);
  }
  std::erase_if(faces_, [](const Face& face) { return face.size() < 3; });
  sort_around(cap, direction);
  if (cap.size() >= 3) faces_.push_back(std::move(cap));
}

std::vector<std::array<Vec3d, 2>> Polytope::edges() const {
  std::vector<std::array<Vec3d, 2>> edges;
  const auto earlier = [](const auto& a, const auto& b) {
    return precedes(a[0], b[0]) || (a[0] == b[0] && precedes(a[1], b[1]));
  };
  for (const Face& face : faces_) {
    for (std::size_t i = 0; i < face.size(); ++i) {
      const Vec3d p = face[i], q = face[(i + 1) % face.size()];
      edges.push_back(precedes(q, p) ? std::array{q, p} : std::array{p, q});
    }
  }
  std::sort(edges.begin(), edges.end(), earlier);
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

double Polytope::surface() const {
  double sum = 0;
  for (const Face& face : faces_) {
    Vec3d area{};
    for (std::size_t i = 2; i < face.size(); ++i) area += cross(face[i - 1] - face[0], face[i] - face[0]);
    sum += norm(area) / 2;
  }
  return sum;
}

}  // namespace supple
