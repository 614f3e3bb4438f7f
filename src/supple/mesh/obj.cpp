// Wavefront OBJ: reads polygons and ignores texture coordinates, normals, groups, materials, lines and
// curves.

#include <limits>
#include <vector>

#include "mesh/mesh_formats.hpp"
#include "mesh/number_text.hpp"
#include "mesh/text_scanner.hpp"

namespace supple {
namespace {

class ObjReader {
 public:
  ObjReader(std::string_view bytes, const std::string& file)
      : scanner_(bytes, file, {.hash_comments = true, .backslash_continues = true}) {}

  TriangleMesh read() {
    for (; scanner_.skip_to_word(); scanner_.skip_line()) {
      const std::string_view keyword = scanner_.word();
      if (keyword == "v") {
        read_vertex();
      } else if (keyword == "f") {
        read_face();
      } else if (keyword.find('\0') != std::string_view::npos) {
        scanner_.fail_here("a zero byte; OBJ files are plain text");
      }
    }
    check_forward_references();
    return std::move(mesh_);
  }

 private:
  // Only references to a later vertex than all references before them: the first invalid one is among them.
  struct ForwardReference {
    std::int64_t index;
    std::size_t line;
  };

  void read_vertex() {
    const double x = scanner_.number("x");
    const double y = scanner_.number("y");
    const double z = scanner_.number("z");
    mesh_.positions.push_back({x, y, z});
  }

  void read_face() {
    std::uint32_t first = 0, previous = 0;
    std::size_t corners = 0;
    for (; !scanner_.at_line_end(); ++corners) {
      const std::uint32_t corner = read_corner();
      if (corners == 0) first = corner;
      if (corners >= 2) mesh_.triangles.push_back({first, previous, corner});
      previous = corner;
    }
    if (corners < 3) {
      scanner_.fail_here("a face has " + std::to_string(corners) + " corners; it needs at least 3");
    }
  }

  std::uint32_t read_corner() {
    const std::int64_t index = scanner_.integer("a face index", true);
    const auto count = static_cast<std::int64_t>(mesh_.positions.size());
    if (index == 0) scanner_.fail_here("face index 0 is not allowed; OBJ counts vertices from 1");
    if (index < -count) {
      scanner_.fail_here("face index " + std::to_string(index) + " is out of range; the file has " +
                         std::to_string(count) + " vertices before it");
    }
    if (index < 0) return static_cast<std::uint32_t>(count + index);
    if (index > count && (forward_.empty() || index > forward_.back().index)) {
      forward_.push_back({index, scanner_.line()});
    }
    return static_cast<std::uint32_t>(index - 1);
  }

  void check_forward_references() const {
    const auto count = static_cast<std::int64_t>(mesh_.positions.size());
    for (const ForwardReference& reference : forward_) {
      if (reference.index <= count) continue;
      scanner_.fail_at(reference.line, "face index " + std::to_string(reference.index) +
                                           " is out of range; the file has " + std::to_string(count) +
                                           " vertices, counted from 1");
    }
  }

  TextScanner scanner_;
  TriangleMesh mesh_;
  std::vector<ForwardReference> forward_;
};

}  // namespace

TriangleMesh read_obj(std::string_view bytes, const std::string& file) {
  return ObjReader(bytes, file).read();
}

std::string write_obj(const TriangleMesh& mesh) {
  std::string text;
  for (const Vec3d& position : mesh.positions) {
    text += 'v';
    for (int axis = 0; axis < 3; ++axis) {
      text += ' ';
      append_double(text, position[axis]);
    }
    text += '\n';
  }
  for (const Triangle& triangle : mesh.triangles) {
    text += 'f';
    for (const std::uint32_t id : triangle) {
      text += ' ';
      append_integer(text, std::uint64_t{id} + 1);
    }
    text += '\n';
  }
  return text;
}

}  // namespace supple
