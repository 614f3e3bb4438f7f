#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "layout.hpp"
#include "supple/recording.hpp"

namespace supple {

/// A value in a row of a list that is not below the allowed number.
struct BadReference {
  std::string list;
  std::size_t row = 0;
  std::string column;
  std::uint64_t value = 0, allowed = 0;
};

/// Checks that the records of a frame refer only to what exists. Objects have their index in the file.
class ReferenceCheck {
 public:
  /// `fail` throws.
  ReferenceCheck(std::span<const RecordedObject> objects, const RecordedFrame& frame,
                 std::function<void(const BadReference&)> fail)
      : objects_(objects), lists_(rows_of(frame)), fail_(std::move(fail)) {}

  /// Checks a list of `list_infos`.
  void list(std::size_t place) const;

 private:
  const RecordedObject& object(const RecordInfo& record, const std::byte* row, char side) const;
  void ranges(const ListInfo& list, const FieldInfo& first, std::size_t i, const std::byte* row) const;
  /// The names become texts only on failure: this runs for each value.
  void below(std::string_view list, std::size_t row, std::string_view column, std::uint64_t value,
             std::uint64_t allowed) const {
    if (value >= allowed) fail_({std::string(list), row, std::string(column), value, allowed});
  }

  std::span<const RecordedObject> objects_;
  std::vector<ListRows> lists_;
  std::function<void(const BadReference&)> fail_;
};

}  // namespace supple
