#pragma once

#include "supple/continuous.hpp"
#include "supple/description.hpp"
#include "supple/distance.hpp"
#include "supple/queries.hpp"
#include "supple/result_descriptions.hpp"
#include "supple/safe_step.hpp"
#include "supple/triangle_intersection.hpp"

// Descriptions of the answers of queries, of safe steps, and of functions for two elements.

namespace supple {

template <>
struct Description<ClosestPoint> {
  static constexpr const char* name = "ClosestPoint";
  template <class Visitor>
  static constexpr void visit(Visitor&& visitor) {
    using Row = ClosestPoint;
    visit_field(visitor, "object", &Row::object, "Object of the triangle", role::id(Names::object, 'a'));
    visit_field(visitor, "triangle", &Row::triangle, "Nearest triangle", role::id(Names::triangle, 'a'));
    visit_field(visitor, "feature", &Row::feature, "Smallest part of it that holds the closest point");
    visit_field(visitor, "distance", &Row::distance,
                "Distance to the triangle; negative for a signed distance inside", role::rounded, "length");
    visit_field(visitor, "barycentric", &Row::barycentric, "Barycentric coordinates of the closest point",
                role::weights('a'));
    visit_field(visitor, "point", &Row::point, "Closest point", role::rounded, "length");
    visit_field(visitor, "normal", &Row::normal, "Unit vector from it to the point of the query",
                role::rounded);
  }
};

template <>
struct Description<RayHit> {
  static constexpr const char* name = "RayHit";
  template <class Visitor>
  static constexpr void visit(Visitor&& visitor) {
    using Row = RayHit;
    visit_field(visitor, "object", &Row::object, "Object of the triangle", role::id(Names::object, 'a'));
    visit_field(visitor, "triangle", &Row::triangle, "Triangle that the ray hits",
                role::id(Names::triangle, 'a'));
    visit_field(visitor, "t", &Row::t, "Parameter of the hit along the direction of the ray", role::rounded);
    visit_field(visitor, "point", &Row::point, "Point of the hit", role::rounded, "length");
    visit_field(visitor, "barycentric", &Row::barycentric, "Barycentric coordinates of the hit",
                role::weights('a'));
    visit_field(visitor, "hits", &Row::hits, "Triangles on the whole ray; 1 if they were not counted");
  }
};

template <>
struct Description<ListedRayHit> {
  static constexpr const char* name = "ListedRayHit";
  template <class Visitor>
  static constexpr void visit(Visitor&& visitor) {
    visit_field(visitor, "query", &ListedRayHit::query, "Place of the ray in the list of rays",
                role::key(Names::nothing, 0));
    visit_field(visitor, "hit", &ListedRayHit::hit, "The hit");
  }
};

template <>
struct Description<Overlap> {
  static constexpr const char* name = "Overlap";
  template <class Visitor>
  static constexpr void visit(Visitor&& visitor) {
    using Row = Overlap;
    visit_field(visitor, "query", &Row::query, "Place of the box or sphere in the list of queries",
                role::key(Names::nothing, 0));
    visit_field(visitor, "object", &Row::object, "Object of the triangle", role::key(Names::object, 'a'));
    visit_field(visitor, "triangle", &Row::triangle, "Triangle that overlaps it",
                role::key(Names::triangle, 'a'));
  }
};

template <>
struct Description<LimitingPair> {
  static constexpr const char* name = "LimitingPair";
  template <class Visitor>
  static constexpr void visit(Visitor&& visitor) {
    using Row = LimitingPair;
    visit_field(visitor, "object_a", &Row::object_a, "Object a", role::object('a'));
    visit_field(visitor, "object_b", &Row::object_b, "Object b", role::object('b'));
    visit_field(visitor, "kind", &Row::kind, "Kinds of the elements", role::key(Names::nothing, 0));
    visit_field(visitor, "element_a", &Row::element_a, "Element of object a", role::key(Names::element, 'a'));
    visit_field(visitor, "element_b", &Row::element_b, "Element of object b", role::key(Names::element, 'b'));
  }
};

template <>
struct Description<ElementDistance> {
  static constexpr const char* name = "ElementDistance";
  template <class Visitor>
  static constexpr void visit(Visitor&& visitor) {
    using Row = ElementDistance;
    visit_field(visitor, "distance", &Row::distance, "Distance of the elements", role::rounded, "length");
    visit_field(visitor, "feature_a", &Row::on_a, "Smallest part of element a that holds the closest point");
    visit_field(visitor, "feature_b", &Row::on_b, "Smallest part of element b that holds the closest point");
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
struct Description<TriangleIntersection> {
  static constexpr const char* name = "TriangleIntersection";
  template <class Visitor>
  static constexpr void visit(Visitor&& visitor) {
    using Row = TriangleIntersection;
    visit_field(visitor, "intersects", &Row::intersects, "Whether the triangles have a point in common");
    visit_field(visitor, "used_exact_fallback", &Row::used_exact_fallback,
                "Whether integers decided because floating-point filters could not");
    visit_field(visitor, "kind", &Row::kind, "What they share; meaningful if they intersect");
    visit_field(visitor, "point_count", &Row::point_count, "Points of the intersection: 0 to 6");
    visit_field(visitor, "points", &Row::points, "These points, in order around a polygon", role::rounded,
                "length");
    visit_field(visitor, "normal", &Row::normal, "Unit vector from b to a", role::rounded);
  }
};

template <>
struct Description<Impact> {
  static constexpr const char* name = "Impact";
  template <class Visitor>
  static constexpr void visit(Visitor&& visitor) {
    using Row = Impact;
    visit_field(visitor, "toi", &Row::toi, "Time of impact: 0 at the start of the step, 1 at its end",
                role::rounded, "steps");
    visit_field(visitor, "certainty", &Row::certainty, "Whether the impact is proven");
    visit_field(visitor, "touching_at_start", &Row::touching_at_start,
                "Whether the elements touch already at the start; the time is then 0");
    visit_field(visitor, "start_distance", &Row::start_distance, "Distance at the start", role::rounded,
                "length");
    visit_field(visitor, "barycentric", &Row::barycentric, "Barycentric coordinates of both points",
                role::rounded);
    visit_field(visitor, "point", &Row::point, "Midpoint of the two points at the time of impact",
                role::rounded, "length");
    visit_field(visitor, "normal", &Row::normal, "Unit vector from b to the side of element a",
                role::rounded);
  }
};

}  // namespace supple
