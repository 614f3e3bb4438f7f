#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "base/json_writer.hpp"
#include "base/text.hpp"
#include "supple/record_info.hpp"
#include "supple/result.hpp"

namespace supple::cli {

// The lists of a result as JSON, as docs/json.md describes. With `details`, each contact is also an object
// with its points, normal and barycentric coordinates.

struct DetailedContacts {
  bool details = false;
  bool points = true;  ///< of intersections
};

/// `triangle_pairs`, `self` and `contacts`.
void write_intersections(JsonWriter& json, const DetectResult& result, const DetailedContacts& content);
/// `continuous` and `earliest`. `with_certainty` adds the list of contacts that are only within tolerance.
void write_continuous_groups(JsonWriter& json, const DetectResult& result, bool with_certainty);
/// `proximity`: the ids and the distance of each pair, by pairs of objects and by kinds.
void write_proximity_groups(JsonWriter& json, const DetectResult& result, ProximityListing listing);
/// `penetration`, `containment`, `contained_parts`, `curves` and, with `details`, `penetrations`.
void write_penetration(JsonWriter& json, const DetectResult& result, bool details);
/// The kinds of contacts without a form or a table of their own: those after penetration.
inline std::span<const ContactKindInfo> other_kinds() {
  return std::span(contact_kinds).subspan(4);
}
/// The lists of those that were requested.
void write_other_answers(JsonWriter& json, const DetectResult& result, ContactKinds requested);
/// `manifolds` with their points, and `ended_manifolds`.
void write_manifolds(JsonWriter& json, const DetectResult& result);
/// `colliding_vertices`, the paper's output.
void write_colliding_vertices(JsonWriter& json, const DetectResult& result);
/// One pair of objects of `supple query distance`, as a list.
void write_distance(JsonWriter& json, const ProximityPair& pair);

/// The id of a vertex or a face, or `[3, 5]` for an edge.
void write_element(JsonWriter& json, const std::array<std::uint32_t, 2>& element, FeatureKind kind);

/// The key of a member in JSON and CSV: objects are `a` and `b`.
constexpr const char* short_key(const char* key) {
  constexpr std::string_view prefix = "object_";
  return std::string_view(key).starts_with(prefix) ? key + prefix.size() : key;
}

/// Whether a member refers to a range of another list.
constexpr bool is_of_range(const Role& role) {
  return role.names == Names::first_row || (role.names == Names::rows && *role.list != 0);
}

/// Calls `visit(value)` for the value of a member in each column: a number, a truth value or a text, or
/// nullptr where a vertex or a face has no second number, or an element has no third weight.
template <class Visit>
void for_each_value(const RecordInfo& record, const FieldInfo& field, const std::byte* row,
                    const Visit& visit) {
  const auto number = [&](std::size_t i) { return number_of(field, row, i); };
  const Names names = field.role.names;
  // An element has as many numbers and weights as vertices, a face one number.
  const auto kind = names == Names::element || names == Names::weights
                        ? record.kind_of_element(row, field.role.side)
                        : FeatureKind::vertex;
  if (field.kind == FieldInfo::Kind::feature) {
    visit(name_of(Feature{static_cast<FeatureKind>(number(0)), static_cast<std::uint8_t>(number(1))}));
  } else if (field.scalar == ScalarType::float64) {
    for (std::size_t i = 0; i < field.count; ++i) {
      const bool has_none = names == Names::weights && i > static_cast<std::size_t>(kind);
      has_none ? visit(nullptr) : visit(real_number(field, row, i));
    }
  } else if (names == Names::element) {
    visit(number(0));
    kind == FeatureKind::edge ? visit(number(1)) : visit(nullptr);
  } else if (field.scalar == ScalarType::boolean) {
    visit(number(0) != 0);
  } else if (!field.words.empty()) {
    visit(field.words[number(0)]);
  } else {
    visit(number(0));
  }
}

/// Writes the members of a record by their keys. What a record refers to by ranges of other lists is left
/// out: the caller writes it as lists of the record. `only_exact` leaves out what is rounded.
void write_members(JsonWriter& json, const RecordInfo& record, const std::byte* row, bool only_exact);
template <Described Row>
void write_fields(JsonWriter& json, const Row& row, bool only_exact = false) {
  static const RecordInfo record = record_info<Row>();
  write_members(json, record, reinterpret_cast<const std::byte*>(&row), only_exact);
}

template <Described Row>
void write_records(JsonWriter& json, const char* name, std::span<const Row> rows) {
  json.objects(name, rows, [&](const Row& row) { write_fields(json, row); });
}

}  // namespace supple::cli
