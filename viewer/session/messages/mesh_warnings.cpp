#include "messages/mesh_warnings.hpp"

#include <algorithm>
#include <cstdint>

#include "messages/long_steps.hpp"
#include "sources/extent.hpp"

namespace supple::viewer {
namespace {

/// What several objects have in common; the first one is named.
struct Found {
  std::string first{};
  std::uint64_t objects = 0, vertices = 0;

  void add(const ViewedObject& object, std::uint64_t count = 0) {
    if (objects++ == 0) first = object.options.name.empty() ? object.mesh.name : object.options.name;
    vertices += count;
  }
  std::string names() const { return first + and_others(objects - 1); }
};

bool has_elements(const ViewedObject& object) {
  const TriangleMesh& mesh = object.mesh;
  const ObjectOptions& options = object.options;
  return !mesh.triangles.empty() || !mesh.edges.empty() || !mesh.points.empty() || !options.edges.empty() ||
         !options.points.empty();
}

}  // namespace

std::vector<std::string> warnings_of_meshes(const SceneView& show) {
  Found not_finite, empty;
  for (const ViewedObject& object : show.objects) {
    const auto& positions = object.mesh.positions;
    const auto count =
        std::count_if(positions.begin(), positions.end(), [](const Vec3d& p) { return !is_finite(p); });
    if (count > 0) not_finite.add(object, static_cast<std::uint64_t>(count));
    if (!has_elements(object)) empty.add(object);
  }
  std::vector<std::string> warnings;
  if (not_finite.objects > 0)
    warnings.push_back(not_finite.names() + ": " + std::to_string(not_finite.vertices) +
                       (not_finite.vertices == 1 ? " vertex is" : " vertices are") +
                       " NaN or infinite; triangles that use such vertices are not drawn and touch nothing");
  if (empty.objects > 0)
    warnings.push_back(empty.names() + ": there are no faces, edges or points, so nothing touches it");
  return warnings;
}

}  // namespace supple::viewer
