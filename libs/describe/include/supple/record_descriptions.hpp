#pragma once

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
struct Description<ObjectPair> : RecordDescription<ObjectPair> {
  static constexpr const char* name = "ObjectPair";
  static constexpr void fields(auto&& field) {
    field("a", &Row::a, "Object a", role::object('a'));
    field("b", &Row::b, "Object b", role::object('b'));
  }
};

template <>
struct Description<ContactGroup> : RecordDescription<ContactGroup> {
  static constexpr const char* name = "ContactGroup";
  static constexpr void fields(auto&& field) {
    field("a", &Row::a, "Object a; the same as b for contacts of an object with itself", role::object('a'));
    field("b", &Row::b, "Object b", role::object('b'));
    field("first_contact", &Row::first_contact, "First contact of the objects in its list");
    field("contact_count", &Row::contact_count, "Number of contacts");
  }
};

template <>
struct Description<Contact> : RecordDescription<Contact> {
  static constexpr const char* name = "Contact";
  static constexpr void fields(auto&& field) {
    field("object_a", &Row::object_a, "Object a; the same as b for a contact with itself", role::object('a'));
    field("object_b", &Row::object_b, "Object b", role::object('b'));
    field("triangle_a", &Row::triangle_a, "Triangle of object a", role::key(Names::triangle, 'a'));
    field("triangle_b", &Row::triangle_b, "Triangle of object b", role::key(Names::triangle, 'b'));
    field("kind", &Row::kind, "What the triangles share");
    field("point_count", &Row::point_count,
          "Points of the intersection: 1, 2, or 3 to 6 in order around a polygon",
          role::rows("contact_points"));
    field("first_point", &Row::first_point, "The first of these points", role::first_row("contact_points"));
    field("normal", &Row::normal, "Unit vector from b to a; zero without contact points", role::rounded);
  }
};

template <>
struct Description<ContactPoint> : RecordDescription<ContactPoint> {
  static constexpr const char* name = "ContactPoint";
  static constexpr void fields(auto&& field) {
    field("position", &Row::position, "The point", role::rounded, "length");
    field("feature_a", &Row::on_a, "Smallest part of triangle a on which the point lies");
    field("feature_b", &Row::on_b, "Smallest part of triangle b on which the point lies");
  }
};

template <>
struct Description<ContinuousContact> : RecordDescription<ContinuousContact> {
  static constexpr const char* name = "ContinuousContact";
  static constexpr void fields(auto&& field) {
    field("object_a", &Row::object_a, "Object a; the same as b for a contact with itself", role::object('a'));
    field("object_b", &Row::object_b, "Object b", role::object('b'));
    field("kind", &Row::kind, "Kinds of the elements: v vertex, e edge, f face; a before b",
          role::key(Names::nothing, 0));
    field("element_a", &Row::element_a, "Element of object a", role::key(Names::element, 'a'));
    field("element_b", &Row::element_b, "Element of object b", role::key(Names::element, 'b'));
    field("certainty", &Row::certainty, "Whether the contact is proven");
    field("touching_at_start", &Row::touching_at_start,
          "Whether the elements touch already at the start of the step; the time is then 0");
    field("toi", &Row::toi, "Time of impact: 0 at the start of the step, 1 at its end", role::rounded,
          "steps");
    field("start_distance", &Row::start_distance, "Distance at the start of the step", role::rounded,
          "length");
    field("barycentric_a", &Row::barycentric_a, "Barycentric coordinates of the point on element a",
          role::weights('a'));
    field("barycentric_b", &Row::barycentric_b, "Barycentric coordinates of the point on element b",
          role::weights('b'));
    field("point", &Row::point, "Midpoint of the two points at the time of impact", role::rounded, "length");
    field("normal", &Row::normal, "Unit vector from b to the side of element a", role::rounded);
  }
};

