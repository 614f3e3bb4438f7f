#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "supple/contact.hpp"
#include "supple/manifold.hpp"
#include "supple/options.hpp"
#include "supple/penetration.hpp"
#include "supple/proximity.hpp"
#include "supple/types.hpp"

namespace supple {

/// The contacts of one pair of objects, or of one object with itself (`a == b`): a range of
/// `DetectResult::contacts`, `continuous_contacts` or `proximity_pairs`. Only pairs with contacts of that
/// kind are listed.
struct ContactGroup {
  ObjectId a, b;
  std::uint32_t first_contact = 0;
  std::uint32_t contact_count = 0;
};

/// The paper's output for one pair of objects: the vertices of both in the leaves that collide, as the user's
/// numbers, ascending. They are a range of `DetectResult::colliding_vertices`: first the vertices of a, then
/// the vertices of b.
struct CollidingVertices {
  ObjectId a, b;
  std::uint32_t first_vertex = 0;
  std::uint32_t count_a = 0;
  std::uint32_t count_b = 0;

  constexpr bool operator==(const CollidingVertices&) const = default;
};

/// A vertex with a coordinate that is not a finite number. The triangles that use it are inert: they are in
/// no box and in no contact until the vertex has a finite position. Vertices that nothing uses, such as those
/// that `ObjectOptions::weld` replaces by others, are not listed.
struct NonFiniteVertex {
  ObjectId object;
  std::uint32_t vertex = 0;
  Vec3d position;
};

/// Changes of a set of pairs since the last step, independent of the request of that step. Each pair that
/// begins ends exactly once: when the objects part, when one is removed, or when a filter excludes the pair.
/// Sorted. `end` may name removed objects.
struct PairEvents {
  std::span<const ObjectPair> begin, stay, end;
};

/// Why there was nothing to test for a kind of contacts.
enum class NothingToTest : std::uint8_t {
  no_objects,  ///< the scene has no object
  /// No object has a triangle. For continuous contacts and proximity: nor an edge or a point, or no edge when
  /// only pairs of edges are searched.
  no_elements,
  not_finite,  ///< each element has a vertex that is not finite
  no_solid,    ///< penetration: no object is solid
  no_motion,   ///< continuous contacts: no object has a path
  no_margin,   ///< proximity: all margins are 0, so that only elements at distance 0 are near
  one_object,  ///< one object has elements, and it is not tested against itself or has only one
  all_static,  ///< all objects with elements are static
  groups,      ///< groups and masks of objects exclude all pairs
  filter,      ///< the pair filter excludes all pairs
};

/// A kind of contacts for which there was nothing to test.
struct UntestedKind {
  ContactKinds kind = ContactKinds::none;  ///< one kind
  NothingToTest reason = NothingToTest::no_objects;

  constexpr bool operator==(const UntestedKind&) const = default;
};

/// Wall-clock seconds and work counts of one step. When two objects both have not moved, the step reuses
/// their contacts, and the counts do not include the work that found them. Traversal and exact tests run
/// interleaved on several threads: their wall-clock time is measured together and split by the threads' own
/// clocks. The counts of a truncated or stopped step depend on the threads.
struct StepStats {
  double refit_seconds = 0;            ///< refit of octrees to new positions
  double broad_phase_seconds = 0;      ///< search for object pairs
  double rebuild_seconds = 0;          ///< rebuild of degraded octrees
  double traversal_seconds = 0;        ///< search for candidates in object pairs
  double exact_seconds = 0;            ///< exact decision of candidates
  double penetration_seconds = 0;      ///< vertices inside solids, contained parts, and curves
  double manifold_seconds = 0;         ///< manifolds and their ids
  double sort_and_events_seconds = 0;  ///< sorting of contacts, and events
  double total_seconds = 0;

