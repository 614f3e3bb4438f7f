#pragma once

#include "packed/archive.hpp"
#include "scene_view.hpp"
#include "supple/simulation_descriptions.hpp"

namespace supple::viewer {

// `Packer` and `Unpacker` call these functions, which list the members of each structure of a packed scene.

/// `Given` is `Structure` or `const Structure`.
template <class Given, class Structure>
concept Of = std::is_same_v<std::remove_const_t<Given>, Structure>;

/// All options except those of the machine, such as numbers of threads, which the machine that plays the
/// scene chooses.
template <class Options>
requires Described<Options>
void fields(auto& archive, Options& options) {
  for_each_field<Options>([&](const auto& field) {
    if (!field.is_of_machine) archive(options.*field.member);
  });
}

void fields(auto& archive, Of<Border> auto& border) {
  archive(border[0], border[1]);
}

void fields(auto& archive, Of<RootCube> auto& cube) {
  archive(cube.corner, cube.edge);
}

void fields(auto& archive, Of<TriangleMesh> auto& mesh) {
  archive(mesh.name, mesh.positions, mesh.triangles, mesh.edges, mesh.points);
}

void fields(auto& archive, Of<Series::Event> auto& event) {
  archive(event.frame, event.a, event.b);
}

void fields(auto& archive, Of<Series::Events> auto& events) {
  archive(events.begin, events.end);
}

void fields(auto& archive, Of<Series> auto& series) {
  archive(series.names, series.values, series.contacts, series.narrow_phase, series.volumes);
}

inline void fields(Packer& archive, const ViewedObject& object) {
  archive(object.mesh, object.options, static_cast<std::uint8_t>(object.motion.index()));
  if (const auto* const wave = std::get_if<WaveMotion>(&object.motion)) archive(*wave);
  if (const auto* const springs = std::get_if<MassSpringMotion>(&object.motion)) archive(*springs);
  if (const auto* const rigid = std::get_if<RigidMotion>(&object.motion)) archive(*rigid);
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
    case 3:
      archive(object.motion.emplace<RigidMotion>());
      break;
    default:
      archive.fail();
  }
}

}  // namespace supple::viewer
