// AMF (ISO/ASTM 52915), as XML or as an archive with one file of it: objects with volumes, and
// constellations, which place objects and other constellations.

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "animation/transform.hpp"
#include "core/error.hpp"
#include "core/quotes.hpp"
#include "files/number_text.hpp"
#include "readers.hpp"
#include "supple/trigonometry.hpp"
#include "xml_nodes.hpp"
#include "zip_reader.hpp"

namespace supple {
namespace {

struct Instance {
  std::string object;
  Transform transform;
};

/// A mesh, or the instances of a constellation.
struct Object {
  std::vector<Vec3d> positions;
  std::vector<Triangle> triangles;
  std::vector<Instance> instances;
};

/// Rotations about x, then y, then z, in degrees; then the translation.
Transform placement(const std::array<double, 3>& degrees, const std::array<double, 3>& translation) {
  Transform result = identity_transform;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (degrees[axis] == 0) continue;
    const double c = cos_turns(degrees[axis] / 360), s = sin_turns(degrees[axis] / 360);
    const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    Transform turn = identity_transform;
    turn[u][u] = turn[v][v] = c;
    turn[u][v] = -s;
    turn[v][u] = s;
    result = turn * result;
  }
  for (std::size_t axis = 0; axis < 3; ++axis) result[axis][3] = translation[axis];
  return result;
}

class AmfReader {
 public:
  AmfReader(std::string_view bytes, const std::string& file) : file_(file), text_(bytes) {
    if (bytes.starts_with("PK\x03\x04")) {
      ZipReader archive(bytes, file);
      text_ = archive.read(archive.name_ending_with(".amf"));
    }
    constexpr unsigned options = pugi::parse_escapes | pugi::parse_cdata;
    const pugi::xml_parse_result result = document_.load_buffer(text_.data(), text_.size(), options);
    if (!result) fail_at(result.offset, one_line(result.description()));
  }

  MeshFile read() {
    const pugi::xml_node root = child(document_, "amf");
    if (!root) fail_at(0, "this is no AMF: it has no element 'amf'");
    result_.frame.unit = metres_of(attribute(root, "unit"));
    std::vector<std::string> order;
    std::set<std::string> placed;
    std::uint64_t stored = 0;
    for (const pugi::xml_node& node : root.children()) {
      const bool is_mesh = name_of(node) == "object";
      if (!is_mesh && name_of(node) != "constellation") continue;
      Object object = is_mesh ? read_object(node) : read_constellation(node);
      stored += object.positions.size() + object.triangles.size();
      for (const Instance& instance : object.instances) placed.insert(instance.object);
      order.push_back(attribute(node, "id"));
      if (!objects_.try_emplace(order.back(), std::move(object)).second)
        fail_at(node.offset_debug(), "two objects have the id " + in_quotes(order.back()));
    }
    const std::uint64_t most = stored + (std::uint64_t{1} << 25);
    left_ = most;
    for (const std::string& id : order) {
      if (!placed.contains(id)) append(id, identity_transform, 0);
    }
    if (!order.empty() && left_ == most) fail(file_ + ": its constellations contain each other");
    return std::move(result_);
  }

 private:
  [[noreturn]] void fail_at(std::ptrdiff_t offset, const std::string& message) const {
    fail(file_ + ", byte " + std::to_string(offset) + ": " + message);
  }

  double metres_of(const std::string& unit) const {
    constexpr std::pair<std::string_view, double> units[] = {
        {"", 0.001},      {"millimeter", 0.001}, {"inch", 0.0254}, {"feet", 0.3048},
        {"foot", 0.3048}, {"meter", 1},          {"micron", 1e-6}, {"micrometer", 1e-6}};
    for (const auto& [name, metres] : units) {
      if (name == unit) return metres;
    }
    fail(file_ + ": unknown unit " + in_quotes(unit) + "; it may be millimeter, inch, feet, meter or micron");
  }

  /// The number in a child of the node; 0 where it is absent and may be.
  double number(const pugi::xml_node& node, const char* name, bool may_be_absent) const {
    const pugi::xml_node place = child(node, name);
    if (!place && may_be_absent) return 0;
    const std::string_view text = trimmed(place.child_value());
    double value = 0;
    const char* end = text.data() + text.size();
    if (text.empty() || parse_double(text.data(), end, value) != end)
      fail_at(node.offset_debug(),
              std::string("expected a number for ") + name + ", found " + in_quotes(text));
    return value;
  }

