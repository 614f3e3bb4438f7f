#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
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

  Line objects() const;
  Line object(std::size_t place) const;
  Line points_of(const char* item, const std::string& of, std::span<const Vec3d> a,
                 std::span<const Vec3d> b) const;
  /// The lists of a frame in one recording and in the other one.
  struct Lists {
    std::vector<ListRows> a, b;
  };
  Line list(std::size_t place, const Lists& lists) const;
  Line row(const RecordInfo& record, const std::byte* p, const std::byte* q) const;
  Line referred(const RecordInfo& record, const std::byte* row, const Lists& lists) const;
  Line value(const FieldInfo& field, const std::string& item, const std::byte* p, const std::byte* q) const;

  std::string name(ObjectId id) const;
  std::string name(const RecordInfo& record, const std::byte* row) const;

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
std::string Comparison::name(const RecordInfo& record, const std::byte* row) const {
  std::string text;
  for (const char side : {'a', 'b'}) {
    std::string part, object;
    for (const FieldInfo& field : record.fields) {
      const Names names = field.role.names;
      if (!field.role.is_key || field.role.side != side || names == Names::nothing) continue;
      const auto number = [&](std::size_t i) { return static_cast<std::uint32_t>(number_of(field, row, i)); };
      if (names == Names::object) {
        object = name(ObjectId{number(0), number(1)});
        continue;
      }
      const FeatureKind kind = names == Names::element    ? record.kind_of_element(row, side)
                               : names == Names::triangle ? FeatureKind::face
                                                          : FeatureKind::vertex;
      part = names == Names::triangle ? "triangle" : word_of(kind);
      for (std::size_t i = 0; i < (names == Names::element && number(0) != number(1) ? 2u : 1u); ++i)
        part.append(" ").append(std::to_string(number(i)));  // two of an edge
    }
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

/// Compares two lists of records row by row, in the order of their keys. What a record refers to in lists of
/// values is compared with the record.
Line Comparison::list(std::size_t place, const Lists& lists) const {
  const ListInfo& info = list_infos()[place];
  const ListRows &rows_a = lists.a[place], &rows_b = lists.b[place];
  std::string item = info.item;
  if (item.starts_with("events/")) item = "event " + item.substr(std::string_view("events/").size());
  const bool has_key = info.record.fields[0].role.is_key;
  if (!has_key) {
    if (Line line = compare_exactly("number of " + item + "s", rows_a.count, rows_b.count)) return line;
  }
  std::vector<std::uint64_t> key_a, key_b;
  const auto row_of = [&](const ListRows& rows, std::size_t i, std::vector<std::uint64_t>& key) {
    key.clear();
    const std::byte* const at = i < rows.count ? rows.data + i * info.record.bytes : nullptr;
    if (at != nullptr) add_key(info.record, at, key);
    return at;
  };
  for (std::size_t i = 0; i < rows_a.count || i < rows_b.count; ++i) {
    const std::byte* const row_a = row_of(rows_a, i, key_a);
    const std::byte* const row_b = row_of(rows_b, i, key_b);
    const bool only_a = row_b == nullptr || (row_a != nullptr && key_a < key_b);
    const bool only_b = row_a == nullptr || (row_b != nullptr && key_b < key_a);
    if (only_a || only_b)
      return item + " " + std::to_string(i) + ": " + name(info.record, only_a ? row_a : row_b) +
             " only in the " + (only_a ? "first" : "second") + " recording (" + std::to_string(rows_a.count) +
             " and " + std::to_string(rows_b.count) + " in all)";
    Line line = row(info.record, row_a, row_b);
    if (!line) line = referred(info.record, row_a, lists);
    if (!line) continue;
    return item + " " + std::to_string(i) + ", " + (has_key ? name(info.record, row_a) + ", " : "") + *line;
  }
  return {};
}

Line Comparison::row(const RecordInfo& record, const std::byte* p, const std::byte* q) const {
  for (const FieldInfo& field : record.fields) {
    if (field.role.is_key) continue;
    if (Line line = value(field, field.name, p, q)) return line;
  }
  return {};
}

std::string text_of(const FieldInfo& field, const std::byte* row, std::size_t place) {
  if (field.scalar == ScalarType::float64) return to_text(real_number(field, row, place));
  const std::uint64_t number = number_of(field, row, place);
  return field.words.empty() ? std::to_string(number) : quoted(field.words[number]);
}
std::string text_of(const FieldInfo& field, const std::byte* row) {
  if (field.count == 1) return text_of(field, row, 0);
  std::string text;
  for (std::size_t i = 0; i < field.count; ++i)
    text.append(i == 0 ? "(" : ", ").append(text_of(field, row, i));
  return text + ")";
}

/// Compares a member of two records.
Line Comparison::value(const FieldInfo& field, const std::string& item, const std::byte* p,
                       const std::byte* q) const {
  const auto is_equal = [&](std::size_t i) {
    const std::size_t at = field.offset + i * size_of(field.scalar);
    if (std::memcmp(p + at, q + at, size_of(field.scalar)) == 0) return true;
    return field.scalar == ScalarType::float64 && field.role.is_rounded &&
           equal(real_number(field, p, i), real_number(field, q, i));
  };
  std::size_t i = 0;
  while (i < field.count && is_equal(i)) ++i;
  if (i == field.count) return {};
  if (field.kind != FieldInfo::Kind::feature)
    return item + ": " + text_of(field, p) + " and " + text_of(field, q);
  FieldInfo part = field;  // a feature is a kind and an index
  if (i == 1) part.words = {};
  return (i == 0 ? item : name_of_feature_index(item)) + ": " + text_of(part, p, i) + " and " +
         text_of(part, q, i);
}

/// Compares the values to which two records with equal ranges refer.
Line Comparison::referred(const RecordInfo& record, const std::byte* row, const Lists& lists) const {
  for (const FieldInfo& first : record.fields) {
    if (first.role.names != Names::first_row) continue;
    const std::size_t place = place_of_list(first.role.list);
    const ListInfo& info = list_infos()[place];
    if (*info.record.name != 0) continue;  // a list of records is compared by itself
    std::size_t count = 0;
    for (const FieldInfo& field : record.fields) {
      if (field.role.names == Names::rows && std::string_view(first.role.list) == field.role.list)
        count += number_of(field, row);
    }
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t at = (number_of(first, row) + i) * info.record.bytes;
      if (Line line = value(info.record.fields[0], std::string(info.item) + " " + std::to_string(i),
                            lists.a[place].data + at, lists.b[place].data + at))
        return line;
    }
  }
  return {};
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
  const Lists lists{supple::rows_of(a), supple::rows_of(b)};
  for (std::size_t place = 0; place < list_infos().size(); ++place) {
    if (*list_infos()[place].record.name == 0) continue;
    if (Line line = list(place, lists)) return line;
  }
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
