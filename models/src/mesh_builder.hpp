#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "model_vectors.hpp"
#include "supple/mesh.hpp"

namespace supple::models {

/// One cross-section of a loft: the ellipse center + u cos + v sin. u × v points along the loft, so that the
/// surface faces outward.
struct Section {
  Vec3d center;
  Vec3d u, v;
};

/// The rectangle with half sides a and b, as a section of four points with the corners ±a ± b.
inline Section rectangle(Vec3d center, Vec3d a, Vec3d b) {
  return {center, a + b, b - a};
}

/// The end of a loft: a fan around one more vertex, or no vertex for a flat end across the last ring.
using Tip = std::optional<Vec3d>;

struct LathePoint {
  double radius, height;
};

/// Assembles parts into one mesh. Vertices and triangles are numbered in the order of insertion.
class MeshBuilder {
 public:
  /// A closed part through at least two sections: `sections` × `sides` vertices, plus the tips.
  void add_loft(std::span<const Section> sections, std::uint32_t sides, Tip start = {}, Tip end = {});

  /// A loft whose last section connects to the first one: a torus.
  void add_loop(std::span<const Section> sections, std::uint32_t sides);

  /// A round tube along a path, with one radius per point, closed flat at both ends.
  void add_tube(std::span<const Vec3d> path, std::span<const double> radii, std::uint32_t sides);

  /// A straight round bar of equal rings. The radius changes linearly from `start_radius` to `end_radius`.
  void add_bar(Vec3d start, Vec3d end, double start_radius, double end_radius, std::uint32_t rings,
               std::uint32_t sides);

  /// A profile rotated around an axis through `origin`. Heights are measured along the axis and increase.
  void add_lathe(Vec3d origin, Vec3d axis, std::span<const LathePoint> profile, std::uint32_t sides,
                 Tip start = {}, Tip end = {});

  /// A closed ring around an axis. Its cross-section has the half sides `half_width` along the axis and
  /// `half_height` across it.
  void add_ring(Vec3d center, Vec3d axis, double radius, double half_width, double half_height,
                std::uint32_t rings, std::uint32_t sides);

  /// An open sheet between two rows of equally many points. `right` is on the right when looking along the
  /// rows.
  void add_strip(std::span<const Vec3d> right, std::span<const Vec3d> left);

  /// Returns the mesh, normalized: the centre of its box is the origin, the longest side is 1.
  TriangleMesh finish(std::string name) &&;

 private:
  std::uint32_t add_section(const Section& section, std::uint32_t sides);
  void bridge(std::uint32_t ring, std::uint32_t next_ring, std::uint32_t sides);
  void close(std::uint32_t ring, std::uint32_t sides, const Tip& tip, bool at_start);
  void add_quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d);

  TriangleMesh mesh_;
};

/// A Catmull-Rom curve through all control points: `steps` points per segment, then the last point.
std::vector<Vec3d> smooth_curve(std::span<const Vec3d> control_points, std::uint32_t steps);

/// `count` ≥ 2 points at equal distances along the polyline, including both ends.
std::vector<Vec3d> resample(std::span<const Vec3d> polyline, std::uint32_t count);

/// Returns a unit vector perpendicular to `direction`.
Vec3d any_perpendicular(Vec3d direction);

/// Moves the centre of the box to the origin and scales its longest side to 1.
void normalize(TriangleMesh& mesh);

}  // namespace supple::models
