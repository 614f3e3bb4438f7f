#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "answers/penetration/manifold_methods.hpp"
#include "manifold/curves/curve_parts.hpp"
#include "queries/object_queries.hpp"

namespace supple {

/// The order of directions with equal depths: along x, then y, then z. It is the same in a mirror, and when a
/// and b are exchanged.
bool is_before(const Vec3d& p, const Vec3d& q);

/// A direction in which a may leave b.
struct WayCandidate {
  Vec3d normal;
  /// For the outward normal of a face of b, and the reverse of that of a face of a: how far a must move so
  /// that nothing of the other body is behind the plane of the face. In the coordinates of `WayOut`.
  double behind_face = std::numeric_limits<double>::infinity();
};

/// Finds the shortest of several ways out: the direction and the depth of a curve. Holds the memory of one
/// worker.
class WayOut {
 public:
  static constexpr double none = CurveParts::nothing_ahead;

  /// Starts another pair of bodies, which must live until the next one. Within one object, no rays are cast.
  void start(const PenetratedObject& a, const PenetratedObject& b);

  /// Whether a point is inside a body, which is solid.
  bool contains(std::size_t side, const Vec3d& point) {
    return queries_[side].inside(0, bodies_[side]->queried, point) == Containment::inside;
  }

  /// Starts another curve. Lengths are `scale` times those of the user, a power of two, and positions of
  /// parts are relative to `origin`.
  void clear(double scale, const Vec3d& origin);
  /// A triangle of a (side 0) or b (side 1) at the contact. Repeated ones count once.
  void add_triangle(std::size_t side, std::uint32_t triangle);
  /// A point of a side that is inside the other body, in the user's coordinates.
  void add_probe(std::size_t side, const Vec3d& point) { probes_[side].push_back(point); }

  struct Way {
    Vec3d normal;
    double depth = none;  ///< scaled; `none` where no candidate leads out
  };
  /// The candidate with the least depth, or a direction between two or three faces with a smaller one. There
  /// is at least one candidate.
  Way find(std::span<const WayCandidate> candidates);
  /// The triangles that it read for this curve.
  std::size_t visited() const { return triangle_count() + beside_count_; }

 private:
  struct Tried {
    Way way;
    bool is_pruned = false;  // the depth is at least that of the way
    bool is_whole = false;   // it is that of the surfaces around the contact, too
    double longest = none;   // the longest way between the first parts, and its ends
    CurveParts::Ends ends{};
    std::size_t part_count = 0;
  };

  std::size_t triangle_count() const { return triangles_[0].size() + triangles_[1].size(); }
  bool casts_rays() const { return bodies_[0] != bodies_[1]; }
  void choose_probes(std::size_t side);
  Tried try_along(const Vec3d& normal, double limit);
  double cast(std::size_t side, const Vec3d& point, const Vec3d& normal, bool is_inside);
  void try_corners(std::span<const WayCandidate> candidates);
  TrianglePoints scaled_corners(std::size_t side, std::uint32_t triangle) const;
  bool add_other_sides(const Vec3d& normal, const CurveParts::Ends& ends);
  double depth_of_surfaces(const Tried& tried);
  double list_beside(const Vec3d& normal, const CurveParts::Ends& ends);
  double depth_without_return(const Way& way, int& parts);
  double least_depth() const;

  std::array<const PenetratedObject*, 2> bodies_{};
  std::array<ObjectQueries, 2> queries_;  // rays that meet a body
  double scale_ = 1;
  Vec3d origin_;
  CurveParts parts_, beside_;  // beside the ends of the longest way
  std::size_t beside_count_ = 0;
  std::array<std::vector<std::uint32_t>, 2> triangles_;  // of the parts
  std::array<std::vector<std::uint8_t>, 2> is_listed_;   // by triangle
  std::array<std::vector<Vec3d>, 2> probes_;
  std::vector<Vec3d> chosen_;
  std::vector<std::uint32_t> around_;
  std::vector<Tried> tried_;
};

}  // namespace supple
