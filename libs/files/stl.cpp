// STL, text or binary: triangles of three points, in text also polygons. Equal points become one vertex.

#include <bit>
#include <cmath>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "files/byte_order.hpp"
#include "files/mesh_formats.hpp"
#include "files/polygon/polygon.hpp"
#include "files/text_scanner.hpp"
#include "mesh/vertex_welder.hpp"

namespace supple {
namespace {

// A binary file has 80 arbitrary bytes, the number of facets, and for each facet a normal and three points of
// three floats, and two more bytes. All numbers are little endian.
constexpr std::size_t header_size = 80, prologue_size = 84, facet_size = 50, normal_size = 12;

// Some programs leave the number at 0; the size tells it then.
std::uint64_t announced_facets(std::string_view bytes) {
  const auto facets = load_scalar<std::uint32_t>(bytes.data() + header_size, std::endian::little);
  return facets == 0 ? (bytes.size() - prologue_size) / facet_size : facets;
}
std::uint64_t announced_size(std::string_view bytes) {
  return prologue_size + facet_size * announced_facets(bytes);
}

// Binary files may start with "solid" too. So first test the size, and zero bytes, which text has only at its
// end.
bool is_text(std::string_view bytes) {
  if (bytes.size() >= prologue_size && bytes.size() == announced_size(bytes)) return false;
  if (is_utf16(bytes)) return true;  // the reader of text refuses it
  if (without_padding(bytes).substr(0, 1024).find('\0') != std::string_view::npos) return false;
  TextScanner scanner(bytes, "", {});
  return scanner.skip_to_word() && lower_case(scanner.word()) == "solid";
}

TriangleMesh read_binary(std::string_view bytes, const std::string& file) {
  if (bytes.size() < prologue_size) {
    fail(file + ": not an STL file: neither text that starts with 'solid' nor the " +
         std::to_string(prologue_size) + " bytes that a binary one has at least");
  }
  if (bytes.size() < announced_size(bytes)) {
    fail(file + ": truncated, or no STL file: the header announces " +
         std::to_string(announced_facets(bytes)) + " facets, which need " +
         std::to_string(announced_size(bytes)) + " bytes; the file has " + std::to_string(bytes.size()));
  }
  VertexWelder welder;
  TriangleMesh mesh;
  const std::size_t size = announced_size(bytes);
  mesh.triangles.reserve(announced_facets(bytes));
  for (std::size_t facet = prologue_size; facet < size; facet += facet_size) {
    Triangle triangle;
    const char* place = bytes.data() + facet + normal_size;
    for (std::uint32_t& id : triangle) {
      Vec3d point;
      for (int axis = 0; axis < 3; ++axis, place += sizeof(float)) {
        point[axis] = static_cast<double>(load_scalar<float>(place, std::endian::little));
      }
      id = welder.id_of(point);
    }
    mesh.triangles.push_back(triangle);
  }
  mesh.positions = welder.take_points();
  return mesh;
}

class StlTextReader {
 public:
  StlTextReader(std::string_view bytes, const std::string& file) : scanner_(bytes, file, {}) {}

  TriangleMesh read() {
    while (scanner_.skip_to_word()) read_solid();
    mesh_.positions = welder_.take_points();
    cut_polygons(mesh_, fans_);
    return std::move(mesh_);
  }

 private:
  void read_solid() {
    expect("solid");
    scanner_.skip_line();
    while (true) {
      const std::string_view word = next_word();
      if (ends(word, "solid")) break;
      if (lower_case(word) != "facet") scanner_.fail_expected("'facet' or 'endsolid'", word);
      read_facet();
    }
    scanner_.skip_line();
  }

  // The normal is not needed and not always a number: it may be any three words.
  void read_facet() {
    expect("normal");
    for (int axis = 0; axis < 3; ++axis) next_word();
    expect("outer");
    expect("loop");
    corners_.clear();
    std::string_view word = next_word();
    for (; lower_case(word) == "vertex"; word = next_word()) {
      corners_.push_back(welder_.id_of(scanner_.point()));
    }
    if (!ends(word, "loop")) scanner_.fail_expected("'vertex' or 'endloop'", word);
    if (corners_.size() < 3) {
      scanner_.fail_here("a facet has " + std::to_string(corners_.size()) + " corners; it needs at least 3");
    }
    if (!ends(word = next_word(), "facet")) scanner_.fail_expected("'endfacet'", word);
    add_face(mesh_, fans_, corners_);
  }

  std::string_view next_word() {
    scanner_.skip_to_word();
    return scanner_.word();
  }

  // Some programs write "end solid" instead of "endsolid".
  bool ends(std::string_view word, std::string_view part) {
    const std::string lower = lower_case(word);
    return lower == "end" ? lower_case(scanner_.word()) == part : lower == "end" + std::string(part);
  }

  void expect(std::string_view keyword) {
    const std::string_view word = next_word();
    if (lower_case(word) != keyword) scanner_.fail_expected(in_quotes(keyword), word);
  }

  TextScanner scanner_;
  TriangleMesh mesh_;
  VertexWelder welder_;
  std::vector<std::uint32_t> corners_;  // of the facet that is read
  std::vector<PolygonFan> fans_;
};

// A unit vector, or zero when the corners give no direction.
Vec3d unit_normal(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const Vec3d normal = cross(b - a, c - a);
  const double length = norm(normal);
  return length > 0 && std::isfinite(length) ? normal / length : Vec3d{};
}

void append_point(std::string& bytes, const Vec3d& point) {
  for (int axis = 0; axis < 3; ++axis) append_scalar(bytes, static_cast<float>(point[axis]));
}

}  // namespace

TriangleMesh read_stl(std::string_view bytes, const std::string& file) {
  return is_text(bytes) ? StlTextReader(bytes, file).read() : read_binary(bytes, file);
}

std::string write_stl(const TriangleMesh& mesh) {
  std::string bytes = "binary STL, single precision";
  bytes.resize(header_size, ' ');
  bytes.reserve(prologue_size + facet_size * mesh.triangles.size());
  append_scalar(bytes, static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const Triangle& triangle : mesh.triangles) {
    const Vec3d& a = mesh.positions[triangle[0]];
    const Vec3d& b = mesh.positions[triangle[1]];
    const Vec3d& c = mesh.positions[triangle[2]];
    append_point(bytes, unit_normal(a, b, c));
    for (const Vec3d* corner : {&a, &b, &c}) append_point(bytes, *corner);
    append_scalar(bytes, std::uint16_t{0});
  }
  return bytes;
}

}  // namespace supple
