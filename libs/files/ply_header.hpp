#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "files/text_scanner.hpp"

/// The header of a PLY file, which describes what follows it.
namespace supple::ply {

enum class ScalarType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

constexpr std::size_t size_of(ScalarType type) {
  constexpr std::size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[static_cast<int>(type)];
}

constexpr bool is_integer(ScalarType type) {
  return type != ScalarType::float32 && type != ScalarType::float64;
}

struct Property {
  std::string name;
  ScalarType type;                       // of the value, or of each value of the list
  std::optional<ScalarType> count_type;  // only of a list
};

struct Element {
  std::string name;
  std::uint64_t count;
  std::vector<Property> properties;
};

enum class Encoding { text, little_endian, big_endian };

struct Header {
  Encoding encoding = Encoding::text;
  std::vector<Element> elements;
};

inline bool is_vertex_list(const Property& property) {
  return property.count_type && (property.name == "vertex_indices" || property.name == "vertex_index");
}

/// Reads up to the line after `end_header`. Throws when the header is not one of PLY 1.0.
Header read_header(TextScanner& scanner);

}  // namespace supple::ply
