#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

#include "supple/comparison_options.hpp"
#include "supple/types.hpp"

// Descriptions of options and statistics: name, words, unit, range and one sentence for each member. The
// command line, scene files, recordings, JSON, the viewer and the documents are made from these descriptions.
// `option_descriptions.hpp` and `result_descriptions.hpp` have the descriptions of the core.

namespace supple {

/// The words for the values of an enumeration, in the order of the values from 0 on.
template <class Enum>
inline constexpr std::array<const char*, 0> words{};

/// An enumeration whose values have words.
template <class Enum>
concept Worded = std::is_enum_v<Enum> &&(words<Enum>.size() > 0);

/// The word of a value; null when the value is not in the enumeration.
template <Worded Enum>
constexpr const char* word_of(Enum value) {
  const auto index = static_cast<std::size_t>(value);
  return index < words<Enum>.size() ? words<Enum>[index] : nullptr;
}

/// The value of a word; nothing when no value has this word.
template <Worded Enum>
constexpr std::optional<Enum> value_of_word(std::string_view word) {
  for (std::size_t i = 0; i < words<Enum>.size(); ++i) {
    if (word == words<Enum>[i]) return static_cast<Enum>(i);
  }
  return std::nullopt;
}

/// All words of an enumeration in one text, such as `aabb, sphere`.
template <Worded Enum>
std::string list_of_words(std::string_view separator = ", ") {
  std::string list;
  for (const char* word : words<Enum>) {
    if (!list.empty()) list += separator;
    list += word;
  }
  return list;
}

/// For an enumeration whose values are sets: the word for the empty set, then the words for single members,
/// in the order of their bits. Users write several members with commas between them, in any order.
template <class Enum>
inline constexpr std::array<const char*, 0> set_words{};

namespace detail {

/// The texts of all sets with the words of their members, by value.
template <class Enum>
constexpr auto texts_of_sets() {
  constexpr auto members = set_words<Enum>.size() - 1;
  std::array<std::array<char, 128>, std::size_t{1} << members> texts{};
  for (std::size_t set = 0; set < texts.size(); ++set) {
    std::size_t end = 0;
    for (std::size_t word = set == 0 ? 0 : 1; word <= (set == 0 ? 0 : members); ++word) {
      if (set != 0 && (set >> (word - 1) & 1) == 0) continue;
      if (end > 0) texts[set][end++] = ',';
      for (const char letter : std::string_view(set_words<Enum>[word])) texts[set][end++] = letter;
    }
  }
  return texts;
}
template <class Enum>
inline constexpr auto texts = texts_of_sets<Enum>();

template <class Enum>
constexpr auto words_of_sets() {
  std::array<const char*, texts<Enum>.size()> words{};
  for (std::size_t set = 0; set < words.size(); ++set) words[set] = texts<Enum>[set].data();
  return words;
}

}  // namespace detail

/// An enumeration whose values are sets of members that have words.
template <class Enum>
concept WordedSet = Worded<Enum> &&(set_words<Enum>.size() > 0);

/// The set of a text such as `b,a`; nothing when a part of it is not a word, or the word for the empty set is
/// not alone.
template <WordedSet Enum>
constexpr std::optional<Enum> value_of_set(std::string_view text) {
  if (text == set_words<Enum>[0]) return Enum{};
  unsigned bits = 0;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    std::size_t member = 1;
    while (member < set_words<Enum>.size() && text.substr(begin, end - begin) != set_words<Enum>[member])
      ++member;
    if (member == set_words<Enum>.size()) return std::nullopt;
    bits |= 1u << (member - 1);
    begin = end + 1;
  }
  return static_cast<Enum>(bits);
}

/// `none, or one or more of a, b, with commas`
template <WordedSet Enum>
std::string list_of_set_words() {
  std::string list = set_words<Enum>[0];
  list += ", or one or more of ";
  for (std::size_t i = 1; i < set_words<Enum>.size(); ++i) {
    list += set_words<Enum>[i];
    list += ", ";
  }
  return list + "with commas";
}

/// The values that a number may have.
struct ValueRange {
  double lowest = -std::numeric_limits<double>::infinity();
  double highest = std::numeric_limits<double>::infinity();
  bool excludes_lowest = false;
  bool includes_infinity = false;  ///< also allows positive infinity, which means "none"
  bool powers_of_two = false;      ///< of whole numbers, allows only powers of two
  bool includes_zero = false;      ///< also allows 0 below the lowest value; it means "chosen automatically"

