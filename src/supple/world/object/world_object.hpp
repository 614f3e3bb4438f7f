#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/parallel.hpp"
#include "mesh/vertex_triangles.hpp"
#include "octree/object_octree.hpp"
#include "supple/options.hpp"
#include "supple/scene.hpp"
#include "world/object/fine_boxes.hpp"
#include "world/object/moving_shape.hpp"
#include "world/object/orientation.hpp"
#include "world/object/placement.hpp"
#include "world/object/rebuild_policy.hpp"
#include "world/object/resting_shape.hpp"
#include "world/object/vertex_groups.hpp"
#include "world/object/vertex_ways.hpp"

namespace supple {

/// The data of objects that a search needs.
struct SearchedShapes {
  bool resting = false, moving = false;
  bool near = false;  ///< elements at the end of the step
  /// Only the volumes of the objects, for the resting shape; `ComparisonMethods::refit_where_objects_meet`
  /// follows.
  bool lazy = false;
  /// Self-collision culling, for objects that are tested against themselves.
  bool cull_resting = false, cull_moving = false;
  bool extra = false;  ///< as `near`, for objects with edges and points of no triangle

  constexpr bool operator==(const SearchedShapes&) const = default;
};

/// The data of objects that queries of points, rays and distances need.
constexpr SearchedShapes shapes_of_queries{.resting = true, .cull_resting = true, .extra = true};

/// The edges that open a solid, and how many more of its triangles use them in one direction than in the
/// other.
using SolidBoundary = std::map<std::array<std::uint32_t, 2>, int>;

/// Edits of a mesh that has no faults.
struct PendingEdits {
  std::vector<std::uint32_t> removed;  ///< triangles, ascending
  std::vector<Triangle> added;
  std::optional<std::vector<Triangle>> extra;  ///< all edges and points of no triangle, when they change
};

/// One object of a scene: its octree, its placement, and the shapes that searches read.
class WorldObject {
 public:
  /// `extra` are edges and points of no triangle, with the last vertex repeated.
  WorldObject(const PositionsView& positions, std::vector<Triangle> faces, std::span<const Triangle> extra,
              const ObjectOptions& object_options, const SceneOptions& scene_options,
              const Parallel& parallel);

  /// For changes of the placement; marks the object as moved.
  Placement& move() {
    has_moved_ = true;
    return placement_;
  }
  const Placement& placement() const { return placement_; }
  /// Adds vertices now, and removes and adds triangles at the next `update`. `all` are the edits since the
  /// last one with `edit`, which has no faults.
  void edit(const MeshEdit& edit, PendingEdits all, const Parallel& parallel);
  const PendingEdits& pending_edits() const { return pending_ ? *pending_ : no_edits; }
  /// Renumbers the triangles after an edit: returns the new id of each, or `no_place`. O(n log n).
  std::vector<std::uint32_t> compact(const Parallel& parallel);
  /// Also of vertices and triangles of an edit that the next `update` makes. Ids of removed triangles count.
  std::size_t vertex_count() const { return placement_.end().size(); }
  std::uint32_t triangle_count() const {
    return face_count_ + static_cast<std::uint32_t>(pending_edits().added.size());
  }
  bool has_triangle(std::uint32_t triangle) const;
  /// One that `has_triangle` knows.
  const Triangle& triangle(std::uint32_t triangle) const {
    return triangle < face_count_ ? octree_.user_triangle(triangle)
                                  : pending_edits().added[triangle - face_count_];
  }
  std::uint64_t mesh_version() const { return mesh_version_; }
  /// The edges and points of no triangle, after all edits.
  std::vector<Triangle> extra_elements() const;
  /// Keeps the vertices that count in place of welded ones; edits may name these.
  void keep_welded(std::vector<std::uint32_t> same_vertex) { same_vertex_ = std::move(same_vertex); }
  /// The vertex that counts in place of a welded one.
  std::uint32_t same_vertex(std::uint32_t vertex) const {
    return vertex < same_vertex_.size() ? same_vertex_[vertex] : vertex;
  }

