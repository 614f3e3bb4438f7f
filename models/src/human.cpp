
#include "built_in.hpp"
#include "implicit_surface.hpp"
#include "mesh_builder.hpp"
#include "remesh.hpp"

namespace supple::models {
namespace {

// Metres; an adult of 1.75 m who looks towards +z. The left side is at +x.
void add_head(ImplicitSurface& surface) {
  surface.set_style(0.05, 0.80);
  surface.add_bone({0, 1.44, -0.018}, {0, 1.56, -0.004}, 0.062, 0.054);  // neck
  surface.add_ellipsoid({0, 1.660, 0.000}, {0.078, 0.102, 0.100});       // skull
  surface.set_style(0.03, 0.55);
  surface.add_ellipsoid({0, 1.600, 0.040}, {0.056, 0.078, 0.062});  // jaw
  surface.add_ellipsoid({0, 1.545, 0.082}, {0.026, 0.020, 0.020});  // chin
  surface.add_ellipsoid({0, 1.682, 0.078}, {0.056, 0.016, 0.026});  // brow
  for (const double side : {1.0, -1.0}) {
    surface.set_style(0.02, 0.42);
    surface.carve_ellipsoid({0.034 * side, 1.655, 0.116}, {0.024, 0.017, 0.026});  // eye socket
    surface.set_style(0.02, 0.50);
    surface.add_ellipsoid({0.082 * side, 1.640, -0.006}, {0.016, 0.036, 0.024});  // ear
  }
  surface.set_style(0.016, 0.40);
  surface.add_bone({0, 1.668, 0.096}, {0, 1.618, 0.124}, 0.010, 0.017);  // nose
  surface.add_ellipsoid({0, 1.577, 0.096}, {0.026, 0.012, 0.012});       // mouth
}

void add_torso(ImplicitSurface& surface) {
  surface.set_style(0.08, 1.25);
  surface.add_ellipsoid({0, 1.30, -0.010}, {0.168, 0.165, 0.108});   // chest
  surface.add_ellipsoid({0, 1.10, 0.000}, {0.134, 0.150, 0.094});    // waist
  surface.add_ellipsoid({0, 0.955, -0.008}, {0.155, 0.115, 0.106});  // hips
  for (const double side : {1.0, -1.0}) {
    surface.set_style(0.08, 1.15);
    surface.add_bone({0.05 * side, 1.445, -0.018}, {0.170 * side, 1.410, -0.014}, 0.050, 0.054);  // shoulder
    surface.set_style(0.05, 1.1);
    surface.add_ellipsoid({0.074 * side, 1.325, 0.066}, {0.082, 0.060, 0.030});   // breast
    surface.add_ellipsoid({0.072 * side, 0.925, -0.072}, {0.076, 0.082, 0.060});  // seat
  }
}

void add_leg(ImplicitSurface& surface, double side) {
  const Vec3d hip{0.088 * side, 0.900, 0.000};
  const Vec3d knee{0.108 * side, 0.490, 0.014};
  const Vec3d ankle{0.122 * side, 0.085, -0.022};
  surface.set_style(0.05, 1.15);
  surface.add_bone(hip, knee, 0.088, 0.055);
  surface.set_style(0.04, 0.95);
  surface.add_bone(knee, ankle, 0.054, 0.037);
  surface.add_ellipsoid({0.114 * side, 0.370, -0.022}, {0.050, 0.120, 0.052});  // calf
  surface.set_style(0.03, 0.62);
  surface.add_bone({0.122 * side, 0.036, -0.048}, {0.132 * side, 0.032, 0.075}, 0.035, 0.031);  // foot
  surface.add_ellipsoid({0.137 * side, 0.028, 0.110}, {0.047, 0.027, 0.062});                   // toes
}

void add_arm(ImplicitSurface& surface, Vec3d shoulder, Vec3d elbow, Vec3d wrist) {
  surface.set_style(0.035, 0.85);
  surface.add_bone(shoulder, elbow, 0.052, 0.038);
  surface.add_bone(elbow, wrist, 0.039, 0.027);
  surface.add_ellipsoid(lerp(elbow, wrist, 0.28), {0.042, 0.085, 0.042}, {0, 0, 1}, wrist - elbow);
}

/// A mitten: a palm, one block for all fingers, a thumb. The palm faces the direction `palm`.
void add_hand(ImplicitSurface& surface, Vec3d wrist, Vec3d along, Vec3d palm, Vec3d thumb) {
  const Vec3d forward = unit(along);
  const Vec3d inward = unit(palm);
  const Vec3d across = unit(thumb);
  surface.set_style(0.025, 0.50);
  surface.add_ellipsoid(wrist + forward * 0.055, {0.026, 0.060, 0.045}, inward, forward);
  surface.add_ellipsoid(wrist + forward * 0.120 + inward * 0.008, {0.023, 0.062, 0.038}, inward, forward);
  surface.set_style(0.016, 0.36);
  surface.add_bone(wrist + forward * 0.030 + across * 0.028, wrist + forward * 0.098 + across * 0.066, 0.019,
                   0.015);
}

}  // namespace

// One closed surface whose right hand rests on the hip. The arm makes a handle, so the surface has genus 1
// and twice as many faces as vertices: 2500 and 1250.
TriangleMesh make_human() {
  ImplicitSurface surface;
  add_torso(surface);
  add_head(surface);
  add_leg(surface, 1);
  add_leg(surface, -1);

  const Vec3d left_wrist{0.330, 0.885, 0.045};
  add_arm(surface, {0.185, 1.400, -0.014}, {0.268, 1.130, -0.020}, left_wrist);
  add_hand(surface, left_wrist, {0.16, -1, 0.15}, {-1, -0.1, -0.7}, {-0.7, 0, 1});

  const Vec3d right_wrist{-0.232, 1.030, 0.050};
  add_arm(surface, {-0.185, 1.400, -0.014}, {-0.400, 1.195, -0.045}, right_wrist);
  add_hand(surface, right_wrist, {0.75, -0.55, 0.32}, {0.45, 0.1, -1}, {0.1, 1, 0.1});

  TriangleMesh mesh = triangulate_with(surface, 0.021, 1250);
  mesh.name = "human";
  normalize(mesh);
  return mesh;
}

}  // namespace supple::models