  /// The method of the broad phase that ran last: octree or grid when the scene has `automatic`.
  BroadPhaseMethod broad_phase_method = BroadPhaseMethod::automatic;
  std::uint64_t objects_refitted = 0;
  std::uint64_t triangles_refitted = 0;
  std::uint64_t octrees_rebuilt = 0;      ///< degraded octrees
  std::uint64_t triangles_rebuilt = 0;    ///< triangles in them
  std::uint64_t object_pairs_tested = 0;  ///< tests of two volumes in the broad phase
  std::uint64_t object_pairs = 0;
  std::uint64_t node_pairs_visited = 0;  ///< pairs of octree nodes in the narrow phase
  /// Tests of two volumes, of children and in leaves; empty children do not count. With
  /// `Descent::one_side_first` only those of children, because the paper's Figure 4 ends at the leaves.
  std::uint64_t boxes_tested = 0;
  /// Triangle pairs whose boxes overlap and that share no vertex.
  std::uint64_t candidate_pairs = 0;
  /// For continuous contacts and proximity: vertex-face and edge-edge pairs whose boxes come within reach.
  std::uint64_t vertex_face_candidates = 0, edge_edge_candidates = 0;
  std::uint64_t exact_fallbacks = 0;  ///< candidates that floating-point filters could not decide
  std::uint64_t contacts = 0;         ///< reported intersections and continuous contacts
  std::uint64_t proximity_pairs = 0;  ///< reported pairs within the margins
  std::uint64_t penetrations = 0;     ///< reported vertices inside solids
  std::uint64_t curves = 0;           ///< reported curves of intersection
};

/// What `Scene::detect` found. `Scene` says how long the spans are valid. Each list has one canonical order:
/// by object a and object b, and `contacts` then by triangle a and triangle b; the other lists say theirs.
/// Lists of kinds that were not requested are empty.
///
/// Pairs, kinds, features and element ids are exact: they are the answer of exact arithmetic on the given
/// coordinates. `object_pairs` and the candidates are conservative. Normals, points, barycentric coordinates
/// and times of impact are rounded; `Contact` and `ContinuousContact` say how.
struct DetectResult {
  std::uint64_t step = 0;                    ///< 0 for the first call; stopped calls do not count
  bool truncated = false;                    ///< a kind has more contacts than `DetectRequest::max_contacts`
  bool stopped = false;                      ///< `DetectRequest::stop` ended the call; all lists are empty
  std::span<const ObjectPair> object_pairs;  ///< pairs whose volumes overlap and whose filters agree
  std::span<const ContactGroup> groups;      ///< of `contacts`
  std::span<const Contact> contacts;
  std::span<const ContactPoint> contact_points;
  std::span<const ContactGroup> continuous_groups;  ///< of `continuous_contacts`
  /// Ordered by object a, object b, kind, element a, element b.
  std::span<const ContinuousContact> continuous_contacts;
  std::span<const ContactGroup> proximity_groups;  ///< of `proximity_pairs`
  /// Ordered by object a, object b, kind a, kind b, element a, element b.
  std::span<const ProximityPair> proximity_pairs;
  /// Of `penetrations` and `vertices_on_surface`; ordered by object a, object b.
  std::span<const PenetrationGroup> penetration_groups;
  std::span<const Penetration> penetrations;  ///< ordered by object a, object b, vertex
  std::span<const std::uint32_t> vertices_on_surface;
  std::span<const ContainedPart> contained_parts;  ///< ordered by inner object, outer object, vertex
  /// Ordered by object a, object b, smallest contact.
  std::span<const IntersectionCurve> curves;
  std::span<const std::uint32_t> curve_contacts;  ///< indices into `contacts`
  std::span<const Vec3d> curve_points;
  std::span<const std::uint32_t> enclosed_vertices;
  /// Ordered by object a, object b, then curves by their first contact, and pairs by their smallest distance.
  std::span<const Manifold> manifolds;
  std::span<const ManifoldPoint> manifold_points;
  std::span<const EndedManifold> ended_manifolds;  ///< those of the last step that are gone, in its order
  std::span<const CollidingVertices> colliding_vertex_groups;
  std::span<const std::uint32_t> colliding_vertices;
  std::span<const NonFiniteVertex> non_finite_vertices;
  PairEvents volume_events;  ///< of `object_pairs`
  /// Changes of the pairs of different objects whose leaves overlap. The paper's narrow phase counts these
  /// pairs. Only with `ComparisonOptions::colliding_vertices`, and only in a step that searches intersections
  /// or penetration.
  PairEvents narrow_phase_events;
  PairEvents contact_events;      ///< of the pairs of different objects that intersect or touch in the step
  PairEvents proximity_events;    ///< of the pairs of different objects that have proximity pairs
  PairEvents penetration_events;  ///< of the pairs of objects with a vertex or a part inside the other one
  StepStats stats;
  /// The requested kinds for which there was nothing to test: no contacts of these kinds then means nothing.
  /// At most one entry for each kind, in their order. A kind that found something is never listed.
  std::span<const UntestedKind> untested;