  /// Whether the object has moved since the last update.
  bool has_moved() const { return has_moved_; }
  /// Whether a shape or the volumes are out of date.
  bool is_stale(const SearchedShapes& shapes) const;
  /// Whether a shape is out of date, so that triangles must be refitted.
  bool needs_refit(const SearchedShapes& shapes) const;
  /// Updates the shapes and the volumes.
  void update(const SearchedShapes& of_search, const Parallel& parallel);

  /// After an update of lazy shapes: the volumes of the children of a node. Returns the number of triangles
  /// that it read.
  std::size_t update_children(std::uint32_t node) {
    return resting_.update_children(octree_, placement_, node);
  }
  /// After an update of lazy shapes: the volumes of all nodes. O(n).
  void update_all_children(const Parallel& parallel) {
    if (resting_.has_object(placement_)) resting_.update(octree_, placement_, parallel);
  }
  /// The next update of lazy shapes takes this box of the present positions, which are finite. It has no
  /// translation.
  void set_bounds(const Aabb& box) { bounds_ = {box, placement_.version()}; }

  /// The triangles in the leaves that the last update refitted.
  std::size_t refitted_triangles() const { return refitted_triangles_; }

  /// Call when the placement has the positions that the octree was built from.
  void measure_built_octree(const Parallel& parallel);
  const RebuildPolicy& rebuild_policy() const { return rebuild_policy_; }
  RebuildPolicy& rebuild_policy() { return rebuild_policy_; }
  /// Builds an octree from the current positions. Returns whether it is so much better that it replaced the
  /// present one: then the shapes are up to date, but views are invalid. Contacts do not change.
  bool rebuild(const Parallel& parallel);

  /// The box of the placed object at the last update. It encloses all shapes, so it may enclose the whole
  /// motion.
  const Aabb& box() const { return box_; }
  const BoundingSphere& sphere() const { return sphere_; }
  const ObjectOctree& octree() const { return octree_; }
  /// The octree's triangles with ids from here on are edges and points of no triangle.
  std::uint32_t face_count() const { return face_count_; }
  bool has_extra_elements() const { return face_count_ != octree_.id_count(); }
  std::span<const std::uint8_t> is_point() const { return is_point_; }
  /// Whether a face has a vertex that is not finite; its object contains nothing.
  bool has_inert_faces() const { return resting_.has_inert_faces(); }

  VertexGroups vertex_groups() const { return {groups_, masks_}; }
  void set_vertex_groups(std::span<const std::uint32_t> groups, std::span<const std::uint32_t> masks) {
    groups_.reserve(groups.size());
    masks_.reserve(masks.size());  // so that both change, or none
    groups_.assign(groups.begin(), groups.end());
    masks_.assign(masks.begin(), masks.end());
  }
  /// O(n).
  VertexWays ways(const Parallel& parallel) const;
  const MovingShape& moving() const { return shapes_of_step().way; }
  /// The elements at the end of the step: those of `moving` for an object at rest.
  const MovingShape& near() const { return placement_.has_motion() ? shapes_of_step().end : moving(); }
  bool needs_fine_boxes() const { return FineBoxes::are_needed(resting_view()); }
  /// Takes O(n) when the octree or the positions have changed.
  void update_fine_boxes() { fine_boxes_.update(resting_view(), placement_.end(), placement_.version()); }
  /// The boxes of the octree at rest in double; null when they are not up to date.
  const QueryBox* fine_boxes() const { return fine_boxes_.of_version(placement_.version()); }
  OctreeView resting_view() const {
    OctreeView view = resting_.view(octree_, placement_);
    view.descent = descent_;
    return view;
  }
  OctreeView moving_view() const {
    OctreeView view = moving().view(octree_, placement_);
    if (has_extra_elements()) view.culled = nullptr;
    return view;
  }
  OctreeView near_view() const {
    OctreeView view = near().view(octree_, placement_);
    view.culled = nullptr;
    return view;
  }
  /// The user's ids, ascending.
  std::span<const std::uint32_t> non_finite_vertices(const SearchedShapes& shapes) const {
    if (shapes.moving) return moving().non_finite_vertices();
    return shapes.resting ? resting_.non_finite_vertices() : near().non_finite_vertices();
  }
  /// The position of a vertex that is not finite: at the end of the step, or at its start if the end is
  /// finite.
  Vec3d non_finite_position(std::uint32_t vertex) const;
  /// An edge with an odd number of triangles, as the user's vertices; nothing when the surface is closed.
  /// The first call takes O(n log n), later ones nothing.
  std::optional<std::array<std::uint32_t, 2>> open_edge();
  /// The triangles around each vertex at rest, by the user's numbers, without inert ones. The first call
  /// takes O(n), and so does each call while there are inert triangles.
  const VertexTriangles& vertex_triangles();
  /// Whether a search for intersections tests triangles that share a vertex.
  bool tests_neighbours() const { return options.self_collision && options.neighbours != Neighbours::skip; }
  /// `Orientation::inward` of a solid at the positions of its shape; empty for other objects. Takes O(n) when
  /// these have changed.
  std::span<const std::uint8_t> inward_triangles();
  /// Memory of the octree and its shapes, without that of the positions.
  std::size_t bytes() const {
    const ShapesOfStep& step = shapes_of_step();
    return octree_.bytes() + resting_.bytes() + step.way.bytes() + step.end.bytes();
  }
  std::uint64_t rebuilds() const { return rebuilds_; }
  /// `query_cost` of the boxes of a shape that is up to date.
  double current_query_cost() const;
  bool is_resting_current() const { return resting_.is_current(placement_); }

