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
struct Description<ClosestPoint> : RecordDescription<ClosestPoint> {
  static constexpr const char* name = "ClosestPoint";
  static constexpr void fields(auto&& field) {
    field("object", &Row::object, "Object of the triangle", role::id(Names::object, 'a'));
    field("triangle", &Row::triangle, "Nearest triangle", role::id(Names::triangle, 'a'));
    field("feature", &Row::feature, "Smallest part of it that holds the closest point");
    field("distance", &Row::distance, "Distance to the triangle; negative for a signed distance inside",
          role::rounded, "length");
    field("barycentric", &Row::barycentric, "Barycentric coordinates of the closest point",
          role::weights('a'));
    field("point", &Row::point, "Closest point", role::rounded, "length");
    field("normal", &Row::normal, "Unit vector from it to the point of the query", role::rounded);
  }
};

template <>
struct Description<RayHit> : RecordDescription<RayHit> {
  static constexpr const char* name = "RayHit";
  static constexpr void fields(auto&& field) {
    field("object", &Row::object, "Object of the triangle", role::id(Names::object, 'a'));
    field("triangle", &Row::triangle, "Triangle that the ray hits", role::id(Names::triangle, 'a'));
    field("t", &Row::t, "Parameter of the hit along the direction of the ray", role::rounded);
    field("point", &Row::point, "Point of the hit", role::rounded, "length");
    field("barycentric", &Row::barycentric, "Barycentric coordinates of the hit", role::weights('a'));
    field("hits", &Row::hits, "Triangles on the whole ray; 1 if they were not counted");
  }
};

template <>
struct Description<ListedRayHit> : RecordDescription<ListedRayHit> {
  static constexpr const char* name = "ListedRayHit";
  static constexpr void fields(auto&& field) {
    field("query", &Row::query, "Place of the ray in the list of rays", role::key(Names::nothing, 0));
    field("hit", &Row::hit, "The hit");
  }
};

template <>
struct Description<Overlap> : RecordDescription<Overlap> {
  static constexpr const char* name = "Overlap";
  static constexpr void fields(auto&& field) {
    field("query", &Row::query, "Place of the box or sphere in the list of queries",
          role::key(Names::nothing, 0));
    field("object", &Row::object, "Object of the triangle", role::key(Names::object, 'a'));
    field("triangle", &Row::triangle, "Triangle that overlaps it", role::key(Names::triangle, 'a'));
  }
};

template <>
struct Description<LimitingPair> : RecordDescription<LimitingPair> {
  static constexpr const char* name = "LimitingPair";
  static constexpr void fields(auto&& field) {
    field("object_a", &Row::object_a, "Object a", role::object('a'));
    field("object_b", &Row::object_b, "Object b", role::object('b'));
    field("kind", &Row::kind, "Kinds of the elements", role::key(Names::nothing, 0));
    field("element_a", &Row::element_a, "Element of object a", role::key(Names::element, 'a'));
    field("element_b", &Row::element_b, "Element of object b", role::key(Names::element, 'b'));
  }
};

template <>
struct Description<ElementDistance> : RecordDescription<ElementDistance> {
  static constexpr const char* name = "ElementDistance";
  static constexpr void fields(auto&& field) {
    field("distance", &Row::distance, "Distance of the elements", role::rounded, "length");
    field("feature_a", &Row::on_a, "Smallest part of element a that holds the closest point");
    field("feature_b", &Row::on_b, "Smallest part of element b that holds the closest point");
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
struct Description<TriangleIntersection> : RecordDescription<TriangleIntersection> {
  static constexpr const char* name = "TriangleIntersection";
  static constexpr void fields(auto&& field) {
    field("intersects", &Row::intersects, "Whether the triangles have a point in common");
    field("used_exact_fallback", &Row::used_exact_fallback,
          "Whether integers decided because floating-point filters could not");
    field("kind", &Row::kind, "What they share; meaningful if they intersect");
    field("point_count", &Row::point_count, "Points of the intersection: 0 to 6");
    field("points", &Row::points, "These points, in order around a polygon", role::rounded, "length");
    field("normal", &Row::normal, "Unit vector from b to a", role::rounded);
  }
};

template <>
struct Description<Impact> : RecordDescription<Impact> {
  static constexpr const char* name = "Impact";
  static constexpr void fields(auto&& field) {
    field("toi", &Row::toi, "Time of impact: 0 at the start of the step, 1 at its end", role::rounded,
          "steps");
    field("certainty", &Row::certainty, "Whether the impact is proven");
    field("touching_at_start", &Row::touching_at_start,
          "Whether the elements touch already at the start; the time is then 0");
    field("start_distance", &Row::start_distance, "Distance at the start", role::rounded, "length");
    field("barycentric", &Row::barycentric, "Barycentric coordinates of both points", role::rounded);
    field("point", &Row::point, "Midpoint of the two points at the time of impact", role::rounded, "length");
    field("normal", &Row::normal, "Unit vector from b to the side of element a", role::rounded);
  }
};

}  // namespace supple
