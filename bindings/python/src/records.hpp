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
#include "supple/result_lists.hpp"

// NumPy layouts of records, made from their descriptions, and arrays of records.

namespace supple::python {

namespace nb = nanobind;

/// The words of an enumeration as a tuple.
template <Worded Enum>
nb::object words_as_tuple() {
  nb::list list;
  for (const char* word : words<Enum>) list.append(word);
  return nb::tuple(list);
}

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

/// A scalar for NumPy, such as `u4`, and how many of them a member has; 0 for a single one.
struct ScalarFormat {
  const char* code;
  std::size_t count = 0;
};

template <class Value>
constexpr ScalarFormat format_of() {
  if constexpr (std::is_same_v<Value, bool>) {
    return {"?"};
  } else if constexpr (std::is_enum_v<Value>) {
    return format_of<std::underlying_type_t<Value>>();
  } else if constexpr (std::is_same_v<Value, double>) {
    return {"f8"};
  } else if constexpr (std::is_same_v<Value, std::uint8_t>) {
    return {"u1"};
  } else if constexpr (std::is_same_v<Value, std::uint32_t>) {
    return {"u4"};
  } else if constexpr (std::is_same_v<Value, std::uint64_t>) {
    return {"u8"};
  } else if constexpr (std::is_same_v<Value, Vec3d>) {
    return {"f8", 3};
  } else {
    return {format_of<typename Value::value_type>().code, std::tuple_size_v<Value>};
  }
}

/// Adds a tuple (name, scalar, count, offset, words or None, documentation, unit) for each member.
template <Described Row>
void add_members(nb::list& members, std::size_t base);

template <class Value>
void add_member(nb::list& members, const std::string& name, std::size_t offset, const char* doc,
                const char* unit) {
  const auto add = [&](const std::string& member, ScalarFormat format, std::size_t at, nb::object values) {
    members.append(nb::make_tuple(member, format.code, format.count, at, std::move(values), doc, unit));
  };
  if constexpr (std::is_same_v<Value, ObjectId>) {
    add(name, {"u4"}, offset + offsetof(ObjectId, index), nb::none());
    add(name + "_generation", {"u4"}, offset + offsetof(ObjectId, generation), nb::none());
  } else if constexpr (std::is_same_v<Value, Feature>) {
    add(name + "_kind", {"u1"}, offset + offsetof(Feature, kind), words_as_tuple<FeatureKind>());
    add(name + "_index", {"u1"}, offset + offsetof(Feature, index), nb::none());
  } else if constexpr (std::is_same_v<Value, std::array<ContactPoint, 6>>) {
    // The members of each point, as NumPy has no lists of records in records with columns.
    for (std::size_t i = 0; i < 6; ++i) {
      nb::list point;
      add_members<ContactPoint>(point, offset + i * sizeof(ContactPoint));
      for (const nb::handle member : point) {
        members.append(nb::make_tuple(nb::cast<std::string>(member[0]) + "_" + std::to_string(i), member[1],
                                      member[2], member[3], member[4], member[5], member[6]));
      }
    }
  } else if constexpr (Described<Value>) {
    add_members<Value>(members, offset);
  } else if constexpr (Worded<Value>) {
    add(name, format_of<Value>(), offset, words_as_tuple<Value>());
  } else {
    add(name, format_of<Value>(), offset, nb::none());
  }
}

template <Described Row>
void add_members(nb::list& members, std::size_t base) {
  static const Row row{};
  for_each_field<Row>([&]<class Value>(const Field<Row, Value>& field) {
    const auto offset =
        reinterpret_cast<const std::byte*>(&(row.*field.member)) - reinterpret_cast<const std::byte*>(&row);
    add_member<Value>(members, field.key, base + static_cast<std::size_t>(offset), field.doc, field.unit);
  });
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

/// The name of a record in `layouts`.
template <class Row>
std::string layout_name() {
  if constexpr (IsFound<Row>::value) {
    return std::string("Found") + Description<decltype(Row::row)>::name;
  } else {
    return Description<Row>::name;
  }
}

/// The members of a record, as `add_member` lists them.
template <class Row>
nb::list members_of() {
  nb::list members;
  if constexpr (IsFound<Row>::value) {
    members.append(nb::make_tuple("found", "?", std::size_t{0}, offsetof(Row, found), nb::none(),
                                  "Whether there is an answer; the other members are valid only then", ""));
    add_members<decltype(Row::row)>(members, offsetof(Row, row));
  } else {
    add_members<Row>(members, 0);
  }
  return members;
}

/// Adds (bytes of a record, its members) to `layouts`.
template <class Row>
void add_layout(nb::dict& layouts) {
  layouts[layout_name<Row>().c_str()] = nb::make_tuple(sizeof(Row), members_of<Row>());
}

/// The places of the bytes of a record that belong to no member.
template <class Row>
std::vector<std::size_t> padding_of() {
  std::vector<std::size_t> places;
  std::vector<bool> is_used(sizeof(Row));
  for (const nb::handle member : members_of<Row>()) {
    const auto code = nb::cast<std::string>(member[1]);
    const std::size_t size = code == "?" ? 1 : static_cast<std::size_t>(code[1] - '0');
    const auto count = std::max<std::size_t>(nb::cast<std::size_t>(member[2]), 1);
    std::fill_n(is_used.begin() + nb::cast<std::ptrdiff_t>(member[3]), size * count, true);
  }
  for (std::size_t i = 0; i < sizeof(Row); ++i) {
    if (!is_used[i]) places.push_back(i);
  }
  return places;
}

/// Clears these bytes, so that equal tables have equal bytes: those that `tobytes`, pickles and hashes read.
template <class Row>
void clear_padding(std::span<const Row> rows) {
  static const std::vector<std::size_t> places = padding_of<Row>();
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
