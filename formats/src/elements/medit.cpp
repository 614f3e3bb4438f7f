// Medit's .mesh (text) and .meshb (binary), of INRIA (https://github.com/LoicMarechal/libMeshb). A file is a
// list of keywords, each with a number of entries.

#include <array>
#include <optional>

#include "core/error.hpp"
#include "core/quotes.hpp"
#include "elements/element_mesh.hpp"
#include "elements/scalar_reader.hpp"
#include "readers.hpp"

namespace supple {
namespace {

struct Keyword {
  std::string_view name;
  std::int64_t code;  // of binary files
  std::size_t corner_count, node_count;
  std::optional<Solid> solid;
};
constexpr std::array<Keyword, 12> element_keywords = {{
    {"Triangles", 6, 3, 3, {}},
    {"TrianglesP2", 24, 3, 6, {}},
    {"Quadrilaterals", 7, 4, 4, {}},
    {"QuadrilateralsQ2", 27, 4, 9, {}},
    {"Tetrahedra", 8, 4, 4, Solid::tetrahedron},
    {"TetrahedraP2", 30, 4, 10, Solid::tetrahedron},
    {"Hexahedra", 10, 8, 8, Solid::hexahedron},
    {"HexahedraQ2", 33, 8, 27, Solid::hexahedron},
    {"Prisms", 9, 6, 6, Solid::prism},
    {"PrismsP2", 86, 6, 18, Solid::prism},
    {"Pyramids", 49, 5, 5, Solid::pyramid},
    {"PyramidsP2", 87, 5, 14, Solid::pyramid},
}};
constexpr std::int64_t dimension_code = 3, vertices_code = 4, end_code = 54;

const Keyword* find_keyword(std::string_view name, std::int64_t code) {
  for (const Keyword& keyword : element_keywords) {
    if (keyword.name == name || keyword.code == code) return &keyword;
  }
  return nullptr;
}

class MeditReader {
 public:
  MeditReader(std::string_view bytes, const std::string& file)
      : file_(file), reader_(bytes, file, {.hash_comments = true}) {}

  TriangleMesh read_text() {
    TextScanner& text = reader_.text;
    text.skip_to_word();
    if (const std::string_view word = text.word(); word != "MeshVersionFormatted")
      text.fail_expected("'MeshVersionFormatted', with which a .mesh file of Medit begins", word);
    reader_.integer(Scalar::int32, "the version");
    while (text.skip_to_word()) {
      const std::string_view word = text.word();
      if (word == "End") break;
      if (word == "Dimension") {
        read_dimension();
      } else if (word == "Vertices") {
        read_vertices();
      } else if (const Keyword* keyword = find_keyword(word, 0)) {
        read_elements(*keyword);
      }
      // Everything else is passed word by word: other keywords, and their numbers.
    }
    return mesh_.take_surface(file_);
  }

  TriangleMesh read_binary() {
    read_version();
    for (std::int64_t code = 0; code != end_code && reader_.text.remaining() > 0;) {
      code = reader_.integer(Scalar::int32, "a keyword");
      const std::int64_t next = reader_.integer(place_type_, "the place of the next keyword");
      if (code == dimension_code) {
        read_dimension();
      } else if (code == vertices_code) {
        read_vertices();
      } else if (const Keyword* keyword = find_keyword({}, code)) {
        read_elements(*keyword);
      }
      if (next == 0) break;
      go_to(next);
    }
    return mesh_.take_surface(file_);
  }

 private:
  void read_version() {
    reader_.set_binary(Encoding::little_endian);
    const std::int64_t one = reader_.integer(Scalar::int32, "the number 1, which tells the byte order");
    if (one == 0x01000000) {
      reader_.set_binary(Encoding::big_endian);
    } else if (one != 1) {
      reader_.fail_here("a .meshb file of Medit begins with the number 1");
    }
    const std::int64_t version = reader_.integer(Scalar::int32, "the version");
    if (version < 1 || version > 4)
      reader_.fail_here("the version is " + std::to_string(version) + "; it may be 1 to 4");
    coordinate_type_ = version == 1 ? Scalar::float32 : Scalar::float64;
    place_type_ = version < 3 ? Scalar::int32 : Scalar::int64;
    integer_type_ = version < 4 ? Scalar::int32 : Scalar::int64;
  }

