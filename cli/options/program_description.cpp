#include "options/option_groups.hpp"

#include <ranges>
#include <type_traits>

#include "base/json_writer.hpp"
#include "reports/reports.hpp"
#include "session/fields/field_forms.hpp"
#include "session/lists/lists_of_frames.hpp"
#include "session/messages/described_json.hpp"
#include "session/messages/sections.hpp"
#include "session/program/attach_descriptions.hpp"
#include "session/settings.hpp"
#include "supple/format_descriptions.hpp"
#include "supple/record_info.hpp"
#include "supple/simulation_descriptions.hpp"
#include "view_file/view_members.hpp"

namespace supple::cli {
namespace {

void write_commands(JsonWriter& json, const CLI::App& program) {
  const auto is_documented = [](const CLI::Option* option) {
    return option->get_positional() || !option->get_group().empty();
  };
  const auto commands = program.get_subcommands([](const CLI::App*) { return true; });
  json.objects("commands", commands, [&](const CLI::App* command) {
    json.member("name", command->get_name());
    json.member("doc", command->get_description());
    json.member("footer", command->get_footer());
    const auto options = command->get_options();
    json.objects("options", options | std::views::filter(is_documented), [&](const CLI::Option* option) {
      json.member("is_input", option->get_positional());
      json.member("name", option->get_name(option->get_positional(), true));
      json.member("value", option->get_expected_max() == 0 ? "" : option->get_type_name());
      json.member("doc", option->get_description());
    });
  });
}

/// The type of a member in a recording.
template <class Value>
const char* stored_type(bool has_words) {
  if (std::is_same_v<Value, double>) return "float64";
  if (std::is_same_v<Value, std::uint64_t>) return "uint64";
  if (std::is_same_v<Value, std::uint32_t>) return "uint32";
  if (std::is_same_v<Value, bool> && !has_words) return "uint8";
  if (std::is_same_v<Value, std::optional<RootCube>>) return "float64, 4";
  return "text";
}

/// What a value must be, in words; empty when it has words.
template <class Struct, class Value>
std::string range_of(const Field<Struct, Value>& field) {
  if constexpr (Worded<Value>) return "";
  if constexpr (std::is_same_v<Value, bool>) return field.has_truth_words() ? "" : "`true`, `false`";
  if constexpr (std::is_same_v<Value, std::string>) return "text";
  if constexpr (std::is_same_v<Value, Vec3d>) return "three finite numbers";
  if constexpr (std::is_same_v<Value, std::optional<RootCube>>) return range_of_root_cube;
  ValueRange range = field.range;
  range.includes_infinity = false;  // infinity is written as none
  return text_of(range, !std::is_same_v<Value, double>);
}

template <class Value>
constexpr bool is_optional =
    std::is_same_v<Value, std::optional<std::uint64_t>> || std::is_same_v<Value, std::optional<RootCube>>;

template <class Struct, class Value>
void write_member(JsonWriter& json, const Field<Struct, Value>& field, const Value& value) {
  if constexpr (Worded<Value> || std::is_arithmetic_v<Value> || std::is_same_v<Value, std::string> ||
                std::is_same_v<Value, Vec3d> || is_optional<Value>) {
    json.begin_object();
    json.member("key", field.key);
    json.member("unit", field.unit);
    json.member("doc", field.doc);
    json.member("type", stored_type<Value>(field.has_truth_words()));
    json.member("is_of_machine", field.is_of_machine);
    json.member("is_setting", viewer::is_setting(field));
    json.member("is_word", Worded<Value>);
    json.member("is_set", WordedSet<Value>);
    if constexpr (WordedSet<Value>)
      json.list("words", set_words<Value>);
    else if constexpr (Worded<Value>)
      json.list("words", words<Value>);
    else if (field.has_truth_words())
      json.list("words", field.truth_words);
    json.member("range", range_of(field));
    json.key("default");
    if constexpr (is_optional<Value>)
      json.null();
    else
      viewer::write_value(json, field, value);
    json.end_object();
  }
}

template <class... Structs>
void write_structures(JsonWriter& json) {
  const auto write = [&]<class Struct>(const Struct& defaults) {
    json.key(Description<Struct>::name);
    json.begin_array();
    for_each_leaf([&](const auto& field, const auto& value) { write_member(json, field, value); }, defaults);
    json.end_array();
  };
  json.object("structures", [&] { (write(Structs{}), ...); });
}

void write_lists(JsonWriter& json) {
  json.objects("lists", list_infos(), [&](const ListInfo& list) {
    json.member("name", list.name);
    json.member("doc", list.doc);
    json.member("has_record", *list.record.name != 0);
    json.objects("fields", list.record.fields, [&](const FieldInfo& field) {
      json.member("name", field.name);
      json.member("doc", field.doc);
      json.member("unit", field.unit);
      json.member("kind", static_cast<std::uint32_t>(field.kind));
      json.member("scalar", static_cast<std::uint32_t>(field.scalar));
      json.member("count", std::uint64_t{field.count});
      json.list("words", field.words);
      json.member("names", static_cast<std::uint32_t>(field.role.names));
      json.member("side", std::string(field.role.side == 0 ? 0 : 1, field.role.side));
      json.member("list", field.role.list);
    });
  });
  const auto kinds = std::views::iota(std::size_t{1}, set_words<ContactKinds>.size());
  json.objects("csv", kinds, [&](std::size_t i) {
    const auto kind = static_cast<ContactKinds>(1u << (i - 1));
    json.member("kind", set_words<ContactKinds>[i]);
    json.list("columns", csv_columns(kind, false));
    json.list("with_details", csv_columns(kind, true));
  });
}

/// The messages, the fields and the view files of the viewer.
void write_viewer(JsonWriter& json) {
  json.list("message_kinds", viewer::names_of_message_kinds);
  json.objects("sections", viewer::section_forms, [&](const viewer::SectionForm& form) {
    json.member("tag", static_cast<std::uint32_t>(form.tag));
    json.member("name", form.name);
    json.member("scalar", viewer::names_of_scalars[static_cast<std::size_t>(form.scalar)]);
    json.member("width", form.width);
    json.list("kinds", viewer::kinds_of(form));
    json.member("is_of_object", form.is_of_object);
    json.member("element", form.element);
    json.member("when", form.when);
  });
  viewer::describe_lists_of_frames(json);
  json.objects("fields", viewer::built_in_fields(), [&](const viewer::FieldForm& form) {
    json.member("key", form.key);
    json.member("of", word_of(form.element));
    json.member("list", form.list);
    json.member("is_vector", form.is_vector);
    json.member("unit", form.unit);
    json.member("doc", form.doc);
  });
  json.objects("view_members", viewer::view_members, [&](const viewer::ViewMember& member) {
    json.member("path", member.path);
    json.member("kind", static_cast<std::uint32_t>(member.kind));
    json.member("range", viewer::text_of(member));
    json.member("low", member.range.lowest);
    json.member("high", member.range.highest);
    json.member("above", member.range.excludes_lowest);
    json.member("words", member.words);
    json.member("doc", member.doc);
  });
}

}  // namespace

void describe_program(const CLI::App& program) {
  JsonWriter json("-");
  json.member("doc", program.get_description());
  json.member("footer", program.get_footer());
  write_commands(json, program);
  write_structures<SceneOptions, ObjectOptions, ObjectOctreeOptions, CoordinateConversion, SimulationOptions,
                   WaveMotion, MassSpringMotion, RigidMotion, ContactResponse, StepStats>(json);
  write_lists(json);
  write_viewer(json);
  json.close();
}

}  // namespace supple::cli
