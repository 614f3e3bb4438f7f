// Changes the mesh of an object, after checks of all that the user gives.

#include <algorithm>
#include <utility>

#include "core/error.hpp"
#include "core/sort_once.hpp"
#include "geometry/vector.hpp"
#include "world/checked_elements.hpp"
#include "world/world.hpp"

namespace supple {
namespace {

void check_finite(const PositionsView& positions, const std::string& where, const char* what) {
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (is_finite(positions[i])) continue;
    fail(where + ": " + what + " of new vertex " + std::to_string(i) + " is not finite");
  }
}

void check_new_vertices(const WorldObject& object, const MeshEdit& edit, const std::string& where) {
  const Placement& placement = object.placement();
  if (placement.shape().is_borrowed())
    fail(where + " shares its positions, so an edit cannot add to them; call set_positions first");
  const std::size_t starts = placement.has_motion() ? edit.new_vertices.size() : 0;
  if (edit.new_starts.size() != starts) {
    fail(where + " is " + (placement.has_motion() ? "on a path" : "not on a path") + " and has " +
         std::to_string(edit.new_starts.size()) + " starts for " + std::to_string(edit.new_vertices.size()) +
         " new vertices; give " + std::to_string(starts));
  }
  const bool is_double = placement.shape().is_double();
  for (const PositionsView& positions : {edit.new_vertices, edit.new_starts}) {
    if (positions.size() == 0 || positions.is_double() == is_double) continue;
    fail(where + " has " + (is_double ? "double" : "float") + " positions, but the new vertices are " +
         (is_double ? "float" : "double") + "; give both in one precision");
  }
  check_finite(edit.new_vertices, where, "the position");
  check_finite(edit.new_starts, where, "the start");
}

/// Adds the triangles that the edit removes.
void remove_triangles(const WorldObject& object, std::span<const std::uint32_t> removed,
                      std::vector<std::uint32_t>& all) {
  for (const std::uint32_t triangle : removed) check_triangle(object, triangle, "edit");
  std::vector<std::uint32_t> sorted(removed.begin(), removed.end());
  std::sort(sorted.begin(), sorted.end());
  if (const auto twice = std::ranges::adjacent_find(sorted); twice != sorted.end())
    fail("edit: " + object.options.name + ": triangle " + std::to_string(*twice) + " is removed twice");
  all.insert(all.end(), sorted.begin(), sorted.end());
  std::sort(all.begin(), all.end());
}

/// The edges and points after the edit.
std::vector<Triangle> edited_elements(const WorldObject& object, const MeshEdit& edit,
                                      std::size_t vertex_count) {
  const std::string where = "edit: " + object.options.name;
  const auto elements = [&](const auto& edges, const auto& points) {
    ObjectOptions named;
    named.name = where;
    named.edges.assign(edges.begin(), edges.end());
    named.points.assign(points.begin(), points.end());
    std::vector<Triangle> found = checked_extra_elements(vertex_count, named);
    merge_welded_elements(found, [&](std::uint32_t v) { return object.same_vertex(v); });
    return found;
  };
  std::vector<Triangle> all = object.extra_elements();
  for (const Triangle& removed : elements(edit.removed_edges, edit.removed_points)) {
    const auto place = std::lower_bound(all.begin(), all.end(), removed);
    if (place != all.end() && *place == removed) {
      all.erase(place);
      continue;
    }
    const auto& [v, w, last] = removed;
    fail(where + " has no " + (v == w ? "point " : "edge ") + std::to_string(v) +
         (v == w ? std::string() : std::string("-").append(std::to_string(w))) +
         " to remove, or it is removed twice");
  }
  const std::vector<Triangle> added = elements(edit.added_edges, edit.added_points);
  all.insert(all.end(), added.begin(), added.end());
  sort_once(all);
  return all;
}

/// Adds the sides of a triangle to those that open a solid: the number of times an edge is used from its
/// smaller to its larger vertex, minus the number of times the other way round.
void add_to_boundary(const Triangle& triangle, int sign, SolidBoundary& boundary) {
  for (std::size_t i = 0; i < 3; ++i) {
    const std::uint32_t from = triangle[i], to = triangle[(i + 1) % 3];
    if (from == to) continue;
    const auto side = boundary.try_emplace({std::min(from, to), std::max(from, to)}, 0).first;
    side->second += from < to ? sign : -sign;
    if (side->second == 0) boundary.erase(side);
  }
}

}  // namespace

void World::edit(ObjectId id, const MeshEdit& edit) {
  WorldObject& found = movable_object(id, "edit");
  const std::string where = "edit: " + found.options.name;
  check_new_vertices(found, edit, where);
  const std::size_t vertices = found.vertex_count() + edit.new_vertices.size();
  if (vertices >= 0xffffffff || found.triangle_count() + edit.added.size() >= 0xffffffff)
    fail(where + ": more than 2^32 - 2 vertices or triangles");
  std::vector<Triangle> added = checked_triangles(where, vertices, edit.added, parallel);
  merge_welded(added, [&](std::uint32_t v) { return found.same_vertex(v); });
  PendingEdits all = found.pending_edits();
  remove_triangles(found, edit.removed, all.removed);
  all.added.insert(all.added.end(), added.begin(), added.end());
  const bool has_elements = !edit.removed_edges.empty() || !edit.added_edges.empty() ||
                            !edit.removed_points.empty() || !edit.added_points.empty();
  if (has_elements) all.extra = edited_elements(found, edit, vertices);
  found.edit(edit, std::move(all), parallel);
  mark_changed();
}

