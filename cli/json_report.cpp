#include "json_report.hpp"

#include <fmt/core.h>

#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "continuous_json.hpp"
#include "manifold_json.hpp"
#include "penetration_json.hpp"
#include "proximity_json.hpp"
#include "session/described_json.hpp"
#include "supple/option_descriptions.hpp"
#include "supple/result_descriptions.hpp"
#include "supple/version.hpp"
#include "text.hpp"

namespace supple::cli {
namespace {

/// Writes all options except those of the machine.
template <class Options>
void write_options(JsonWriter& json, const Options& options) {
  json.key("options");
  json.begin_object();
  for_each_leaf(
      [&](const auto& field, const auto& value) {
        if (field.is_of_machine || std::string_view(field.key) == "name") return;
        json.key(field.key);
        viewer::write_value(json, field, value);
      },
      options);
  json.end_object();
}

void write_faces(JsonWriter& json, const std::vector<Triangle>& triangles) {
  json.key("faces");
  json.begin_array();
  for (const Triangle& triangle : triangles) {
    json.begin_array();
    for (const std::uint32_t vertex : triangle) json.value(vertex);
    json.end_array();
  }
  json.end_array();
}

void write_part(JsonWriter& json, const PartOfMesh& part) {
  json.key("part");
  json.begin_object();
  json.member("of", part.mesh);
  for (const auto& [name, ids] :
       {std::pair("vertices", &part.vertices), std::pair("triangles", &part.triangles)}) {
    json.key(name);
    json.begin_array();
    for (const std::uint32_t id : *ids) json.value(id);
    json.end_array();
  }
  json.end_object();
}

void write_object_pairs(JsonWriter& json, const char* name, std::span<const ObjectPair> pairs) {
  json.key(name);
  json.begin_array();
  for (const ObjectPair& pair : pairs) json.pair(pair.a.index, pair.b.index);
  json.end_array();
}

/// Writes the groups of different objects, or the groups of objects with themselves.
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
    if (with_points) {
      json.member("normal", contact.normal);
      write_points(json, result.points_of(contact));
    }
    json.end_object();
  }
  json.end_array();
}

/// Writes the paper's output: the vertices in colliding leaves.
void write_colliding_vertices(JsonWriter& json, const DetectResult& result) {
  json.key("colliding_vertices");
  json.begin_array();
  for (const CollidingVertices& group : result.colliding_vertex_groups) {
    const auto write = [&](const char* name, std::size_t first, std::size_t count) {
      json.key(name);
      json.begin_array();
      for (const std::uint32_t vertex : result.colliding_vertices.subspan(first, count)) json.value(vertex);
      json.end_array();
    };
    json.begin_object();
    json.member("a", std::uint64_t{group.a.index});
    json.member("b", std::uint64_t{group.b.index});
    write("vertices_a", group.first_vertex, group.count_a);
    write("vertices_b", group.first_vertex + group.count_a, group.count_b);
    json.end_object();
  }
  json.end_array();
}

/// `stay` is left out: it follows from earlier frames and would repeat every lasting pair in every frame.
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

