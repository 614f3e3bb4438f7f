#pragma once

#include <variant>

#include "show.hpp"
#include "supple/sway.hpp"

namespace supple::viewer {

/// Where an object of a show is at the start: in waves it is not at rest.
inline TriangleMesh start_of(const Show& show, const ShowObject& object) {
  TriangleMesh mesh = object.mesh;
  if (const auto* const waves = std::get_if<Sway>(&object.motion))
    sway(*waves, show.simulation.border, object.mesh.positions, 0, mesh.positions);
  return mesh;
}

}  // namespace supple::viewer