  constexpr bool allows(double value) const {
    if (value == std::numeric_limits<double>::infinity()) return includes_infinity;
    if (value == 0 && includes_zero) return true;
    return value >= lowest && value <= highest && value > -std::numeric_limits<double>::infinity() &&
           !(excludes_lowest && value == lowest);
  }
  template <std::unsigned_integral Whole>
  constexpr bool allows(Whole value) const {
    return allows(static_cast<double>(value)) && !(powers_of_two && (value & (value - 1)) != 0);
  }
  /// The finite values from `lowest` on, from `lowest` to `highest`, or above `lowest`.
  static constexpr ValueRange from(double lowest) { return {.lowest = lowest}; }
  static constexpr ValueRange from(double lowest, double highest) { return {lowest, highest}; }
  static constexpr ValueRange above(double lowest) { return {.lowest = lowest, .excludes_lowest = true}; }
  constexpr ValueRange or_infinity() const {
    ValueRange range = *this;
    range.includes_infinity = true;
    return range;
  }
  constexpr ValueRange or_zero() const {
    ValueRange range = *this;
    range.includes_zero = true;
    return range;
  }
  constexpr ValueRange only_powers_of_two() const {
    ValueRange range = *this;
    range.powers_of_two = true;
    return range;
  }
};

/// The range in words: `a whole number from 0 to 32`, `a finite number above 0`, `2, 4 or 8`.
std::string text_of(const ValueRange& range, bool is_whole);

/// What a number of a record means.
enum class Names : std::uint8_t {
  nothing,    ///< a value
  object,     ///< an object, the one of this side
  triangle,   ///< a triangle of the object of this side, by the user's number
  vertex,     ///< a vertex of this object
  element,    ///< {v, v} for a vertex, {v, w} for an edge, {t, t} for a face of this object
  weights,    ///< barycentric coordinates in the element of this side
  rows,       ///< a number of rows of `list`, which are vertices of this object if there is a side; without a
              ///< list, a number of its vertices
  first_row,  ///< the first of these rows
};

/// What a member of a record means to programs that know no record by name.
struct Role {
  Names names = Names::nothing;
  char side = 0;            ///< 'a' or 'b'; 0 when it concerns both objects or none
  const char* list = "";    ///< the list of the result, for rows
  bool is_key = false;      ///< the first members of a record are its key; lists are sorted by it
  bool is_rounded = false;  ///< not exact: comparisons may allow a tolerance
};
namespace role {
/// The roles of members. An id is of the object of `side`.
constexpr Role object(char side) {
  return {.names = Names::object, .side = side, .is_key = true};
}
constexpr Role key(Names names, char side) {
  return {.names = names, .side = side, .is_key = true};
}
constexpr Role id(Names names, char side) {
  return {.names = names, .side = side};
}
constexpr Role rows(const char* list, char side = 0) {
  return {.names = Names::rows, .side = side, .list = list};
}
constexpr Role first_row(const char* list) {
  return {.names = Names::first_row, .list = list};
}
constexpr Role weights(char side) {
  return {.names = Names::weights, .side = side, .is_rounded = true};
}
inline constexpr Role rounded{.is_rounded = true};
}  // namespace role

/// One member of a structure.
template <class Struct, class Value>
struct Field {
  const char* name;  ///< name of the member
  Value Struct::*member;
  const char* doc;  ///< one sentence, without a full stop
  ValueRange range{};
  const char* unit = "";
  /// The name for users: in scene files, recordings, JSON and the viewer, and with dashes on the command
  /// line. It is unique among the fields of structures that are used together.
  const char* key = name;
  /// For a truth value that users write as a word: the word for false and the word for true.
  std::array<const char*, 2> truth_words{};
  /// The value belongs to the machine and not to the scene: a number of threads, a measured time, or a count
  /// that depends on the number of threads. Two runs of the same scene may differ in it.
  bool is_of_machine = false;
  Role role{};  ///< of members of records

  constexpr bool has_truth_words() const { return truth_words[0] != nullptr; }
};

/// `name` is the name of the structure. `visit(visitor)` calls `visitor(field)` for each member, in the order
/// of the structure.
template <class Struct>
struct Description;