  static std::string_view trimmed(std::string_view text) {
    constexpr std::string_view blanks = " \t\r\n";
    const std::size_t first = std::min(text.find_first_not_of(blanks), text.size());
    return text.substr(first, text.find_last_not_of(blanks) + 1 - first);
  }

  Object read_object(const pugi::xml_node& node) const {
    Object object;
    for (const pugi::xml_node& mesh : node.children()) {
      if (name_of(mesh) != "mesh") continue;
      const std::size_t first = object.positions.size();
      for (const pugi::xml_node& vertex : child(mesh, "vertices").children()) {
        if (name_of(vertex) != "vertex") continue;
        const pugi::xml_node place = child(vertex, "coordinates");
        object.positions.push_back(
            {number(place, "x", false), number(place, "y", false), number(place, "z", false)});
      }
      for (const pugi::xml_node& volume : mesh.children()) {
        if (name_of(volume) != "volume") continue;
        for (const pugi::xml_node& triangle : volume.children()) {
          if (name_of(triangle) == "triangle")
            object.triangles.push_back(read_triangle(triangle, first, object.positions.size()));
        }
      }
    }
    return object;
  }

  Triangle read_triangle(const pugi::xml_node& node, std::size_t first, std::size_t end) const {
    constexpr const char* names[] = {"v1", "v2", "v3"};
    Triangle triangle;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::string_view text = trimmed(child(node, names[i]).child_value());
      std::int64_t id = 0;
      const char* text_end = text.data() + text.size();
      if (text.empty() || parse_integer(text.data(), text_end, id) != text_end)
        fail_at(node.offset_debug(), std::string("expected an integer for ") + names[i] +
                                         " of a triangle, found " + in_quotes(text));
      if (id < 0 || static_cast<std::uint64_t>(id) >= end - first) {
        fail_at(node.offset_debug(), "vertex index " + std::to_string(id) +
                                         " of a triangle is out of range; its mesh has " +
                                         std::to_string(end - first) + " vertices, counted from 0");
      }
      triangle[i] = static_cast<std::uint32_t>(first + static_cast<std::uint64_t>(id));
    }
    return triangle;
  }

  Object read_constellation(const pugi::xml_node& node) const {
    Object object;
    for (const pugi::xml_node& instance : node.children()) {
      if (name_of(instance) != "instance") continue;
      const auto numbers = [&](const char* x, const char* y, const char* z) {
        return std::array{number(instance, x, true), number(instance, y, true), number(instance, z, true)};
      };
      object.instances.push_back(
          {attribute(instance, "objectid"),
           placement(numbers("rx", "ry", "rz"), numbers("deltax", "deltay", "deltaz"))});
    }
    return object;
  }

  void append(const std::string& id, const Transform& to_scene, int depth) {
    constexpr int deepest = 100;
    if (depth > deepest)
      fail(file_ + ": object " + in_quotes(id) + " is nested more than " + std::to_string(deepest) +
           " deep; does it contain itself?");
    const auto found = objects_.find(id);
    if (found == objects_.end()) fail(file_ + ": there is no object " + in_quotes(id));
    const Object& object = found->second;
    const std::uint64_t size = 1 + object.positions.size() + object.triangles.size();
    if (size > left_) {
      fail(file_ +
           ": its constellations repeat objects until there are more than 33 million vertices and triangles; "
           "place fewer copies");
    }
    left_ -= size;
    TriangleMesh& mesh = result_.mesh;
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3d& position : object.positions) mesh.positions.push_back(apply(to_scene, position));
    for (Triangle triangle : object.triangles) {
      for (std::uint32_t& vertex : triangle) vertex += first;
      mesh.triangles.push_back(triangle);
    }
    for (const Instance& instance : object.instances)
      append(instance.object,
             to_scene == identity_transform ? instance.transform : to_scene * instance.transform, depth + 1);
  }

  const std::string& file_;
  std::string text_;
  pugi::xml_document document_;
  std::map<std::string, Object> objects_;
  std::uint64_t left_ = 0;  // vertices, triangles and instances that may still be added
  MeshFile result_;
};

}  // namespace

MeshFile read_amf(std::string_view bytes, const std::string& file) {
  return AmfReader(bytes, file).read();
}

}  // namespace supple
