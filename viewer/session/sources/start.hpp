#pragma once

#include <variant>

#include "scene_view.hpp"
#include "supple/wave_motion.hpp"

namespace supple::viewer {

/// The mesh of an object at the start. With waves it differs from the rest pose.
inline TriangleMesh start_of(const SceneView& show, const ViewedObject& object) {
  TriangleMesh mesh = object.mesh;
  if (const auto* const waves = std::get_if<WaveMotion>(&object.motion))
    apply_wave_motion(*waves, show.simulation.border, object.mesh.positions, 0, mesh.positions);
  return mesh;
}

}  // namespace supple::viewer
