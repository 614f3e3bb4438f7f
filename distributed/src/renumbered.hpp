#pragma once

#include <array>
#include <cstdint>

#include "supple/difference_descriptions.hpp"
#include "supple/result_lists.hpp"
#include "supple/types.hpp"

namespace supple {

/// The record with other numbers of objects, faces and vertices. `numbers.object(object)`,
/// `numbers.face(object, t)` and `numbers.vertex(object, v)` take the numbers that it has. For all records
/// with `object_a` and `object_b`: a single vertex is one of a, a single triangle one of b.
template <class Record, class Numbers>
Record renumbered(Record record, const Numbers& numbers) {
  const ObjectId a = record.object_a, b = record.object_b;
  if constexpr (requires { record.element_a; }) {
    const auto renumber = [&](ObjectId object, FeatureKind kind, std::array<std::uint32_t, 2>& element) {
      for (std::uint32_t& number : element)
        number = kind == FeatureKind::face ? numbers.face(object, number) : numbers.vertex(object, number);
    };
    renumber(a, kind_of_element(record, 'a'), record.element_a);
    renumber(b, kind_of_element(record, 'b'), record.element_b);
  } else if constexpr (requires { record.triangle_a; }) {
    record.triangle_a = numbers.face(a, record.triangle_a);
    record.triangle_b = numbers.face(b, record.triangle_b);
  } else {
    record.vertex = numbers.vertex(a, record.vertex);
    if constexpr (requires { record.triangle; }) record.triangle = numbers.face(b, record.triangle);
  }
  record.object_a = numbers.object(a);
  record.object_b = numbers.object(b);
  return record;
}

template <class Numbers>
ContainedPart renumbered(ContainedPart part, const Numbers& numbers) {
  part.vertex = numbers.vertex(part.inner, part.vertex);
  part.inner = numbers.object(part.inner);
  part.outer = numbers.object(part.outer);
  return part;
}

}  // namespace supple
