// Wavefront OBJ: reads faces, lines and points, and ignores texture coordinates, normals, groups,
// materials and curves.

#include <string>
#include <vector>

#include "files/mesh_formats.hpp"
#include "files/number_text.hpp"
#include "files/polygon/polygon.hpp"
#include "files/text_scanner.hpp"

namespace supple {
namespace {

class ObjReader {
 public:
  ObjReader(std::string_view bytes, const std::string& file)
      : scanner_(bytes, file, {.hash_comments = true, .backslash_continues = true}) {}

  TriangleMesh read() {
    for (; scanner_.skip_to_word(); scanner_.skip_line()) {
      const std::string_view keyword = scanner_.word();
      if (keyword == "v" || keyword == "V") {  // some programs write capitals
        mesh_.positions.push_back(scanner_.point());
      } else if (keyword == "f" || keyword == "F" || keyword == "fo") {  // "fo" is the older name
        read_face();
      } else if (keyword == "l" || keyword == "L") {
        read_polyline();
      } else if (keyword == "p" || keyword == "P") {
        read_points();
      } else if (keyword.find('\0') != std::string_view::npos) {
        scanner_.fail_here("a zero byte; OBJ files are plain text");
      }
    }
    check_forward_references();
    cut_polygons(mesh_, fans_);
    return std::move(mesh_);
  }

 private:
  // Only references to a later vertex than all references before them: the first invalid one is among them.
  struct ForwardReference {
    std::int64_t index;
    std::size_t line;
    const char* element;
  };

  void read_face() {
    corners_.clear();
    while (!scanner_.at_line_end()) corners_.push_back(read_vertex("face"));
    if (corners_.empty()) scanner_.fail_here("a face has no corners; it needs at least 1");
    if (corners_.size() == 2) check_line(corners_[0], corners_[1]);
    add_face(mesh_, fans_, corners_);
  }

  void read_polyline() {
    std::uint32_t previous = 0;
    std::size_t vertices = 0;
    for (; !scanner_.at_line_end(); ++vertices) {
      const std::uint32_t vertex = read_vertex("line");
      if (vertices > 0) {
        check_line(previous, vertex);
        mesh_.edges.push_back({previous, vertex});
      }
      previous = vertex;
    }
    if (vertices < 2)
      scanner_.fail_here("a line has " + std::to_string(vertices) +
                         (vertices == 1 ? " vertex" : " vertices") + "; it needs at least 2");
  }

  void check_line(std::uint32_t from, std::uint32_t to) const {
    if (from != to) return;
    const std::string id = std::to_string(std::uint64_t{to} + 1);
    scanner_.fail_here("a line joins vertex " + id +
                       " to itself; leave out the repetition, or write a point: p " + id);
  }

  void read_points() {
    if (scanner_.at_line_end()) scanner_.fail_here("a point has no vertex; it needs at least 1");
    while (!scanner_.at_line_end()) mesh_.points.push_back(read_vertex("point"));
  }

  /// The vertex of an element, with texture and normal ids after it. `element` names it in messages.
  std::uint32_t read_vertex(const char* element) {
    const std::string what = std::string(element) + " index";
    const std::int64_t index = scanner_.integer(("a " + what).c_str(), true);
    const auto count = static_cast<std::int64_t>(mesh_.positions.size());
    if (index == 0) scanner_.fail_here(what + " 0 is not allowed; OBJ counts vertices from 1");
    if (index < -count) {
      scanner_.fail_here(what + " " + std::to_string(index) + " is out of range; the file has " +
                         std::to_string(count) + " vertices before it");
    }
    if (index < 0) return static_cast<std::uint32_t>(count + index);
    if (index > count && (forward_.empty() || index > forward_.back().index)) {
      forward_.push_back({index, scanner_.line(), element});
    }
    return static_cast<std::uint32_t>(index - 1);
  }

  void check_forward_references() const {
    const auto count = static_cast<std::int64_t>(mesh_.positions.size());
    for (const ForwardReference& reference : forward_) {
      if (reference.index <= count) continue;
      scanner_.fail_at(reference.line, std::string(reference.element) + " index " +
                                           std::to_string(reference.index) +
                                           " is out of range; the file has " + std::to_string(count) +
                                           " vertices, counted from 1");
    }
  }

  TextScanner scanner_;
  TriangleMesh mesh_;
  std::vector<ForwardReference> forward_;
  std::vector<std::uint32_t> corners_;  // of the face that is read
  std::vector<PolygonFan> fans_;
};

}  // namespace

TriangleMesh read_obj(std::string_view bytes, const std::string& file) {
  return ObjReader(bytes, file).read();
}

std::string write_obj(const TriangleMesh& mesh) {
  std::string text;
  const auto append = [&](const char* keyword, const auto&... numbers) {
    append_line(text += keyword, numbers...);
  };
  const auto id = [](std::uint32_t vertex) { return std::uint64_t{vertex} + 1; };
  for (const Vec3d& p : mesh.positions) append("v ", p.x, p.y, p.z);
  for (const auto& [i, j, k] : mesh.triangles) append("f ", id(i), id(j), id(k));
  for (const auto& [from, to] : mesh.edges) append("l ", id(from), id(to));
  for (const std::uint32_t point : mesh.points) append("p ", id(point));
  return text;
}

}  // namespace supple
