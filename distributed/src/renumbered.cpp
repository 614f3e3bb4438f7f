#include "renumbered.hpp"

#include <cstring>

namespace supple {

std::array<ObjectId, 2> objects_of(const RecordInfo& record, const std::byte* row) {
  std::array<ObjectId, 2> objects{};
  for (const FieldInfo& field : record.fields) {
    if (field.kind != FieldInfo::Kind::object) continue;
    std::memcpy(&objects[field.role.side == 'b' ? 1 : 0], row + field.offset, sizeof(ObjectId));
    if (field.role.side == 'a') objects[1] = objects[0];
  }
  return objects;
}

bool is_name(const FieldInfo& field) {
  const Names names = field.role.names;
  return names == Names::object || names == Names::triangle || names == Names::vertex ||
         names == Names::element;
}

void renumber(const RecordInfo& record, std::byte* row, const std::array<ObjectId, 2>& objects,
              const Numbers& numbers, char side) {
  for (const FieldInfo& field : record.fields) {
    const Role& role = field.role;
    const ObjectId object = objects[(role.side != 0 ? role.side : side) == 'b' ? 1 : 0];
    if (role.names == Names::object) {
      const ObjectId other = numbers.object(object);
      std::memcpy(row + field.offset, &other, sizeof other);
    } else if (is_name(field)) {
      const bool is_face =
          role.names == Names::triangle ||
          (role.names == Names::element && record.kind_of_element(row, role.side) == FeatureKind::face);
      for (std::size_t i = 0; i < field.count; ++i) {
        std::uint32_t number;
        std::byte* const at = row + field.offset + i * sizeof number;
        std::memcpy(&number, at, sizeof number);
        number = is_face ? numbers.face(object, number) : numbers.vertex(object, number);
        std::memcpy(at, &number, sizeof number);
      }
    }
  }
}

}  // namespace supple
