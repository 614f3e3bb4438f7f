#pragma once

#include <cstdint>

#include "supple/contact.hpp"
#include "supple/description.hpp"
#include "supple/manifold.hpp"
#include "supple/penetration.hpp"
#include "supple/proximity.hpp"
#include "supple/result.hpp"
#include "supple/result_descriptions.hpp"

// Descriptions of the records of a result; `result_lists.hpp` has the lists that contain them. Recordings,
// `diff`, JSON, the documents and bindings are made from these descriptions: a new member of a record needs a
// line in its struct and one here.

namespace supple {

template <>
struct Description<ObjectPair> {
  static constexpr const char* name = "ObjectPair";
  template <class Visitor>
  static constexpr void visit(Visitor&& visitor) {
    visit_field(visitor, "a", &ObjectPair::a, "Object a", role::object('a'));
    visit_field(visitor, "b", &ObjectPair::b, "Object b", role::object('b'));
  }
};

template <>
struct Description<ContactGroup> {
  static constexpr const char* name = "ContactGroup";
  template <class Visitor>
  static constexpr void visit(Visitor&& visitor) {
    using Row = ContactGroup;
    visit_field(visitor, "a", &Row::a, "Object a; the same as b for contacts of an object with itself",
                role::object('a'));
    visit_field(visitor, "b", &Row::b, "Object b", role::object('b'));
    visit_field(visitor, "first_contact", &Row::first_contact, "First contact of the objects in its list");
    visit_field(visitor, "contact_count", &Row::contact_count, "Number of contacts");
  }
};

template <>
struct Description<Contact> {
  static constexpr const char* name = "Contact";
  template <class Visitor>
  static constexpr void visit(Visitor&& visitor) {
    using Row = Contact;
    visit_field(visitor, "object_a", &Row::object_a, "Object a; the same as b for a contact with itself",
                role::object('a'));
    visit_field(visitor, "object_b", &Row::object_b, "Object b", role::object('b'));
    visit_field(visitor, "triangle_a", &Row::triangle_a, "Triangle of object a",
                role::key(Names::triangle, 'a'));
    visit_field(visitor, "triangle_b", &Row::triangle_b, "Triangle of object b",
                role::key(Names::triangle, 'b'));
    visit_field(visitor, "kind", &Row::kind, "What the triangles share");
    visit_field(visitor, "point_count", &Row::point_count,
                "Points of the intersection: 1, 2, or 3 to 6 in order around a polygon",
                role::rows("contact_points"));
    visit_field(visitor, "first_point", &Row::first_point, "The first of these points",
                role::first_row("contact_points"));
    visit_field(visitor, "normal", &Row::normal, "Unit vector from b to a; zero without contact points",
                role::rounded);
  }
};

template <>
struct Description<ContactPoint> {
  static constexpr const char* name = "ContactPoint";
  template <class Visitor>
  static constexpr void visit(Visitor&& visitor) {
    using Row = ContactPoint;
    visit_field(visitor, "position", &Row::position, "The point", role::rounded, "length");
    visit_field(visitor, "feature_a", &Row::on_a, "Smallest part of triangle a on which the point lies");
    visit_field(visitor, "feature_b", &Row::on_b, "Smallest part of triangle b on which the point lies");
  }
};

template <>
struct Description<ContinuousContact> {
  static constexpr const char* name = "ContinuousContact";
  template <class Visitor>
  static constexpr void visit(Visitor&& visitor) {
    using Row = ContinuousContact;
    visit_field(visitor, "object_a", &Row::object_a, "Object a; the same as b for a contact with itself",
                role::object('a'));
    visit_field(visitor, "object_b", &Row::object_b, "Object b", role::object('b'));
    visit_field(visitor, "kind", &Row::kind, "Kinds of the elements: v vertex, e edge, f face; a before b",
                role::key(Names::nothing, 0));
    visit_field(visitor, "element_a", &Row::element_a, "Element of object a", role::key(Names::element, 'a'));
    visit_field(visitor, "element_b", &Row::element_b, "Element of object b", role::key(Names::element, 'b'));
    visit_field(visitor, "certainty", &Row::certainty, "Whether the contact is proven");
    visit_field(visitor, "touching_at_start", &Row::touching_at_start,
                "Whether the elements touch already at the start of the step; the time is then 0");
    visit_field(visitor, "toi", &Row::toi, "Time of impact: 0 at the start of the step, 1 at its end",
                role::rounded, "steps");
    visit_field(visitor, "start_distance", &Row::start_distance, "Distance at the start of the step",
                role::rounded, "length");
    visit_field(visitor, "barycentric_a", &Row::barycentric_a,
                "Barycentric coordinates of the point on element a", role::weights('a'));
    visit_field(visitor, "barycentric_b", &Row::barycentric_b,
                "Barycentric coordinates of the point on element b", role::weights('b'));
    visit_field(visitor, "point", &Row::point, "Midpoint of the two points at the time of impact",
                role::rounded, "length");
    visit_field(visitor, "normal", &Row::normal, "Unit vector from b to the side of element a",
                role::rounded);
  }
};

template <>
struct Description<ProximityPair> {
  static constexpr const char* name = "ProximityPair";
  template <class Visitor>
  static constexpr void visit(Visitor&& visitor) {
    using Row = ProximityPair;
    visit_field(visitor, "object_a", &Row::object_a, "Object a; the same as b for a pair of one object",
                role::object('a'));
    visit_field(visitor, "object_b", &Row::object_b, "Object b", role::object('b'));
    visit_field(visitor, "kind_a", &Row::kind_a, "Kind of element a", role::key(Names::nothing, 'a'));
    visit_field(visitor, "kind_b", &Row::kind_b, "Kind of element b", role::key(Names::nothing, 'b'));
    visit_field(visitor, "element_a", &Row::element_a, "Element of object a", role::key(Names::element, 'a'));
    visit_field(visitor, "element_b", &Row::element_b, "Element of object b", role::key(Names::element, 'b'));
    visit_field(visitor, "feature_a", &Row::on_a, "Smallest part of element a that holds the closest point");
    visit_field(visitor, "feature_b", &Row::on_b, "Smallest part of element b that holds the closest point");
    visit_field(visitor, "distance", &Row::distance, "Distance of the elements", role::rounded, "length");
    visit_field(visitor, "barycentric_a", &Row::barycentric_a,
                "Barycentric coordinates of the closest point on element a", role::weights('a'));
    visit_field(visitor, "barycentric_b", &Row::barycentric_b,
                "Barycentric coordinates of the closest point on element b", role::weights('b'));
    visit_field(visitor, "point_a", &Row::point_a, "Closest point of a", role::rounded, "length");
    visit_field(visitor, "point_b", &Row::point_b, "Closest point of b", role::rounded, "length");
    visit_field(visitor, "normal", &Row::normal, "Unit vector from b to a", role::rounded);
  }
};

template <>
struct Description<PenetrationGroup> {
  static constexpr const char* name = "PenetrationGroup";
  template <class Visitor>
  static constexpr void visit(Visitor&& visitor) {
    using Row = PenetrationGroup;
    visit_field(visitor, "a", &Row::a, "Object whose vertices are inside b or on its surface",
                role::object('a'));
    visit_field(visitor, "b", &Row::b, "Solid object", role::object('b'));
    visit_field(visitor, "first_penetration", &Row::first_penetration, "First vertex inside",
                role::first_row("penetrations"));
    visit_field(visitor, "penetration_count", &Row::penetration_count, "Number of vertices inside",
                role::rows("penetrations"));
    visit_field(visitor, "first_on_surface", &Row::first_on_surface, "First vertex on the surface",
                role::first_row("vertices_on_surface"));
    visit_field(visitor, "on_surface_count", &Row::on_surface_count, "Number of vertices on the surface",
                role::rows("vertices_on_surface", 'a'));
  }
};

template <>
struct Description<Penetration> {
  static constexpr const char* name = "Penetration";
  template <class Visitor>
  static constexpr void visit(Visitor&& visitor) {
    using Row = Penetration;
    visit_field(visitor, "object_a", &Row::object_a, "Object of the vertex", role::object('a'));
    visit_field(visitor, "object_b", &Row::object_b, "Solid object in which the vertex is",
                role::object('b'));
    visit_field(visitor, "vertex", &Row::vertex, "Vertex of object a", role::key(Names::vertex, 'a'));
    visit_field(visitor, "triangle", &Row::triangle, "Nearest triangle of object b",
                role::id(Names::triangle, 'b'));
    visit_field(visitor, "feature", &Row::feature, "Smallest part of it that holds the closest point");
    visit_field(visitor, "depth", &Row::depth, "Distance to the surface of object b", role::rounded,
                "length");
    visit_field(visitor, "barycentric", &Row::barycentric, "Barycentric coordinates of the closest point",
                role::weights('b'));
    visit_field(visitor, "point", &Row::point, "Closest point", role::rounded, "length");
    visit_field(visitor, "normal", &Row::normal, "Unit vector from the vertex to this point", role::rounded);
  }
};

template <>
struct Description<ContainedPart> {
  static constexpr const char* name = "ContainedPart";
  template <class Visitor>
  static constexpr void visit(Visitor&& visitor) {
    using Row = ContainedPart;
    visit_field(visitor, "inner", &Row::inner, "Object of the part", role::object('a'));
    visit_field(visitor, "outer", &Row::outer, "Solid object that contains the part", role::object('b'));
    visit_field(visitor, "vertex", &Row::vertex, "Smallest vertex of the part",
                role::key(Names::vertex, 'a'));
    visit_field(visitor, "vertex_count", &Row::vertex_count, "Vertices of the part", role::rows("", 'a'));
    visit_field(visitor, "is_whole", &Row::is_whole, "Whether all parts of the object are contained");
  }
};

template <>
struct Description<IntersectionCurve> {
  static constexpr const char* name = "IntersectionCurve";
  template <class Visitor>
  static constexpr void visit(Visitor&& visitor) {
    using Row = IntersectionCurve;
    visit_field(visitor, "a", &Row::a, "Object a; the same as b for a curve of an object with itself",
                role::object('a'));
    visit_field(visitor, "b", &Row::b, "Object b", role::object('b'));
    visit_field(visitor, "kind", &Row::kind, "How the contacts of the curve are linked");
    visit_field(visitor, "first_contact", &Row::first_contact, "First contact of the curve",
                role::first_row("curve_contacts"));
    visit_field(visitor, "contact_count", &Row::contact_count, "Number of contacts",
                role::rows("curve_contacts"));
    visit_field(visitor, "first_point", &Row::first_point, "First point of the curve",
                role::first_row("curve_points"));
    visit_field(visitor, "point_count", &Row::point_count,
                "Number of points: one more than contacts for an open curve, none for a branched one",
                role::rows("curve_points"));
    visit_field(visitor, "first_enclosed", &Row::first_enclosed, "First vertex that the curve cuts off",
                role::first_row("enclosed_vertices"));
    visit_field(visitor, "enclosed_count_a", &Row::enclosed_count_a, "Number of these vertices of object a",
                role::rows("enclosed_vertices", 'a'));
    visit_field(visitor, "enclosed_count_b", &Row::enclosed_count_b,
                "Number of vertices of object b, which follow", role::rows("enclosed_vertices", 'b'));
    visit_field(visitor, "centroid", &Row::centroid, "Centroid of the segments", role::rounded, "length");
    visit_field(visitor, "area", &Row::area, "Vector area of a closed curve; else zero", role::rounded,
                "length²");
    visit_field(visitor, "normal", &Row::normal, "Unit vector along which a leaves b; zero if none",
                role::rounded);
    visit_field(visitor, "depth", &Row::depth, "How far a must move along the normal", role::rounded,
                "length");
  }
};

template <>
struct Description<CollidingVertices> {
  static constexpr const char* name = "CollidingVertices";
  template <class Visitor>
  static constexpr void visit(Visitor&& visitor) {
    using Row = CollidingVertices;
    visit_field(visitor, "a", &Row::a, "Object a", role::object('a'));
    visit_field(visitor, "b", &Row::b, "Object b", role::object('b'));
    visit_field(visitor, "first_vertex", &Row::first_vertex, "First vertex in a leaf that collides",
                role::first_row("colliding_vertices"));
    visit_field(visitor, "count_a", &Row::count_a, "Number of these vertices of object a",
                role::rows("colliding_vertices", 'a'));
    visit_field(visitor, "count_b", &Row::count_b, "Number of vertices of object b, which follow",
                role::rows("colliding_vertices", 'b'));
  }
};

template <>
struct Description<ManifoldPoint> {
  static constexpr const char* name = "ManifoldPoint";
  template <class Visitor>
  static constexpr void visit(Visitor&& visitor) {
    using Row = ManifoldPoint;
    visit_field(visitor, "id", &Row::id, "Id of the point, while it stays");
    visit_field(visitor, "lasting", &Row::lasting,
                "Whether the point was there in the last step (stay) or not (begin)");
    visit_field(visitor, "position", &Row::position, "The point", role::rounded, "length");
    visit_field(visitor, "depth", &Row::depth, "How deep the point is; negative where the objects are apart",
                role::rounded, "length");
  }
};

template <>
struct Description<Manifold> {
  static constexpr const char* name = "Manifold";
  template <class Visitor>
  static constexpr void visit(Visitor&& visitor) {
    using Row = Manifold;
    visit_field(visitor, "a", &Row::a, "Object a; the same as b for a patch of an object with itself",
                role::object('a'));
    visit_field(visitor, "b", &Row::b, "Object b", role::object('b'));
    visit_field(visitor, "id", &Row::id, "Id of the manifold, while it stays", role::key(Names::nothing, 0));
    visit_field(visitor, "lasting", &Row::lasting,
                "Whether the manifold was there in the last step (stay) or not (begin)");
    visit_field(visitor, "source", &Row::source,
                "What the manifold summarises: a curve of intersection (curve) or proximity pairs (pairs)");
    visit_field(visitor, "normal", &Row::normal, "Unit vector from b to a", role::rounded);
    visit_field(visitor, "depth", &Row::depth, "Depth of the curve, or minus the smallest distance",
                role::rounded, "length");
    visit_field(visitor, "first_point", &Row::first_point, "First point of the manifold",
                role::first_row("manifold_points"));
    visit_field(visitor, "point_count", &Row::point_count, "Number of points: 1 to 4",
                role::rows("manifold_points"));
    visit_field(visitor, "record", &Row::record, "Index of the curve or of the nearest proximity pair");
  }
};

template <>
struct Description<EndedManifold> {
  static constexpr const char* name = "EndedManifold";
  template <class Visitor>
  static constexpr void visit(Visitor&& visitor) {
    using Row = EndedManifold;
    visit_field(visitor, "a", &Row::a, "Object a", role::object('a'));
    visit_field(visitor, "b", &Row::b, "Object b", role::object('b'));
    visit_field(visitor, "id", &Row::id, "Id of the manifold", role::key(Names::nothing, 0));
  }
};

template <>
struct Description<NonFiniteVertex> {
  static constexpr const char* name = "NonFiniteVertex";
  template <class Visitor>
  static constexpr void visit(Visitor&& visitor) {
    using Row = NonFiniteVertex;
    visit_field(visitor, "object", &Row::object, "Object of the vertex", role::object('a'));
    visit_field(visitor, "vertex", &Row::vertex, "Vertex with a coordinate that is not finite",
                role::key(Names::vertex, 'a'));
    visit_field(visitor, "position", &Row::position, "Its position", {}, "length");
  }
};

template <>
struct Description<UntestedKind> {
  static constexpr const char* name = "UntestedKind";
  template <class Visitor>
  static constexpr void visit(Visitor&& visitor) {
    visit_field(visitor, "kind", &UntestedKind::kind, "Kind of contacts", role::key(Names::nothing, 0));
    visit_field(visitor, "reason", &UntestedKind::reason, "Why there was nothing to test");
  }
};

}  // namespace supple
