#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "supple/call_limits.hpp"
#include "supple/mesh.hpp"
#include "supple/options.hpp"
#include "supple/queries.hpp"
#include "supple/result.hpp"
#include "supple/safe_step.hpp"
#include "supple/types.hpp"
#include "supple/views.hpp"

namespace supple {

class Scene;
/// A function that sees each step of a scene; see `Scene::set_observer`.
using DetectObserver = std::function<void(const Scene&, const DetectRequest&)>;

namespace detail {

ElementVertices vertices_of(const Scene& scene, ObjectId id, FeatureKind kind,
                            const std::array<std::uint32_t, 2>& element);
using PairWeights = std::array<std::array<double, 3>, 2>;
PairWeights weights_of(const Scene& scene, const Contact& contact);
PairWeights weights_of(const Scene&, const auto& pair) {
  return {pair.barycentric_a, pair.barycentric_b};
}

}  // namespace detail

/// Rigid placement: `rotation` (row-major; it may also scale, shear or mirror), then `translation`. A point p
/// becomes fl(R p) + t. Each row of R p is summed from left to right in double, without fused multiply-add.
struct RigidTransform {
  std::array<double, 9> rotation{1, 0, 0, 0, 1, 0, 0, 0, 1};
  Vec3d translation{};

  /// The rotation by the quaternion x i + y j + z k + w, then the translation. The quaternion need not have
  /// unit length: it is divided by its length, and each number of the matrix is within 2^-49 of the exact
  /// one. It has the same bits on every machine. Throws `Error` when the quaternion is zero or not finite.
  static RigidTransform from_quaternion(double x, double y, double z, double w, Vec3d translation = {});
};

/// What changes in the mesh of an object: see `Scene::edit`. All lists may be empty.
struct MeshEdit {
  std::span<const std::uint32_t> removed{};  ///< triangles; their ids stay unused
  /// Triangles; their ids are `triangle_count` and those after it. They may use new vertices.
  TrianglesView added{};
  /// Vertices; their ids are `vertex_count` and those after it. The positions are before the transform and
  /// the translation of the object, and have the precision of its positions. Finite.
  PositionsView new_vertices{};
  /// Where the new vertices of an object on a path start. `new_vertices` are where they end.
  PositionsView new_starts{};
  /// Edges and points of no triangle, as `ObjectOptions::edges` and `points`, by their vertices.
  std::span<const std::array<std::uint32_t, 2>> removed_edges{}, added_edges{};
  std::span<const std::uint32_t> removed_points{}, added_points{};
};

/// Deforming objects and all contacts between them.
///
/// ```cpp
/// supple::Scene scene;
/// auto rabbit = scene.add(rabbit_mesh);
/// auto fish = scene.add(fish_mesh, {.self_collision = true});
/// for (;;) {
///   scene.set_positions(rabbit, rabbit_xyz);
///   scene.set_positions(fish, fish_xyz);
///   for (const supple::Contact& c : scene.detect().contacts) respond(c);
/// }
/// ```
///
/// One call moves an object. `detect` then updates its octree, its bounds and the scene.
///
/// Memory: the scene keeps one copy of each object's positions, in the precision of the last call, and no
/// copy of shared positions. It keeps a second copy for objects moved by `set_transform` or `set_motion`.
/// Once continuous contacts, proximity or a safe step are requested, it also keeps the positions at the end
/// of the step, and for objects on a path those at its start.
///
/// Spans: those of a result are valid until the next call of the function that found it, `detect` or
/// `search`, and those of `collision_free_steps` until its next call. Nothing else ends them, except the
/// destructor and an assignment. `keep_result` makes them last.
///
/// Threads: calls on one scene must not overlap, except calls of const functions. Different scenes are
/// independent.
///
/// Errors: every function that takes an `ObjectId` throws `Error` when the object is not in the scene.
/// Functions that move an object throw `Error` when it is static, and when a number of a translation or
/// rotation is not finite. When memory runs out, functions throw `std::bad_alloc`. The scene stays usable: a
/// change that failed has no effect, events are not lost, and every call can be repeated. `SceneInspector`
/// shows the inside of a scene.
class Scene {
 public:
  /// Throws `Error` when an option is out of its range.
  explicit Scene(const SceneOptions& options = {});

  /// Adds an object and builds its octree from these positions (the rest pose) in O(n log n), on all threads
  /// of the scene. An object without triangles touches nothing. Throws `Error` for a vertex id that is
  /// negative or too large; the message names the triangle and the id.
  ObjectId add(const TriangleMesh& mesh, const ObjectOptions& options = {});
  ObjectId add(PositionsView positions, TrianglesView triangles, const ObjectOptions& options = {});
  /// Removes an object. Its pairs end at the next `detect`.
  void remove(ObjectId object);

