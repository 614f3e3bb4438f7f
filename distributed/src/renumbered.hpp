#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "supple/record_info.hpp"
#include "supple/types.hpp"

namespace supple {

/// Other numbers for objects and for what belongs to them.
class Numbers {
 public:
  virtual ~Numbers() = default;
  virtual ObjectId object(ObjectId object) const = 0;
  virtual std::uint32_t face(ObjectId object, std::uint32_t t) const = 0;
  virtual std::uint32_t vertex(ObjectId object, std::uint32_t v) const = 0;
};

/// Objects a and b of a row; a row without b has a twice.
std::array<ObjectId, 2> objects_of(const RecordInfo& record, const std::byte* row);

/// Whether a member names objects or what belongs to them.
bool is_name(const FieldInfo& field);

/// Gives a row of a record other numbers. `objects` are those of the row. A vertex of no side is one of the
/// object `side`.
void renumber(const RecordInfo& record, std::byte* row, const std::array<ObjectId, 2>& objects,
              const Numbers& numbers, char side = 'a');

template <Described Record>
Record renumbered(Record record, const Numbers& numbers) {
  static const RecordInfo info = record_info<Record>();
  auto* const row = reinterpret_cast<std::byte*>(&record);
  renumber(info, row, objects_of(info, row), numbers);
  return record;
}

}  // namespace supple
