// The output files of TetGen (https://wias-berlin.de/software/tetgen/fformats.html): one entry a line. In two
// dimensions, as Triangle writes them, the elements are triangles.

#include <optional>

#include "elements/element_mesh.hpp"
#include "elements/node_numbers.hpp"
#include "elements/scalar_reader.hpp"
#include "readers.hpp"

namespace supple {
namespace {

constexpr TextSyntax syntax{.hash_comments = true};

class TetgenReader {
 public:
  void read_nodes(const TetgenFile& file) {
    ScalarReader reader(file.bytes, file.name, syntax);
    const std::uint64_t count = reader.count(Scalar::int64, "the number of points");
    dimension_ = reader.text.at_line_end() ? 3 : reader.integer(Scalar::int64, "the dimension");
    if (dimension_ != 2 && dimension_ != 3)
      reader.fail_here("the dimension is " + std::to_string(dimension_) + "; it may be 2 or 3");
    reader.text.skip_line();
    reader.expect(count, 1 + static_cast<std::uint64_t>(dimension_), Scalar::float64, "points");
    for (std::uint64_t i = 0; i < count; ++i) {
      numbers_.add(reader.integer(Scalar::int64, "the number of a point"));
      Vec3d point;
      for (int axis = 0; axis < dimension_; ++axis) point[axis] = reader.text.number("a coordinate");
      mesh_.positions.push_back(point);
      reader.text.skip_line();  // attributes and markers
    }
    if (const auto twice = numbers_.sort())
      reader.fail_here("two points have the number " + std::to_string(*twice));
  }

  // Lines of an .ele file: a number, `corners` nodes, further nodes, attributes.
  void read_elements(const TetgenFile& file) {
    ScalarReader reader(file.bytes, file.name, syntax);
    const std::uint64_t count = reader.count(Scalar::int64, "the number of elements");
    const std::int64_t nodes =
        reader.text.at_line_end() ? dimension_ + 1 : reader.integer(Scalar::int64, "the number of nodes");
    if (nodes < dimension_ + 1)
      reader.fail_here("elements have " + std::to_string(nodes) + " nodes; they need " +
                       std::to_string(dimension_ + 1));
    reader.text.skip_line();
    for (std::uint64_t i = 0; i < count; ++i) {
      if (dimension_ == 3) {
        mesh_.add_solid(Solid::tetrahedron, read_corners<4>(reader));
      } else {
        mesh_.add_polygon(read_corners<3>(reader));
      }
    }
  }

  void read_faces(const TetgenFile& file) {
    ScalarReader reader(file.bytes, file.name, syntax);
    const std::uint64_t count = reader.count(Scalar::int64, "the number of faces");
    reader.text.skip_line();
    for (std::uint64_t i = 0; i < count; ++i) mesh_.add_polygon(read_corners<3>(reader));
  }

  TriangleMesh take_surface(const std::string& file) { return mesh_.take_surface(file); }

 private:
  template <std::size_t count>
  std::array<std::uint32_t, count> read_corners(ScalarReader& reader) const {
    reader.integer(Scalar::int64, "the number of an element");
    std::array<std::uint32_t, count> corners;
    for (std::uint32_t& corner : corners) {
      const std::int64_t number = reader.text.integer("a point");
      const std::optional<std::uint32_t> id = numbers_.find(number);
      if (!id)
        reader.fail_here("an element uses point " + std::to_string(number) +
                         ", which the .node file does not have");
      corner = *id;
    }
    reader.text.skip_line();
    return corners;
  }

  std::int64_t dimension_ = 3;
  NodeNumbers numbers_;
  ElementMesh mesh_;
};

}  // namespace

TriangleMesh read_tetgen(const TetgenFile& nodes, const TetgenFile& elements, const TetgenFile& faces) {
  TetgenReader reader;
  reader.read_nodes(nodes);
  if (!faces.name.empty()) reader.read_faces(faces);
  if (!elements.name.empty()) reader.read_elements(elements);
  return reader.take_surface(nodes.name);
}

}  // namespace supple
