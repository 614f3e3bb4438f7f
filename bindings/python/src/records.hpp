#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "supple/query_descriptions.hpp"
#include "supple/record_info.hpp"

// NumPy layouts of records, made from their descriptions, and arrays of records.

namespace supple::python {

namespace nb = nanobind;

/// The members of a structure by their keys; enumerations as words.
template <Described Struct>
nb::dict dict_of(const Struct& members) {
  nb::dict dict;
  for_each_field<Struct>([&]<class Value>(const Field<Struct, Value>& field) {
    if constexpr (Worded<Value>) {
      dict[field.key] = word_of(members.*field.member);
    } else {
      dict[field.key] = nb::cast(members.*field.member);
    }
  });
  return dict;
}

/// An answer of a query for one of its places, or none.
template <class Row>
struct Found {
  Row row{};
  bool found = false;
};
template <class Row>
struct IsFound : std::false_type {};
template <class Row>
struct IsFound<Found<Row>> : std::true_type {};

/// A record as data. An answer of a query has the member `found`.
template <class Row>
const RecordInfo& record_of() {
  static const RecordInfo record = [] {
    if constexpr (IsFound<Row>::value) {
      RecordInfo found = record_info<decltype(Row::row)>();
      found.bytes = sizeof(Row);
      for (FieldInfo& field : found.fields) field.offset += offsetof(Row, row);
      found.fields.insert(found.fields.begin(),
                          {.name = "found",
                           .scalar = ScalarType::boolean,
                           .offset = offsetof(Row, found),
                           .doc = "Whether there is an answer; the other members are valid only then"});
      return found;
    } else {
      return record_info<Row>();
    }
  }();
  return record;
}

/// The name of a record in `layouts`.
template <class Row>
std::string layout_name() {
  return std::string(IsFound<Row>::value ? "Found" : "") + record_of<Row>().name;
}

/// A tuple (name, scalar, count, offset, words or None, documentation, unit) for each member; the count is 0
/// for a single scalar. An id of an object and a feature have two members.
nb::list members_of(const RecordInfo& record);

/// Adds (bytes of a record, its members) to `layouts`.
template <class Row>
void add_layout(nb::dict& layouts) {
  layouts[layout_name<Row>().c_str()] = nb::make_tuple(sizeof(Row), members_of(record_of<Row>()));
}

/// The places of the bytes of a record that belong to no member.
std::vector<std::size_t> padding_of(const RecordInfo& record);

/// Clears these bytes, so that equal tables have equal bytes: those that `tobytes`, pickles and hashes read.
template <class Row>
void clear_padding(std::span<const Row> rows) {
  static const std::vector<std::size_t> places = padding_of(record_of<Row>());
  for (const Row& row : rows) {
    auto* const bytes = reinterpret_cast<std::byte*>(const_cast<Row*>(&row));  // the lists are not constant
    for (const std::size_t place : places) bytes[place] = std::byte{0};
  }
}

/// Read-only memory as an array of NumPy, which keeps `owner`.
template <class Scalar, std::size_t... shape>
nb::object to_array(const void* data, std::size_t count, nb::handle owner) {
  static const Scalar nothing{};
  const std::size_t sizes[] = {count, shape...};
  return nb::cast(
      nb::ndarray<nb::numpy, const Scalar>(count == 0 ? &nothing : data, 1 + sizeof...(shape), sizes, owner));
}

/// A list of a result: (name of the record or None, array). Records are bytes, which Python views by their
/// layout.
template <class Row>
nb::object to_table(std::span<const Row> rows, nb::handle owner) {
  if constexpr (std::is_same_v<Row, std::uint32_t> || std::is_same_v<Row, double> ||
                std::is_same_v<Row, std::uint8_t>) {
    return nb::make_tuple(nb::none(), to_array<Row>(rows.data(), rows.size(), owner));
  } else if constexpr (std::is_same_v<Row, Vec3d>) {
    return nb::make_tuple(nb::none(), to_array<double, 3>(rows.data(), rows.size(), owner));
  } else {
    clear_padding(rows);
    return nb::make_tuple(layout_name<Row>(), to_array<std::uint8_t>(rows.data(), rows.size_bytes(), owner));
  }
}

/// What keeps a list for the arrays that read it.
template <class List>
nb::capsule owner_of(List* list) {
  return nb::capsule(list, [](void* p) noexcept { delete static_cast<List*>(p); });
}

/// The same for a list that Python takes over.
template <class Row>
nb::object to_table(std::vector<Row>&& rows) {
  auto* const list = new std::vector<Row>(std::move(rows));
  return to_table(std::span<const Row>(*list), owner_of(list));
}

/// A list that Python takes over as an array that it may change: each row has this shape of scalars.
template <class Scalar, std::size_t... shape, class Row>
nb::object to_own_array(std::vector<Row>&& rows) {
  static_assert(sizeof(Row) == sizeof(Scalar) * (shape * ... * 1));
  auto* const list = new std::vector<Row>(std::move(rows));
  static Row nothing{};
  const std::size_t sizes[] = {list->size(), shape...};
  return nb::cast(nb::ndarray<nb::numpy, Scalar>(list->empty() ? &nothing : list->data(),
                                                 1 + sizeof...(shape), sizes, owner_of(list)));
}

/// The answers of a query as a table with the member `found`.
template <class Row>
nb::object to_answers(const std::vector<std::optional<Row>>& answers) {
  std::vector<Found<Row>> rows(answers.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (answers[i]) rows[i] = {*answers[i], true};
  }
  return to_table(std::move(rows));
}

/// A table of one record, or None.
template <class Row>
nb::object to_table(const std::optional<Row>& row) {
  if (!row) return nb::none();
  return to_table(std::vector<Row>{*row});
}

}  // namespace supple::python
