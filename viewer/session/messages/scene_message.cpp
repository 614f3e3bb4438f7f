#include "messages/scene_message.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "messages/described_json.hpp"
#include "messages/frame_message.hpp"
#include "messages/long_steps.hpp"
#include "messages/mesh_warnings.hpp"
#include "pins/pin_commands.hpp"
#include "program/program_commands.hpp"
#include "sources/extent.hpp"
#include "supple/result_descriptions.hpp"
#include "supple/simulation_descriptions.hpp"
#include "supple/version.hpp"

namespace supple::viewer {
namespace {

const MassSpringMotion* body_of(const ViewedObject& object) {
  return std::get_if<MassSpringMotion>(&object.motion);
}

std::string_view name_of(const Stage& stage, std::size_t object) {
  if (stage.show().program != nullptr) return "";
  return stage.source().scene().options(stage.source().id(object)).name;
}

void add_objects(const Stage& stage, JsonText& json) {
  json.key("objects");
  json.begin_array();
  for (std::size_t i = 0; i < stage.show().objects.size(); ++i) {
    const ViewedObject& object = stage.show().objects[i];
    json.begin_object();
    // The scene of a program cannot be read at all times.
    json.member("name", object.id ? std::string_view(object.options.name) : name_of(stage, i));
    json.member("vertices", std::uint64_t{object.mesh.positions.size()});
    json.member("triangles", std::uint64_t{object.mesh.triangles.size()});
    json.member("static", object.options.is_static);
    json.member("body", body_of(object) != nullptr);
    json.member("waves", std::holds_alternative<WaveMotion>(object.motion));
    json.member("rigid", std::holds_alternative<RigidMotion>(object.motion));
    json.member("self_collision", object.options.self_collision);
    json.member("margin", object.options.margin);
    if (stage.show().program != nullptr) json.member("removed", !object.id.has_value());
    json.end_object();
  }
  json.end_array();
}

void add_place(const Stage& stage, JsonText& json) {
  const Extent extent = extent_of(stage.show());
  const Vec3d center = stage.center().at;
  json.member("center", center);
  json.key("bounds");
  json.begin_array();
  json.value(extent.empty() ? Vec3d{} : extent.low - center);
  json.value(extent.empty() ? Vec3d{} : extent.high - center);
  json.end_array();
  json.key("border");
  const std::optional<Border>& border = stage.show().simulation.border;
  if (!border || !is_finite((*border)[0]) || !is_finite((*border)[1])) return json.null();
  json.begin_array();
  for (const Vec3d& corner : *border) json.value(corner - center);
  json.end_array();
}

/// The options that `set` takes.
template <class Options>
void add_values(const Options& options, JsonText& json) {
  for_each_leaf(
      [&](const auto& field, const auto& value) {
        if (!is_setting(field)) return;
        json.key(field.key);
        write_value(json, field, value);
      },
      options);
}

template <class Words>
void add_words(const Words& list, JsonText& json) {
  json.member("kind", "word");
  json.key("words");
  json.begin_array();
  for (const char* word : list) json.value(word);
  json.end_array();
}

/// Describes an option that `set` takes: what the user may choose, and whether that restarts.
template <class Struct, class Value>
void add_description(const Field<Struct, Value>& field, bool restarts, JsonText& json) {
  constexpr bool is_whole = std::is_integral_v<Value>;
  json.begin_object();
  json.member("key", field.key);
  json.member("doc", field.doc);
  json.member("unit", field.unit);
  json.member("restarts", restarts);
  if (field.has_truth_words()) {
    add_words(field.truth_words, json);
  } else if constexpr (std::is_same_v<Value, bool>) {
    json.member("kind", "truth");
  } else if constexpr (std::is_same_v<Value, ContactKinds>) {
    std::vector<const char*> sets;  // with all that they include
    for (std::size_t i = 0; i < words<Value>.size(); ++i) {
      if (const auto kinds = static_cast<Value>(i); with_included(kinds) == kinds)
        sets.push_back(words<Value>[i]);
    }
    add_words(sets, json);
  } else if constexpr (Worded<Value>) {
    add_words(words<Value>, json);
  } else if constexpr (std::is_arithmetic_v<Value>) {
    json.member("kind", is_whole ? "whole" : "number");
    json.member("range", text_of(field.range, is_whole));
  } else {
    json.member("kind", "cube");
    json.member("range", range_of_root_cube);
  }
  json.end_object();
}

template <class Options>
void add_descriptions(JsonText& json) {
  const Options options;
  for_each_leaf(
      [&](const auto& field, const auto&) {
        if (is_setting(field)) add_description(field, false, json);
      },
      options);
}

bool has_bodies(const SceneView& show) {
  return std::any_of(show.objects.begin(), show.objects.end(),
                     [](const ViewedObject& object) { return body_of(object) != nullptr; });
}

/// Without the integrator when nothing is integrated.
void add_settings(Stage& stage, JsonText& json) {
  json.key("settings");
  json.begin_array();
  add_descriptions<SceneOptions>(json);
  add_descriptions<ObjectOctreeOptions>(json);
  if (stage.simulation() != nullptr) {
    for_each_restart_setting([&]<class Struct, class Value>(const Field<Struct, Value>& field, auto) {
      if (!std::is_same_v<Value, Integrator> || has_bodies(stage.show())) add_description(field, true, json);
    });
  }
  json.end_array();
}

void add_options(const Stage& stage, JsonText& json) {
  const SceneView& show = stage.show();
  const SceneOptions& scene = show.simulation.scene;
  const ObjectOctreeOptions octree =
      show.objects.empty() ? ObjectOctreeOptions{} : show.objects.front().options.octree;
  json.member("time_step", show.simulation.time_step);
  json.member("seed", std::to_string(show.simulation.seed));
  add_values(scene, json);
  add_values(octree, json);
  json.key("integrator");
  const auto first_body = std::find_if(show.objects.begin(), show.objects.end(),
                                       [](const ViewedObject& object) { return body_of(object) != nullptr; });
  if (first_body == show.objects.end())
    json.null();
  else
    json.value(word_of(body_of(*first_body)->springs.integrator));
}

void add_abilities(Stage& stage, JsonText& json) {
  json.member("source", stage.recording() ? "recording" : stage.program() ? "program" : "simulation");
  json.key("frames");
  if (RecordingSource* const recording = stage.recording())
    json.value(recording->frame_count());
  else
    json.null();
  const std::vector<std::string> simulation{"play", "reset", "grab", "set"}, recording{"play", "seek", "set"},
      program{"play", "break", "set"};
  json.member("can", std::span<const std::string>(stage.recording() ? recording
                                                  : stage.program() ? program
                                                                    : simulation));
  if (ProgramSource* const source = stage.program()) write_breaks(source->program().state().breaks, json);
}

/// The two recordings that are shown, and where they differ first.
void add_comparison(const Stage& stage, JsonText& json) {
  json.key("comparison");
  const std::optional<Comparison>& comparison = stage.show().comparison;
  if (!comparison) return json.null();
  json.begin_object();
  json.member("names", std::span<const std::string>(comparison->names));
  json.member("objects_of_a", std::uint64_t{comparison->objects_of_a});
  json.key("frame");
  comparison->frame ? json.value(*comparison->frame) : json.null();
  json.member("text", comparison->text);
  json.end_object();
}

void add_column_names(Stage& stage, JsonText& json) {
  json.key("statistics");
  json.begin_array();
  json.value("motion_seconds");
  for_each_statistic({}, [&](const char* name, double) { json.value(name); });
  json.end_array();
  static const std::vector<std::string> none;
  json.member("series",
              std::span<const std::string>(stage.recording() ? stage.show().frames->series().names : none));
}

void add_warnings(Stage& stage, JsonText& json) {
  std::vector<std::string> warnings = warnings_of_meshes(stage.show());
  if (SimulationSource* const simulation = stage.simulation()) {
    if (auto warning = warning_of_long_steps(simulation->simulation()))
      warnings.push_back(std::move(*warning));
  }
  json.member("warnings", std::span<const std::string>(warnings));
}

/// Adds the edges or points of no triangle, in the order in which the scene numbers them; nothing when there
/// are none.
template <class Element>
void add_elements(Tag tag, std::size_t object, const std::vector<Element>& of_mesh,
                  const std::vector<Element>& of_options, MessageWriter& message) {
  const std::size_t count = of_mesh.size() + of_options.size();
  if (count == 0) return;
  const auto sent = message.add<Element>(tag, static_cast<std::uint32_t>(object), count);
  std::copy(of_mesh.begin(), of_mesh.end(), std::copy(of_options.begin(), of_options.end(), sent.begin()));
}

void add_events(Tag begin, Tag end, const Series::Events& events, MessageWriter& message) {
  for (const auto& [tag, list] : {std::pair(begin, &events.begin), std::pair(end, &events.end)}) {
    const auto rows = message.add<std::array<std::uint32_t, 3>>(tag, list->size());
    std::transform(list->begin(), list->end(), rows.begin(), [](const Series::Event& event) {
      return std::array{event.frame, event.a, event.b};
    });
  }
}

}  // namespace

void pack_scene(Stage& stage, SceneNumbers numbers, const std::vector<FieldForm>& fields, JsonText& json,
                MessageWriter& message) {
  const SceneView& show = stage.show();
  json.clear();
  json.begin_object();
  json.member("version", SUPPLE_VERSION);
  json.member("title", show.title);
  json.member("generation", numbers.generation);
  json.member("run", numbers.run);
  add_abilities(stage, json);
  add_place(stage, json);
  add_objects(stage, json);
  add_options(stage, json);
  add_settings(stage, json);
  add_comparison(stage, json);
  write_fields(fields, json);
  add_column_names(stage, json);
  write_pin_values(json);
  add_warnings(stage, json);
  json.end_object();
  message.begin(MessageKind::scene);
  message.add_text(json.text());
  for (std::size_t i = 0; i < show.objects.size(); ++i) {
    const std::vector<Triangle>& triangles = show.objects[i].mesh.triangles;
    const auto sent = message.add<Triangle>(Tag::triangles, static_cast<std::uint32_t>(i), triangles.size());
    std::copy(triangles.begin(), triangles.end(), sent.begin());
    const ViewedObject& object = show.objects[i];
    add_elements<std::array<std::uint32_t, 2>>(Tag::edges, i, object.mesh.edges, object.options.edges,
                                               message);
    add_elements<std::uint32_t>(Tag::points, i, object.mesh.points, object.options.points, message);
  }
}

void pack_series(const Frames& frames, MessageWriter& message) {
  const Series& series = frames.series();
  const std::size_t columns = series.names.size();
  const std::size_t rows = columns == 0 ? 0 : series.values.size() / columns;
  message.begin(MessageKind::series);
  // One row per element, one column per component.
  const auto values = message.add_rows<double>(Tag::series, no_object, rows, columns);
  std::copy_n(series.values.begin(), values.size(), values.begin());
  add_events(Tag::series_contact_begin, Tag::series_contact_end, series.contacts, message);
  add_events(Tag::series_narrow_phase_begin, Tag::series_narrow_phase_end, series.narrow_phase, message);
  add_events(Tag::series_volume_begin, Tag::series_volume_end, series.volumes, message);
}

}  // namespace supple::viewer
