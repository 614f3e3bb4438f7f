#include "penetration_json.hpp"

#include <cstdint>
#include <span>

#include "supple/result_descriptions.hpp"
#include "text.hpp"

namespace supple::cli {
namespace {

void write_ids(JsonWriter& json, const char* name, std::span<const std::uint32_t> ids) {
  json.key(name);
  json.begin_array();
  for (const std::uint32_t id : ids) json.value(std::uint64_t{id});
  json.end_array();
}

void write_objects(JsonWriter& json, ObjectId a, ObjectId b) {
  json.member("a", std::uint64_t{a.index});
  json.member("b", std::uint64_t{b.index});
}

void write_groups(JsonWriter& json, const DetectResult& result) {
  json.key("penetration");
  json.begin_array();
  for (const PenetrationGroup& group : result.penetration_groups) {
    json.begin_object();
    write_objects(json, group.a, group.b);
    json.key("vertices");
    json.begin_array();
    for (const Penetration& p : result.penetrations_of(group)) {
      json.begin_array();
      json.value(std::uint64_t{p.vertex});
      json.value(std::uint64_t{p.triangle});
      json.value(p.depth);
      json.end_array();
    }
    json.end_array();
    write_ids(json, "on_surface", result.vertices_on_surface_of(group));
    json.end_object();
  }
  json.end_array();
}

void write_contained(JsonWriter& json, std::span<const ContainedPart> parts) {
  json.key("containment");
  json.begin_array();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const bool is_first =
        i == 0 || parts[i - 1].inner != parts[i].inner || parts[i - 1].outer != parts[i].outer;
    if (parts[i].is_whole && is_first) json.pair(parts[i].inner.index, parts[i].outer.index);
  }
  json.end_array();
  json.key("contained_parts");
  json.begin_array();
  for (const ContainedPart& part : parts) {
    json.begin_object();
    json.member("inner", std::uint64_t{part.inner.index});
    json.member("outer", std::uint64_t{part.outer.index});
    json.member("vertex", std::uint64_t{part.vertex});
    json.member("vertices", std::uint64_t{part.vertex_count});
    json.end_object();
  }
  json.end_array();
}

void write_curve_details(JsonWriter& json, const DetectResult& result, const IntersectionCurve& curve) {
  json.key("pairs");
  json.begin_array();
  for (const std::uint32_t i : result.contacts_of(curve))
    json.pair(result.contacts[i].triangle_a, result.contacts[i].triangle_b);
  json.end_array();
  json.key("points");
  json.begin_array();
  for (const Vec3d& point : result.points_of(curve)) json.value(point);
  json.end_array();
  json.member("centroid", curve.centroid);
  json.member("area", curve.area);
  json.member("normal", curve.normal);
  json.member("depth", curve.depth);
  write_ids(json, "enclosed_a", result.enclosed_vertices_of(curve, ContactSide::a));
  write_ids(json, "enclosed_b", result.enclosed_vertices_of(curve, ContactSide::b));
}

void write_curves(JsonWriter& json, const DetectResult& result, bool details) {
  json.key("curves");
  json.begin_array();
  for (const IntersectionCurve& curve : result.curves) {
    json.begin_object();
    write_objects(json, curve.a, curve.b);
    json.member("kind", word_of(curve.kind));
    json.member("segments", std::uint64_t{curve.contact_count});
    if (details) write_curve_details(json, result, curve);
    json.end_object();
  }
  json.end_array();
}

void write_penetrations(JsonWriter& json, std::span<const Penetration> penetrations) {
  json.key("penetrations");
  json.begin_array();
  for (const Penetration& p : penetrations) {
    json.begin_object();
    write_objects(json, p.object_a, p.object_b);
    json.member("vertex", std::uint64_t{p.vertex});
    json.member("triangle", std::uint64_t{p.triangle});
    json.member("on", name_of(p.feature));
    json.member("depth", p.depth);
    json.key("barycentric");
    json.begin_array();
    for (const double weight : p.barycentric) json.value(weight);
    json.end_array();
    json.member("point", p.point);
    json.member("normal", p.normal);
    json.end_object();
  }
  json.end_array();
}

}  // namespace

void write_penetration(JsonWriter& json, const DetectResult& result, bool details) {
  write_groups(json, result);
  write_contained(json, result.contained_parts);
  write_curves(json, result, details);
  if (details) write_penetrations(json, result.penetrations);
}

void write_penetration_verify(JsonWriter& json, const VerifyReport& report) {
  json.key("penetration_verify");
  json.begin_object();
  json.member("vertex_triangle_pairs_checked", report.vertex_triangle_pairs_checked);
  json.member("inside_vertices", report.inside_vertices);
  json.key("differences");
  json.begin_array();
  for (const PenetrationDifference& difference : report.penetration_differences) {
    json.begin_object();
    write_objects(json, difference.object_a, difference.object_b);
    json.member("vertex", std::uint64_t{difference.vertex});
    json.member("fault", word_of(difference.fault));
    json.end_object();
  }
  json.end_array();
  json.end_object();
}

}  // namespace supple::cli