  /// Changes the mesh of an object: removes and adds triangles, and adds vertices. Its id, options, events,
  /// manifolds, groups and user data stay; new vertices are in all groups. O(m log m) for m triangles and
  /// vertices of all edits since the last search, so search between many edits. The next search builds the
  /// parts of the octree around them again, O(k log n) and a copy of its arrays; with edges and points of no
  /// triangle, and with methods of comparison, it builds the whole octree.
  ///
  /// All answers are those of a scene to which the edited mesh was added, with the same ids. A pair of
  /// objects that touches before and after an edit stays. On a path, a new triangle moves as its vertices do,
  /// as if it had been there at the start. A solid is judged at once: while its surface is open, its option
  /// `solid` is false, so that nothing penetrates it, and `inside` throws as for each open surface. New
  /// vertices are not welded; triangles may name welded ones.
  ///
  /// Throws `Error`, and changes nothing, when there is no such triangle, vertex, edge or point, when one is
  /// removed twice, when a position is not finite or of the other precision, when the number of starts is not
  /// that of the new vertices on a path and 0 at rest, and when the object is static or shares its positions.
  void edit(ObjectId object, const MeshEdit& edit);
  /// Renumbers the triangles that are left after edits from 0, in their order, and frees memory. Returns the
  /// new number of each id, or 2^32 - 1 for a removed one; the last result keeps the old ones. O(n log n).
  std::vector<std::uint32_t> compact(ObjectId object);
  /// Sets the positions of all vertices, in the user's numbering. Copies them, O(n). Replaces earlier
  /// transforms, translations and paths. Throws `Error` when the number of positions differs from the mesh.
  /// The bounds are the lowest and the highest coordinates of the positions. With them and
  /// `ComparisonOptions::lazy_refit`, `detect` does not read the vertices of an object that meets no other
  /// one. All positions must be finite and within the bounds: nothing checks that, and otherwise `detect`
  /// misses contacts. Throws `Error` when a bound is not finite.
  void set_positions(ObjectId object, PositionsView positions,
                     const std::optional<std::array<Vec3d, 2>>& bounds = {});
  /// Sets the positions of some vertices, O(k) for k of them, where only a part of the object moves: all
  /// others stay. `detect` then refits only the nodes of the octree around these vertices, to the same
  /// volumes. The positions are those that were last set, before the object's transform and translation,
  /// which stay; a path ends. When more than an eighth of the vertices move, and for continuous contacts and
  /// proximity, `detect` refits the whole object.
  ///
  /// Shared positions are copied first, O(n). Throws `Error` when there is no such vertex, when the numbers
  /// of vertices and positions differ, and when one is `float` and the object's positions are `double`, or
  /// the other way round.
  void set_vertices(ObjectId object, std::span<const std::uint32_t> vertices, PositionsView positions);
  /// As `set_positions`, but the scene reads the user's memory instead of a copy, O(1). The memory must stay
  /// valid until the object gets other positions or is removed. To change the values, write them between two
  /// calls on the scene and then call this function again.
  ///
  /// The scene copies the positions when it cannot read them in place: when x, y and z of a point are not
  /// adjacent (a column-major n x 3 matrix), and when the point stride or the address is not a multiple of
  /// the scalar's size. Searches for continuous contacts, proximity and safe steps also copy them.
  void share_positions(ObjectId object, PositionsView positions);
  /// Moves the object by `offset` in O(1), without reading its vertices. Each coordinate becomes
  /// fl(position + D) in double. D is the translation of the last `set_transform` plus all offsets since it,
  /// or since the positions were last set.
  void translate(ObjectId object, Vec3d offset);
  /// Places the positions that were last set, or those of `add`. Replaces earlier transforms and
  /// translations. O(1) when only the translation changes, O(n) otherwise. A negative determinant mirrors the
  /// object: curves and manifolds see its triangles turned over, so that they keep their outer side. Throws
  /// `Error` for a solid when the matrix is singular. The signs of determinants are exact.
  void set_transform(ObjectId object, const RigidTransform& transform);
  /// Sets a path for continuous contacts: every vertex moves straight from its position in `from` (t = 0) to
  /// its position in `to` (t = 1). Copies both, O(n). The path stays until another call moves the object; all
  /// other calls place it at rest. Everything except continuous contacts uses the end of the path. Throws
  /// `Error` as `set_positions` does, and when one view is `float` and the other `double`.
  void set_motion(ObjectId object, PositionsView from, PositionsView to);
  /// Changes the options that have a value, O(1): `{.is_static = false}` lets a static object move. Values
  /// that the options already have change nothing. Throws `Error` when a value is out of range.
  void set_options(ObjectId object, const ObjectChanges& changes);
  /// Gives each vertex a group and a mask, as bits. Two vertices may touch when the group of each has a bit
  /// in common with the mask of the other; for objects without groups, all bits are set. `detect`, `verify`
  /// and safe steps leave out two triangles or elements when no vertex of one may touch a vertex of the
  /// other. Queries do not read the groups. O(n). Empty lists remove them. Throws `Error` when the lists have
  /// not one number for each vertex.
  void set_vertex_groups(ObjectId object, std::span<const std::uint32_t> groups,
                         std::span<const std::uint32_t> masks);
  /// Sets a function that excludes pairs of objects; an empty function removes it. See `PairFilter`. When it
  /// excludes all pairs whose volumes overlap, `detect` also asks for others, until it accepts one.
  void set_pair_filter(PairFilter filter);

