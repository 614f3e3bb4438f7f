#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "arguments.hpp"
#include "scene_view.hpp"

namespace supple::viewer {

// Read the numbers of objects, vertices and triangles from a command. What does not exist in the scene is an
// error of the arguments.

/// False, and an error, when there is no such object.
bool has_object(std::uint32_t object, const SceneView& scene, Arguments& arguments);

/// A required object.
std::uint32_t read_object(const char* name, const SceneView& scene, Arguments& arguments);

/// The member `vertex` of a command, a vertex of the object.
std::optional<std::uint32_t> read_vertex(std::uint32_t object, const SceneView& scene, Arguments& arguments);

/// The member `triangle` of a command, a triangle of the object.
std::optional<std::uint32_t> read_triangle(std::uint32_t object, const SceneView& scene,
                                           Arguments& arguments);

/// A required object and one of its triangles.
std::array<std::uint32_t, 2> read_object_triangle(const char* name, const SceneView& scene,
                                                  Arguments& arguments);

}  // namespace supple::viewer
