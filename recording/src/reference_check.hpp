#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
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
      : objects_(objects), fail_(std::move(fail)) {
    for_each_list([&](const auto& list, auto member) {
      Target& target = targets_[list.name];
      target.rows = member(frame).size();
      if constexpr (std::is_same_v<std::remove_cvref_t<decltype(member(frame))>, std::vector<std::uint32_t>>)
        target.numbers = member(frame);
    });
  }

  template <class Row>
  void rows(const ResultList<Row>& list, std::span<const Row> rows) const {
    if constexpr (Described<Row>) {
      for_each_field<Row>([&](const auto& field) {
        if (field.role.names == Names::object) objects(list, field, rows);
      });
      for_each_field<Row>([&](const auto& field) { column(list, field, rows); });
      if constexpr (std::is_same_v<Row, Manifold>) manifold_records(list, rows);
    } else if (list.role.names == Names::first_row) {
      const std::size_t allowed = targets_.at(list.role.list).rows;
      for (std::size_t i = 0; i < rows.size(); ++i)
        below(list.name, i, list.value, number_of(rows[i]), allowed);
    }
  }

 private:
  /// A list that others refer to.
  struct Target {
    std::size_t rows = 0;
    std::span<const std::uint32_t> numbers;  ///< of a list without members
  };

  static std::uint64_t number_of(const auto& value) {
    if constexpr (requires { static_cast<std::uint64_t>(value); })
      return static_cast<std::uint64_t>(value);
    else
      return 0;
  }

  /// The names become texts only on failure: this runs for each value.
  void below(std::string_view list, std::size_t row, std::string_view column, std::uint64_t value,
             std::uint64_t allowed) const {
    if (value >= allowed) fail_({std::string(list), row, std::string(column), value, allowed});
  }

  template <class Row>
  const RecordedObject& object(const Row& row, char side) const {
    const RecordedObject* found = nullptr;
    for_each_field<Row>([&]<class Value>(const Field<Row, Value>& field) {
      if constexpr (std::is_same_v<Value, ObjectId>) {
        if (field.role.side == side) found = &objects_[(row.*field.member).index];
      }
    });
    return *found;
  }

  template <class Row, class Value>
  void objects(const ResultList<Row>& list, const Field<Row, Value>& field, std::span<const Row> rows) const {
    if constexpr (std::is_same_v<Value, ObjectId>) {
      const std::string name = std::string("object_") + field.role.side;
      for (std::size_t i = 0; i < rows.size(); ++i)
        below(list.name, i, name, (rows[i].*field.member).index, objects_.size());
    }
  }

  template <class Row, class Value>
  void column(const ResultList<Row>& list, const Field<Row, Value>& field, std::span<const Row> rows) const {
    const auto each = [&](auto value_and_limit) {
      for (std::size_t i = 0; i < rows.size(); ++i) {
        const auto [value, allowed] = value_and_limit(rows[i], rows[i].*field.member);
        below(list.name, i, field.key, value, allowed);
      }
    };
    using Pair = std::pair<std::uint64_t, std::uint64_t>;
    if constexpr (Worded<Value>) {
      each([](const Row&, Value value) { return Pair(number_of(value), words<Value>.size()); });
    } else if constexpr (std::is_same_v<Value, Feature>) {
      const std::string index = name_of_feature_index(field.key);
      for (std::size_t i = 0; i < rows.size(); ++i) {
        const Feature& feature = rows[i].*field.member;
        below(list.name, i, field.key, number_of(feature.kind), words<FeatureKind>.size());
        below(list.name, i, index, feature.index, 3);
      }
    } else if constexpr (std::is_same_v<Value, std::uint32_t>) {
      if (field.role.names == Names::triangle)
        each([&](const Row& row, auto value) {
          return Pair(value, object(row, field.role.side).triangles.size());
        });
      else if (field.role.names == Names::vertex)
        each([&](const Row& row, auto value) {
          return Pair(value, object(row, field.role.side).rest_positions.size());
        });
      else if (field.role.names == Names::rows && *field.role.list == 0)
        each([&](const Row& row, auto value) {
          return Pair(value, object(row, field.role.side).rest_positions.size() + 1);
        });
      else if (field.role.names == Names::first_row)
        ranges(list, field, rows);
    } else if constexpr (std::is_same_v<Value, std::array<std::uint32_t, 2>>) {
      each([&](const Row& row, const Value& ids) {
        const bool is_face = kind_of_element(row, field.role.side) == FeatureKind::face;
        const RecordedObject& of = object(row, field.role.side);
        return Pair(std::max(ids[0], ids[1]), is_face ? of.triangles.size() : of.rest_positions.size());
      });
    }
  }

  /// The rows of another list that a record refers to: the first, and one or more numbers of rows.
  template <class Row>
  void ranges(const ResultList<Row>& list, const Field<Row, std::uint32_t>& first,
              std::span<const Row> rows) const {
    const std::string_view name = first.role.list;
    const Target& target = targets_.at(first.role.list);
    // Contacts have numbers of points also when the points themselves are switched off.
    if (target.rows == 0 && name == "contact_points") return;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      std::uint64_t left = target.rows;
      const auto for_each_count = [&](auto visit) {
        for_each_field<Row>([&]<class Value>(const Field<Row, Value>& field) {
          if constexpr (std::is_integral_v<Value>) {
            if (field.role.names == Names::rows && name == field.role.list)
              visit(field, std::uint64_t{rows[i].*field.member});
          }
        });
      };
      for_each_count([&](const auto& field, std::uint64_t count) {
        below(list.name, i, field.key, count, left + 1);
        left -= count;
      });
      std::uint64_t at = rows[i].*first.member;
      below(list.name, i, first.key, at, left + 1);
      for_each_count([&](const auto& field, std::uint64_t count) {
        if (field.role.side != 0) {
          const std::size_t vertices = object(rows[i], field.role.side).rest_positions.size();
          for (std::uint64_t v = at; v < at + count; ++v)
            below(first.role.list, v, "vertex", target.numbers[v], vertices);
        }
        at += count;
      });
    }
  }

  void manifold_records(const ResultList<Manifold>& list, std::span<const Manifold> rows) const {
    for (std::size_t i = 0; i < rows.size(); ++i)
      below(list.name, i, "record", rows[i].record,
            targets_.at(rows[i].source == ManifoldSource::curve ? "curves" : "proximity_pairs").rows);
  }

  std::span<const RecordedObject> objects_;
  std::map<std::string, Target> targets_;
  std::function<void(const BadReference&)> fail_;
};

}  // namespace supple
