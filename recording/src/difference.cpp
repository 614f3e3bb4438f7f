#include <bit>
#include <cmath>
#include <cstddef>
#include <span>
#include <tuple>
#include <type_traits>

#include "supple/error.hpp"
#include "supple/option_descriptions.hpp"
#include "supple/recording.hpp"
#include "supple/result_descriptions.hpp"
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
  Line pairs(const char* item, const std::vector<ObjectPair>& a, const std::vector<ObjectPair>& b) const;
  Line contacts(const RecordedFrame& a, const RecordedFrame& b) const;
  Line contact_points(const RecordedFrame& a, const RecordedFrame& b) const;
  Line continuous_contacts(const RecordedFrame& a, const RecordedFrame& b) const;
  Line proximity_pairs(const RecordedFrame& a, const RecordedFrame& b) const;
  Line colliding_vertices(const RecordedFrame& a, const RecordedFrame& b) const;

  std::string name(ObjectId id) const;
  std::string name(const ObjectPair& pair) const { return name(pair.a) + " and " + name(pair.b); }
  std::string name(const CollidingVertices& group) const { return name(ObjectPair{group.a, group.b}); }
  std::string name(const Contact& c) const {
    return "triangle " + std::to_string(c.triangle_a) + " of " + name(c.object_a) + " and triangle " +
           std::to_string(c.triangle_b) + " of " + name(c.object_b);
  }
  std::string name(const ContinuousContact& c) const;
  std::string name(const ProximityPair& pair) const;
  /// An edge has two different ids.
  std::string name(const char* noun, const std::array<std::uint32_t, 2>& ids, ObjectId object) const;

  /// Compares lists in ascending order of `key`. `compare_rows` compares two rows with equal keys.
  template <class Row, class Key, class CompareRows>
  Line lists(const std::string& item, const std::vector<Row>& a, const std::vector<Row>& b, Key key,
             CompareRows compare_rows) const;

  const Recording& a_;
  const Recording& b_;
  double tolerance_;
};

template <class Row, class Key, class CompareRows>
Line Comparison::lists(const std::string& item, const std::vector<Row>& a, const std::vector<Row>& b, Key key,
                       CompareRows compare_rows) const {
  for (std::size_t i = 0; i < a.size() || i < b.size(); ++i) {
    const bool only_a = i == b.size() || (i < a.size() && key(a[i]) < key(b[i]));
    const bool only_b = i == a.size() || (i < b.size() && key(b[i]) < key(a[i]));
    if (only_a || only_b) {
      return item + " " + std::to_string(i) + ": " + name(only_a ? a[i] : b[i]) + " only in the " +
             (only_a ? "first" : "second") + " recording (" + std::to_string(a.size()) + " and " +
             std::to_string(b.size()) + " in all)";
    }
    if (const Line line = compare_rows(a[i], b[i]))
      return item + " " + std::to_string(i) + ", " + name(a[i]) + ", " + *line;
  }
  return {};
}

std::string Comparison::name(ObjectId id) const {
  const std::vector<RecordedObject>& objects = a_.header().objects;
  for (std::size_t place = 0; place < objects.size(); ++place) {
    if (objects[place].id == id)
      return "object " + std::to_string(place) + " " + quoted(objects[place].options.name);
  }
  return "object of id " + std::to_string(id.index);
}

std::string Comparison::name(const char* noun, const std::array<std::uint32_t, 2>& ids,
                             ObjectId object) const {
  std::string text = std::string(noun) + " " + std::to_string(ids[0]);
  if (ids[0] != ids[1]) text.append(" ").append(std::to_string(ids[1]));
  return text + " of " + name(object);
}

std::string Comparison::name(const ProximityPair& pair) const {
  return name(word_of(pair.kind_a), pair.element_a, pair.object_a) + " and " +
         name(word_of(pair.kind_b), pair.element_b, pair.object_b);
}