std::vector<std::uint32_t> World::compact(ObjectId id) {
  std::vector<std::uint32_t> numbers = object(id, "compact").compact(parallel);
  mark_changed();
  return numbers;
}

const PendingEdits WorldObject::no_edits{};

bool WorldObject::has_triangle(std::uint32_t triangle) const {
  if (triangle >= triangle_count()) return false;
  if (std::ranges::binary_search(pending_edits().removed, triangle)) return false;
  return triangle >= face_count_ || octree_.has_triangle(triangle);
}

std::vector<Triangle> WorldObject::extra_elements() const {
  if (pending_edits().extra) return *pending_edits().extra;
  std::vector<Triangle> extra;
  for (auto e = face_count_; e < octree_.id_count(); ++e) extra.push_back(octree_.user_triangle(e));
  return extra;
}

void WorldObject::edit(const MeshEdit& edit, PendingEdits all, const Parallel& parallel) {
  auto pending = std::make_unique<PendingEdits>(std::move(all));
  std::unique_ptr<SolidBoundary> boundary;
  if (boundary_ || options.solid) {
    boundary = boundary_ ? std::make_unique<SolidBoundary>(*boundary_) : std::make_unique<SolidBoundary>();
    for (const std::uint32_t id : edit.removed) add_to_boundary(triangle(id), -1, *boundary);
    for (std::size_t i = pending_edits().added.size(); i < pending->added.size(); ++i)
      add_to_boundary(pending->added[i], 1, *boundary);
  }
  const std::size_t vertices = vertex_count() + edit.new_vertices.size();
  if (!groups_.empty()) {
    groups_.reserve(vertices);
    masks_.reserve(vertices);
  }
  if (edit.new_vertices.size() > 0) move().append(edit.new_vertices, edit.new_starts, parallel);
  if (!groups_.empty()) {
    groups_.resize(vertices, ~std::uint32_t{0});
    masks_.resize(vertices, ~std::uint32_t{0});
  }
  if (boundary) options.solid = boundary->empty();
  boundary_ = std::move(boundary);
  pending_ = std::move(pending);
  ++mesh_version_;
  has_moved_ = true;
}

/// Changes the octree as all edits since the last update say.
void WorldObject::make_pending_edits(const Parallel& parallel) {
  forget_octree();  // takes memory, so that nothing can fail between the changes below
  const PendingEdits& edits = *pending_;
  const PositionsView positions = placement_.end().view();
  const auto face_count = triangle_count();
  const auto first_added = std::ranges::lower_bound(edits.removed, face_count_);
  const auto old_count = static_cast<std::size_t>(first_added - edits.removed.begin());
  const std::span<const std::uint32_t> removed = std::span(edits.removed).first(old_count);
  const bool has_extra = has_extra_elements() || edits.extra;
  // What was added and removed again stays out, but keeps its id.
  if (has_extra || old_count < edits.removed.size()) {
    const std::vector<Triangle> extra = extra_elements();
    ObjectOctree::Triangles listed = octree_.listed_triangles(removed);
    while (!listed.ids.empty() && listed.ids.back() >= face_count_) {
      listed.ids.pop_back();
      listed.triangles.pop_back();
    }
    for (std::uint32_t id = face_count_; id < face_count; ++id) {
      if (has_triangle(id)) listed.push(edits.added[id - face_count_], id);
    }
    for (std::size_t i = 0; i < extra.size(); ++i) listed.push(extra[i], face_count + i);
    ObjectOctree octree = octree_.built_like_this(positions, listed, face_count + extra.size(), parallel);
    list_points(extra, positions.size());
    octree_ = std::move(octree);
  } else {
    octree_.edit(removed, edits.added, positions, is_edited_locally_, parallel);
  }
  face_count_ = face_count;
  pending_.reset();
  resting_.forget_octree(face_count_);
  knows_open_edge_ = false;
  open_edge_.reset();
  vertex_triangles_.reset();
  orientation_.reset();
  inward_triangles();  // the present positions decide which sheets bound holes
}

std::vector<std::uint32_t> WorldObject::compact(const Parallel& parallel) {
  if (pending_) make_pending_edits(parallel);
  std::vector<std::uint32_t> numbers(face_count_, no_place);
  ObjectOctree::Triangles listed = octree_.listed_triangles();
  std::uint32_t count = 0, faces = 0;
  for (std::uint32_t& id : listed.ids) {
    if (id < face_count_) {
      numbers[id] = count;
      ++faces;
    }
    id = count++;
  }
  std::unique_ptr<Orientation> orientation;  // by the present positions, as for an edit
  if (options.solid) {
    orientation = std::make_unique<Orientation>(
        std::vector<Triangle>(listed.triangles.begin(), listed.triangles.begin() + faces),
        placement_.shape().view());
  }
  forget_octree();
  octree_ = octree_.built_like_this(placement_.end().view(), listed, count, parallel);
  face_count_ = faces;
  resting_.forget_octree(face_count_);
  vertex_triangles_.reset();
  orientation_ = std::move(orientation);
  oriented_version_ = placement_.shape_version();
  ++mesh_version_;
  has_moved_ = true;
  return numbers;
}

}  // namespace supple
