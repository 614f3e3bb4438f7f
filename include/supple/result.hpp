#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "supple/contact.hpp"
#include "supple/options.hpp"
#include "supple/types.hpp"

namespace supple {

/// The contacts of one pair of objects, or of one object with itself (`a == b`): a range of
/// `DetectResult::contacts`, or of `continuous_contacts` in that mode. A pair is listed only when it has
/// contacts.
struct ContactGroup {
  ObjectId a, b;
  std::uint32_t first_contact = 0;
  std::uint32_t contact_count = 0;
};

/// The paper's output for one pair of objects: the vertices of both in the leaves that collide, user's
/// numbers, ascending. Ranges of `DetectResult::colliding_vertices`: those of a come first, those of b
/// follow.
struct CollidingVertices {
  ObjectId a, b;
  std::uint32_t first_vertex = 0;
  std::uint32_t count_a = 0;
  std::uint32_t count_b = 0;
};

/// A vertex with a coordinate that is not a finite number; the triangles that use it are inert: in no box and
/// in no contact, until finite positions come.
struct NonFiniteVertex {
  ObjectId object;
  std::uint32_t vertex = 0;
  Vec3d position;
};

/// Changes of a set of pairs since the step before. Each pair that begins ends exactly once, be it by
/// parting, by removal of an object or by a filter. Sorted; `end` may name objects that are no longer there.
struct PairEvents {
  std::span<const ObjectPair> begin, stay, end;
};

/// Seconds by the wall clock and counts of what was done in one step: contacts of two objects that both are
/// where they were are known from the step before, and what led to them is not counted again. Traversal and
/// exact tests run interleaved on several threads: their times are the time of both together, split as the
/// threads' own clocks say.
struct StepStats {
  double refit_seconds = 0;            ///< new positions into octrees
  double broad_phase_seconds = 0;      ///< object volumes into object pairs
  double rebuild_seconds = 0;          ///< degraded parts of octrees anew
  double traversal_seconds = 0;        ///< object pairs into candidate triangle pairs
  double exact_seconds = 0;            ///< candidates into contacts
  double sort_and_events_seconds = 0;  ///< canonical order and events
  double total_seconds = 0;

  /// The method of the broad phase that ran last: octree or grid when the scene has `automatic`.
  BroadPhaseMethod broad_phase_method = BroadPhaseMethod::automatic;
  std::uint64_t objects_refitted = 0;
  std::uint64_t triangles_refitted = 0;
  std::uint64_t subtrees_rebuilt = 0;  ///< parts of octrees that had degraded, and their triangles
  std::uint64_t triangles_rebuilt = 0;
  std::uint64_t object_pairs_tested = 0;  ///< volume against volume in the broad phase
  std::uint64_t object_pairs = 0;
  std::uint64_t node_pairs_visited = 0;  ///< eight-wide node against eight-wide node
  /// Volume against volume inside them and at the leaves; lanes of a node that have no child do not count.
  std::uint64_t boxes_tested = 0;
  /// Triangle pairs whose boxes overlap and that share no vertex; of continuous contacts 0.
  std::uint64_t candidate_pairs = 0;
  /// Likewise vertex-face and edge-edge pairs whose moving boxes meet, of continuous contacts.
  std::uint64_t vertex_face_candidates = 0, edge_edge_candidates = 0;
  std::uint64_t exact_fallbacks = 0;  ///< candidates that floating-point filters could not decide
  std::uint64_t contacts = 0;
};

/// What `Scene::detect` found. The spans look into buffers of the scene and last until its next call that is
/// not const. Everything is in one canonical order: by object a, object b, triangle a, triangle b.
struct DetectResult {
  std::uint64_t step = 0;                    ///< 0 for the first call
  std::span<const ObjectPair> object_pairs;  ///< the broad phase's: volumes overlap and filters agree
  std::span<const ContactGroup> groups;
  std::span<const Contact> contacts;
  std::span<const ContactPoint> contact_points;
  /// Of `ContactMode::continuous`, which leaves the two above empty. By object a, object b, kind, element a,
  /// element b.
  std::span<const ContinuousContact> continuous_contacts;
  std::span<const CollidingVertices> colliding_vertex_groups;
  std::span<const std::uint32_t> colliding_vertices;
  std::span<const NonFiniteVertex> non_finite_vertices;
  PairEvents volume_events;   ///< of `object_pairs`
  PairEvents contact_events;  ///< of the pairs of different objects that have contacts
  StepStats stats;

