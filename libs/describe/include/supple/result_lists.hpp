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
  /// The kind of contacts whose answer is this list, one row for each; none for other lists.
  ContactKinds answers = ContactKinds::none;
  /// For rows without members: the name of the value, and what it is.
  const char* value = "";
  Role role{};
  const char* unit = "";
};

/// Calls `visitor(begin, end, stay, member)` for the events of each set of pairs: with the lists of the pairs
/// that begin and end, the name of the list of those that stay, and `member(result)`, the `PairEvents`.
template <class Visitor>
constexpr void for_each_events(Visitor&& visitor) {
#define SUPPLE_EVENTS(kind, doc_begin, doc_end)                                              \
  visitor(                                                                                   \
      ResultList<ObjectPair>{"events/" #kind "_begin", "events/" #kind "_begin", doc_begin}, \
      ResultList<ObjectPair>{"events/" #kind "_end", "events/" #kind "_end", doc_end},       \
      "events/" #kind "_stay", [](auto& result) -> auto& { return result.kind##_events; })
  SUPPLE_EVENTS(volume, "object pairs that the last frame did not have",
                "object pairs that only the last frame had");
  SUPPLE_EVENTS(narrow_phase, "different objects whose leaves begin to collide; with `colliding_vertices`",
                "different objects without such leaves from now on");
  SUPPLE_EVENTS(contact, "different objects that begin to have contacts",
                "different objects that no longer have any");
  SUPPLE_EVENTS(proximity, "different objects that come within their margins",
                "different objects that leave their margins");
  SUPPLE_EVENTS(penetration, "objects one of which begins to have a vertex or a part inside the other",
                "objects that no longer penetrate");
#undef SUPPLE_EVENTS
}

/// Calls `visitor(list, member)` for each list with records of its own; `member(result)` is the list of a
/// `DetectResult` or of a structure with members of the same names. Lists of groups follow from the records.
template <class Visitor>
constexpr void for_each_list(Visitor&& visitor) {
// The member and the name of a list are the same word.
#define SUPPLE_LIST(Row, list, ...) \
  visitor(                          \
      ResultList<Row>{#list, __VA_ARGS__}, [](auto& result) -> auto& { return result.list; })
  SUPPLE_LIST(ObjectPair, object_pairs, "object pair",
              "pairs of the broad phase: their bounding volumes overlap");
  SUPPLE_LIST(Contact, contacts, "contact", "two triangles that intersect, decided exactly",
              ContactKinds::intersection);
  SUPPLE_LIST(ContactPoint, contact_points, "contact point", "an extreme point of an intersection");
  SUPPLE_LIST(ContinuousContact, continuous_contacts, "continuous contact",
              "two elements that touch on their paths from the last frame to this one",
              ContactKinds::continuous);
  SUPPLE_LIST(ProximityPair, proximity_pairs, "proximity pair",
              "two features, or elements, within the margins of their objects", ContactKinds::proximity);
  SUPPLE_LIST(Penetration, penetrations, "penetration", "a vertex of object a inside object b",
              ContactKinds::penetration);
  SUPPLE_LIST(std::uint32_t, vertices_on_surface, "vertex on surface",
              "a vertex of object a on the surface of object b, of a penetration group", ContactKinds::none,
              "vertex", role::id(Names::vertex, 0));
  SUPPLE_LIST(PenetrationGroup, penetration_groups, "penetration group",
              "an object with vertices inside another one or on its surface");
  SUPPLE_LIST(ContainedPart, contained_parts, "contained part",
              "a connected part of an object inside another one without touching it");
  SUPPLE_LIST(std::uint32_t, curve_contacts, "contact", "the contacts of a curve in order",
              ContactKinds::none, "contact", role::first_row("contacts"));
  SUPPLE_LIST(Vec3d, curve_points, "point", "the points of a curve in order", ContactKinds::none, "position",
              role::rounded, "length");
  SUPPLE_LIST(std::uint32_t, enclosed_vertices, "enclosed vertex", "a vertex that a curve cuts off",
              ContactKinds::none, "vertex", role::id(Names::vertex, 0));
  SUPPLE_LIST(IntersectionCurve, curves, "curve", "a curve in which two objects intersect");
  SUPPLE_LIST(std::uint32_t, colliding_vertices, "vertex", "a vertex in a leaf that collides",
              ContactKinds::none, "vertex", role::id(Names::vertex, 0));
  SUPPLE_LIST(CollidingVertices, colliding_vertex_groups, "colliding vertices",
              "two objects with leaves that collide; with `colliding_vertices`");
  SUPPLE_LIST(ManifoldPoint, manifold_points, "manifold point", "a point that spans a manifold");
  SUPPLE_LIST(Manifold, manifolds, "manifold", "a patch of contacts of two objects; with `manifolds`");
#undef SUPPLE_LIST
  for_each_events([&](const auto& begin, const auto& end, const char*, auto member) {
    visitor(
        begin, [member](auto& result) -> auto& { return member(result).begin; });
    visitor(
        end, [member](auto& result) -> auto& { return member(result).end; });
  });
}

}  // namespace supple
