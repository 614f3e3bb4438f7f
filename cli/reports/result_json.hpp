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