/// The base of the description of a record. Its `fields(field)` calls `field(key, member, doc, role, unit)`
/// for each member; `key` is its name for users.
template <class Struct>
struct RecordDescription {
  using Row = Struct;  ///< the record
  /// Calls `visitor(field)` for each member.
  template <class Visitor>
  static constexpr void visit(Visitor&& visitor) {
    Description<Row>::fields([&]<class Value>(const char* key, Value Row::*member, const char* doc,
                                              Role role = {}, const char* unit = "") {
      visitor(Field<Row, Value>{.name = key, .member = member, .doc = doc, .unit = unit, .role = role});
    });
  }
};

/// A structure that has a `Description`.
template <class Struct>
concept Described = requires {
  Description<std::remove_const_t<Struct>>::name;
};

/// Calls `visitor(field)` for each member, in the order of the structure.
template <Described Struct, class Visitor>
constexpr void for_each_field(Visitor&& visitor) {
  Description<std::remove_const_t<Struct>>::visit(visitor);
}

/// Calls `visitor(field, values...)` for each leaf, in order. A leaf is a member whose type has no
/// description; members whose type has one are visited recursively. All structures have the same type,
/// constant or not.
template <class Visitor, Described First, class... Rest>
constexpr void for_each_leaf(Visitor&& visitor, First& first, Rest&... rest) {
  for_each_field<First>([&](const auto& field) {
    if constexpr (Described<std::remove_reference_t<decltype(first.*field.member)>>) {
      for_each_leaf(visitor, first.*field.member, (rest.*field.member)...);
    } else {
      visitor(field, first.*field.member, (rest.*field.member)...);
    }
  });
}

/// The number of leaves that `for_each_leaf` visits.
template <Described Struct>
constexpr std::size_t count_leaves() {
  std::size_t count = 0;
  for_each_field<Struct>([&]<class Value>(const Field<Struct, Value>&) {
    if constexpr (Described<Value>) {
      count += count_leaves<Value>();
    } else {
      ++count;
    }
  });
  return count;
}

/// The fewest digits that read back to the same double.
std::string text_of(double value);
/// `X,Y,Z,EDGE`: the corner and the edge.
std::string text_of(const RootCube& cube);
/// Whether the numbers are in their ranges.
bool is_valid(const RootCube& cube);
/// The words for these ranges.
inline constexpr const char* range_of_root_cube =
    "three coordinates from -1e36 to 1e36 and an edge from 1e-30 to 1e36";

/// What `check` throws: `WHERE: STRUCTURE::NAME is VALUE; it must be WHAT`.
[[noreturn]] void fail_range(std::string_view where, const char* structure, const char* name,
                             std::uint64_t value, const ValueRange& range);
[[noreturn]] void fail_range(std::string_view where, const char* structure, const char* name, double value,
                             const ValueRange& range);
[[noreturn]] void fail_range(std::string_view where, const char* structure, const char* name, Vec3d value);
[[noreturn]] void fail_range(std::string_view where, const char* structure, const char* name,
                             const RootCube& value);
[[noreturn]] void fail_range(std::string_view where, const char* structure, const char* name,
                             std::uint64_t value, const std::string& words);

/// Throws `Error` when a member is out of its range; the message names the first such member. `where` is the
/// source of the options for the message; it may be empty.
template <Described Struct>
void check(const Struct& options, std::string_view where = {}) {
  const char* const structure = Description<Struct>::name;
  for_each_field<Struct>([&](const auto& field) {
    const auto& value = options.*field.member;
    using Value = std::remove_cvref_t<decltype(value)>;
    if constexpr (Described<Value>) {
      check(value, where);
    } else if constexpr (Worded<Value>) {
      if (word_of(value) == nullptr)
        fail_range(where, structure, field.name, static_cast<std::uint64_t>(value), list_of_words<Value>());
    } else if constexpr (std::unsigned_integral<Value> && !std::same_as<Value, bool>) {
      if (!field.range.allows(value))
        fail_range(where, structure, field.name, std::uint64_t{value}, field.range);
    } else if constexpr (std::same_as<Value, double>) {
      if (!field.range.allows(value)) fail_range(where, structure, field.name, value, field.range);
    } else if constexpr (std::same_as<Value, Vec3d>) {
      if (!field.range.allows(value.x) || !field.range.allows(value.y) || !field.range.allows(value.z))
        fail_range(where, structure, field.name, value);
    } else if constexpr (std::same_as<Value, std::optional<RootCube>>) {
      if (value && !is_valid(*value)) fail_range(where, structure, field.name, *value);
    }
  });
}

}  // namespace supple