  /// Sets a function that `detect` calls at its end, in the same thread, unless the call was stopped; an
  /// empty function removes it. It reads the scene and its `result`, and must not change the scene. What it
  /// throws leaves `detect`, and the result stays. Without an observer, this costs nothing.
  void set_observer(DetectObserver observer);

  /// Finds every contact of the requested kinds: intersections, penetration and pairs within the margins at
  /// the current positions, and continuous contacts within the step. The request defaults to the options of
  /// the scene. Time depends on the objects that moved and on the overlapping volumes. No memory is
  /// allocated after the largest step so far, except to sort more than 2^20 pairs of objects. An empty list
  /// of contacts means that nothing touches, unless `DetectResult::untested` says that there was nothing to
  /// test. Throws `Error` when the request is out of range.
  const DetectResult& detect(const DetectRequest& request = {});
  /// As `detect`, but apart from the steps of the scene: `result`, `verify` and the events do not change, and
  /// the result has no events and no manifolds. For a search within a step, for example of a solver that
  /// tries out paths. Tests only the pairs of objects that `only` accepts, all when it is empty; for an
  /// object with self-collision, it gets the same object twice. The result is valid until the next `search`.
  /// The first call takes memory for the answers; the objects and their octrees are those of the scene.
  /// Throws `Error` as `detect` does, and when manifolds are requested.
  const DetectResult& search(const DetectRequest& request, const PairFilter& only = {});
  /// The first continuous contact with `SceneOptions::impact`, or nothing when nothing touches within the
  /// step. Of contacts with the same time, it is the first in canonical order. The search skips pairs that
  /// can only touch later, so with many contacts it is faster than `detect`. Does not change `result` and
  /// `verify`. A call that `limits` end returns nothing: ask `StepLimits::stop`, or call `max_step`. Throws
  /// `Error` when a limit is out of its range.
  std::optional<ContinuousContact> earliest_impact(const StepLimits& limits = {});
  /// The largest safe part of the step, 0 to 1, and the pair that ends it: the time of the first impact, or 1
  /// without one. Never later than the true first contact. Elements that touch at the start end it there only
  /// where their surfaces meet in the step, as for `collision_free_step`. Elements within the separation at
  /// the start do not end it when they part, as with `ImpactOptions::skip_parting`. Bodies that already cut
  /// through each other at the start do not shorten it. Throws `Error` as `earliest_impact` does.
  SafeStep max_step(const StepLimits& limits = {});
  /// A part of the step, 0 to 1, after which nothing has crossed and every pair of elements keeps a share of
  /// its distance at the start, `StepOptions::keep`; and the pair that ends it.
  ///
  /// A pair at distance d at the start keeps at least `keep` d. With separation s, a pair at distance d > s
  /// keeps at least s + `keep` (d - s). So a pair within the separation does not make the step 0, and one
  /// that parts does not end it. The exact step ends when the first pair is at the distance that it keeps.
  /// The returned step never exceeds the exact one, and is shorter by at most 2^-18 of it.
  ///
  /// Elements that share a point at the start end the step there when the triangles around this point cut
  /// into each other just after the start, and when one leaves a face through the inner side on which it lies
  /// flat. Otherwise they end the step where they touch again, and not at all while they slide in one plane
  /// or move by the same vector. docs/guarantees.md has the exact conditions.
  ///
  /// Otherwise the step is positive. It is proven that also the positions from + t (to - from), computed in
  /// double, are reached without contact, for coordinates below 2^1022. Where rounding could make elements
  /// touch, the part is shortened by 2^-19 of it, then halved until it does not; the limiting pair is then
  /// the first that would touch.
  ///
  /// Ignores `ImpactOptions::max_time` and `skip_parting`. A step that is many times longer than the objects
  /// takes about the time of a short one, which is a few times that of `detect` for a short step. Throws
  /// `Error` when an option or a limit is out of its range.
  SafeStep collision_free_step(const StepOptions& options = {}, const StepLimits& limits = {});
  /// A safe part of the step for each object, ascending, so that one pair does not stop all objects. Objects
  /// of one island move by the same part. After each island has moved by its part, or by less, nothing has
  /// crossed and every pair keeps its share as for `collision_free_step`; the islands can move in any order,
  /// or at the same time at different speeds.
  ///
  /// Two objects that move are in one island unless every two of their elements are so far apart that what
  /// both move towards each other cannot use up their room. Objects that do not move have the step 1 and
  /// connect nothing. Takes longer than `collision_free_step`. A call that `limits` end returns one island of
  /// all objects that move. Throws `Error` as that function does.
  std::span<const ObjectStep> collision_free_steps(const StepOptions& options = {},
                                                   const StepLimits& limits = {});
  /// The result of the last `detect`.
  const DetectResult& result() const;
  /// Takes the memory of this result out of the scene: its spans stay valid as long as what is returned.
  /// `result` is then empty, as before the first step, and the next `detect` takes new memory; events go on.
  /// Call it before the next `detect` to keep a result without a copy of its own. O(size of the lists),
  /// because the scene keeps copies, from which `detect` takes the contacts of objects that do not move.
  std::shared_ptr<const void> keep_result();