template <>
struct Description<ProximityPair> : RecordDescription<ProximityPair> {
  static constexpr const char* name = "ProximityPair";
  static constexpr void fields(auto&& field) {
    field("object_a", &Row::object_a, "Object a; the same as b for a pair of one object", role::object('a'));
    field("object_b", &Row::object_b, "Object b", role::object('b'));
    field("kind_a", &Row::kind_a, "Kind of element a", role::key(Names::nothing, 'a'));
    field("kind_b", &Row::kind_b, "Kind of element b", role::key(Names::nothing, 'b'));
    field("element_a", &Row::element_a, "Element of object a", role::key(Names::element, 'a'));
    field("element_b", &Row::element_b, "Element of object b", role::key(Names::element, 'b'));
    field("feature_a", &Row::on_a, "Smallest part of element a that holds the closest point");
    field("feature_b", &Row::on_b, "Smallest part of element b that holds the closest point");
    field("distance", &Row::distance, "Distance of the elements", role::rounded, "length");
    field("barycentric_a", &Row::barycentric_a, "Barycentric coordinates of the closest point on element a",
          role::weights('a'));
    field("barycentric_b", &Row::barycentric_b, "Barycentric coordinates of the closest point on element b",
          role::weights('b'));
    field("point_a", &Row::point_a, "Closest point of a", role::rounded, "length");
    field("point_b", &Row::point_b, "Closest point of b", role::rounded, "length");
    field("normal", &Row::normal, "Unit vector from b to a", role::rounded);
  }
};

template <>
struct Description<PenetrationGroup> : RecordDescription<PenetrationGroup> {
  static constexpr const char* name = "PenetrationGroup";
  static constexpr void fields(auto&& field) {
    field("a", &Row::a, "Object whose vertices are inside b or on its surface", role::object('a'));
    field("b", &Row::b, "Solid object", role::object('b'));
    field("first_penetration", &Row::first_penetration, "First vertex inside",
          role::first_row("penetrations"));
    field("penetration_count", &Row::penetration_count, "Number of vertices inside",
          role::rows("penetrations"));
    field("first_on_surface", &Row::first_on_surface, "First vertex on the surface",
          role::first_row("vertices_on_surface"));
    field("on_surface_count", &Row::on_surface_count, "Number of vertices on the surface",
          role::rows("vertices_on_surface", 'a'));
  }
};

template <>
struct Description<Penetration> : RecordDescription<Penetration> {
  static constexpr const char* name = "Penetration";
  static constexpr void fields(auto&& field) {
    field("object_a", &Row::object_a, "Object of the vertex", role::object('a'));
    field("object_b", &Row::object_b, "Solid object in which the vertex is", role::object('b'));
    field("vertex", &Row::vertex, "Vertex of object a", role::key(Names::vertex, 'a'));
    field("triangle", &Row::triangle, "Nearest triangle of object b", role::id(Names::triangle, 'b'));
    field("feature", &Row::feature, "Smallest part of it that holds the closest point");
    field("depth", &Row::depth, "Distance to the surface of object b", role::rounded, "length");
    field("barycentric", &Row::barycentric, "Barycentric coordinates of the closest point",
          role::weights('b'));
    field("point", &Row::point, "Closest point", role::rounded, "length");
    field("normal", &Row::normal, "Unit vector from the vertex to this point", role::rounded);
  }
};

template <>
struct Description<ContainedPart> : RecordDescription<ContainedPart> {
  static constexpr const char* name = "ContainedPart";
  static constexpr void fields(auto&& field) {
    field("inner", &Row::inner, "Object of the part", role::object('a'));
    field("outer", &Row::outer, "Solid object that contains the part", role::object('b'));
    field("vertex", &Row::vertex, "Smallest vertex of the part", role::key(Names::vertex, 'a'));
    field("vertex_count", &Row::vertex_count, "Vertices of the part", role::rows("", 'a'));
    field("is_whole", &Row::is_whole, "Whether all parts of the object are contained");
  }
};

template <>
struct Description<IntersectionCurve> : RecordDescription<IntersectionCurve> {
  static constexpr const char* name = "IntersectionCurve";
  static constexpr void fields(auto&& field) {
    field("a", &Row::a, "Object a; the same as b for a curve of an object with itself", role::object('a'));
    field("b", &Row::b, "Object b", role::object('b'));
    field("kind", &Row::kind, "How the contacts of the curve are linked");
    field("first_contact", &Row::first_contact, "First contact of the curve",
          role::first_row("curve_contacts"));
    field("contact_count", &Row::contact_count, "Number of contacts", role::rows("curve_contacts"));
    field("first_point", &Row::first_point, "First point of the curve", role::first_row("curve_points"));
    field("point_count", &Row::point_count,
          "Number of points: one more than contacts for an open curve, none for a branched one",
          role::rows("curve_points"));
    field("first_enclosed", &Row::first_enclosed, "First vertex that the curve cuts off",
          role::first_row("enclosed_vertices"));
    field("enclosed_count_a", &Row::enclosed_count_a, "Number of these vertices of object a",
          role::rows("enclosed_vertices", 'a'));
    field("enclosed_count_b", &Row::enclosed_count_b, "Number of vertices of object b, which follow",
          role::rows("enclosed_vertices", 'b'));
    field("centroid", &Row::centroid, "Centroid of the segments", role::rounded, "length");
    field("area", &Row::area, "Vector area of a closed curve; else zero", role::rounded, "length²");
    field("normal", &Row::normal, "Unit vector along which a leaves b; zero if none", role::rounded);
    field("depth", &Row::depth, "How far a must move along the normal", role::rounded, "length");
  }
};

