#include <bit>
#include <cmath>
#include <cstddef>
#include <span>
#include <type_traits>

#include "layout.hpp"
#include "supple/error.hpp"
#include "supple/option_descriptions.hpp"
#include "supple/recording.hpp"
#include "text.hpp"

namespace supple {
namespace {

/// A sentence about a difference, or nothing when both are equal.
using Line = std::optional<std::string>;

std::string quoted(const std::string& text) {
  std::string result(1, '\'');
  result += text;
  result += '\'';
  return result;
}
std::string value_text(const std::string& value) {
  return quoted(value);
}
std::string value_text(double value) {
  return to_text(value);
}
std::string value_text(Vec3d value) {
  return to_text(value);
}
std::string value_text(const std::optional<RootCube>& value) {
  return value ? text_of(*value) : "none";
}
template <class Value>
requires std::is_integral_v<Value> std::string value_text(Value value) {
  return std::to_string(value);
}
template <class Enum>
requires std::is_enum_v<Enum> std::string value_text(Enum value) {
  if constexpr (Worded<Enum>) {
    return quoted(word_of(value));
  } else {
    return std::to_string(static_cast<unsigned>(value));
  }
}
template <class Scalar, std::size_t Count>
std::string value_text(const std::array<Scalar, Count>& values) {
  std::string text;
  for (const Scalar value : values) {
    text += text.empty() ? "(" : ", ";
    text += value_text(value);
  }
  return text + ")";
}

template <class Value>
std::string both(const std::string& item, const Value& a, const Value& b) {
  return item + ": " + value_text(a) + " and " + value_text(b);
}

bool equal_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

template <class Value>
Line compare_exactly(const std::string& item, const Value& a, const Value& b) {
  bool equal = false;
  if constexpr (std::is_same_v<Value, double>) {
    equal = equal_bits(a, b);
  } else {
    equal = a == b;
  }
  return equal ? Line() : both(item, a, b);
}

/// Compares all options or statistics except those of the machine; an item is named `before + name + after`.
template <Described Struct>
Line compare_described(const std::string& before, const Struct& a, const Struct& b,
                       const std::string& after = {}) {
  Line line;
  for_each_leaf(
      [&](const auto& field, const auto& p, const auto& q) {
        if (!line && !field.is_of_machine) line = compare_exactly(before + field.key + after, p, q);
      },
      a, b);
  return line;
}

/// The first difference.
template <class... Lines>
Line first_of(Lines... compare) {
  Line line;
  ((line = compare(), line.has_value()) || ...);
  return line;
}

class Comparison {
 public:
  Comparison(const Recording& a, const Recording& b, double tolerance)
      : a_(a), b_(b), tolerance_(tolerance) {}

  Line headers() const;
  Line frame(std::uint64_t number) const;

 private:
  bool equal(double a, double b) const {
    return equal_bits(a, b) ||
           (tolerance_ > 0 && ((std::isnan(a) && std::isnan(b)) || std::fabs(a - b) <= tolerance_));
  }
  bool equal(Vec3d a, Vec3d b) const { return equal(a.x, b.x) && equal(a.y, b.y) && equal(a.z, b.z); }
  template <std::size_t Count>
  bool equal(const std::array<double, Count>& a, const std::array<double, Count>& b) const {
    for (std::size_t i = 0; i < Count; ++i) {
      if (!equal(a[i], b[i])) return false;
    }
    return true;
  }
  template <class Value>
  Line compare(const std::string& item, const Value& a, const Value& b) const {
    return equal(a, b) ? Line() : both(item, a, b);
  }

  Line objects() const;
  Line object(std::size_t place) const;
  Line points_of(const char* item, const std::string& of, std::span<const Vec3d> a,
                 std::span<const Vec3d> b) const;
  Line lists(const RecordedFrame& a, const RecordedFrame& b) const;
  template <class Row>
  Line list(const ResultList<Row>& list, const RecordedFrame& a, const RecordedFrame& b,
            std::span<const Row> rows_a, std::span<const Row> rows_b) const;
  template <class Row>
  Line row(const Row& p, const Row& q) const;
  template <class Row>
  Line rows_of(const Row& row, const RecordedFrame& a, const RecordedFrame& b) const;
  template <class Value>
  Line value(const std::string& item, const Role& role, const Value& a, const Value& b) const {
    if constexpr (!std::is_integral_v<Value> && requires { equal(a, b); }) {
      if (role.is_rounded) return compare(item, a, b);
    }
    return compare_exactly(item, a, b);
  }

  std::string name(ObjectId id) const;
  template <class Row>
  std::string name(const Row& row) const;