  void go_to(std::int64_t place) {
    const auto here = static_cast<std::int64_t>(reader_.text.offset());
    if (place < here || place - here > static_cast<std::int64_t>(reader_.text.remaining()))
      reader_.fail_here("the next keyword is at byte " + std::to_string(place) +
                        ", which is not between here and the end of the file");
    reader_.text.skip_bytes(static_cast<std::size_t>(place - here));
  }

  void read_dimension() {
    dimension_ = reader_.integer(Scalar::int32, "the dimension");
    if (dimension_ != 2 && dimension_ != 3)
      reader_.fail_here("the dimension is " + std::to_string(dimension_) + "; it may be 2 or 3");
  }

  // Each entry ends with a reference, which some writers of texts leave out.
  void skip_reference() {
    if (reader_.encoding() != Encoding::text) {
      reader_.skip(integer_type_, 1, "a reference");
    } else if (!reader_.text.at_line_end()) {
      reader_.text.word();
    }
  }

  void read_vertices() {
    if (dimension_ == 0) reader_.fail_here("the vertices come before the dimension");
    if (has_vertices_) reader_.fail_here("the vertices are there twice");
    has_vertices_ = true;
    const std::uint64_t count = reader_.count(integer_type_, "the number of vertices");
    reader_.expect(count, static_cast<std::uint64_t>(dimension_), Scalar::float32, "vertices");
    mesh_.positions.resize(count);
    for (Vec3d& position : mesh_.positions) {
      for (int axis = 0; axis < dimension_; ++axis)
        position[axis] = reader_.number(coordinate_type_, "a coordinate");
      skip_reference();
    }
  }

  void read_elements(const Keyword& keyword) {
    if (!has_vertices_) reader_.fail_here(in_quotes(keyword.name) + " come before the vertices");
    const std::uint64_t count = reader_.count(integer_type_, "the number of elements");
    std::array<std::uint32_t, 8> corners;
    for (std::uint64_t i = 0; i < count; ++i) {
      for (std::size_t k = 0; k < keyword.corner_count; ++k) corners[k] = read_vertex(keyword);
      reader_.skip(integer_type_, keyword.node_count - keyword.corner_count, "a vertex");
      skip_reference();
      const auto used = std::span(corners).first(keyword.corner_count);
      if (keyword.solid) {
        mesh_.add_solid(*keyword.solid, used);
      } else {
        mesh_.add_polygon(used);
      }
    }
  }

  std::uint32_t read_vertex(const Keyword& keyword) {
    const std::int64_t number = reader_.integer(integer_type_, "a vertex");
    if (number < 1 || static_cast<std::uint64_t>(number) > mesh_.positions.size()) {
      reader_.fail_here(in_quotes(keyword.name) + ": vertex " + std::to_string(number) +
                        " is out of range; the file has " + std::to_string(mesh_.positions.size()) +
                        " vertices, counted from 1");
    }
    return static_cast<std::uint32_t>(number - 1);
  }

  std::string file_;
  ScalarReader reader_;
  Scalar coordinate_type_ = Scalar::float64, place_type_ = Scalar::int32, integer_type_ = Scalar::int32;
  std::int64_t dimension_ = 0;
  bool has_vertices_ = false;
  ElementMesh mesh_;
};

}  // namespace

TriangleMesh read_medit(std::string_view bytes, const std::string& file) {
  return MeditReader(bytes, file).read_text();
}

TriangleMesh read_medit_binary(std::string_view bytes, const std::string& file) {
  return MeditReader(bytes, file).read_binary();
}

}  // namespace supple
