#include <utility>

#include "mesh/models/implicit_surface.hpp"
#include "mesh/models/mesh_builder.hpp"
#include "mesh/models/models.hpp"
#include "mesh/models/remesh.hpp"

namespace supple::models {

// A sitting rabbit that looks towards +x, as one closed surface without a handle: 453 vertices, 902 faces.
TriangleMesh make_rabbit() {
  ImplicitSurface surface;
  surface.set_style(0.10, 1.35);
  surface.add_ellipsoid({-0.10, 0.265, 0}, {0.26, 0.22, 0.185}, {1, 0.25, 0}, {-0.25, 1, 0});  // rump
  surface.add_ellipsoid({0.10, 0.31, 0}, {0.16, 0.20, 0.140});                                 // chest
  surface.set_style(0.10, 1.1);
  surface.add_bone({0.10, 0.40, 0}, {0.19, 0.56, 0}, 0.12, 0.10);  // neck
  for (const double side : {1.0, -1.0}) {
    surface.set_style(0.035, 1.05);
    surface.add_ellipsoid({-0.120, 0.190, 0.150 * side}, {0.170, 0.165, 0.085});  // haunch
    surface.set_style(0.035, 0.80);
    surface.add_bone({-0.130, 0.045, 0.185 * side}, {0.135, 0.042, 0.210 * side}, 0.045, 0.047);  // hind foot
    surface.set_style(0.04, 0.85);
    surface.add_bone({0.170, 0.240, 0.075 * side}, {0.215, 0.070, 0.078 * side}, 0.065, 0.048);  // front leg
    surface.set_style(0.03, 0.75);
    surface.add_bone({0.215, 0.042, 0.080 * side}, {0.285, 0.038, 0.082 * side}, 0.044, 0.040);  // paw
  }
  surface.set_style(0.03, 0.85);
  surface.add_ellipsoid({-0.400, 0.225, 0}, {0.090, 0.092, 0.090});  // tail
  surface.set_style(0.06, 0.90);
  surface.add_ellipsoid({0.225, 0.620, 0}, {0.150, 0.128, 0.120}, {1, -0.2, 0}, {0.2, 1, 0});  // head
  surface.set_style(0.05, 0.75);
  surface.add_ellipsoid({0.345, 0.580, 0}, {0.075, 0.064, 0.068});  // muzzle
  for (const double side : {1.0, -1.0}) {
    surface.set_style(0.05, 0.80);
    surface.add_ellipsoid({0.265, 0.560, 0.065 * side}, {0.075, 0.065, 0.060});  // cheek
    const Vec3d along{-0.36, 1, 0.20 * side};
    const Vec3d root{0.160, 0.705, 0.055 * side};
    surface.set_style(0.04, 0.72);
    surface.add_ellipsoid(root + unit(along) * 0.215, {0.045, 0.270, 0.082}, {0.55, 0.3, 0.85 * side}, along);
  }
  TriangleMesh mesh = triangulate_with(surface, 0.020, 453);
  mesh.name = "rabbit";
  normalize(mesh);
  return mesh;
}

}  // namespace supple::models
