#include "options/description_tables.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "reports/csv_report.hpp"
#include "session/fields/field_forms.hpp"
#include "session/messages/sections.hpp"
#include "session/program/attach_descriptions.hpp"
#include "session/settings.hpp"
#include "supple/format_descriptions.hpp"
#include "supple/record_info.hpp"
#include "supple/simulation_descriptions.hpp"
#include "view_file/view_members.hpp"

namespace supple::cli {
namespace {

std::string code(const std::string& text) {
  return text.empty() ? "" : fmt::format("`{}`", text);
}

template <class Struct, class Value>
std::string allowed_values(const Field<Struct, Value>& field) {
  if constexpr (WordedSet<Value>) {
    return fmt::format("`{}`; several with commas between them", fmt::join(set_words<Value>, "`, `"));
  } else if constexpr (Worded<Value>) {
    return code(list_of_words<Value>("`, `"));
  } else if constexpr (std::is_same_v<Value, bool>) {
    if (field.has_truth_words()) return fmt::format("`{}`, `{}`", field.truth_words[0], field.truth_words[1]);
    return "`true`, `false`";
  } else if constexpr (std::is_same_v<Value, std::string>) {
    return "text";
  } else if constexpr (std::is_same_v<Value, Vec3d>) {
    return "three finite numbers";
  } else if constexpr (std::is_same_v<Value, std::optional<std::uint64_t>>) {
    return text_of(field.range, true);
  } else if constexpr (std::is_same_v<Value, std::optional<RootCube>>) {
    return range_of_root_cube;
  } else {
    ValueRange range = field.range;
    range.includes_infinity = false;  // infinity is written as none
    return text_of(range, std::is_integral_v<Value>);
  }
}

template <class Struct, class Value>
std::string default_value(const Field<Struct, Value>& field, const Value& value) {
  if constexpr (Worded<Value>) {
    return code(word_of(value));
  } else if constexpr (std::is_same_v<Value, bool>) {
    if (field.has_truth_words()) return code(field.truth_words[value ? 1 : 0]);
    return value ? "`true`" : "`false`";
  } else if constexpr (std::is_same_v<Value, std::string>) {
    return "";
  } else if constexpr (std::is_same_v<Value, Vec3d>) {
    return fmt::format("[{}, {}, {}]", value.x, value.y, value.z);
  } else if constexpr (std::is_same_v<Value, std::optional<std::uint64_t>> ||
                       std::is_same_v<Value, std::optional<RootCube>>) {
    return "none";
  } else {
    return std::isinf(static_cast<double>(value)) ? "none" : fmt::format("{}", value);
  }
}

/// The type of a field in a recording.
template <class Struct, class Value>
const char* stored_type(const Field<Struct, Value>& field) {
  if (std::is_same_v<Value, double>) return "float64";
  if (std::is_same_v<Value, std::uint64_t>) return "uint64";
  if (std::is_same_v<Value, std::uint32_t>) return "uint32";
  if (std::is_same_v<Value, bool> && !field.has_truth_words()) return "uint8";
  if (std::is_same_v<Value, std::optional<RootCube>>) return "float64, 4";
  return "text";
}

template <class Value>
constexpr bool is_in_tables =
    Worded<Value> || std::is_arithmetic_v<Value> || std::is_same_v<Value, std::string> ||
    std::is_same_v<Value, Vec3d> || std::is_same_v<Value, std::optional<std::uint64_t>> ||
    std::is_same_v<Value, std::optional<RootCube>>;

/// Calls `row(field, default_value)` for each option of a structure, except those of the machine.
template <class Struct, class Row>
void for_each_row(Row row) {
  const Struct defaults{};
  for_each_leaf(
      [&](const auto& field, const auto& value) {
        if constexpr (is_in_tables<std::remove_cvref_t<decltype(value)>>) {
          if (!field.is_of_machine) row(field, value);
        }
      },
      defaults);
}

template <class Print>
void table(const char* name, const char* header, Print print) {
  std::string rule;
  for (const char c : std::string_view(header)) {
    if (c == '|') rule += rule.empty() ? "|" : "---|";
  }
  fmt::print("<!-- begin {} -->\n{}\n{}\n", name, header, rule);
  print();
  fmt::print("<!-- end {} -->\n", name);
}

void print_option(const auto& field, const auto& value) {
  fmt::print("| `{}` | {} | {} | {} | {} |\n", field.key, default_value(field, value), field.unit,
             allowed_values(field), field.doc);
}
constexpr const char* option_header = "| Key | Default | Unit | Allowed | Meaning |";

template <class... Structs>
void option_table(const char* name) {
  table(name, option_header, [] {
    (for_each_row<Structs>([](const auto& field, const auto& value) { print_option(field, value); }), ...);
  });
}

/// The attributes of each type, in the order of the types' first attributes.
template <class Struct>
void attribute_table(const char* name) {
  table(name, "| Attributes | Type |", [] {
    std::vector<std::pair<std::string, std::string>> names_by_type;
    for_each_row<Struct>([&](const auto& field, const auto&) {
      const std::string type = stored_type(field);
      const auto known = std::ranges::find(names_by_type, type, &std::pair<std::string, std::string>::second);
      if (known == names_by_type.end())
        names_by_type.emplace_back(code(field.key), type);
      else
        known->first += ", " + code(field.key);
    });
    for (const auto& [names, type] : names_by_type) fmt::print("| {} | {} |\n", names, type);
  });
}

void statistics_table() {
  const StepStats stats;
  table("recording_statistics", "| Dataset | Shape | Type | Unit | Meaning |", [&] {
    for_each_leaf(
        [&](const auto& field, const auto& value) {
          using Value = std::remove_cvref_t<decltype(value)>;
          std::string doc = field.doc;
          if constexpr (Worded<Value>) {
            for (std::size_t i = 0; i < words<Value>.size(); ++i)
              doc += fmt::format("{} {} {}", i == 0 ? ":" : ",", i, words<Value>[i]);
          }
          fmt::print("| `statistics/{}` | (F) | {} | {} | {} |\n", field.key,
                     Worded<Value> ? "uint8" : stored_type(field), field.unit, doc);
        },
        stats);
  });
}

const char* unit_of(const Role& role, const char* unit) {
  switch (role.names) {
    case Names::object:
      return "objects";
    case Names::triangle:
      return "triangles";
    case Names::vertex:
      return "vertices";
    case Names::element:
      return "vertices or triangles";
    case Names::rows:
      return role.side == 0 ? "rows" : "vertices";
    case Names::first_row:
      return "rows";
    default:
      return unit;
  }
}

/// A row of the table of datasets, which several datasets of the same form share.
struct Datasets {
  std::vector<std::string> names;
  const FieldInfo* field;
  std::string doc;
};

void print_datasets(const char* group, const Datasets& row) {
  constexpr const char* types[] = {"uint8", "uint8", "uint32", "uint64", "float64"};  // by `ScalarType`
  const FieldInfo& field = *row.field;
  const bool is_single = field.count == 1 || field.kind != FieldInfo::Kind::numbers;
  fmt::print("| `{}/{}` | {} | {} | {} | {} |\n", group, fmt::join(row.names, "`, `"),
             is_single ? "(rows)" : fmt::format("(rows, {})", field.count),
             types[static_cast<std::size_t>(field.scalar)], unit_of(field.role, field.unit), row.doc);
}

/// Whether `next` is the same of object b as `row` of object a: only letters a are b.
bool is_other_side(const Datasets& row, const Datasets& next) {
  const auto is_same_or_b = [](char a, char b) { return a == b || (a == 'a' && b == 'b'); };
  return row.names[0].ends_with("_a") && next.names[0].ends_with("_b") &&
         std::ranges::equal(row.doc, next.doc, is_same_or_b);
}

/// The datasets of a member of a record; a feature has two.
Datasets datasets_of(const FieldInfo& field) {
  const Role& role = field.role;
  std::string name = field.name, doc = field.doc;
  if (role.names == Names::object) name = std::string("object_") + role.side;
  if (role.names == Names::first_row)
    doc += fmt::format(": a row of `{}`, from the first one of the frame", role.list);
  if (role.names == Names::element) doc += ": v v for a vertex, the two vertices for an edge, t t for a face";
  if (role.names == Names::weights) doc += ": 1 0 0 for a vertex, 1−s s 0 for an edge, three for a face";
  std::vector<std::string> names{name};
  if (field.kind == FieldInfo::Kind::feature) {
    doc +=
        ": 0 vertex, 1 edge, 2 face; the index is that of the corner, or of the corner where the edge starts";
    names.push_back(name.insert(std::string_view("feature").size(), "_index"));
  } else {
    for (std::size_t i = 0; i < field.words.size(); ++i)
      doc += fmt::format("{} {} {}", i == 0 ? ":" : ",", i, field.words[i]);
  }
  if (field.scalar == ScalarType::boolean) doc += ": 0 no, 1 yes";
  return {names, &field, doc};
}

/// Whether a column is object a or b of its row and nothing more: the row of the list names it then.
bool is_plain_object(const FieldInfo& field) {
  const std::string_view doc = field.doc;
  return field.role.names == Names::object && (doc.starts_with("Object a") || doc.starts_with("Object b"));
}

void lists_table() {
  table("recording_lists", "| Dataset | Shape | Type | Unit | Meaning |", [] {
    for (const ListInfo& list : list_infos()) {
      std::string names = fmt::format("`{}/end`", list.name);
      std::vector<Datasets> rows;
      for (const FieldInfo& field : list.record.fields) {
        if (is_plain_object(field)) {
          names += fmt::format(", `object_{}`", field.role.side);
          continue;
        }
        Datasets row = *list.record.name == 0 ? Datasets{{field.name}, &field, ""} : datasets_of(field);
        if (rows.empty() || !is_other_side(rows.back(), row)) {
          rows.push_back(std::move(row));
          continue;
        }
        rows.back().names.insert(rows.back().names.end(), row.names.begin(), row.names.end());
        rows.back().doc += "; b likewise";
      }
      fmt::print("| {} | | | | a row is: {} |\n", names, list.doc);
      for (const Datasets& row : rows) print_datasets(list.name, row);
    }
  });
}

constexpr const char* scalars_of_sections[] = {"u8", "u32", "f32", "f64"};
constexpr const char* arrays_of_sections[] = {"Uint8Array", "Uint32Array", "Float32Array", "Float64Array"};

std::vector<std::string> kinds_of(const viewer::SectionForm& form, std::string_view quote) {
  std::vector<std::string> kinds;
  for (std::size_t kind = 1; kind < std::size(viewer::names_of_message_kinds); ++kind) {
    if ((form.kinds >> kind & 1) != 0)
      kinds.push_back(fmt::format("{0}{1}{0}", quote, viewer::names_of_message_kinds[kind]));
  }
  return kinds;
}

void sections_table() {
  table("protocol_sections", "| tag | name | element | in |", [] {
    for (const viewer::SectionForm& form : viewer::section_forms) {
      const std::string width = form.width == 1   ? ""
                                : form.width == 0 ? " × names"
                                                  : fmt::format(" × {}", form.width);
      fmt::print("| {} | `{}` | {}{}: {} | {}{}{}{} |\n", static_cast<std::uint32_t>(form.tag), form.name,
                 scalars_of_sections[static_cast<std::size_t>(form.scalar)], width, form.element,
                 fmt::join(kinds_of(form, ""), ", "), form.is_of_object ? "; one per object" : "",
                 *form.when == 0 ? "" : "; ", form.when);
    }
  });
}

void fields_table() {
  table("protocol_fields", "| Key | Of each | Unit | Meaning |", [] {
    for (const viewer::FieldForm& form : viewer::built_in_fields()) {
      const std::string of =
          form.section.empty() ? word_of(form.element) : fmt::format("contact, in `{}`", form.section);
      fmt::print("| `{}` | {}{} | {} | {} |\n", form.key, of, form.is_vector ? ", a vector" : "", form.unit,
                 form.doc);
    }
  });
}

constexpr const char* kinds_of_view_values[] = {"number", "whole", "truth", "word",     "colour",
                                                "text",   "key",   "point", "interval", "objects"};

void view_table() {
  table("view_members", "| Member | Value | Meaning |", [] {
    for (const viewer::ViewMember& member : viewer::view_members)
      fmt::print("| `{}` | {} | {} |\n", member.path, viewer::text_of(member), member.doc);
  });
}

void csv_table() {
  table("json_csv", "| Contacts | Columns | With `--contact-details` also |", [] {
    for (std::size_t i = 1; i < set_words<ContactKinds>.size(); ++i) {
      const auto kind = static_cast<ContactKinds>(1u << (i - 1));
      const std::vector<std::string> columns = csv_columns(kind, false);
      std::vector<std::string> details = csv_columns(kind, true);
      std::erase_if(details, [&](const std::string& name) {
        return std::ranges::find(columns, name) != columns.end();
      });
      fmt::print("| {} | `{}` | `{}` |\n", set_words<ContactKinds>[i], fmt::join(columns, ","),
                 fmt::join(details, ","));
    }
  });
}

}  // namespace

void print_sections() {
  fmt::print(
      "// `make docs` writes this file from viewer/session/messages/sections.hpp.\n\n"
      "export interface Form {{\n  name: string;\n"
      "  array: Uint8ArrayConstructor | Uint32ArrayConstructor | Float32ArrayConstructor | "
      "Float64ArrayConstructor;\n"
      "  /** Numbers per element; 0 when the scene determines it. */\n  width: number;\n"
      "  kinds: readonly string[];\n  perObject: boolean;\n}}\n\n");
  std::vector<std::string> kinds;
  for (const char* name : viewer::names_of_message_kinds) kinds.push_back(fmt::format("\"{}\"", name));
  fmt::print("export const KINDS = [{}] as const;\n\nexport const FORMS = {{\n", fmt::join(kinds, ", "));
  for (const viewer::SectionForm& form : viewer::section_forms)
    fmt::print("  {}: {{ name: \"{}\", array: {}, width: {}, kinds: [{}], perObject: {} }},\n",
               static_cast<std::uint32_t>(form.tag), form.name,
               arrays_of_sections[static_cast<std::size_t>(form.scalar)], form.width,
               fmt::join(kinds_of(form, "\""), ", "), form.is_of_object);
  fmt::print("}} as const satisfies Record<number, Form>;\n");
}

void print_view_members() {
  fmt::print(
      "// `make docs` writes this file from viewer/view_file/view_members.hpp.\n\n"
      "export interface ViewMember {{\n  path: string;\n"
      "  kind: \"number\" | \"whole\" | \"truth\" | \"word\" | \"colour\" | \"text\" | \"key\" | \"point\" | "
      "\"interval\" | "
      "\"objects\";\n"
      "  /** What a value must be, in words. */\n  range: string;\n"
      "  /** Of numbers; `above` excludes the lowest number. */\n  low: number;\n  high: number;\n  above: "
      "boolean;\n"
      "  words: readonly string[];\n}}\n\nexport const VIEW_MEMBERS: readonly ViewMember[] = [\n");
  const auto number = [](double x) {
    return std::isfinite(x) ? fmt::format("{}", x) : x < 0 ? "-Infinity" : "Infinity";
  };
  // `"off", "x"` of `off x`.
  const auto quoted = [](std::string_view words) {
    std::string list;
    for (const char c : words) list += c == ' ' ? std::string("\", \"") : std::string(1, c);
    return list.empty() ? list : fmt::format("\"{}\"", list);
  };
  for (const viewer::ViewMember& member : viewer::view_members)
    fmt::print(
        "  {{ path: \"{}\", kind: \"{}\", range: \"{}\", low: {}, high: {}, above: {}, words: [{}] }},\n",
        member.path, kinds_of_view_values[static_cast<std::size_t>(member.kind)], viewer::text_of(member),
        number(member.range.lowest), number(member.range.highest), member.range.excludes_lowest,
        quoted(member.words));
  fmt::print("];\n");
}

std::vector<std::string> keys_of_tables() {
  std::vector<std::string> keys;
  const auto add = [&](const auto& field, const auto&) { keys.emplace_back(field.key); };
  for_each_row<SceneOptions>(add);
  for_each_row<ObjectOptions>(add);
  return keys;
}

void print_description_tables() {
  attribute_table<SceneOptions>("recording_scene_options");
  attribute_table<ObjectOptions>("recording_object_options");
  lists_table();
  sections_table();
  view_table();
  fields_table();
  statistics_table();
  csv_table();
  option_table<ObjectOptions>("scene_object_options");
  option_table<CoordinateConversion>("scene_coordinate_options");
  table("scene_simulation_options", option_header, [] {
    const SimulationOptions defaults;
    for_each_field<SimulationOptions>([&]<class Value>(const Field<SimulationOptions, Value>& field) {
      if constexpr (is_in_tables<Value>) print_option(field, defaults.*field.member);
    });
  });
  option_table<SceneOptions>("scene_detection_options");
  option_table<WaveMotion>("scene_wave_options");
  option_table<MassSpringMotion>("scene_mass_spring_options");
  option_table<RigidMotion>("scene_rigid_options");
  table("scene_response_options", option_header, [] {
    for_each_row<ContactResponse>([](const auto& field, const auto& value) { print_option(field, value); });
  });
  table("protocol_settings", "| Key | Default |", [] {
    const auto row = [](const auto& field, const auto& value) {
      if (viewer::is_setting(field)) fmt::print("| `{}` | {} |\n", field.key, default_value(field, value));
    };
    for_each_row<SceneOptions>(row);
    for_each_row<ObjectOctreeOptions>(row);
  });
}

}  // namespace supple::cli
