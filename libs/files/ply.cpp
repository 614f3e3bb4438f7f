// PLY, text or binary in either byte order: reads vertices with x, y, z, faces, triangle strips and edges,
// and skips everything else.

#include <algorithm>
#include <array>
#include <bit>
#include <initializer_list>
#include <limits>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "files/byte_order.hpp"
#include "files/face_reader.hpp"
#include "files/mesh_formats.hpp"
#include "files/ply_header.hpp"
#include "files/text_scanner.hpp"

namespace supple {
namespace {

using namespace ply;

// The values of a text body, which may have any line breaks.
class TextBody {
 public:
  explicit TextBody(TextScanner& scanner) : scanner_(scanner) {}

  // A digit and a blank.
  static constexpr std::size_t least_size(ScalarType) { return 2; }
  // The blank after the last value may be missing.
  std::size_t available() const { return scanner_.remaining() + 1; }

  double number(ScalarType) {
    skip_to_value();
    return scanner_.number("a coordinate");
  }
  std::int64_t integer(ScalarType) {
    skip_to_value();
    return scanner_.integer("a count or a vertex index");
  }
  void skip(ScalarType, std::uint64_t count) {
    for (std::uint64_t i = 0; i < count; ++i) {
      skip_to_value();
      scanner_.word();
    }
  }
  void finish() {
    if (scanner_.skip_to_word()) scanner_.fail_here("more follows after the last element of the header");
  }
  [[noreturn]] void fail_here(const std::string& message) const { scanner_.fail_here(message); }

 private:
  void skip_to_value() {
    if (!scanner_.skip_to_word()) scanner_.fail_here("the file ends before the last element of the header");
  }

  TextScanner& scanner_;
};

class BinaryBody {
 public:
  BinaryBody(std::string_view bytes, std::size_t offset, std::endian order, const std::string& file)
      : begin_(bytes.data()),
        position_(begin_ + offset),
        last_value_(position_),
        end_(begin_ + bytes.size()),
        order_(order),
        file_(file) {}

  static constexpr std::size_t least_size(ScalarType type) { return size_of(type); }
  std::size_t available() const { return static_cast<std::size_t>(end_ - position_); }

  double number(ScalarType type) {
    if (type == ScalarType::float32) return static_cast<double>(next<float>());
    if (type == ScalarType::float64) return next<double>();
    return static_cast<double>(integer(type));
  }
  std::int64_t integer(ScalarType type) {
    switch (type) {
      case ScalarType::int8:
        return next<std::int8_t>();
      case ScalarType::uint8:
        return next<std::uint8_t>();
      case ScalarType::int16:
        return next<std::int16_t>();
      case ScalarType::uint16:
        return next<std::uint16_t>();
      case ScalarType::int32:
        return next<std::int32_t>();
      default:
        return next<std::uint32_t>();
    }
  }
  void skip(ScalarType type, std::uint64_t count) {
    last_value_ = position_;
    if (count > available() / size_of(type)) fail_truncated();
    position_ += count * size_of(type);
  }
  // Some writers add padding, so data after the last element is allowed.
  void finish() {}
  [[noreturn]] void fail_here(const std::string& message) const {
    fail(file_ + ", byte " + std::to_string(last_value_ - begin_) + ": " + message);
  }

 private:
  template <class Scalar>
  Scalar next() {
    last_value_ = position_;
    if (available() < sizeof(Scalar)) fail_truncated();
    const Scalar value = load_scalar<Scalar>(position_, order_);
    position_ += sizeof(Scalar);
    return value;
  }
  [[noreturn]] void fail_truncated() const {
    fail_here("the file ends before the last element of the header");
  }

  const char* begin_;
  const char* position_;
  const char* last_value_;  // for messages: the start of the value that was read last
  const char* end_;
  std::endian order_;
  const std::string& file_;
};

template <class Body>
class BodyReader {
 public:
  BodyReader(const Header& header, Body body) : header_(header), body_(body) {}