  // Queries. The first one after a change refits the objects that have moved, as `detect` does. They run on
  // all threads of the scene; results do not depend on their number. They do not change `result` and
  // `verify`. Several threads may call them at the same time, as long as no other function changes the scene.
  // All throw `Error` when the numbers of queries and results differ, and when the filter names an object
  // that is not in the scene.
  //
  // Worst case: each query decides all triangles, and `distance` all pairs of elements, by exact arithmetic;
  // docs/guarantees.md has a table of its time. That needs input made for it, such as many triangles at
  // distances that are equal to a hundred bits. `CallLimits::stop` ends such a call.

  /// For each point the nearest triangle, or nothing when there is none within the largest distance and when
  /// the point is not finite. Takes about 1.4 µs for each of many points near a surface of 70,000 triangles,
  /// and 3.5 µs for those far away; longer for single points. Throws `Error` when the largest distance
  /// is negative or NaN, and for a signed distance when a surface is open.
  void closest(std::span<const Vec3d> points, std::span<std::optional<ClosestPoint>> results,
               const ClosestOptions& options = {}) const;
  /// For each ray the first triangle on it, or nothing when there is none, when a number of the ray is not
  /// finite, and when its direction is zero. Watertight: a ray through an edge hits a triangle of the edge.
  void cast(std::span<const Ray> rays, std::span<std::optional<RayHit>> results,
            const CastOptions& options = {}) const;
  /// All triangles on each ray, ordered by ray, then by t as exact arithmetic compares it, object and
  /// triangle.
  std::vector<ListedRayHit> cast_all(std::span<const Ray> rays, const QueryFilter& filter = {},
                                     const CallLimits& limits = {}) const;
  /// All triangles that overlap each box or sphere, ordered by query, object and triangle. A box or sphere
  /// with a number that is not finite, a box with min > max, and a sphere with a negative radius overlap
  /// nothing.
  std::vector<Overlap> overlaps(std::span<const QueryBox> boxes, const QueryFilter& filter = {},
                                const CallLimits& limits = {}) const;
  std::vector<Overlap> overlaps(std::span<const QuerySphere> spheres, const QueryFilter& filter = {},
                                const CallLimits& limits = {}) const;
  /// For each point whether it is inside an object of the filter: outside of all, else on a triangle of one,
  /// or inside at least one. Exact. A point inside a part of a surface that crosses itself is inside where a
  /// ray from it crosses the surface an odd number of times. Points that are not finite are outside, and so
  /// are all points of an object with a vertex that is not finite, except on its triangles. Takes about
  /// 0.3 µs for a point in the box of 70,000 triangles; many points in one call share a grid of at most four
  /// million cells, and a million of them take 60 ms.
  ///
  /// The surfaces must be closed: throws `Error` when an object of the filter has an edge with an odd number
  /// of triangles, and names it. The first call checks that in O(n log n).
  void inside(std::span<const Vec3d> points, std::span<Containment> results, const QueryFilter& filter = {},
              const CallLimits& limits = {}) const;

