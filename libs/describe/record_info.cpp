#include "supple/record_info.hpp"

#include <algorithm>
#include <cstring>
#include <string>

#include "core/error.hpp"

namespace supple {

std::uint64_t number_of(const FieldInfo& field, const std::byte* row, std::size_t place) {
  const std::byte* const from = row + field.offset + place * size_of(field.scalar);
  const auto as = [&]<class Number>(Number number) -> std::uint64_t {
    std::memcpy(&number, from, sizeof number);
    return number;
  };
  if (field.scalar == ScalarType::float64) fail(std::string(field.name) + " is no whole number");
  const std::size_t size = size_of(field.scalar);
  return size == 1 ? as(std::uint8_t{}) : size == 4 ? as(std::uint32_t{}) : as(std::uint64_t{});
}

double real_number(const FieldInfo& field, const std::byte* row, std::size_t place) {
  double number;
  std::memcpy(&number, row + field.offset + place * sizeof number, sizeof number);
  return number;
}

void add_key(const RecordInfo& record, const std::byte* row, std::vector<std::uint64_t>& key) {
  for (const FieldInfo& field : record.fields) {
    if (!field.role.is_key) break;
    for (std::size_t i = 0; i < field.count; ++i) key.push_back(number_of(field, row, i));
  }
}

const std::vector<ListInfo>& list_infos() {
  static const std::vector<ListInfo> lists = [] {
    std::vector<ListInfo> all;
    for_each_list([&]<class Row>(const ResultList<Row>& list, auto) {
      ListInfo info{list.name, list.item, list.doc, list.answers, {}};
      if constexpr (Described<Row>) {
        info.record = record_info<Row>();
      } else {
        info.record.bytes = sizeof(Row);
        detail::add_field<Row>(info.record.fields,
                               {.name = list.value, .role = list.role, .unit = list.unit, .doc = list.doc});
      }
      all.push_back(std::move(info));
    });
    return all;
  }();
  return lists;
}

std::size_t place_of_list(std::string_view name) {
  const auto found = std::ranges::find(list_infos(), name, &ListInfo::name);
  if (found == list_infos().end()) fail("a result has no list " + std::string(name));
  return static_cast<std::size_t>(found - list_infos().begin());
}

std::size_t place_of_answer(ContactKinds kind) {
  const auto found = std::ranges::find(list_infos(), kind, &ListInfo::answers);
  return static_cast<std::size_t>(found - list_infos().begin());
}

void set_rows(DetectResult& result, std::span<const ListRows> lists) {
  std::size_t i = 0;
  for_each_list([&]<class Row>(const ResultList<Row>&, auto member) {
    const ListRows& rows = lists[i++];
    member(result) = {reinterpret_cast<const Row*>(rows.data), rows.count};
  });
}

}  // namespace supple