template <>
struct Description<CollidingVertices> : RecordDescription<CollidingVertices> {
  static constexpr const char* name = "CollidingVertices";
  static constexpr void fields(auto&& field) {
    field("a", &Row::a, "Object a", role::object('a'));
    field("b", &Row::b, "Object b", role::object('b'));
    field("first_vertex", &Row::first_vertex, "First vertex in a leaf that collides",
          role::first_row("colliding_vertices"));
    field("count_a", &Row::count_a, "Number of these vertices of object a",
          role::rows("colliding_vertices", 'a'));
    field("count_b", &Row::count_b, "Number of vertices of object b, which follow",
          role::rows("colliding_vertices", 'b'));
  }
};

template <>
struct Description<ManifoldPoint> : RecordDescription<ManifoldPoint> {
  static constexpr const char* name = "ManifoldPoint";
  static constexpr void fields(auto&& field) {
    field("id", &Row::id, "Id of the point, while it stays");
    field("lasting", &Row::lasting, "Whether the point was there in the last step (stay) or not (begin)");
    field("position", &Row::position, "The point", role::rounded, "length");
    field("depth", &Row::depth, "How deep the point is; negative where the objects are apart", role::rounded,
          "length");
  }
};

template <>
struct Description<Manifold> : RecordDescription<Manifold> {
  static constexpr const char* name = "Manifold";
  static constexpr void fields(auto&& field) {
    field("a", &Row::a, "Object a; the same as b for a patch of an object with itself", role::object('a'));
    field("b", &Row::b, "Object b", role::object('b'));
    field("id", &Row::id, "Id of the manifold, while it stays", role::key(Names::nothing, 0));
    field("lasting", &Row::lasting, "Whether the manifold was there in the last step (stay) or not (begin)");
    field("source", &Row::source,
          "What the manifold summarises: a curve of intersection (curve) or proximity pairs (pairs)");
    field("normal", &Row::normal, "Unit vector from b to a", role::rounded);
    field("depth", &Row::depth, "Depth of the curve, or minus the smallest distance", role::rounded,
          "length");
    field("first_point", &Row::first_point, "First point of the manifold",
          role::first_row("manifold_points"));
    field("point_count", &Row::point_count, "Number of points: 1 to 4", role::rows("manifold_points"));
    field("record", &Row::record, "Index of the curve or of the nearest proximity pair");
  }
};

template <>
struct Description<EndedManifold> : RecordDescription<EndedManifold> {
  static constexpr const char* name = "EndedManifold";
  static constexpr void fields(auto&& field) {
    field("a", &Row::a, "Object a", role::object('a'));
    field("b", &Row::b, "Object b", role::object('b'));
    field("id", &Row::id, "Id of the manifold", role::key(Names::nothing, 0));
  }
};

template <>
struct Description<NonFiniteVertex> : RecordDescription<NonFiniteVertex> {
  static constexpr const char* name = "NonFiniteVertex";
  static constexpr void fields(auto&& field) {
    field("object", &Row::object, "Object of the vertex", role::object('a'));
    field("vertex", &Row::vertex, "Vertex with a coordinate that is not finite",
          role::key(Names::vertex, 'a'));
    field("position", &Row::position, "Its position", {}, "length");
  }
};

template <>
struct Description<UntestedKind> : RecordDescription<UntestedKind> {
  static constexpr const char* name = "UntestedKind";
  static constexpr void fields(auto&& field) {
    field("kind", &Row::kind, "Kind of contacts", role::key(Names::nothing, 0));
    field("reason", &Row::reason, "Why there was nothing to test");
  }
};

}  // namespace supple
