#include "object_arguments.hpp"

#include <cstddef>
#include <string>

namespace supple::viewer {
namespace {

/// Whether an object has a vertex or triangle, of which it has `count`.
bool has(const char* what, std::uint32_t number, std::size_t count, std::uint32_t object,
         Arguments& arguments) {
  if (number < count) return true;
  arguments.fail("object " + std::to_string(object) + " has no " + what + " " + std::to_string(number) +
                 "; it has " + std::to_string(count) + ", numbered from 0");
  return false;
}

/// An optional member of the command that numbers a vertex or a triangle.
std::optional<std::uint32_t> read(const char* what, std::size_t count, std::uint32_t object,
                                  Arguments& arguments) {
  const auto given = arguments.integer(what, 0, largest_id);
  if (!given) return std::nullopt;
  const auto number = static_cast<std::uint32_t>(*given);
  return has(what, number, count, object, arguments) ? std::optional(number) : std::nullopt;
}

}  // namespace

bool has_object(std::uint32_t object, const SceneView& scene, Arguments& arguments) {
  const std::size_t count = scene.objects.size();
  if (object < count) return true;
  arguments.fail("there is no object " + std::to_string(object) + "; there are " + std::to_string(count) +
                 ", numbered from 0");
  return false;
}

std::uint32_t read_object(const char* name, const SceneView& scene, Arguments& arguments) {
  const auto object =
      static_cast<std::uint32_t>(arguments.required(name, arguments.integer(name, 0, largest_id)));
  has_object(object, scene, arguments);
  return object;
}

std::optional<std::uint32_t> read_vertex(std::uint32_t object, const SceneView& scene, Arguments& arguments) {
  if (!has_object(object, scene, arguments)) return std::nullopt;
  return read("vertex", scene.objects[object].mesh.positions.size(), object, arguments);
}

std::optional<std::uint32_t> read_triangle(std::uint32_t object, const SceneView& scene,
                                           Arguments& arguments) {
  if (!has_object(object, scene, arguments)) return std::nullopt;
  return read("triangle", scene.objects[object].mesh.triangles.size(), object, arguments);
}

std::array<std::uint32_t, 2> read_object_triangle(const char* name, const SceneView& scene,
                                                  Arguments& arguments) {
  const auto [object, triangle] = arguments.required(name, arguments.pair(name));
  if (has_object(object, scene, arguments))
    has("triangle", triangle, scene.objects[object].mesh.triangles.size(), object, arguments);
  return {object, triangle};
}

}  // namespace supple::viewer
