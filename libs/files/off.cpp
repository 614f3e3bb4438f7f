// Geomview's OFF as text, with one vertex or face per line: the variants whose vertices start with x, y and
// z.

#include <utility>

#include "files/face_reader.hpp"
#include "files/mesh_formats.hpp"
#include "files/number_text.hpp"
#include "files/text_scanner.hpp"

namespace supple {
namespace {

class OffReader {
 public:
  OffReader(std::string_view bytes, const std::string& file)
      : scanner_(bytes, file, {.hash_comments = true}) {}

  TriangleMesh read() {
    read_keyword();
    const std::size_t vertices = read_count("the number of vertices");
    const std::size_t faces = read_count("the number of faces");
    scanner_.skip_line();
    check_counts(vertices, faces);
    mesh_.positions.reserve(vertices);
    mesh_.triangles.reserve(faces);
    for (std::size_t i = 0; i < vertices; ++i, scanner_.skip_line()) {
      if (!scanner_.skip_to_word()) fail_truncated("vertices", i, vertices);
      mesh_.positions.push_back(scanner_.point());
    }
    for (std::size_t i = 0; i < faces; ++i) read_face(i, faces);
    if (scanner_.skip_to_word()) {
      scanner_.fail_here("more follows after the " + std::to_string(vertices) + " vertices and " +
                         std::to_string(faces) + " faces of the header");
    }
    faces_.finish(mesh_);
    return std::move(mesh_);
  }

 private:
  void read_keyword() {
    scanner_.skip_to_word();
    while (scanner_.accept("ST") || scanner_.accept("C") || scanner_.accept("N")) {
    }
    if (scanner_.accept("4OFF") || scanner_.accept("nOFF") || scanner_.accept("4nOFF")) {
      scanner_.fail_here("vertices of other than three dimensions (4OFF, nOFF) are not supported");
    }
    if (!scanner_.accept("OFF")) scanner_.fail_expected("'OFF', 'COFF', 'NOFF' or 'STOFF'", scanner_.word());
    scanner_.skip_to_word();
    if (scanner_.accept("BINARY")) {
      scanner_.fail_here("binary OFF is not supported; save it as text, or as binary PLY");
    }
  }

  std::size_t read_count(const char* what) {
    scanner_.skip_to_word();
    const std::int64_t count = scanner_.integer(what);
    if (count < 0) scanner_.fail_here(std::string(what) + " is " + std::to_string(count));
    return static_cast<std::size_t>(count);
  }

  // Check the counts before they determine an allocation. The shortest vertex is "0 0 0", the shortest face
  // is "1 0", and a line end follows all but the last.
  void check_counts(std::size_t vertices, std::size_t faces) const {
    const std::size_t available = scanner_.remaining() + 1;
    if (vertices > available / 6 || faces > (available - 6 * vertices) / 4) {
      scanner_.fail_here("the header announces " + std::to_string(vertices) + " vertices and " +
                         std::to_string(faces) + " faces, more than the " +
                         std::to_string(scanner_.remaining()) + " bytes after it can hold");
    }
  }

  void read_face(std::size_t i, std::size_t count) {
    if (!scanner_.skip_to_word()) fail_truncated("faces", i, count);
    const std::int64_t corners = scanner_.integer("the number of corners");
    const auto next_index = [&] { return scanner_.integer("a vertex index"); };
    faces_.read(mesh_, mesh_.positions.size(), i, corners, scanner_, next_index);
    scanner_.skip_line();
  }

  [[noreturn]] void fail_truncated(const char* what, std::size_t found, std::size_t announced) const {
    scanner_.fail_here("the file ends after " + std::to_string(found) + " of the " +
                       std::to_string(announced) + " " + what + " of the header");
  }

  TextScanner scanner_;
  TriangleMesh mesh_;
  FaceReader faces_;
};

}  // namespace

TriangleMesh read_off(std::string_view bytes, const std::string& file) {
  return OffReader(bytes, file).read();
}

std::string write_off(const TriangleMesh& mesh) {
  std::string text =
      "OFF\n" + std::to_string(mesh.positions.size()) + ' ' + std::to_string(mesh.triangles.size()) + " 0\n";
  for (const Vec3d& p : mesh.positions) append_line(text, p.x, p.y, p.z);
  for (const auto& [i, j, k] : mesh.triangles) append_line(text, 3, i, j, k);
  return text;
}

}  // namespace supple