  TriangleMesh read() {
    check_counts();
    for (const Element& element : header_.elements) {
      if (element.count == 0) continue;
      if (element.name == "vertex") {
        read_vertices(element);
      } else if (element.name == "face") {
        // A triangle takes at least four bytes.
        mesh_.triangles.reserve(std::min<std::uint64_t>(element.count, body_.available() / 4));
        read_lists(element, [&](std::uint64_t face, const Property& list) { read_face(face, list); });
      } else if (element.name == "tristrips") {
        read_lists(element, [&](std::uint64_t strip, const Property& list) { read_strip(strip, list); });
      } else if (element.name == "edge") {
        read_edges(element);
      } else if (!element.properties.empty()) {
        for (std::uint64_t i = 0; i < element.count; ++i) {
          for (const Property& property : element.properties) skip_property(property);
        }
      }
    }
    body_.finish();
    faces_.finish(mesh_);
    return std::move(mesh_);
  }

 private:
  // Check the counts before they determine an allocation or a loop. After this, all relevant counts are below
  // the size of the file.
  void check_counts() {
    std::uint64_t available = body_.available();
    for (const Element& element : header_.elements) {
      const std::uint64_t size = least_size(element);
      if (size != 0 && element.count > available / size) {
        body_.fail_here("the header announces " + std::to_string(element.count) + " of element " +
                        in_quotes(element.name) + ", more than the rest of the file can hold");
      }
      available -= element.count * size;
      if (element.name == "vertex") vertex_count_ = element.count;
    }
  }

  static std::uint64_t least_size(const Element& element) {
    std::uint64_t size = 0;
    for (const Property& property : element.properties) {
      size += Body::least_size(property.count_type.value_or(property.type));
    }
    return size;
  }

  void read_vertices(const Element& element) {
    const std::vector<int> axes = places_of({"x", "y", "z"}, element);
    mesh_.positions.resize(element.count);
    for (Vec3d& position : mesh_.positions) {
      read_row(element, axes,
               [&](int axis, const Property& property) { position[axis] = body_.number(property.type); });
    }
  }

  void read_edges(const Element& element) {
    const std::vector<int> ends = places_of({"vertex1", "vertex2"}, element);
    for (std::size_t i = 0; i < ends.size(); ++i) {
      if (ends[i] >= 0 && !is_integer(element.properties[i].type)) {
        body_.fail_here("property " + in_quotes(element.properties[i].name) +
                        " of element 'edge' must be of an integer type");
      }
    }
    for (std::uint64_t number = 0; number < element.count; ++number) {
      std::array<std::uint32_t, 2> edge{};
      read_row(element, ends, [&](int end, const Property& property) {
        edge[static_cast<std::size_t>(end)] =
            checked_vertex(body_.integer(property.type), vertex_count_, "edge", number, body_);
      });
      if (edge[0] == edge[1]) {
        body_.fail_here("edge " + std::to_string(number) + " joins vertex " + std::to_string(edge[0]) +
                        " to itself; leave it out");
      }
      mesh_.edges.push_back(edge);
    }
  }

  // For each property of the element, its place in the list of names, or -1. Every name must be there.
  std::vector<int> places_of(std::initializer_list<const char*> names, const Element& element) const {
    std::vector<int> places(element.properties.size(), -1);
    int place = 0;
    for (const char* name : names) {
      bool found = false;
      for (std::size_t i = 0; i < places.size(); ++i) {
        if (element.properties[i].name != name || element.properties[i].count_type) continue;
        places[i] = place;
        found = true;
      }
      if (!found) {
        body_.fail_here("element " + in_quotes(element.name) + " has no scalar property " + in_quotes(name));
      }
      ++place;
    }
    return places;
  }

  // Calls `read(number, property)` for the list of vertices of each face or strip.
  template <class Read>
  void read_lists(const Element& element, Read read) {
    const auto vertex_list = std::ranges::find_if(element.properties, is_vertex_list);
    if (vertex_list == element.properties.end()) {
      body_.fail_here("element " + in_quotes(element.name) +
                      " has no list 'vertex_indices' or 'vertex_index'");
    }
    std::vector<int> places(element.properties.size(), -1);
    places[static_cast<std::size_t>(vertex_list - element.properties.begin())] = 0;
    for (std::uint64_t number = 0; number < element.count; ++number)
      read_row(element, places, [&](int, const Property& property) { read(number, property); });
  }

