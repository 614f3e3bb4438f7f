#pragma once

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "supple/description.hpp"

namespace supple::cli {

/// `--scene-octree-arity` for the key `scene_octree_arity`.
std::string flag_of(const char* key);

/// The word for a choice on the command line, with dashes. Both spellings are accepted.
std::string spelled(const char* word);
bool is_word(const std::string& given, const char* word);

/// Nothing unless the whole text is a finite number.
std::optional<double> parse_number(std::string_view text);
/// The numbers of a text such as `1,-2.5,3`; nothing when one is no finite number or their count differs.
template <std::size_t Count>
std::optional<std::array<double, Count>> parse_numbers(std::string_view text) {
  std::array<double, Count> numbers{};
  for (std::size_t i = 0; i < Count; ++i) {
    const std::size_t end = i + 1 < Count ? text.find(',') : text.size();
    const auto number = end <= text.size() ? parse_number(text.substr(0, end)) : std::nullopt;
    if (!number) return std::nullopt;
    numbers[i] = *number;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return numbers;
}

/// An option whose value is one of some words; `set` gets the index of the word.
CLI::Option* add_words(CLI::App& app, const std::string& name, std::vector<const char*> choices,
                       std::function<void(std::size_t)> set, const std::string& description);
/// Options for a whole number and for a real number in a range.
CLI::Option* add_whole(CLI::App& app, const std::string& name, const ValueRange& range,
                       std::function<void(std::uint64_t)> set, const std::string& description);
CLI::Option* add_real(CLI::App& app, const std::string& name, const ValueRange& range, const char* unit,
                      std::function<void(double)> set, const std::string& description);
template <class Number>
CLI::Option* add_real(CLI::App& app, const std::string& name, const ValueRange& range, const char* unit,
                      Number& value,
                      const std::string& description) requires std::is_assignable_v<Number&, double> {
  return add_real(
      app, name, range, unit, [&value](double given) { value = given; }, description);
}

/// An option with a list of values: given several times, or once with commas. `add` gets each value; a value
/// that is given twice is an error.
CLI::Option* add_list(CLI::App& app, const std::string& name, std::function<void(const std::string&)> add,
                      const std::string& description);

/// The index of the given word; throws a usage error of the option `name` when it is not one of the choices.
std::size_t index_of_word(const std::string& name, const std::vector<const char*>& choices,
                          const std::string& given);
/// The given number; throws a usage error of the option `name` when the range does not allow it.
std::uint64_t whole_of(const std::string& name, const ValueRange& range, const std::string& given);
double real_of(const std::string& name, const ValueRange& range, const std::string& given);

/// The value of an option as the command line has it.
template <class Struct, class Value>
std::string spelled_value(const Field<Struct, Value>& field, const Value& value) {
  if constexpr (Worded<Value>) {
    return spelled(word_of(value));
  } else if constexpr (std::is_same_v<Value, bool>) {
    return field.has_truth_words() ? spelled(field.truth_words[value ? 1 : 0]) : value ? "true" : "false";
  } else {
    return fmt::format("{}", value);
  }
}

/// An option of a structure, made from its description. `set` gets the value. A truth value without words
/// becomes a flag that negates the default.
template <class Struct, class Value, class Set>
CLI::Option* add_field(CLI::App& app, const Field<Struct, Value>& field, const Value& default_value,
                       Set set) {
  const std::string name = flag_of(field.key);
  // `Shape of the octree (triangles; default: 64)`
  const std::string help = fmt::format("{} ({}{}default: {})", field.doc, field.unit, *field.unit ? "; " : "",
                                       spelled_value(field, default_value));
  if constexpr (WordedSet<Value>) {
    const auto parse = [name, set](const std::string& given) {
      const std::optional<Value> value = value_of_set<Value>(given);
      if (!value)
        throw CLI::ValidationError(name, fmt::format("'{}' is not {}", given, list_of_set_words<Value>()));
      set(*value);
    };
    return app.add_option_function<std::string>(name, parse, help)
        ->type_name(fmt::format("{}", fmt::join(set_words<Value>, "|")));
  } else if constexpr (Worded<Value>) {
    return add_words(
        app, name, {words<Value>.begin(), words<Value>.end()},
        [set](std::size_t place) { set(static_cast<Value>(place)); }, help);
  } else if constexpr (std::is_same_v<Value, bool>) {
    if (field.has_truth_words())
      return add_words(
          app, name, {field.truth_words.begin(), field.truth_words.end()},
          [set](std::size_t place) { set(place == 1); }, help);
    if (!default_value)
      return app.add_flag_callback(
          name, [set] { set(true); }, field.doc);
    std::string negated = std::string("Do not ") + field.doc;
    negated[7] = static_cast<char>(std::tolower(static_cast<unsigned char>(negated[7])));
    return app.add_flag_callback(
        "--no-" + name.substr(2), [set] { set(false); }, negated);
  } else if constexpr (std::is_same_v<Value, double>) {
    return add_real(app, name, field.range, field.unit, set, help);
  } else {
    ValueRange range = field.range;
    range.highest = std::min(range.highest, static_cast<double>(std::numeric_limits<Value>::max()));
    return add_whole(
        app, name, range, [set](std::uint64_t value) { set(static_cast<Value>(value)); }, help);
  }
}

/// A whole number from `lowest` to `highest`.
template <class Number>
CLI::Option* add_number(CLI::App& app, const std::string& name, Number& value, std::uint32_t lowest,
                        std::uint32_t highest, const std::string& description) {
  return add_whole(
      app, name, ValueRange::from(lowest, highest),
      [&value](std::uint64_t number) { value = static_cast<std::uint32_t>(number); }, description);
}

/// A file to write; `-` is standard output.
CLI::Option* add_file(CLI::App& app, const std::string& name, std::string& value,
                      const std::string& description);

/// An option that has an effect only with a certain value of another option.
struct Dependence {
  const CLI::Option* option;
  std::function<bool()> satisfied;
  std::string needs;
};
using Dependences = std::vector<Dependence>;

/// Adds options to one heading of the help, each with what it needs, if anything.
struct Heading {
  const char* name;
  Dependences& dependences;

  CLI::Option* operator()(CLI::Option* option, const std::function<bool()>& satisfied = {},
                          const char* needs = "") const {
    if (satisfied) dependences.push_back({option, satisfied, needs});
    return option->group(name);
  }
};

/// Throws a usage error for the first given option whose dependence is not satisfied.
void check(const Dependences& dependences);

/// Adds the flag of the root of the scene octree. The word `border` needs the scene, which is read later.
CLI::Option* add_root(CLI::App& app, const char* key, bool& root_is_border,
                      std::function<void(const RootCube&)> set);

}  // namespace supple::cli
