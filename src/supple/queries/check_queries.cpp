#include "queries/check_queries.hpp"

#include <string>

#include "core/error.hpp"
#include "supple/topology.hpp"

namespace supple {
namespace {

TriangleMesh surface_of(const WorldObject& object) {
  TriangleMesh mesh;
  for (std::uint32_t v = 0; v < object.octree().vertex_count(); ++v)
    mesh.positions.push_back(object.placement().position(v));
  for (std::uint32_t t = 0; t < object.face_count(); ++t) {
    if (object.octree().has_triangle(t)) mesh.triangles.push_back(object.octree().user_triangle(t));
  }
  return mesh;
}

}  // namespace

void check_distance(double distance, const char* call) {
  if (distance >= 0) return;
  fail(std::string(call) + ": max_distance is " + std::to_string(distance) + "; it must be 0 or more");
}

void check_counts(std::size_t queries, std::size_t results, const char* call) {
  if (queries == results) return;
  fail(std::string(call) + ": " + std::to_string(results) + " results for " + std::to_string(queries) +
       " queries; give one for each");
}

void check_closed(const World& world, const QueryFilter& seen, const char* call) {
  if (seen.object) world.object(*seen.object, call);
  for (std::uint32_t slot = 0; slot < world.slot_count(); ++slot) {
    WorldObject* const object = world.at(slot);
    if (object == nullptr || !sees(seen, world.id_of(slot), object->options)) continue;
    const auto edge = object->open_edge();
    if (!edge) continue;
    const TriangleMesh surface = surface_of(*object);
    fail(std::string(call) + ": the surface of " + object->options.name + " is " +
         describe_surface(compute_topology(surface)) + ": the edge of vertices " +
         std::to_string((*edge)[0]) + " and " + std::to_string((*edge)[1]) +
         " has an odd number of triangles; " + advice_for_open_surface(surface) +
         ", or leave this object out");
  }
}

}  // namespace supple
