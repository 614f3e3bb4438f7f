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

/// Excludes the pairs of objects of different recordings.
inline PairFilter filter_of(const Comparison& comparison) {
  return [count = comparison.objects_of_a](ObjectId a, ObjectId b) {
    return (a.index < count) == (b.index < count);
  };
}

}  // namespace supple::viewer