  std::span<const Contact> contacts_of(const ContactGroup& group) const {
    return contacts.subspan(group.first_contact, group.contact_count);
  }
  std::span<const ContinuousContact> continuous_contacts_of(const ContactGroup& group) const {
    return continuous_contacts.subspan(group.first_contact, group.contact_count);
  }
  /// Empty when `SceneOptions::contact_points` is off.
  std::span<const ContactPoint> points_of(const Contact& contact) const {
    return contact_points.empty() ? contact_points
                                  : contact_points.subspan(contact.first_point, contact.point_count);
  }
};

/// A pair on which `Scene::verify` and the last `Scene::detect` differ.
struct Difference {
  ObjectId object_a, object_b;
  std::uint32_t triangle_a = 0, triangle_b = 0;
  bool missed = false;  ///< true: it intersects and was not reported; false: reported, and does not intersect

  constexpr bool operator==(const Difference&) const = default;
};

/// The same of continuous contacts.
struct ContinuousDifference {
  enum class Fault : std::uint8_t {
    missed,  ///< it touches and was not reported
    added,   ///< reported as certain, and does not touch
    late,    ///< reported with a time after the first contact
    early,   ///< reported with a time before the first contact by more than `toi_tolerance`
  };
  ObjectId object_a, object_b;
  ElementPairKind kind = ElementPairKind::vertex_face;
  std::array<std::uint32_t, 2> element_a{}, element_b{};
  Fault fault = Fault::missed;

  constexpr bool operator==(const ContinuousDifference&) const = default;
};

/// Outcome of the exact brute force over every triangle pair of the scene, or every vertex-face and edge-edge
/// pair when contacts are continuous.
struct VerifyReport {
  std::uint64_t triangle_pairs_checked = 0;
  std::uint64_t intersecting_pairs = 0;
  std::uint64_t element_pairs_checked = 0;
  std::uint64_t touching_element_pairs = 0;
  std::vector<Difference> differences;                       ///< sorted
  std::vector<ContinuousDifference> continuous_differences;  ///< sorted
  bool agrees() const { return differences.empty() && continuous_differences.empty(); }
};

/// Of an object's octree.
struct OctreeStatistics {
  std::uint64_t triangles = 0;
  std::uint64_t vertices = 0;
  std::uint64_t nodes = 0;  ///< eight-wide
  std::uint64_t leaves = 0;
  std::uint32_t depth = 0;         ///< of the deepest leaf, the root being 0
  std::uint32_t largest_leaf = 0;  ///< triangles
  double mean_leaf_size = 0;       ///< triangles
  double mean_node_width = 0;      ///< occupied lanes of eight
  std::uint64_t bytes = 0;         ///< all memory of the octree: nodes, ids and maps, without the positions
  double bytes_per_triangle = 0;
  std::vector<std::uint64_t> leaves_by_level;
  /// What a query whose box meets the object's visits on average, by the surface-area heuristic: a visit a
  /// lane, and an eighth for each triangle of a leaf. Of the boxes as last refitted; 0 when they have no
  /// surface.
  double cost = 0;
  /// The cost over what it was when built: 1 as built, 2 when queries cost twice as much.
  double degradation = 1;
  std::uint64_t subtrees_rebuilt = 0;  ///< since the object was added, and their triangles
  std::uint64_t triangles_rebuilt = 0;
};

/// One region of the scene octree, for inspection and drawing.
struct SceneRegion {
  /// h of the paper's R(h, k): the root is 0, children of h are 8h + 1 … 8h + 8; of arity k, kh + 1 … kh + k.
  std::uint64_t number = 0;
  std::uint32_t level = 0;  ///< k
  Aabb box;
  bool is_leaf = true;
  std::uint32_t object_count = 0;  ///< objects that touch a leaf; 0 for inner regions
};

}  // namespace supple
