// Adds an object to a world, after checks of all that the user gives.

#include <algorithm>
#include <utility>

#include "core/error.hpp"
#include "core/sort_once.hpp"
#include "mesh/vertex_triangles.hpp"
#include "supple/option_descriptions.hpp"
#include "supple/topology.hpp"
#include "world/checked_elements.hpp"
#include "world/world.hpp"

namespace supple {
namespace {

/// `ObjectOptions::same_vertex`, or its replacement by `weld`; empty when each vertex is its own.
std::vector<std::uint32_t> checked_same_vertices(const PositionsView& positions,
                                                 const ObjectOptions& options) {
  const std::vector<std::uint32_t>& same = options.same_vertex;
  if (options.weld && !same.empty())
    fail(options.name + ": weld and same_vertex are both set; choose one of them");
  if (options.weld) return vertices_at_same_position(positions);
  if (!same.empty() && same.size() != positions.size()) {
    fail(options.name + ": same_vertex has " + std::to_string(same.size()) + " ids for " +
         std::to_string(positions.size()) + " vertices; give one for each vertex");
  }
  for (std::size_t v = 0; v < same.size(); ++v) {
    if (same[v] < same.size() && same[same[v]] == same[v]) continue;
    fail(options.name + ": same_vertex of vertex " + std::to_string(v) + " is " + std::to_string(same[v]) +
         ", which is no vertex that counts as itself");
  }
  return same;
}

}  // namespace

ObjectId World::add(const PositionsView& positions, const TrianglesView& triangles,
                    const ObjectOptions& object_options, const std::string& fallback_name) {
  const auto index = free_slots_.empty() ? static_cast<std::uint32_t>(slots_.size()) : free_slots_.back();
  ObjectOptions named = object_options;
  if (named.name.empty())
    named.name = fallback_name.empty() ? "object " + std::to_string(index) : fallback_name;
  check(named);
  if (named.octree.build == ObjectOctreeBuild::balanced && named.octree.arity != node_width)
    fail(named.name + ": a balanced octree has eight children; for an arity of " +
         std::to_string(named.octree.arity) + ", build it regular or bottom-up");
  std::vector<Triangle> faces = checked_triangles(named.name, positions.size(), triangles, parallel);
  std::vector<Triangle> extra = checked_extra_elements(positions.size(), named);
  if (faces.size() + extra.size() >= 0xffffffff) fail(named.name + ": more than 2^32 - 2 elements");
  std::vector<std::uint32_t> same = checked_same_vertices(positions, named);
  if (!same.empty()) {
    const auto same_vertex = [&](std::uint32_t vertex) { return same[vertex]; };
    merge_welded(faces, same_vertex);
    merge_welded_elements(extra, same_vertex);
  }
  sort_once(extra);
  if (named.solid) {
    TriangleMesh surface{.name = {}, .positions = {}, .triangles = faces};
    for (std::size_t v = 0; v < positions.size(); ++v) surface.positions.push_back(positions[v]);
    if (const std::string fault = fault_of_solid(surface); !fault.empty())
      fail(named.name + " is no solid: " + fault);
  }
  auto object = std::make_unique<WorldObject>(positions, std::move(faces), extra, named, options, parallel);
  object->keep_welded(std::move(same));
  object->move().set_positions(positions, parallel);
  object->measure_built_octree(parallel);
  object->inward_triangles();  // the rest pose decides which sheets bound holes
  if (free_slots_.empty()) {
    slots_.emplace_back();
  } else {
    free_slots_.pop_back();
  }
  slots_[index].object = std::move(object);
  mark_changed();
  return id_of(index);
}

}  // namespace supple
