#pragma once

#include "archive.hpp"
#include "scene_view.hpp"
#include "supple/simulation.hpp"

namespace supple::viewer {

// The members of all that a packed show has, in order, for `Packer` and `Unpacker`. Numbers of threads are
// left out: they belong to the machine that plays the show.

template <>
inline constexpr std::uint8_t count_of<BoundingVolume> = 2;
template <>
inline constexpr std::uint8_t count_of<SphereFit> = 2;
template <>
inline constexpr std::uint8_t count_of<BroadPhaseMethod> = 5;
template <>
inline constexpr std::uint8_t count_of<RegionSphereTest> = 2;
template <>
inline constexpr std::uint8_t count_of<ContactKinds> = 4;
template <>
inline constexpr std::uint8_t count_of<Integrator> = 3;

/// A structure, or the same constant.
template <class Given, class Structure>
concept Of = std::is_same_v<std::remove_const_t<Given>, Structure>;

void fields(auto& archive, Of<ObjectOctreeOptions> auto& o) {
  archive(o.max_level, o.leaf_size, o.arity, o.rebuild_degraded);
}

void fields(auto& archive, Of<ObjectOptions> auto& o) {
  archive(o.name, o.self_collision, o.is_static, o.group, o.mask, o.octree);
}

void fields(auto& archive, Of<SceneOctreeOptions> auto& o) {
  archive(o.max_level, o.expand_at, o.region_sphere_test, o.arity);
}

void fields(auto& archive, Of<ImpactOptions> auto& o) {
  archive(o.min_separation, o.exact);
}

void fields(auto& archive, Of<SceneOptions> auto& o) {
  archive(o.bounding_volume, o.comparison.sphere_fit, o.broad_phase, o.scene_octree, o.contacts,
          o.contact_points, o.impact, o.comparison.colliding_vertices);
}

void fields(auto& archive, Of<Border> auto& border) {
  archive(border[0], border[1]);
}

void fields(auto& archive, Of<ContactResponse> auto& o) {
  archive(o.enabled, o.thickness, o.restitution, o.friction, o.iterations);
}

void fields(auto& archive, Of<SimulationOptions> auto& o) {
  archive(o.scene, o.time_step, o.border, o.seed, o.response);
}

void fields(auto& archive, Of<TriangleMesh> auto& mesh) {
  archive(mesh.name, mesh.positions, mesh.triangles);
}

void fields(auto& archive, Of<WaveMotion> auto& sway) {
  archive(sway.velocity, sway.amplitude, sway.wavelength, sway.period, sway.seed);
}

void fields(auto& archive, Of<MassSpringOptions> auto& o) {
  archive(o.integrator, o.substeps, o.vertex_mass, o.stiffness, o.damping, o.air_friction,
          o.bending_stiffness, o.area_stiffness, o.volume_stiffness, o.gravity, o.max_strain, o.yield_strain,
          o.plastic_rate, o.fixed_vertices);
}

void fields(auto& archive, Of<MassSpringMotion::Handle> auto& handle) {
  archive(handle.vertices, handle.by, handle.seconds);
}

void fields(auto& archive, Of<MassSpringMotion> auto& motion) {
  archive(motion.springs, motion.velocity, motion.random_speed, motion.random_force, motion.deform_seconds,
          motion.seed, motion.handles);
}

void fields(auto& archive, Of<Series::Event> auto& event) {
  archive(event.frame, event.a, event.b);
}

void fields(auto& archive, Of<Series> auto& series) {
  archive(series.names, series.values, series.begin, series.end);
}

inline void fields(Packer& archive, const ViewedObject& object) {
  archive(object.mesh, object.options, static_cast<std::uint8_t>(object.motion.index()));
  if (const auto* const sway = std::get_if<WaveMotion>(&object.motion)) archive(*sway);
  if (const auto* const springs = std::get_if<MassSpringMotion>(&object.motion)) archive(*springs);
}

inline void fields(Unpacker& archive, ViewedObject& object) {
  std::uint8_t kind = 0;
  archive(object.mesh, object.options, kind);
  switch (kind) {
    case 0:
      object.motion.emplace<std::monostate>();
      break;
    case 1:
      archive(object.motion.emplace<WaveMotion>());
      break;
    case 2:
      archive(object.motion.emplace<MassSpringMotion>());
      break;
    default:
      archive.fail();
  }
}

}  // namespace supple::viewer
