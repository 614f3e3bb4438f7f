#include "description_tables.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

#include "session/settings.hpp"
#include "supple/format_descriptions.hpp"
#include "supple/result_descriptions.hpp"
#include "supple/simulation_descriptions.hpp"

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

template <class Struct>
void attribute_table(const char* name) {
  table(name, "| Attribute | Type |", [] {
    for_each_row<Struct>(
        [](const auto& field, const auto&) { fmt::print("| `{}` | {} |\n", field.key, stored_type(field)); });
  });
}

void statistics_tables() {
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
  table("json_stats", "| Key | Unit | Meaning |", [&] {
    for_each_leaf([&](const auto& field,
                      const auto&) { fmt::print("| `{}` | {} | {} |\n", field.key, field.unit, field.doc); },
                  stats);
  });
}

template <class... Records>
void record_table(const char* name) {
  table(name, "| Record | Key | Unit | Meaning |", [] {
    const auto rows = []<class Record>(const Record&) {
      for_each_field<Record>([](const auto& field) {
        fmt::print("| {} | `{}` | {} | {} |\n", Description<Record>::name, field.key, field.unit, field.doc);
      });
    };
    (rows(Records{}), ...);
  });
}

}  // namespace

void print_description_tables() {
  attribute_table<SceneOptions>("recording_scene_options");
  attribute_table<ObjectOptions>("recording_object_options");
  statistics_tables();
  record_table<Manifold, ManifoldPoint>("json_manifolds");
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
