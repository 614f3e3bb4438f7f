#include "reports/reports.hpp"

#include <string_view>
#include <utility>

#include "inputs/inputs.hpp"
#include "moving/moving_objects.hpp"
#include "reports/result_json.hpp"
#include "session/messages/described_json.hpp"
#include "supple/difference_descriptions.hpp"
#include "supple/option_descriptions.hpp"

namespace supple::cli {
namespace {

/// Writes all options except those of the machine.
template <class Options>
void write_options(JsonWriter& json, const Options& options) {
  json.object("options", [&] {
    for_each_leaf(
        [&](const auto& field, const auto& value) {
          if (field.is_of_machine || std::string_view(field.key) == "name") return;
          json.key(field.key);
          viewer::write_value(json, field, value);
        },
        options);
  });
}

void write_object_pairs(JsonWriter& json, const char* name, std::span<const ObjectPair> pairs) {
  json.list(name, pairs, [&](const ObjectPair& pair) { json.pair(pair.a.index, pair.b.index); });
}

/// `stay` is left out: it follows from earlier frames and would repeat every lasting pair in every frame.
void write_events(JsonWriter& json, const char* name, const PairEvents& events) {
  json.object(name, [&] {
    write_object_pairs(json, "begin", events.begin);
    write_object_pairs(json, "end", events.end);
  });
}

void write_untested(JsonWriter& json, const Frame& frame) {
  json.key("untested");
  json.begin_array();
  for (const UntestedKind& untested : frame.result.untested) {
    json.begin_object();
    write_fields(json, untested);
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
  json.object("stats", [&] {
    if (frame.simulated) json.member("motion_seconds", frame.simulated->motion_seconds);
    viewer::write_members(json, frame.result.stats);
  });
}

/// Two counts of the brute force, and the differences from it.
template <class Row>
void write_verify(JsonWriter& json, const char* name, std::pair<const char*, std::uint64_t> checked,
                  std::pair<const char*, std::uint64_t> found, const std::vector<Row>& differences) {
  json.object(name, [&] {
    json.member(checked.first, checked.second);
    json.member(found.first, found.second);
    write_records(json, "differences", std::span<const Row>(differences));
  });
}

/// Writes the result of `supple detect` as docs/json.md describes, frame by frame.
class JsonReport : public Report {
 public:
  JsonReport(const std::string& file_name, const Input& input, const MovingObjects& objects,
             const JsonContent& content)
      : json_(file_name), input_(input), objects_(objects), content_(content) {
    if (content_.stats) write_options(json_, input_.simulation.scene);
    std::uint32_t number = 0;
    json_.objects("objects", input.objects, [&](const InputObject& object) {
      json_.member("name", input.name(ObjectId{number++}));
      json_.member("vertices", std::uint64_t{object.mesh.positions.size()});
      json_.member("triangles", std::uint64_t{object.mesh.triangles.size()});
      if (content_.stats) write_options(json_, object.options);
      if (content_.faces)
        json_.list("faces", object.mesh.triangles, [&](const Triangle& triangle) {
          json_.array(triangle, [&](std::uint32_t vertex) { json_.value(vertex); });
        });
      if (!object.part) return;
      json_.object("part", [&] {
        json_.member("of", object.part->mesh);
        json_.list("vertices", object.part->vertices);
        json_.list("triangles", object.part->triangles);
      });
    });
    json_.key("frames");
    json_.begin_array();
  }

  void add(const Frame& frame) override {
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
      write_continuous_groups(json_, result, !options.impact.exact);
      if (content_.contact_details)
        write_records(json_, both ? "continuous_contacts" : "contacts", result.continuous_contacts);
    }
    if (at_rest) write_intersections(json_, result, {content_.contact_details, options.contact_points});
    if (proximity) {
      write_proximity_groups(json_, result, options.proximity_listing);
      if (content_.contact_details) write_records(json_, "proximity_pairs", result.proximity_pairs);
    }
    const bool penetration = contains(options.contacts, ContactKinds::penetration);
    if (penetration) write_penetration(json_, result, content_.contact_details);
    write_other_answers(json_, result, options.contacts);
    if (options.manifolds) write_manifolds(json_, result);
    if (options.comparison.colliding_vertices) write_colliding_vertices(json_, result);
    if (content_.node_pairs) write_node_pairs(json_, objects_.scene(), *content_.node_pairs);
    json_.object("events", [&] {
      write_events(json_, "volumes", result.volume_events);
      if (options.comparison.colliding_vertices)
        write_events(json_, "narrow_phase", result.narrow_phase_events);
      write_events(json_, "contacts", result.contact_events);
      for (const ContactKindInfo& of : contact_kinds) {
        if (of.events != &DetectResult::contact_events && contains(options.contacts, of.kind))
          write_events(json_, word_of(of.kind), result.*of.events);
      }
    });
    write_records(json_, "non_finite", result.non_finite_vertices);
    if (frame.verify) {
      const VerifyReport& report = *frame.verify;
      if (continuous)
        write_verify(json_, both ? "continuous_verify" : "verify",
                     {"element_pairs_checked", report.element_pairs_checked},
                     {"touching_element_pairs", report.touching_element_pairs},
                     report.continuous_differences);
      if (contains(options.contacts, ContactKinds::intersection))
        write_verify(json_, "verify", {"triangle_pairs_checked", report.triangle_pairs_checked},
                     {"intersecting_pairs", report.intersecting_pairs}, report.differences);
      if (proximity)
        write_verify(json_, "proximity_verify", {"element_pairs_checked", report.proximity_pairs_checked},
                     {"near_pairs", report.near_pairs}, report.proximity_differences);
      if (penetration)
        write_verify(json_, "penetration_verify",
                     {"vertex_triangle_pairs_checked", report.vertex_triangle_pairs_checked},
                     {"inside_vertices", report.inside_vertices}, report.penetration_differences);
    }
    if (content_.stats) write_stats(json_, frame);
    json_.end_object();
    json_.flush();
  }

  void finish(bool was_ended) override {
    json_.end_array();
    json_.member("truncated", was_ended || is_truncated_);
    json_.close();
  }

 private:
  JsonWriter json_;

  /// Writes the files of a frame.
  void add_files(std::uint64_t frame) {
    bool is_first = true;
    for (std::size_t i = 0; i < input_.objects.size(); ++i) {
      const auto* const sequence = motion_of<FrameSequence>(input_.objects[i]);
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

  const Input& input_;
  const MovingObjects& objects_;
  JsonContent content_;
  bool is_truncated_ = false;
};

}  // namespace

std::unique_ptr<Report> make_json_report(const std::string& file_name, const Input& input,
                                         const MovingObjects& objects, const JsonContent& content) {
  return std::make_unique<JsonReport>(file_name, input, objects, content);
}

}  // namespace supple::cli