std::string Comparison::name(const ContinuousContact& c) const {
  const auto [kind_a, kind_b] = feature_kinds(c.kind);
  return name(word_of(kind_a), c.element_a, c.object_a) + " and " +
         name(word_of(kind_b), c.element_b, c.object_b);
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

Line Comparison::pairs(const char* item, const std::vector<ObjectPair>& a,
                       const std::vector<ObjectPair>& b) const {
  return lists(
      item, a, b, [](const ObjectPair& pair) { return pair; },
      [](const ObjectPair&, const ObjectPair&) { return Line(); });
}

Line Comparison::contacts(const RecordedFrame& a, const RecordedFrame& b) const {
  const auto key = [](const Contact& c) {
    return std::tuple(c.object_a, c.object_b, c.triangle_a, c.triangle_b);
  };
  return lists("contact", a.contacts, b.contacts, key, [this](const Contact& p, const Contact& q) {
    return first_of([&] { return compare_exactly("kind", p.kind, q.kind); },
                    [&] { return compare_exactly("point_count", p.point_count, q.point_count); },
                    [&] { return compare_exactly("first_point", p.first_point, q.first_point); },
                    [&] { return compare("normal", p.normal, q.normal); });
  });
}

Line Comparison::contact_points(const RecordedFrame& a, const RecordedFrame& b) const {
  if (Line line =
          compare_exactly("number of contact points", a.contact_points.size(), b.contact_points.size()))
    return line;
  for (std::size_t i = 0; i < a.contact_points.size(); ++i) {
    const ContactPoint &p = a.contact_points[i], &q = b.contact_points[i];
    const std::string item = "contact point " + std::to_string(i) + ", ";
    const auto line =
        first_of([&] { return compare(item + "position", p.position, q.position); },
                 [&] { return compare_exactly(item + "feature_a", p.on_a.kind, q.on_a.kind); },
                 [&] { return compare_exactly(item + "feature_index_a", p.on_a.index, q.on_a.index); },
                 [&] { return compare_exactly(item + "feature_b", p.on_b.kind, q.on_b.kind); },
                 [&] { return compare_exactly(item + "feature_index_b", p.on_b.index, q.on_b.index); });
    if (line) return line;
  }
  return {};
}

Line Comparison::continuous_contacts(const RecordedFrame& a, const RecordedFrame& b) const {
  const auto key = [](const ContinuousContact& c) {
    return std::tuple(c.object_a, c.object_b, c.kind, c.element_a, c.element_b);
  };
  const auto compare_rows = [this](const ContinuousContact& p, const ContinuousContact& q) {
    return first_of(
        [&] { return compare_exactly("certainty", p.certainty, q.certainty); },
        [&] { return compare_exactly("touching_at_start", p.touching_at_start, q.touching_at_start); },
        [&] { return compare("toi", p.toi, q.toi); },
        [&] { return compare("start_distance", p.start_distance, q.start_distance); },
        [&] { return compare("barycentric_a", p.barycentric_a, q.barycentric_a); },
        [&] { return compare("barycentric_b", p.barycentric_b, q.barycentric_b); },
        [&] { return compare("point", p.point, q.point); },
        [&] { return compare("normal", p.normal, q.normal); });
  };
  return lists("continuous contact", a.continuous_contacts, b.continuous_contacts, key, compare_rows);
}

Line Comparison::proximity_pairs(const RecordedFrame& a, const RecordedFrame& b) const {
  const auto key = [](const ProximityPair& p) {
    return std::tuple(p.object_a, p.object_b, p.kind_a, p.kind_b, p.element_a, p.element_b);
  };
  const auto compare_rows = [this](const ProximityPair& p, const ProximityPair& q) {
    return first_of([&] { return compare_exactly("feature_a", p.on_a.kind, q.on_a.kind); },
                    [&] { return compare_exactly("feature_index_a", p.on_a.index, q.on_a.index); },
                    [&] { return compare_exactly("feature_b", p.on_b.kind, q.on_b.kind); },
                    [&] { return compare_exactly("feature_index_b", p.on_b.index, q.on_b.index); },
                    [&] { return compare("distance", p.distance, q.distance); },
                    [&] { return compare("barycentric_a", p.barycentric_a, q.barycentric_a); },
                    [&] { return compare("barycentric_b", p.barycentric_b, q.barycentric_b); },
                    [&] { return compare("point_a", p.point_a, q.point_a); },
                    [&] { return compare("point_b", p.point_b, q.point_b); },
                    [&] { return compare("normal", p.normal, q.normal); });
  };
  return lists("proximity pair", a.proximity_pairs, b.proximity_pairs, key, compare_rows);
}

Line Comparison::colliding_vertices(const RecordedFrame& a, const RecordedFrame& b) const {
  const auto compare_groups = [&](const CollidingVertices& p, const CollidingVertices& q) {
    Line line = first_of([&] { return compare_exactly("count_a", p.count_a, q.count_a); },
                         [&] { return compare_exactly("count_b", p.count_b, q.count_b); },
                         [&] { return compare_exactly("first_vertex", p.first_vertex, q.first_vertex); });
    for (std::size_t i = p.first_vertex; !line && i < p.first_vertex + p.count_a + p.count_b; ++i) {
      line = compare_exactly("vertex " + std::to_string(i - p.first_vertex), a.colliding_vertices[i],
                             b.colliding_vertices[i]);
    }
    return line;
  };
  return lists(
      "colliding vertices", a.colliding_vertex_groups, b.colliding_vertex_groups,
      [](const CollidingVertices& group) {
        return ObjectPair{group.a, group.b};
      },
      compare_groups);
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
  return first_of(
      [&] { return pairs("object pair", a.object_pairs, b.object_pairs); }, [&] { return contacts(a, b); },
      [&] { return contact_points(a, b); }, [&] { return continuous_contacts(a, b); },
      [&] { return proximity_pairs(a, b); }, [&] { return colliding_vertices(a, b); },
      [&] { return pairs("event volume_begin", a.volume_begin, b.volume_begin); },
      [&] { return pairs("event volume_end", a.volume_end, b.volume_end); },
      [&] { return pairs("event narrow_phase_begin", a.narrow_phase_begin, b.narrow_phase_begin); },
      [&] { return pairs("event narrow_phase_end", a.narrow_phase_end, b.narrow_phase_end); },
      [&] { return pairs("event contact_begin", a.contact_begin, b.contact_begin); },
      [&] { return pairs("event contact_end", a.contact_end, b.contact_end); },
      [&] { return pairs("event proximity_begin", a.proximity_begin, b.proximity_begin); },
      [&] { return pairs("event proximity_end", a.proximity_end, b.proximity_end); },
      [&] { return compare_described("statistics, ", a.stats, b.stats); });
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