  std::span<const Contact> contacts_of(const ContactGroup& group) const {
    return contacts.subspan(group.first_contact, group.contact_count);
  }
  std::span<const ContinuousContact> continuous_contacts_of(const ContactGroup& group) const {
    return continuous_contacts.subspan(group.first_contact, group.contact_count);
  }
  std::span<const ProximityPair> proximity_pairs_of(const ContactGroup& group) const {
    return proximity_pairs.subspan(group.first_contact, group.contact_count);
  }
  std::span<const Penetration> penetrations_of(const PenetrationGroup& group) const {
    return penetrations.subspan(group.first_penetration, group.penetration_count);
  }
  std::span<const std::uint32_t> vertices_on_surface_of(const PenetrationGroup& group) const {
    return vertices_on_surface.subspan(group.first_on_surface, group.on_surface_count);
  }
  std::span<const std::uint32_t> contacts_of(const IntersectionCurve& curve) const {
    return curve_contacts.subspan(curve.first_contact, curve.contact_count);
  }
  std::span<const Vec3d> points_of(const IntersectionCurve& curve) const {
    return curve_points.subspan(curve.first_point, curve.point_count);
  }
  /// The vertices that a curve encloses on one side.
  std::span<const std::uint32_t> enclosed_vertices_of(const IntersectionCurve& curve,
                                                      ContactSide side) const {
    return side == ContactSide::a ? enclosed_vertices.subspan(curve.first_enclosed, curve.enclosed_count_a)
                                  : enclosed_vertices.subspan(curve.first_enclosed + curve.enclosed_count_a,
                                                              curve.enclosed_count_b);
  }
  std::span<const ManifoldPoint> points_of(const Manifold& manifold) const {
    return manifold_points.subspan(manifold.first_point, manifold.point_count);
  }
  /// Empty when `SceneOptions::contact_points` is off and no penetration was requested.
  std::span<const ContactPoint> points_of(const Contact& contact) const {
    return contact_points.empty() ? contact_points
                                  : contact_points.subspan(contact.first_point, contact.point_count);
  }
};

/// What a search for a kind of contacts reads of objects.
enum class SearchedShape : std::uint8_t {
  triangles,  ///< at the current positions
  paths,      ///< triangles, edges and points on their paths within the step
  margins,    ///< triangles, edges and points at the current positions, with their margins
};

/// A kind of contacts as data, for code that treats all kinds alike: see `contact_kinds`.
struct ContactKindInfo {
  ContactKinds kind = ContactKinds::none;
  const char* name = "";  ///< in words
  SearchedShape shape = SearchedShape::triangles;
  /// What each object lacks when no object has what the kind needs of one of two; `no_elements` when it needs
  /// nothing else.
  NothingToTest lack = NothingToTest::no_elements;
  PairEvents DetectResult::*events = nullptr;
  /// The groups and their name; null for penetration, which has groups of another type.
  std::span<const ContactGroup> DetectResult::*groups = nullptr;
  const char* groups_name = "";

  bool is_in(const DetectResult& result) const {
    return groups != nullptr ? !(result.*groups).empty() : !result.penetration_groups.empty();
  }
};

/// All kinds of contacts, in the order of their bits; `info_of` returns the entry of one.
inline constexpr std::array<ContactKindInfo, 4> contact_kinds{
    {{ContactKinds::intersection, "intersections", SearchedShape::triangles, NothingToTest::no_elements,
      &DetectResult::contact_events, &DetectResult::groups, "groups"},
     {ContactKinds::continuous, "continuous contacts", SearchedShape::paths, NothingToTest::no_motion,
      &DetectResult::contact_events, &DetectResult::continuous_groups, "continuous_groups"},
     {ContactKinds::proximity, "proximity", SearchedShape::margins, NothingToTest::no_margin,
      &DetectResult::proximity_events, &DetectResult::proximity_groups, "proximity_groups"},
     {ContactKinds::penetration, "penetration", SearchedShape::triangles, NothingToTest::no_solid,
      &DetectResult::penetration_events}}};

/// The entry of one kind in `contact_kinds`.
constexpr const ContactKindInfo& info_of(ContactKinds kind) {
  return contact_kinds[static_cast<std::size_t>(std::countr_zero(static_cast<unsigned>(kind)))];
}

/// One region of the scene octree, for inspection and drawing.
struct SceneRegion {
  /// h of the paper's R(h, k): the root is 0, and the children of h are 8h + 1 … 8h + 8. With arity m they
  /// are mh + 1 … mh + m.
  std::uint64_t number = 0;
  std::uint32_t level = 0;  ///< k
  Aabb box;
  bool is_leaf = true;
  std::uint32_t object_count = 0;  ///< objects that touch a leaf; 0 for inner regions
};

}  // namespace supple
