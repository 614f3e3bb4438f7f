#include "lists/lists_of_frames.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <span>
#include <string_view>
#include <utility>

#include "messages/frame_message.hpp"

namespace supple::viewer {
namespace {

ScalarOfSection scalar_of(ScalarType type) {
  switch (type) {
    case ScalarType::uint32:
      return ScalarOfSection::uint32;
    case ScalarType::uint64:
      return ScalarOfSection::float64;
    case ScalarType::float64:
      return ScalarOfSection::float32;
    default:
      return ScalarOfSection::uint8;
  }
}

std::vector<Column> columns_of(const RecordInfo& record) {
  std::vector<Column> columns;
  for (const FieldInfo& field : record.fields) {
    if (field.role.names == Names::weights || field.kind == FieldInfo::Kind::feature) continue;
    const bool is_object = field.kind == FieldInfo::Kind::object;
    columns.push_back({&field, is_object ? std::string("object_") + field.role.side : field.name,
                       scalar_of(field.scalar), is_object ? 1u : static_cast<std::uint32_t>(field.count),
                       field.count == 3 && std::string_view(field.unit) == "length"});
  }
  return columns;
}

/// Whether a member is the number of rows of a list, or also the first one.
bool is_of_rows(const FieldInfo& field, std::string_view list, bool also_first) {
  const Names names = field.role.names;
  return list == field.role.list && (names == Names::rows || (also_first && names == Names::first_row));
}

/// Answers have no parent: groups only say which of them belong together.
std::size_t parent_of(std::size_t list) {
  const std::vector<ListInfo>& infos = list_infos();
  for (std::size_t i = 0; i < infos.size() && infos[list].answers == ContactKinds::none; ++i) {
    for (const FieldInfo& field : infos[i].record.fields) {
      if (is_of_rows(field, infos[list].name, false)) return i;
    }
  }
  return list;
}

/// The end of the rows of `list` that other rows name.
std::uint64_t end_of(const RecordInfo& record, const ListRows& rows, std::string_view list) {
  std::uint64_t end = 0;
  for (const FieldInfo& field : record.fields) {
    if (rows.count > 0 && is_of_rows(field, list, true))
      end += number_of(field, rows.data + (rows.count - 1) * record.bytes);
  }
  return end;
}

/// The members of rows as elements of a section.
template <class From, class To, class Convert>
void copy_members(const Column& column, const ListRows& rows, std::size_t bytes, std::span<To> sent,
                  const Convert& convert) {
  auto to = sent.begin();
  for (std::size_t row = 0; row < rows.count; ++row) {
    const std::byte* from = rows.data + row * bytes + column.field->offset;
    for (std::size_t place = 0; place < column.width; ++place, from += sizeof(From)) {
      From value;
      std::memcpy(&value, from, sizeof value);
      *to++ = convert(value, place);
    }
  }
}

void add_column(std::uint32_t number, const Column& column, const ListRows& rows, std::size_t bytes,
                const Vec3d& center, MessageWriter& message) {
  const auto add = [&]<class From, class To>(From, To, const auto& convert) {
    copy_members<From>(column, rows, bytes,
                       message.add_rows<To>(Tag::column, number, rows.count, column.width), convert);
  };
  const auto as_it_is = [](auto value, std::size_t) { return value; };
  const auto to_double = [](std::uint64_t value, std::size_t) { return static_cast<double>(value); };
  const std::array<double, 3> origin{center.x, center.y, center.z};
  const auto to_float = [&](double value, std::size_t place) {
    return Center::narrow(column.is_position ? value - origin[place] : value);
  };
  if (column.scalar == ScalarOfSection::uint8) return add(std::uint8_t{}, std::uint8_t{}, as_it_is);
  if (column.scalar == ScalarOfSection::uint32) return add(std::uint32_t{}, std::uint32_t{}, as_it_is);
  if (column.scalar == ScalarOfSection::float64) return add(std::uint64_t{}, double{}, to_double);
  add(double{}, float{}, to_float);
}

}  // namespace

const std::vector<ListOfFrames>& lists_of_frames() {
  static const std::vector<ListOfFrames> all = [] {
    std::vector<ListOfFrames> lists;
    for (const ListInfo& info : list_infos()) {
      const std::size_t place = static_cast<std::size_t>(&info - list_infos().data());
      if (!std::string_view(info.name).starts_with("events/"))
        lists.push_back({&info, place, parent_of(place), columns_of(info.record)});
    }
    return lists;
  }();
  return all;
}

/// Lists are cut at the limit, and lists whose rows belong to those of another one where these end.
void FramePacker::add_lists(const FrameView& frame) {
  const ContactKinds kinds = with_included(frame.source.contacts());
  list_rows_ = rows_of(frame.source.scene().result(), std::move(list_rows_));
  for (const ListOfFrames& list : lists_of_frames()) {
    std::size_t& count = list_rows_[list.place].count;
    if (!contains(kinds, list.info->answers)) count = 0;
    if (list.parent == list.place) count = limited(list.info->name, count);
  }
  std::uint32_t number = 0;
  for (const ListOfFrames& list : lists_of_frames()) {
    ListRows& own = list_rows_[list.place];
    if (list.parent != list.place) {
      const auto end = end_of(list_infos()[list.parent].record, list_rows_[list.parent], list.info->name);
      own.count = std::min(own.count, static_cast<std::size_t>(end));
    }
    for (const Column& column : list.columns) {
      if (own.count > 0) add_column(number, column, own, list.info->record.bytes, frame.center.at, *message_);
      ++number;
    }
  }
}

}  // namespace supple::viewer
