#pragma once

#include <cstdint>
#include <vector>

#include "model_vectors.hpp"
#include "supple/mesh.hpp"

namespace supple::models {

/// Distance to the surface, negative inside (approximate away from it), and how long a triangle's edges
/// should be there, relative to other places.
struct SurfaceSample {
  double distance;
  double edge_length;
};

/// A smooth closed surface around round parts that melt into one another.
class ImplicitSurface {
 public:
  /// What follows is rounded into what was added before over a width of about `blend`; edges on it are
  /// `edge_length` long, relative to other parts.
  void set_style(double blend, double edge_length);

  /// A ball at each end and the cone that touches both.
  void add_bone(Vec3d start, Vec3d end, double start_radius, double end_radius);

  /// `radii` along `side`, `up` and their cross product. `up` keeps its direction, `side` is turned square.
  void add_ellipsoid(Vec3d center, Vec3d radii, Vec3d side = {1, 0, 0}, Vec3d up = {0, 1, 0});

  /// An ellipsoid taken away from what was added before it.
  void carve_ellipsoid(Vec3d center, Vec3d radii, Vec3d side = {1, 0, 0}, Vec3d up = {0, 1, 0});

  SurfaceSample sample(Vec3d point) const;

  /// The point moved towards the surface by one step of Newton's method. Meant for points close to it.
  Vec3d project(Vec3d point) const;

  /// Closed triangles, outward, by marching tetrahedra on cubes of side `cell` over the parts' box. Parts
  /// thinner than a cell may be lost.
  TriangleMesh triangulate(double cell) const;

 private:
  enum class Kind { bone, ellipsoid, carved_ellipsoid };
  struct Part {
    Kind kind;
    Vec3d start, end;  // an ellipsoid's centre is `start`
    double start_radius, end_radius;
    Vec3d radii, side, up, front;
    Vec3d middle;  // of a ball with radius `reach` around the part
    double reach;
    double blend, edge_length;
  };

  static double distance_to(const Part& part, Vec3d point);

  std::vector<Part> parts_;
  double blend_ = 0.1;
  double edge_length_ = 1;
};

}  // namespace supple::models