  // Calls `read(place, property)` for the properties of a row that have a place, and skips the others.
  template <class Read>
  void read_row(const Element& element, const std::vector<int>& places, const Read& read) {
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (places[i] >= 0)
        read(places[i], element.properties[i]);
      else
        skip_property(element.properties[i]);
    }
  }

  void read_face(std::uint64_t face, const Property& vertex_list) {
    const std::int64_t corners = body_.integer(*vertex_list.count_type);
    const auto next_index = [&] { return body_.integer(vertex_list.type); };
    faces_.read(mesh_, vertex_count_, face, corners, body_, next_index);
  }

  // Each vertex of a strip forms a triangle with the two before it, and every second triangle is turned
  // around. After -1 the strip starts again. Strips repeat vertices to go on elsewhere; the triangles of such
  // a repetition have no area and are left out.
  void read_strip(std::uint64_t number, const Property& vertex_list) {
    const std::int64_t count = body_.integer(*vertex_list.count_type);
    if (count < 0) {
      body_.fail_here("strip " + std::to_string(number) + " has " + std::to_string(count) + " vertices");
    }
    std::uint32_t first = 0, second = 0;
    std::uint64_t run = 0;
    for (std::int64_t i = 0; i < count; ++i, ++run) {
      const std::int64_t index = body_.integer(vertex_list.type);
      if (index == -1) {
        run = ~std::uint64_t{0};
        continue;
      }
      const std::uint32_t vertex = checked_vertex(index, vertex_count_, "strip", number, body_);
      if (run >= 2 && first != second && second != vertex && vertex != first) {
        mesh_.triangles.push_back(run % 2 == 0 ? Triangle{first, second, vertex}
                                               : Triangle{second, first, vertex});
      }
      first = second;
      second = vertex;
    }
  }

  void skip_property(const Property& property) {
    std::int64_t count = 1;
    if (property.count_type) count = body_.integer(*property.count_type);
    if (count < 0) {
      body_.fail_here("list " + in_quotes(property.name) + " has the length " + std::to_string(count));
    }
    body_.skip(property.type, static_cast<std::uint64_t>(count));
  }

  const Header& header_;
  Body body_;
  std::uint64_t vertex_count_ = 0;
  TriangleMesh mesh_;
  FaceReader faces_;
};

}  // namespace

TriangleMesh read_ply(std::string_view bytes, const std::string& file) {
  TextScanner scanner(bytes, file, {});
  const Header header = read_header(scanner);
  if (header.encoding == Encoding::text) return BodyReader(header, TextBody(scanner)).read();
  const std::endian order = header.encoding == Encoding::big_endian ? std::endian::big : std::endian::little;
  return BodyReader(header, BinaryBody(bytes, scanner.offset(), order, file)).read();
}

std::string write_ply(const TriangleMesh& mesh) {
  const bool fits_int = mesh.positions.size() <= std::uint64_t{std::numeric_limits<std::int32_t>::max()};
  std::string bytes = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                      std::to_string(mesh.positions.size()) +
                      "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
                      std::to_string(mesh.triangles.size()) + "\nproperty list uchar " +
                      (fits_int ? "int" : "uint") + " vertex_indices\nend_header\n";
  bytes.reserve(bytes.size() + 24 * mesh.positions.size() + 13 * mesh.triangles.size());
  for (const Vec3d& position : mesh.positions) {
    for (int axis = 0; axis < 3; ++axis) append_scalar(bytes, position[axis]);
  }
  for (const Triangle& triangle : mesh.triangles) {
    append_scalar(bytes, std::uint8_t{3});
    for (const std::uint32_t id : triangle) append_scalar(bytes, id);
  }
  return bytes;
}

}  // namespace supple
