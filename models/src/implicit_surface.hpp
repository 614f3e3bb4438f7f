#pragma once

#include <vector>

#include "model_vectors.hpp"
#include "supple/mesh.hpp"

namespace supple::models {

/// The distance to the surface, negative inside and approximate far from it, and the wanted length of
/// triangle edges there, relative to other places.
struct SurfaceSample {
  double distance;
  double edge_length;
};

/// A smooth closed surface around round parts that blend into one another.
class ImplicitSurface {
 public:
  /// Parts added later blend into earlier parts over a width of about `blend`. Edges on them have the
  /// relative length `edge_length`.
  void set_style(double blend, double edge_length);

  /// Adds two spheres and the cone that touches both.
  void add_bone(Vec3d start, Vec3d end, double start_radius, double end_radius);

  /// The radii are along `side`, `up` and their cross product. `side` is made perpendicular to `up`.
  void add_ellipsoid(Vec3d center, Vec3d radii, Vec3d side = {1, 0, 0}, Vec3d up = {0, 1, 0});

  /// Subtracts an ellipsoid from the parts added before it.
  void carve_ellipsoid(Vec3d center, Vec3d radii, Vec3d side = {1, 0, 0}, Vec3d up = {0, 1, 0});

  SurfaceSample sample(Vec3d point) const;

  /// Moves a point towards the surface by one Newton step. For points close to the surface.
  Vec3d project(Vec3d point) const;

  /// Marching tetrahedra on cubes of side `cell` over the bounding box of the parts. Returns closed
  /// triangles that face outward. Parts thinner than a cell may be lost.
  TriangleMesh triangulate(double cell) const;

 private:
  enum class Kind { bone, ellipsoid, carved_ellipsoid };
  struct Part {
    Kind kind;
    Vec3d start, end;  // start: the centre of an ellipsoid
    double start_radius, end_radius;
    Vec3d radii, side, up, front;
    Vec3d middle;  // centre of a sphere of radius `reach` around the part
    double reach;
    double blend, edge_length;
  };

  static double distance_to(const Part& part, Vec3d point);

  std::vector<Part> parts_;
  double blend_ = 0.1;
  double edge_length_ = 1;
};

}  // namespace supple::models
