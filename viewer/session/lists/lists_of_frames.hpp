#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "messages/sections.hpp"
#include "supple/record_info.hpp"

namespace supple::viewer {

/// What a column names, in the order of `Names`.
inline constexpr const char* names_of_roles[] = {"",        "object",  "triangle", "vertex",
                                                 "element", "weights", "rows",     "first_row"};

/// A member of the records of a list, as frames have it.
struct Column {
  const FieldInfo* field = nullptr;
  std::string name;  ///< of the member; `object_a` or `object_b` for an object
  ScalarOfSection scalar{};
  std::uint32_t width = 1;   ///< scalars of a row; of an object its number, without its generation
  bool is_position = false;  ///< three lengths: `center` of the scene is subtracted
};

/// A list that frames have column by column. A page shows no barycentric coordinates and no parts of
/// elements, so these members are left out.
struct ListOfFrames {
  const ListInfo* info = nullptr;
  std::size_t place = 0;  ///< in `list_infos`
  /// The place of the list to whose rows its own belong, as points to contacts; its own if there is none.
  std::size_t parent = 0;
  std::vector<Column> columns;
};

/// All lists but events, which are sections of their own. A section has the number of its column, counted
/// through all lists.
const std::vector<ListOfFrames>& lists_of_frames();

/// Writes what the page must know of them; `make docs` gives it to the page.
template <class Json>
void describe_lists_of_frames(Json& json) {
  json.objects("lists_of_frames", lists_of_frames(), [&](const ListOfFrames& list) {
    json.member("name", list.info->name);
    json.member("item", list.info->item);
    json.member("answers", list.info->answers == ContactKinds::none ? "" : word_of(list.info->answers));
    json.objects("columns", list.columns, [&](const Column& column) {
      const Role& role = column.field->role;
      json.member("name", column.name);
      json.member("scalar", names_of_scalars[static_cast<std::size_t>(column.scalar)]);
      json.member("width", column.width);
      json.member("names", names_of_roles[static_cast<std::size_t>(role.names)]);
      json.member("side", std::string(role.side == 0 ? 0 : 1, role.side));
      json.member("rows_of", role.list);
      json.member("is_key", role.is_key);
      json.member("is_position", column.is_position);
      json.member("unit", column.field->unit);
      json.list("words", column.field->words);
    });
  });
}

}  // namespace supple::viewer
