#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "supple/contact.hpp"
#include "supple/result.hpp"
#include "supple/types.hpp"

// What is in a recording and where: docs/recording.md says it in words. Rows name objects by their place in
// the file, in `ObjectId::index`.

namespace supple {

inline constexpr const char* format_name = "supple recording";
inline constexpr std::uint32_t format_version = 1;

enum class ScalarType : std::uint8_t { uint8, uint32, uint64, float64 };

constexpr std::size_t size_of(ScalarType type) {
  return type == ScalarType::uint8 ? 1 : type == ScalarType::uint32 ? 4 : 8;
}

/// How a field of a row is stored: one or more scalars of one type.
template <class Field>
struct Storage;
template <class Field>
requires(std::is_enum_v<Field> || std::is_same_v<Field, std::uint8_t>) struct Storage<Field> {
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
  void (*store)(const Row& row, std::byte* to);
  void (*load)(Row& row, const std::byte* from);

  std::size_t bytes() const { return size_of(type) * width; }
};

/// `Field` gives a reference to the field of a row.
template <class Row, class FieldOf>
ColumnOf<Row> column(const char* name, FieldOf) {
  using Field = std::remove_cvref_t<std::invoke_result_t<FieldOf, Row&>>;
  using Stored = Storage<Field>;
  static_assert(sizeof(Field) == size_of(Stored::type) * Stored::width);
  return {name, Stored::type, Stored::width,
          [](const Row& row, std::byte* to) { std::memcpy(to, &FieldOf{}(row), sizeof(Field)); },
          [](Row& row, const std::byte* from) { std::memcpy(&FieldOf{}(row), from, sizeof(Field)); }};
}

template <class Row>
const std::vector<ColumnOf<Row>>& columns_of();

/// Names of the groups of rows of which a frame has any number.
namespace group_names {
inline constexpr const char* object_pairs = "object_pairs";
inline constexpr const char* contacts = "contacts";
inline constexpr const char* contact_points = "contact_points";
inline constexpr const char* continuous_contacts = "continuous_contacts";
inline constexpr const char* volume_begin = "events/volume_begin";
inline constexpr const char* volume_end = "events/volume_end";
inline constexpr const char* contact_begin = "events/contact_begin";
inline constexpr const char* contact_end = "events/contact_end";
inline constexpr const char* statistics = "statistics";  // one row a frame
}  // namespace group_names

/// Words for the choices that a recording names, in the order of their values.
namespace choice_names {
inline constexpr std::array contacts{"none", "intersection", "continuous", "intersection,continuous"};
inline constexpr std::array bounding_volume{"aabb", "sphere"};
inline constexpr std::array sphere_fit{"vertices", "box"};
inline constexpr std::array broad_phase{"automatic", "octree", "grid", "sweep", "brute"};
inline constexpr std::array region_sphere_test{"arvo", "grown_box"};
}  // namespace choice_names

inline std::string object_path(std::size_t place) {
  return "objects/" + std::to_string(place);
}

}  // namespace supple