  /// The nearest features of two objects, as a pair of the listing of features, or nothing when one of them
  /// has no finite triangle, edge or point. Of several pairs at the same distance, the first one in the order
  /// of `DetectResult::proximity_pairs`. When the surfaces intersect, the distance is 0, and the pair is the
  /// first point of their first contact: then an edge can be paired with a face. `object_a` is the smaller
  /// object. An object inside another one has the distance of the surfaces. Triangles with a vertex that is
  /// not finite do not count. A distance that no double holds is infinite. Starts at the result of the last
  /// call for these objects, so that objects that move little take less time. Objects that are far from each
  /// other need few decisions, unless their coordinates are so coarse that many elements are equally near.
  /// Throws `Error` when both are the same.
  std::optional<ProximityPair> distance(ObjectId a, ObjectId b, const CallLimits& limits = {}) const;
  /// The same for all pairs of objects that `detect` would test and that are within `max_distance`, closed:
  /// one pair of features for each, ordered by objects. Throws `Error` when the distance is
  /// negative or NaN.
  std::vector<ProximityPair> distances(double max_distance, const CallLimits& limits = {}) const;
  /// Whether any triangle of one object intersects one of the other. Stops at the first. Throws `Error` when
  /// both are the same.
  bool any_contact(ObjectId a, ObjectId b, const CallLimits& limits = {}) const;

  std::vector<ObjectId> objects() const;  ///< ascending
  bool contains(ObjectId object) const;
  /// The options of an object, with its name in messages and results and all changes since it was added.
  const ObjectOptions& options(ObjectId object) const;
  std::size_t vertex_count(ObjectId object) const;    ///< of its mesh
  std::size_t triangle_count(ObjectId object) const;  ///< of its mesh, with those that edits removed
  /// The vertices of a triangle, those that count in place of welded ones; nothing for one that an edit
  /// removed. Throws `Error` when the object never had such a triangle.
  std::optional<Triangle> triangle(ObjectId object, std::uint32_t triangle) const;
  /// 0, and one more after each `edit` and `compact`.
  std::uint64_t mesh_version(ObjectId object) const;
  /// The position that the exact tests use: with transforms and translations. Throws `Error` when there is no
  /// such vertex.
  Vec3d position(ObjectId object, std::uint32_t vertex) const;
  /// The vertex ids of one side of a record with a triangle or an element on each side, O(1),
  /// in the order of the barycentric coordinates: an edge as in `element_a` or `element_b`, a triangle in the
  /// order of its corners. Throws `Error` when the triangle or its object was removed.
  template <class Pair>
  ElementVertices vertices_of(const Pair& pair, ContactSide side) const {
    const bool is_a = side == ContactSide::a;
    const ObjectId object = is_a ? pair.object_a : pair.object_b;
    if constexpr (requires { pair.triangle_a; }) {
      return detail::vertices_of(*this, object, FeatureKind::face,
                                 {is_a ? pair.triangle_a : pair.triangle_b});
    } else {
      FeatureKind kind;
      if constexpr (requires { pair.kind_a; })
        kind = is_a ? pair.kind_a : pair.kind_b;
      else
        kind = feature_kinds(pair.kind)[is_a ? 0 : 1];
      return detail::vertices_of(*this, object, kind, is_a ? pair.element_a : pair.element_b);
    }
  }
  /// Calls `function(object, vertex, weight)` for each vertex of a pair: first those of a, then those of b.
  /// The weights are the barycentric coordinates of the closest or touching points, positive for a and
  /// negative for b. So their sum is 0, but for rounding, and the sum of weight times position is the vector
  /// from the point of b to the point of a. Of a `Contact`, the points are the mean of its points in both
  /// triangles, or the centres of the triangles when `SceneOptions::contact_points` is off or a triangle is
  /// flat. O(1). Throws `Error` as `vertices_of` does; of a `Contact` also when it is not of `result`.
  template <class Pair, class Function>
  void for_each_vertex(const Pair& pair, Function&& function) const {
    const detail::PairWeights weights = detail::weights_of(*this, pair);
    for (const ContactSide side : {ContactSide::a, ContactSide::b}) {
      const bool is_a = side == ContactSide::a;
      const ElementVertices vertices = vertices_of(pair, side);
      for (std::size_t i = 0; i < vertices.size(); ++i)
        function(is_a ? pair.object_a : pair.object_b, vertices[i], is_a ? weights[0][i] : -weights[1][i]);
    }
  }
  const SceneOptions& options() const;

 private:
  friend class SceneAccess;
  class Implementation;
  struct Deleter {
    void operator()(Implementation* implementation) const;
  };
  std::unique_ptr<Implementation, Deleter> implementation_;
};

}  // namespace supple