void write_untested(JsonWriter& json, const Frame& frame) {
  json.key("untested");
  json.begin_array();
  for (const UntestedKind& untested : frame.result.untested) {
    json.begin_object();
    json.member("kind", word_of(untested.kind));
    json.member("reason", word_of(untested.reason));
    json.end_object();
  }
  for (const ObjectId object : frame.turned) {
    json.begin_object();
    json.member("kind", word_of(ContactKinds::continuous));
    json.member("reason", "half_turn");
    json.member("object", std::uint64_t{object.index});
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

JsonReport::JsonReport(const std::string& file_name, const Input& input, const Scene& scene,
                       const JsonContent& content)
    : json_(file_name), input_(input), scene_(scene), content_(content) {
  json_.begin_object();
  json_.member("supple", std::string(SUPPLE_VERSION));
  if (content_.stats) write_options(json_, input_.simulation.scene);
  json_.key("objects");
  json_.begin_array();
  const std::vector<ObjectId> objects = scene.objects();
  for (std::size_t i = 0; i < objects.size(); ++i) {
    json_.begin_object();
    json_.member("name", scene.name(objects[i]));
    json_.member("vertices", std::uint64_t{scene.vertex_count(objects[i])});
    json_.member("triangles", std::uint64_t{scene.triangle_count(objects[i])});
    if (content_.stats) write_options(json_, input_.objects[i].options);
    if (content_.faces) write_faces(json_, input_.objects[i].mesh.triangles);
    if (input_.objects[i].part) write_part(json_, *input_.objects[i].part);
    json_.end_object();
  }
  json_.end_array();
  json_.key("frames");
  json_.begin_array();
}

/// Writes the files of a frame.
void JsonReport::add_files(std::uint64_t frame) {
  bool is_first = true;
  for (std::size_t i = 0; i < input_.objects.size(); ++i) {
    const auto& motion = input_.objects[i].motion;
    const auto* const sequence = motion ? std::get_if<FrameSequence>(&*motion) : nullptr;
    if (!sequence) continue;
    if (std::exchange(is_first, false)) {
      json_.key("files");
      json_.begin_array();
    }
    json_.begin_object();
    json_.member("object", std::uint64_t{i});
    json_.member("file", sequence->file_at(frame).string());
    json_.end_object();
  }
  if (!is_first) json_.end_array();
}

void JsonReport::add(const Frame& frame) {
  const DetectResult& result = frame.result;
  const SceneOptions& options = input_.simulation.scene;
  json_.begin_object();
  json_.member("frame", frame.number);
  if (frame.simulated) json_.member("time", frame.simulated->time);
  add_files(frame.number);
  json_.member("truncated", result.truncated);
  is_truncated_ = is_truncated_ || result.truncated;
  write_untested(json_, frame);
  write_object_pairs(json_, "object_pairs", result.object_pairs);
  const bool continuous = contains(options.contacts, ContactKinds::continuous);
  const bool both = continuous && contains(options.contacts, ContactKinds::intersection);
  const bool at_rest =
      options.contacts == ContactKinds::none || contains(options.contacts, ContactKinds::intersection);
  const bool proximity = contains(options.contacts, ContactKinds::proximity);
  if (continuous) {
    write_continuous_groups(json_, result, !options.impact.exact || options.max_exact_bits < most_exact_bits);
    if (content_.contact_details)
      write_continuous_contacts(json_, both ? "continuous_contacts" : "contacts", result);
  }
  if (at_rest) {
    write_groups(json_, "triangle_pairs", result, false);
    write_groups(json_, "self", result, true);
    if (content_.contact_details) write_contacts(json_, result, options.contact_points);
  }
  if (proximity) {
    write_proximity_groups(json_, result, options.proximity_listing);
    if (content_.contact_details) write_proximity_pairs(json_, result);
  }
  const bool penetration = contains(options.contacts, ContactKinds::penetration);
  if (penetration) write_penetration(json_, result, content_.contact_details);
  if (options.manifolds) write_manifolds(json_, result);
  if (options.comparison.colliding_vertices) write_colliding_vertices(json_, result);
  if (content_.node_pairs) write_node_pairs(json_, scene_, *content_.node_pairs);
  json_.key("events");
  json_.begin_object();
  write_events(json_, "volumes", result.volume_events);
  if (options.comparison.colliding_vertices) write_events(json_, "narrow_phase", result.narrow_phase_events);
  write_events(json_, "contacts", result.contact_events);
  if (proximity) write_events(json_, "proximity", result.proximity_events);
  if (penetration) write_events(json_, "penetration", result.penetration_events);
  json_.end_object();
  write_non_finite(json_, result.non_finite_vertices);
  if (frame.verify) {
    if (continuous) write_continuous_verify(json_, both ? "continuous_verify" : "verify", *frame.verify);
    if (contains(options.contacts, ContactKinds::intersection)) write_verify(json_, *frame.verify);
    if (proximity) write_proximity_verify(json_, *frame.verify);
    if (penetration) write_penetration_verify(json_, *frame.verify);
  }
  if (content_.stats) write_stats(json_, frame);
  json_.end_object();
  json_.flush();
}

void JsonReport::finish(bool was_ended) {
  json_.end_array();
  json_.member("truncated", was_ended || is_truncated_);
  json_.end_object();
  json_.close();
}

}  // namespace supple::cli