  const Recording& a_;
  const Recording& b_;
  double tolerance_;
};

std::string Comparison::name(ObjectId id) const {
  const std::vector<RecordedObject>& objects = a_.header().objects;
  for (std::size_t place = 0; place < objects.size(); ++place) {
    if (objects[place].id == id)
      return "object " + std::to_string(place) + " " + quoted(objects[place].options.name);
  }
  return "object of id " + std::to_string(id.index);
}

/// The key of a record: `triangle 3 of object 0 'cloth' and triangle 5 of object 1 'ball'`.
template <class Row>
std::string Comparison::name(const Row& row) const {
  std::string text;
  for (const char side : {'a', 'b'}) {
    std::string part, object;
    for_each_field<Row>([&]<class Value>(const Field<Row, Value>& field) {
      if (!field.role.is_key || field.role.side != side) return;
      if constexpr (std::is_same_v<Value, ObjectId>) {
        object = name(row.*field.member);
      } else if constexpr (std::is_same_v<Value, std::array<std::uint32_t, 2>>) {
        const auto& [first, second] = row.*field.member;
        part = std::string(word_of(kind_of_element(row, side))) + " " + std::to_string(first);
        if (first != second) part += " " + std::to_string(second);  // an edge
      } else if constexpr (std::is_integral_v<Value>) {
        part = (field.role.names == Names::triangle ? "triangle " : "vertex ") +
               std::to_string(row.*field.member);
      }
    });
    text += (text.empty() ? "" : " and ") + part + (part.empty() ? "" : " of ") + object;
  }
  return text;
}

Line Comparison::headers() const {
  const RecordingHeader &a = a_.header(), &b = b_.header();
  return first_of([&] { return objects(); },
                  [&] { return compare_exactly("time_step", a.time_step, b.time_step); },
                  [&] { return compare_described("", a.scene, b.scene); });
}

Line Comparison::objects() const {
  const std::size_t count = a_.header().objects.size();
  if (Line line = compare_exactly("number of objects", count, b_.header().objects.size())) return line;
  for (std::size_t place = 0; place < count; ++place) {
    if (Line line = object(place)) return line;
  }
  return {};
}

Line Comparison::object(std::size_t place) const {
  const RecordedObject &a = a_.header().objects[place], &b = b_.header().objects[place];
  const std::string of = " of object " + std::to_string(place);
  const auto line = first_of(
      [&] { return compare_exactly("id_index" + of, a.id.index, b.id.index); },
      [&] { return compare_exactly("id_generation" + of, a.id.generation, b.id.generation); },
      [&] { return compare_described("", a.options, b.options, of); },
      [&] {
        return compare_exactly("number of vertices" + of, a.rest_positions.size(), b.rest_positions.size());
      },
      [&] { return points_of("rest position", of, a.rest_positions, b.rest_positions); });
  if (line) return line;
  const auto elements = [&](const std::string& noun, const auto& of_a, const auto& of_b) -> Line {
    if (Line count = compare_exactly("number of " + noun + "s" + of, of_a.size(), of_b.size())) return count;
    for (std::size_t i = 0; i < of_a.size(); ++i) {
      if (Line ids = compare_exactly(noun + " " + std::to_string(i) + of, of_a[i], of_b[i])) return ids;
    }
    return {};
  };
  return first_of([&] { return elements("triangle", a.triangles, b.triangles); },
                  [&] { return elements("edge", a.options.edges, b.options.edges); },
                  [&] { return elements("point", a.options.points, b.options.points); });
}

Line Comparison::points_of(const char* item, const std::string& of, std::span<const Vec3d> a,
                           std::span<const Vec3d> b) const {
  for (std::size_t vertex = 0; vertex < a.size(); ++vertex) {
    if (equal(a[vertex], b[vertex])) continue;
    return both(std::string(item) + " of vertex " + std::to_string(vertex) + of, a[vertex], b[vertex]);
  }
  return {};
}

/// The key of a record, by which lists are sorted.
struct Key {
  std::array<std::uint64_t, 10> numbers{};
  std::size_t count = 0;