  ObjectOptions options;

 private:
  static const PendingEdits no_edits;
  void make_pending_edits(const Parallel& parallel);
  /// Call when the octree has changed.
  void forget_octree();
  void list_points(std::span<const Triangle> extra, std::size_t vertex_count);
  struct ShapesOfStep {
    MovingShape way{MovingShape::Part::way}, end{MovingShape::Part::end};
  };
  const ShapesOfStep& shapes_of_step() const {
    static const ShapesOfStep none;
    return shapes_of_step_ ? *shapes_of_step_ : none;
  }
  void refit(const SearchedShapes& shapes, const Parallel& parallel);
  std::size_t update_resting(const SearchedShapes& shapes, const Parallel& parallel);
  bool is_lazy(const SearchedShapes& shapes) const { return shapes.lazy && !options.self_collision; }
  /// With `near`, if `extra` asks for it.
  SearchedShapes of_this(SearchedShapes shapes) const;
  /// Adds the shapes that are up to date.
  SearchedShapes with_current(SearchedShapes shapes) const;
  void update_volumes(const SearchedShapes& shapes);

  std::uint32_t face_count_;  // ids of triangles, also of removed ones
  std::unique_ptr<PendingEdits> pending_;
  std::vector<std::uint32_t> same_vertex_;   // empty unless vertices are welded
  std::unique_ptr<SolidBoundary> boundary_;  // of a solid that was edited
  bool is_edited_locally_;
  std::uint64_t mesh_version_ = 0;
  Descent descent_;
  ObjectOctree octree_;
  Placement placement_;
  RestingShape resting_{face_count_};
  struct Bounds {
    Aabb box;
    std::uint64_t version = 0;  // of the placement
  } bounds_;
  std::unique_ptr<ShapesOfStep> shapes_of_step_;  // null before the first search for them, as they are large
  FineBoxes fine_boxes_;
  RebuildPolicy rebuild_policy_;
  std::uint64_t rebuilds_ = 0;
  std::size_t refitted_triangles_ = 0;
  std::vector<std::uint32_t> groups_, masks_;  // by vertex
  std::vector<std::uint8_t> is_point_;         // by vertex, or empty
  bool has_moved_ = true;
  bool knows_open_edge_ = false;
  std::optional<std::array<std::uint32_t, 2>> open_edge_;
  std::unique_ptr<VertexTriangles> vertex_triangles_;
  bool leaves_out_inert_ = false;  // `vertex_triangles_` does
  std::unique_ptr<Orientation> orientation_;
  std::uint64_t oriented_version_ = 0;  // of the shape
  SearchedShapes updated_;              // by the last update
  Aabb box_;
  BoundingSphere sphere_;
};

}  // namespace supple
