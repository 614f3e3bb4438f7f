#include "reference_check.hpp"

#include <algorithm>

namespace supple {

const RecordedObject& ReferenceCheck::object(const RecordInfo& record, const std::byte* row,
                                             char side) const {
  const auto field = std::ranges::find_if(record.fields, [&](const FieldInfo& each) {
    return each.kind == FieldInfo::Kind::object && each.role.side == side;
  });
  return objects_[number_of(*field, row)];
}

void ReferenceCheck::list(std::size_t place) const {
  const ListInfo& list = list_infos()[place];
  const RecordInfo& record = list.record;
  const auto for_each_row = [&](auto visit) {
    for (std::size_t i = 0; i < lists_[place].count; ++i) visit(i, lists_[place].data + i * record.bytes);
  };
  for (const FieldInfo& field : record.fields) {
    if (field.kind != FieldInfo::Kind::object) continue;
    const std::string column = std::string("object_") + field.role.side;
    for_each_row([&](std::size_t i, const std::byte* row) {
      below(list.name, i, column, number_of(field, row), objects_.size());
    });
  }
  for (const FieldInfo& field : record.fields) {
    const auto& [names, side, other, is_key, is_rounded] = field.role;
    const bool is_value = *record.name == 0;
    const auto allowed = [&](const std::byte* row) -> std::uint64_t {
      const RecordedObject& of = object(record, row, side);
      const bool is_face =
          names == Names::triangle ||
          (names == Names::element && record.kind_of_element(row, side) == FeatureKind::face);
      return is_face ? of.triangles.size() : of.rest_positions.size() + (names == Names::rows ? 1 : 0);
    };
    for_each_row([&](std::size_t i, const std::byte* row) {
      if (!field.words.empty()) {
        below(list.name, i, field.name, number_of(field, row), field.words.size());
        if (field.kind == FieldInfo::Kind::feature)
          below(list.name, i, name_of_feature_index(field.name), number_of(field, row, 1), 3);
      } else if (names == Names::element) {
        below(list.name, i, field.name, std::max(number_of(field, row), number_of(field, row, 1)),
              allowed(row));
      } else if (side != 0 && (names == Names::triangle || names == Names::vertex ||
                               (names == Names::rows && *other == 0))) {
        below(list.name, i, field.name, number_of(field, row), allowed(row));
      } else if (names == Names::first_row && is_value) {
        below(list.name, i, field.name, number_of(field, row), lists_[place_of_list(other)].count);
      } else if (names == Names::first_row) {
        ranges(list, field, i, row);
      }
    });
  }
  if (std::string_view(list.name) != "manifolds") return;
  for_each_row([&](std::size_t i, const std::byte* row) {
    const auto& manifold = *reinterpret_cast<const Manifold*>(row);
    const char* const of = manifold.source == ManifoldSource::curve ? "curves" : "proximity_pairs";
    below(list.name, i, "record", manifold.record, lists_[place_of_list(of)].count);
  });
}

/// Checks the rows of another list to which a record refers: the first, and one or more numbers of rows.
void ReferenceCheck::ranges(const ListInfo& list, const FieldInfo& first, std::size_t i,
                            const std::byte* row) const {
  const std::string_view name = first.role.list;
  const std::size_t place = place_of_list(name);
  const ListInfo& target = list_infos()[place];
  // Contacts have numbers of points also when the points themselves are switched off.
  if (lists_[place].count == 0 && name == "contact_points") return;
  std::uint64_t left = lists_[place].count;
  const auto for_each_count = [&](auto visit) {
    for (const FieldInfo& field : list.record.fields) {
      if (field.role.names == Names::rows && name == field.role.list) visit(field, number_of(field, row));
    }
  };
  for_each_count([&](const FieldInfo& field, std::uint64_t count) {
    below(list.name, i, field.name, count, left + 1);
    left -= count;
  });
  std::uint64_t at = number_of(first, row);
  below(list.name, i, first.name, at, left + 1);
  for_each_count([&](const FieldInfo& field, std::uint64_t count) {
    const std::size_t vertices =
        field.role.side != 0 ? object(list.record, row, field.role.side).rest_positions.size() : 0;
    for (std::uint64_t v = at; field.role.side != 0 && v < at + count; ++v)
      below(target.name, v, "vertex",
            number_of(target.record.fields[0], lists_[place].data + v * target.record.bytes), vertices);
    at += count;
  });
}

}  // namespace supple
