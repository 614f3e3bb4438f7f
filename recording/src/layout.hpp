#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

#include "supple/contact.hpp"
#include "supple/result.hpp"
#include "supple/types.hpp"

// The content of a recording and its location in the file, as docs/recording.md describes. Rows refer to
// objects by their index in the file, in `ObjectId::index`.

namespace supple {

inline constexpr const char* format_name = "supple recording";
inline constexpr std::uint32_t format_version = 3;
/// The oldest supported version. Values that it lacks get their defaults.
inline constexpr std::uint32_t oldest_version = 1;

// The names of attributes and columns of this version in another version.
std::string attribute_in_version(const std::string& name, std::uint32_t version);
std::string column_in_version(const std::string& name, std::uint32_t version);

enum class ScalarType : std::uint8_t { uint8, uint32, uint64, float64 };

constexpr std::size_t size_of(ScalarType type) {
  return type == ScalarType::uint8 ? 1 : type == ScalarType::uint32 ? 4 : 8;
}

/// How a field of a row is stored: one or more scalars of one type.
template <class Field>
struct Storage;
template <class Field>
requires(std::is_enum_v<Field> || std::is_same_v<Field, std::uint8_t> ||
         std::is_same_v<Field, bool>) struct Storage<Field> {
  static_assert(sizeof(Field) == 1);
  static constexpr ScalarType type = ScalarType::uint8;
  static constexpr std::size_t width = 1;
};
template <>
struct Storage<std::uint32_t> {
  static constexpr ScalarType type = ScalarType::uint32;
  static constexpr std::size_t width = 1;
};
template <>
struct Storage<std::uint64_t> {
  static constexpr ScalarType type = ScalarType::uint64;
  static constexpr std::size_t width = 1;
};
template <>
struct Storage<double> {
  static constexpr ScalarType type = ScalarType::float64;
  static constexpr std::size_t width = 1;
};
template <>
struct Storage<Vec3d> {
  static constexpr ScalarType type = ScalarType::float64;
  static constexpr std::size_t width = 3;
};
template <class Scalar, std::size_t Count>
struct Storage<std::array<Scalar, Count>> {
  static constexpr ScalarType type = Storage<Scalar>::type;
  static constexpr std::size_t width = Count;
};

/// A dataset that holds one field of each row.
template <class Row>
struct ColumnOf {
  const char* name;
  ScalarType type;
  std::size_t width;
  std::size_t offset;  ///< of the field in a row
  bool is_truth;       ///< a truth value; every number but 0 is true

  std::size_t bytes() const { return size_of(type) * width; }
  void store(const Row& row, std::byte* to) const {
    std::memcpy(to, reinterpret_cast<const std::byte*>(&row) + offset, bytes());
  }
  void load(Row& row, const std::byte* from) const {
    std::byte* const field = reinterpret_cast<std::byte*>(&row) + offset;
    std::memcpy(field, from, bytes());
    if (is_truth) *field = std::byte{*from != std::byte{}};
  }
};

/// `field_of` returns a reference to the field of a row.
template <class Row, class FieldOf>
ColumnOf<Row> column(const char* name, FieldOf field_of) {
  static_assert(std::is_trivially_copyable_v<Row>);
  using Field = std::remove_cvref_t<std::invoke_result_t<FieldOf, Row&>>;
  using Stored = Storage<Field>;
  static_assert(sizeof(Field) == size_of(Stored::type) * Stored::width);
  Row row{};
  const auto* const field = reinterpret_cast<const std::byte*>(&field_of(row));
  return {name, Stored::type, Stored::width,
          static_cast<std::size_t>(field - reinterpret_cast<const std::byte*>(&row)),
          std::is_same_v<Field, bool>};
}

template <class Row>
const std::vector<ColumnOf<Row>>& columns_of();

/// A row of `curve_contacts`. Its type distinguishes its column from that of lists of vertices.
struct CurveContact {
  std::uint32_t contact = 0;
};

/// References to the two objects of a row: its columns `object_a` and `object_b`.
template <class Row>
auto objects_of(Row& row) {
  if constexpr (requires { row.inner; }) {
    return std::tie(row.inner, row.outer);
  } else if constexpr (requires { row.a; }) {
    return std::tie(row.a, row.b);
  } else {
    return std::tie(row.object_a, row.object_b);
  }
}

/// Names of the groups with any number of rows per frame.
namespace group_names {
inline constexpr const char* object_pairs = "object_pairs";
inline constexpr const char* contacts = "contacts";
inline constexpr const char* contact_points = "contact_points";
inline constexpr const char* continuous_contacts = "continuous_contacts";
inline constexpr const char* proximity_pairs = "proximity_pairs";
inline constexpr const char* penetration_groups = "penetration_groups";
inline constexpr const char* penetrations = "penetrations";
inline constexpr const char* vertices_on_surface = "vertices_on_surface";
inline constexpr const char* contained_parts = "contained_parts";
inline constexpr const char* curves = "curves";
inline constexpr const char* curve_contacts = "curve_contacts";
inline constexpr const char* curve_points = "curve_points";
inline constexpr const char* enclosed_vertices = "enclosed_vertices";
inline constexpr const char* colliding_vertex_groups = "colliding_vertex_groups";
inline constexpr const char* colliding_vertices = "colliding_vertices";
inline constexpr const char* volume_begin = "events/volume_begin";
inline constexpr const char* volume_end = "events/volume_end";
inline constexpr const char* narrow_phase_begin = "events/narrow_phase_begin";
inline constexpr const char* narrow_phase_end = "events/narrow_phase_end";
inline constexpr const char* contact_begin = "events/contact_begin";
inline constexpr const char* contact_end = "events/contact_end";
inline constexpr const char* proximity_begin = "events/proximity_begin";
inline constexpr const char* proximity_end = "events/proximity_end";
inline constexpr const char* penetration_begin = "events/penetration_begin";
inline constexpr const char* penetration_end = "events/penetration_end";
inline constexpr const char* statistics = "statistics";  // one row per frame
}  // namespace group_names

inline std::string object_path(std::size_t place) {
  return "objects/" + std::to_string(place);
}

}  // namespace supple
