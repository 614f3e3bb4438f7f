#pragma once

#include <cstdint>

#include "supple/record_descriptions.hpp"

// The lists of a result, with what each row is.

namespace supple {

/// The kind of the element of side 'a' or 'b', which says what its numbers and weights mean. Records without
/// kinds have faces.
template <Described Row>
constexpr FeatureKind kind_of_element(const Row& row, char side) {
  if constexpr (requires { row.kind_a; })
    return side == 'a' ? row.kind_a : row.kind_b;
  else if constexpr (requires { feature_kinds(row.kind); })
    return feature_kinds(row.kind)[side == 'a' ? 0 : 1];
  else
    return FeatureKind::face;
}

/// One list of a result.
template <class Row>
struct ResultList {
  const char* name;  ///< of the member of `DetectResult`; events as `events/volume_begin`
  const char* item;  ///< one row in words
  const char* doc;   ///< what a row is
  /// For rows without members: the name of the value, and what it is.
  const char* value = "";
  Role role{};
  const char* unit = "";
  /// The kind of contacts whose answer is this list, one row for each; none for other lists.
  ContactKinds answers = ContactKinds::none;
};

/// Calls `visitor(list, member)` for each list with records of its own; `member(result)` is the list of a
/// `DetectResult` or of a structure with members of the same names. Lists of groups follow from the records.
template <class Visitor>
constexpr void for_each_list(Visitor&& visitor) {
  const auto list = [&]<class Row>(const ResultList<Row>& of, auto member) { visitor(of, member); };
  list(
      ResultList<ObjectPair>{"object_pairs", "object pair",
                             "pairs of the broad phase: their bounding volumes overlap"},
      [](auto& result) -> auto& { return result.object_pairs; });
  list(
      ResultList<Contact>{.name = "contacts",
                          .item = "contact",
                          .doc = "two triangles that intersect, decided exactly",
                          .answers = ContactKinds::intersection},
      [](auto& result) -> auto& { return result.contacts; });
  list(
      ResultList<ContactPoint>{"contact_points", "contact point", "an extreme point of an intersection"},
      [](auto& result) -> auto& { return result.contact_points; });
  list(
      ResultList<ContinuousContact>{
          .name = "continuous_contacts",
          .item = "continuous contact",
          .doc = "two elements that touch on their paths from the last frame to this one",
          .answers = ContactKinds::continuous},
      [](auto& result) -> auto& { return result.continuous_contacts; });
  list(
      ResultList<ProximityPair>{.name = "proximity_pairs",
                                .item = "proximity pair",
                                .doc = "two features, or elements, within the margins of their objects",
                                .answers = ContactKinds::proximity},
      [](auto& result) -> auto& { return result.proximity_pairs; });
  list(
      ResultList<Penetration>{.name = "penetrations",
                              .item = "penetration",
                              .doc = "a vertex of object a inside object b",
                              .answers = ContactKinds::penetration},
      [](auto& result) -> auto& { return result.penetrations; });
  list(
      ResultList<std::uint32_t>{"vertices_on_surface", "vertex on surface",
                                "a vertex of object a on the surface of object b, of a penetration group",
                                "vertex", role::id(Names::vertex, 0)},
      [](auto& result) -> auto& { return result.vertices_on_surface; });
  list(
      ResultList<PenetrationGroup>{"penetration_groups", "penetration group",
                                   "an object with vertices inside another one or on its surface"},
      [](auto& result) -> auto& { return result.penetration_groups; });
  list(
      ResultList<ContainedPart>{"contained_parts", "contained part",
                                "a connected part of an object inside another one without touching it"},
      [](auto& result) -> auto& { return result.contained_parts; });
  list(
      ResultList<std::uint32_t>{"curve_contacts", "contact", "the contacts of a curve in order", "contact",
                                role::first_row("contacts")},
      [](auto& result) -> auto& { return result.curve_contacts; });
  list(
      ResultList<Vec3d>{"curve_points", "point", "the points of a curve in order", "position", role::rounded,
                        "length"},
      [](auto& result) -> auto& { return result.curve_points; });
  list(
      ResultList<std::uint32_t>{"enclosed_vertices", "enclosed vertex", "a vertex that a curve cuts off",
                                "vertex", role::id(Names::vertex, 0)},
      [](auto& result) -> auto& { return result.enclosed_vertices; });
  list(
      ResultList<IntersectionCurve>{"curves", "curve", "a curve in which two objects intersect"},
      [](auto& result) -> auto& { return result.curves; });
  list(
      ResultList<std::uint32_t>{"colliding_vertices", "vertex", "a vertex in a leaf that collides", "vertex",
                                role::id(Names::vertex, 0)},
      [](auto& result) -> auto& { return result.colliding_vertices; });
  list(
      ResultList<CollidingVertices>{"colliding_vertex_groups", "colliding vertices",
                                    "two objects with leaves that collide; with `colliding_vertices`"},
      [](auto& result) -> auto& { return result.colliding_vertex_groups; });
  list(
      ResultList<ManifoldPoint>{"manifold_points", "manifold point", "a point that spans a manifold"},
      [](auto& result) -> auto& { return result.manifold_points; });
  list(
      ResultList<Manifold>{"manifolds", "manifold", "a patch of contacts of two objects; with `manifolds`"},
      [](auto& result) -> auto& { return result.manifolds; });
  const auto events = [&](const char* begin, const char* end, const char* doc_begin, const char* doc_end,
                          auto member) {
    list(
        ResultList<ObjectPair>{begin, begin, doc_begin}, [member](auto& result) -> auto& {
          return member(result).begin;
        });
    list(
        ResultList<ObjectPair>{end, end, doc_end}, [member](auto& result) -> auto& {
          return member(result).end;
        });
  };
  events(
      "events/volume_begin", "events/volume_end", "object pairs that the last frame did not have",
      "object pairs that only the last frame had",
      [](auto& result) -> auto& { return result.volume_events; });
  events(
      "events/narrow_phase_begin", "events/narrow_phase_end",
      "different objects whose leaves begin to collide; with `colliding_vertices`",
      "different objects without such leaves from now on",
      [](auto& result) -> auto& { return result.narrow_phase_events; });
  events(
      "events/contact_begin", "events/contact_end", "different objects that begin to have contacts",
      "different objects that no longer have any",
      [](auto& result) -> auto& { return result.contact_events; });
  events(
      "events/proximity_begin", "events/proximity_end", "different objects that come within their margins",
      "different objects that leave their margins",
      [](auto& result) -> auto& { return result.proximity_events; });
  events(
      "events/penetration_begin", "events/penetration_end",
      "objects one of which begins to have a vertex or a part inside the other",
      "objects that no longer penetrate", [](auto& result) -> auto& { return result.penetration_events; });
}

}  // namespace supple
