#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <type_traits>

#include "base/json_writer.hpp"
#include "base/text.hpp"
#include "session/messages/described_json.hpp"
#include "supple/result_lists.hpp"

namespace supple::cli {

/// The id of a vertex or a face, or `[3, 5]` for an edge.
inline void write_element(JsonWriter& json, const std::array<std::uint32_t, 2>& element, FeatureKind kind) {
  if (kind == FeatureKind::edge)
    json.pair(element[0], element[1]);
  else
    json.value(element[0]);
}

inline void write_ids(JsonWriter& json, const char* name, std::span<const std::uint32_t> ids) {
  json.key(name);
  json.begin_array();
  for (const std::uint32_t id : ids) json.value(id);
  json.end_array();
}

/// The key of a member in JSON and CSV: objects are `a` and `b`.
constexpr const char* short_key(const char* key) {
  constexpr std::string_view prefix = "object_";
  return std::string_view(key).starts_with(prefix) ? key + prefix.size() : key;
}

/// Whether a member refers to a range of another list.
constexpr bool is_of_range(const Role& role) {
  return role.names == Names::first_row || (role.names == Names::rows && *role.list != 0);
}

/// Writes the members of a record by their keys. What a record refers to by ranges of other lists is left
/// out: the caller writes it as lists of the record. `only_exact` leaves out what is rounded.
template <Described Row>
void write_fields(JsonWriter& json, const Row& row, bool only_exact = false) {
  for_each_field<Row>([&]<class Value>(const Field<Row, Value>& field) {
    const Role& role = field.role;
    if (only_exact && role.is_rounded) return;
    if (is_of_range(role)) return;
    const Value& value = row.*field.member;
    json.key(short_key(field.key));
    if constexpr (std::is_same_v<Value, ObjectId>) {
      json.value(value.index);
    } else if constexpr (std::is_same_v<Value, std::array<std::uint32_t, 2>>) {
      write_element(json, value, kind_of_element(row, role.side));
    } else if constexpr (std::is_same_v<Value, std::array<double, 3>>) {
      json.begin_array();  // one weight for each vertex of the element
      for (std::size_t i = 0; i <= static_cast<std::size_t>(kind_of_element(row, role.side)); ++i)
        json.value(value[i]);
      json.end_array();
    } else if constexpr (std::is_same_v<Value, Feature>) {
      json.value(name_of(value));
    } else if constexpr (std::is_same_v<Value, std::uint8_t>) {
      json.value(std::uint32_t{value});
    } else {
      viewer::write_value(json, field, value);
    }
  });
}

template <Described Row>
void write_records(JsonWriter& json, const char* name, std::span<const Row> rows) {
  json.key(name);
  json.begin_array();
  for (const Row& row : rows) {
    json.begin_object();
    write_fields(json, row);
    json.end_object();
  }
  json.end_array();
}

}  // namespace supple::cli
