#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "supple/result_lists.hpp"

// Records and lists of a result as data, made from their descriptions. Programs that treat all records alike
// loop over these members and rows and name no record.

namespace supple {

/// The type of a number in a record.
enum class ScalarType : std::uint8_t { boolean, uint8, uint32, uint64, float64 };

/// In bytes.
constexpr std::size_t size_of(ScalarType type) {
  return type <= ScalarType::uint8 ? 1 : type == ScalarType::uint32 ? 4 : 8;
}

/// A member of a record: `count` scalars of one type at `offset`.
struct FieldInfo {
  /// What the numbers are together.
  enum class Kind : std::uint8_t {
    numbers,
    object,   ///< an `ObjectId`: its index and its generation
    feature,  ///< a `Feature`: its kind and its index
  };

  const char* name = "";
  int place = -1;  ///< of its record in an array of records; -1 for members of no array
  Kind kind = Kind::numbers;
  ScalarType scalar = ScalarType::uint8;
  std::size_t count = 1;
  std::size_t offset = 0;                ///< bytes in the record
  std::span<const char* const> words{};  ///< of an enumeration; of a feature those of its kind
  Role role{};
  const char* unit = "";
  const char* doc = "";

  std::size_t bytes() const { return size_of(scalar) * count; }
};

/// A record: its members, in their order.
struct RecordInfo {
  const char* name = "";  ///< empty for rows without members
  std::size_t bytes = 0;
  std::vector<FieldInfo> fields;
  /// As the function `kind_of_element` of this record.
  FeatureKind (*kind_of_element)(const std::byte* row, char side) = nullptr;
};

/// A list of a result, as `ResultList` with its records.
struct ListInfo {
  const char* name = "";
  const char* item = "";
  const char* doc = "";
  ContactKinds answers = ContactKinds::none;
  RecordInfo record;  ///< rows without members have one, with the name of the value
};

namespace detail {

template <class Value>
constexpr std::pair<ScalarType, std::size_t> scalars_of() {
  if constexpr (std::is_same_v<Value, bool>)
    return {ScalarType::boolean, 1};
  else if constexpr (std::is_enum_v<Value>)
    return scalars_of<std::underlying_type_t<Value>>();
  else if constexpr (std::is_same_v<Value, std::uint8_t>)
    return {ScalarType::uint8, 1};
  else if constexpr (std::is_same_v<Value, std::uint32_t>)
    return {ScalarType::uint32, 1};
  else if constexpr (std::is_same_v<Value, std::uint64_t>)
    return {ScalarType::uint64, 1};
  else if constexpr (std::is_same_v<Value, double>)
    return {ScalarType::float64, 1};
  else if constexpr (std::is_same_v<Value, Vec3d>)
    return {ScalarType::float64, 3};
  else
    return {scalars_of<typename Value::value_type>().first, std::tuple_size_v<Value>};
}

template <Described Row>
void add_fields(std::vector<FieldInfo>& fields, std::size_t base, int place);

/// Adds a member with the name, place, role and texts of `field`.
template <class Value>
void add_field(std::vector<FieldInfo>& fields, FieldInfo field) {
  if constexpr (std::is_same_v<Value, ObjectId>) {
    field.kind = FieldInfo::Kind::object;
    field.scalar = ScalarType::uint32;
    field.count = 2;
  } else if constexpr (std::is_same_v<Value, Feature>) {
    field.kind = FieldInfo::Kind::feature;
    field.count = 2;
    field.words = words<FeatureKind>;
  } else if constexpr (Described<Value>) {
    return add_fields<Value>(fields, field.offset, field.place);
  } else if constexpr (requires { requires Described<typename Value::value_type>; }) {
    for (std::size_t i = 0; i < std::tuple_size_v<Value>; ++i)
      add_fields<typename Value::value_type>(fields, field.offset + i * sizeof(typename Value::value_type),
                                             static_cast<int>(i));
    return;
  } else {
    std::tie(field.scalar, field.count) = scalars_of<Value>();
    if constexpr (Worded<Value>) field.words = words<Value>;
  }
  fields.push_back(field);
}

template <Described Row>
void add_fields(std::vector<FieldInfo>& fields, std::size_t base, int place) {
  static const Row row{};
  for_each_field<Row>([&]<class Value>(const Field<Row, Value>& field) {
    const auto offset =
        reinterpret_cast<const std::byte*>(&(row.*field.member)) - reinterpret_cast<const std::byte*>(&row);
    add_field<Value>(fields, {.name = field.key,
                              .place = place,
                              .offset = base + static_cast<std::size_t>(offset),
                              .role = field.role,
                              .unit = field.unit,
                              .doc = field.doc});
  });
}

}  // namespace detail

/// The members of records inside a record are its members; those of an array of records have a place.
template <Described Row>
RecordInfo record_info() {
  static_assert(std::is_trivially_copyable_v<Row>);
  RecordInfo record{Description<Row>::name, sizeof(Row), {}, [](const std::byte* row, char side) {
                      return kind_of_element(*reinterpret_cast<const Row*>(row), side);
                    }};
  detail::add_fields<Row>(record.fields, 0, -1);
  return record;
}

/// The members of the key of a row, as numbers in their order: lists are sorted by it.
void add_key(const RecordInfo& record, const std::byte* row, std::vector<std::uint64_t>& key);
/// A scalar of a member as a whole number.
std::uint64_t number_of(const FieldInfo& field, const std::byte* row, std::size_t place = 0);
/// A double of a member.
double real_number(const FieldInfo& field, const std::byte* row, std::size_t place);

/// The lists of a result, in the order of `for_each_list`.
const std::vector<ListInfo>& list_infos();
/// The place of a list in `list_infos`. Throws `Error` when there is no list with this name.
std::size_t place_of_list(std::string_view name);
/// The place of the list that answers a kind of contacts.
std::size_t place_of_answer(ContactKinds kind);

/// The rows of a list.
struct ListRows {
  const std::byte* data = nullptr;
  std::size_t count = 0;
};
/// The rows of all lists, in the order of `list_infos`; they belong to the owner of the lists. These are a
/// `DetectResult`, or a structure with members of the same names. `all` gives memory that is used again.
template <class Lists>
std::vector<ListRows> rows_of(const Lists& lists, std::vector<ListRows> all = {}) {
  all.clear();
  for_each_list([&](const auto&, auto member) {
    const auto& rows = member(lists);
    all.push_back({reinterpret_cast<const std::byte*>(rows.data()), rows.size()});
  });
  return all;
}
/// The inverse: the lists of a result have these rows, which stay where they are.
void set_rows(DetectResult& result, std::span<const ListRows> lists);

}  // namespace supple
