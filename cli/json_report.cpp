#include "json_report.hpp"

#include <fmt/core.h>

#include <string>

#include "continuous_json.hpp"
#include "session/described_json.hpp"
#include "supple/result_descriptions.hpp"
#include "supple/version.hpp"

namespace supple::cli {
namespace {

/// `v0` … `v2`, `e0` … `e2`, `f`.
std::string name_of(Feature feature) {
  if (feature.kind == FeatureKind::face) return "f";
  return fmt::format("{}{}", feature.kind == FeatureKind::vertex ? 'v' : 'e', feature.index);
}

void write_object_pairs(JsonWriter& json, const char* name, std::span<const ObjectPair> pairs) {
  json.key(name);
  json.begin_array();
  for (const ObjectPair& pair : pairs) json.pair(pair.a.index, pair.b.index);
  json.end_array();
}

/// The groups of different objects, or those of objects with themselves.
void write_groups(JsonWriter& json, const char* name, const DetectResult& result, bool self) {
  json.key(name);
  json.begin_array();
  for (const ContactGroup& group : result.groups) {
    if ((group.a == group.b) != self) continue;
    json.begin_object();
    json.member("a", std::uint64_t{group.a.index});
    if (!self) json.member("b", std::uint64_t{group.b.index});
    json.key("pairs");
    json.begin_array();
    for (const Contact& contact : result.contacts_of(group))
      json.pair(contact.triangle_a, contact.triangle_b);
    json.end_array();
    json.end_object();
  }
  json.end_array();
}

void write_points(JsonWriter& json, std::span<const ContactPoint> points) {
  json.key("points");
  json.begin_array();
  for (const ContactPoint& point : points) {
    json.begin_object();
    json.member("position", point.position);
    json.member("on_a", name_of(point.on_a));
    json.member("on_b", name_of(point.on_b));
    json.end_object();
  }
  json.end_array();
}

void write_contacts(JsonWriter& json, const DetectResult& result, bool with_points) {
  json.key("contacts");
  json.begin_array();
  for (const Contact& contact : result.contacts) {
    json.begin_object();
    json.member("a", std::uint64_t{contact.object_a.index});
    json.member("b", std::uint64_t{contact.object_b.index});
    json.key("triangles");
    json.pair(contact.triangle_a, contact.triangle_b);
    json.member("kind", word_of(contact.kind));
    if (with_points) write_points(json, result.points_of(contact));
    json.end_object();
  }
  json.end_array();
}

/// `stay` follows from the frames before, and would repeat every lasting pair in every frame.
void write_events(JsonWriter& json, const char* name, const PairEvents& events) {
  json.key(name);
  json.begin_object();
  write_object_pairs(json, "begin", events.begin);
  write_object_pairs(json, "end", events.end);
  json.end_object();
}

void write_non_finite(JsonWriter& json, std::span<const NonFiniteVertex> vertices) {
  json.key("non_finite");
  json.begin_array();
  for (const NonFiniteVertex& vertex : vertices) {
    json.begin_object();
    json.member("object", std::uint64_t{vertex.object.index});
    json.member("vertex", std::uint64_t{vertex.vertex});
    json.member("position", vertex.position);
    json.end_object();
  }
  json.end_array();
}

void write_stats(JsonWriter& json, const Frame& frame) {
  json.key("stats");
  json.begin_object();
  if (frame.simulated) json.member("motion_seconds", frame.simulated->motion_seconds);
  viewer::write_members(json, frame.result.stats);
  json.end_object();
}

void write_verify(JsonWriter& json, const VerifyReport& report) {
  json.key("verify");
  json.begin_object();
  json.member("triangle_pairs_checked", report.triangle_pairs_checked);
  json.member("intersecting_pairs", report.intersecting_pairs);
  json.key("differences");
  json.begin_array();
  for (const Difference& difference : report.differences) {
    json.begin_object();
    json.member("a", std::uint64_t{difference.object_a.index});
    json.member("b", std::uint64_t{difference.object_b.index});
    json.key("triangles");
    json.pair(difference.triangle_a, difference.triangle_b);
    json.member("missed", difference.missed);
    json.end_object();
  }
  json.end_array();
  json.end_object();
}

}  // namespace

JsonReport::JsonReport(const std::string& file_name, const Scene& scene, const JsonContent& content)
    : json_(file_name), options_(scene.options()), content_(content) {
  json_.begin_object();
  json_.member("supple", std::string(SUPPLE_VERSION));
  json_.key("objects");
  json_.begin_array();
  for (const ObjectId object : scene.objects()) {
    json_.begin_object();
    json_.member("name", scene.name(object));
    json_.member("vertices", std::uint64_t{scene.vertex_count(object)});
    json_.member("triangles", std::uint64_t{scene.triangle_count(object)});
    json_.end_object();
  }
  json_.end_array();
  json_.key("frames");
  json_.begin_array();
}

void JsonReport::add(const Frame& frame) {
  const DetectResult& result = frame.result;
  json_.begin_object();
  json_.member("frame", frame.number);
  if (frame.simulated) json_.member("time", frame.simulated->time);
  write_object_pairs(json_, "object_pairs", result.object_pairs);
  if (options_.contacts == ContactMode::continuous) {
    write_continuous_groups(json_, result, !options_.impact.exact);
    if (content_.contact_details) write_continuous_contacts(json_, result);
  } else {
    write_groups(json_, "triangle_pairs", result, false);
    write_groups(json_, "self", result, true);
    write_contacts(json_, result, options_.contact_points);
  }
  json_.key("events");
  json_.begin_object();
  write_events(json_, "volumes", result.volume_events);
  write_events(json_, "contacts", result.contact_events);
  json_.end_object();
  write_non_finite(json_, result.non_finite_vertices);
  if (frame.verify) {
    if (options_.contacts == ContactMode::continuous)
      write_continuous_verify(json_, *frame.verify);
    else
      write_verify(json_, *frame.verify);
  }
  if (content_.stats) write_stats(json_, frame);
  json_.end_object();
  json_.flush();
}

void JsonReport::finish() {
  json_.end_array();
  json_.end_object();
  json_.close();
}

}  // namespace supple::cli
