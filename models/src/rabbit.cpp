
#include "built_in.hpp"
#include "implicit_surface.hpp"
#include "mesh_builder.hpp"
#include "remesh.hpp"

namespace supple::models {

// A sitting rabbit that looks towards +x: one closed surface of genus 0, 453 vertices, 902 faces.
TriangleMesh make_rabbit() {
  ImplicitSurface surface;
  surface.set_style(0.10, 1.35);
  surface.add_ellipsoid({-0.10, 0.265, 0}, {0.26, 0.23, 0.190}, {1, 0.25, 0}, {-0.25, 1, 0});  // rump
  surface.add_ellipsoid({0.10, 0.30, 0}, {0.16, 0.20, 0.145});                                 // chest
  surface.set_style(0.10, 1.1);
  surface.add_bone({0.10, 0.40, 0}, {0.17, 0.50, 0}, 0.13, 0.11);  // neck
  for (const double side : {1.0, -1.0}) {
    surface.set_style(0.025, 1.00);
    surface.add_ellipsoid({-0.110, 0.200, 0.155 * side}, {0.165, 0.175, 0.090});  // haunch
    surface.set_style(0.035, 0.80);
    surface.add_bone({-0.130, 0.045, 0.185 * side}, {0.115, 0.042, 0.215 * side}, 0.045, 0.048);  // hind foot
    surface.set_style(0.04, 0.85);
    surface.add_bone({0.165, 0.240, 0.075 * side}, {0.210, 0.070, 0.078 * side}, 0.065, 0.048);  // front leg
    surface.set_style(0.03, 0.75);
    surface.add_bone({0.210, 0.042, 0.080 * side}, {0.275, 0.038, 0.082 * side}, 0.044, 0.040);  // paw
  }
  surface.set_style(0.03, 0.85);
  surface.add_ellipsoid({-0.390, 0.205, 0}, {0.085, 0.088, 0.085});  // tail
  surface.set_style(0.06, 0.90);
  surface.add_ellipsoid({0.205, 0.585, 0}, {0.160, 0.140, 0.132}, {1, -0.2, 0}, {0.2, 1, 0});  // head
  surface.set_style(0.04, 0.75);
  surface.add_ellipsoid({0.325, 0.545, 0}, {0.070, 0.064, 0.070});  // muzzle
  for (const double side : {1.0, -1.0}) {
    surface.set_style(0.05, 0.80);
    surface.add_ellipsoid({0.250, 0.525, 0.070 * side}, {0.080, 0.072, 0.070});  // cheek
    const Vec3d along{-0.32, 1, 0.18 * side};
    const Vec3d root{0.145, 0.680, 0.060 * side};
    surface.set_style(0.035, 0.72);
    surface.add_ellipsoid(root + unit(along) * 0.225, {0.045, 0.280, 0.082}, {0.55, 0.3, 0.85 * side}, along);
  }
  TriangleMesh mesh = triangulate_with(surface, 0.025, 453);
  mesh.name = "rabbit";
  normalize(mesh);
  return mesh;
}

}  // namespace supple::models