  void add(std::uint64_t number) { numbers[count++] = number; }
  auto operator<=>(const Key&) const = default;
};

template <class Row>
Key key_of(const Row& row) {
  Key key;
  for_each_field<Row>([&]<class Value>(const Field<Row, Value>& field) {
    if (!field.role.is_key) return;
    const Value& value = row.*field.member;
    if constexpr (std::is_same_v<Value, ObjectId>) {
      key.add(value.index);
      key.add(value.generation);
    } else if constexpr (std::is_same_v<Value, std::array<std::uint32_t, 2>>) {
      for (const std::uint32_t number : value) key.add(number);
    } else if constexpr (std::is_integral_v<Value> || std::is_enum_v<Value>) {
      key.add(static_cast<std::uint64_t>(value));
    }
  });
  return key;
}

/// Compares all lists: of records row by row, in the order of their keys. What a record refers to in lists of
/// values is compared with the record.
Line Comparison::lists(const RecordedFrame& a, const RecordedFrame& b) const {
  Line line;
  for_each_list([&]<class Row>(const ResultList<Row>& of, auto member) {
    if constexpr (Described<Row>) {
      if (!line) line = list(of, a, b, std::span<const Row>(member(a)), std::span<const Row>(member(b)));
    }
  });
  return line;
}

template <class Row>
Line Comparison::list(const ResultList<Row>& list, const RecordedFrame& a, const RecordedFrame& b,
                      std::span<const Row> rows_a, std::span<const Row> rows_b) const {
  std::string item = list.item;
  if (item.starts_with("events/")) item = "event " + item.substr(std::string_view("events/").size());
  const bool has_key = key_of(Row{}).count > 0;
  if (!has_key) {
    if (Line line = compare_exactly("number of " + item + "s", rows_a.size(), rows_b.size())) return line;
  }
  for (std::size_t i = 0; i < rows_a.size() || i < rows_b.size(); ++i) {
    const Key key_a = i < rows_a.size() ? key_of(rows_a[i]) : Key{};
    const Key key_b = i < rows_b.size() ? key_of(rows_b[i]) : Key{};
    const bool only_a = i >= rows_b.size() || (i < rows_a.size() && key_a < key_b);
    const bool only_b = i >= rows_a.size() || (i < rows_b.size() && key_b < key_a);
    if (only_a || only_b)
      return item + " " + std::to_string(i) + ": " + name(only_a ? rows_a[i] : rows_b[i]) + " only in the " +
             (only_a ? "first" : "second") + " recording (" + std::to_string(rows_a.size()) + " and " +
             std::to_string(rows_b.size()) + " in all)";
    Line line = row(rows_a[i], rows_b[i]);
    if (!line) line = rows_of(rows_a[i], a, b);
    if (!line) continue;
    return item + " " + std::to_string(i) + ", " + (has_key ? name(rows_a[i]) + ", " : "") + *line;
  }
  return {};
}

template <class Row>
Line Comparison::row(const Row& p, const Row& q) const {
  Line line;
  for_each_field<Row>([&]<class Value>(const Field<Row, Value>& field) {
    if (line || field.role.is_key) return;
    const Value &a = p.*field.member, &b = q.*field.member;
    if constexpr (std::is_same_v<Value, Feature>) {
      line = first_of([&] { return compare_exactly(field.key, a.kind, b.kind); },
                      [&] { return compare_exactly(name_of_feature_index(field.key), a.index, b.index); });
    } else if constexpr (!std::is_same_v<Value, ObjectId>) {
      line = value(field.key, field.role, a, b);
    }
  });
  return line;
}

/// Compares the values to which two records with equal ranges refer.
template <class Row>
Line Comparison::rows_of(const Row& row, const RecordedFrame& a, const RecordedFrame& b) const {
  Line line;
  for_each_field<Row>([&]<class Value>(const Field<Row, Value>& first) {
    if constexpr (std::is_same_v<Value, std::uint32_t>) {
      if (first.role.names != Names::first_row) return;
      const std::string_view name = first.role.list;
      std::size_t count = 0;
      for_each_field<Row>([&]<class Count>(const Field<Row, Count>& field) {
        if constexpr (std::is_integral_v<Count>) {
          if (field.role.names == Names::rows && name == field.role.list) count += row.*field.member;
        }
      });
      for_each_list([&]<class Item>(const ResultList<Item>& list, auto member) {
        if constexpr (!Described<Item>) {
          for (std::size_t i = 0; !line && name == list.name && i < count; ++i) {
            const std::size_t at = row.*first.member + i;
            line = value(std::string(list.item) + " " + std::to_string(i), list.role, member(a)[at],
                         member(b)[at]);
          }
        }
      });
    }
  });
  return line;
}

Line Comparison::frame(std::uint64_t number) const {
  const RecordedFrame a = a_.frame(number), b = b_.frame(number);
  if (Line line = compare_exactly("time", a.time, b.time)) return line;
  const std::vector<RecordedObject>& objects = a_.header().objects;
  for (std::size_t place = 0; place < objects.size(); ++place) {
    if (objects[place].options.is_static && number > 0) continue;
    if (Line line = points_of("position", " of " + name(objects[place].id), a_.positions(number, place),
                              b_.positions(number, place)))
      return line;
  }
  if (Line line = lists(a, b)) return line;
  // Counts of work depend on the number of ranks.
  if (a_.header().ranks != b_.header().ranks) return {};
  return compare_described("statistics, ", a.stats, b.stats);
}

}  // namespace

std::optional<RecordingDifference> find_first_difference(const Recording& a, const Recording& b,
                                                         double tolerance) {
  if (!(tolerance >= 0 && std::isfinite(tolerance)))
    throw Error("the tolerance of a comparison is " + to_text(tolerance) +
                "; give a finite number, 0 or more");
  const Comparison comparison(a, b, tolerance);
  if (Line line = comparison.headers()) return RecordingDifference{{}, *line};
  const std::uint64_t frames = std::min(a.frame_count(), b.frame_count());
  for (std::uint64_t frame = 0; frame < frames; ++frame) {
    if (Line line = comparison.frame(frame)) return RecordingDifference{frame, *line};
  }
  if (Line line = compare_exactly("number of frames", a.frame_count(), b.frame_count()))
    return RecordingDifference{{}, *line};
  return {};
}

}  // namespace supple
