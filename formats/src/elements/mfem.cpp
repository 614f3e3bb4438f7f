// MFEM's meshes of version 1 (https://mfem.org/mesh-formats): keywords, each with a number of entries. A
// curved mesh has the places of its vertices among its nodes.

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "core/error.hpp"
#include "core/quotes.hpp"
#include "elements/element_mesh.hpp"
#include "elements/scalar_reader.hpp"
#include "readers.hpp"

namespace supple {
namespace {

/// The elements in the order of their numbers in a file.
struct ElementKind {
  std::size_t corner_count;
  std::optional<Solid> solid;
};
constexpr std::array<ElementKind, 8> element_kinds = {{
    {1, {}},
    {2, {}},
    {3, {}},
    {4, {}},
    {4, Solid::tetrahedron},
    {8, Solid::hexahedron},
    {6, Solid::prism},
    {5, Solid::pyramid},
}};

class MfemReader {
 public:
  MfemReader(std::string_view bytes, const std::string& file)
      : file_(file), reader_(bytes, file, {.hash_comments = true}) {}

  TriangleMesh read() {
    TextScanner& text = reader_.text;
    text.skip_to_word();
    if (!text.accept("MFEM mesh v1."))
      text.fail_here(
          "only meshes that begin with 'MFEM mesh v1.' are supported, not NURBS, INLINE or NC meshes; save "
          "it "
          "as such a mesh, or export it for ParaView as .vtu");
    text.skip_line();
    while (text.skip_to_word()) {
      const std::string_view word = text.word();
      if (word == "elements" || word == "boundary") {
        read_elements();
      } else if (word == "vertices") {
        read_vertices();
      } else if (word == "nodes") {
        read_nodes();
        break;
      } else if (word == "mfem_mesh_end") {
        break;
      }
      // Everything else is passed word by word: the dimension, and sets of attributes with their names.
    }
    if (!has_positions_) text.fail_here("the file has no coordinates of its vertices");
    for (const auto& [kind, first] : elements_) {
      const std::span corners = std::span(corners_).subspan(first, kind->corner_count);
      for (const std::uint32_t corner : corners) {
        if (corner >= mesh_.positions.size())
          fail(file_ + ": vertex " + std::to_string(corner) +
               " of an element is out of range; the file has " + std::to_string(mesh_.positions.size()) +
               ", counted from 0");
      }
      if (kind->solid)
        mesh_.add_solid(*kind->solid, corners);
      else
        mesh_.add_polygon(corners);
    }
    return mesh_.take_surface(file_);
  }

 private:
  void read_elements() {
    const std::uint64_t count = reader_.count(Scalar::int64, "the number of elements");
    reader_.expect(count, 3, Scalar::int8, "elements");
    for (std::uint64_t i = 0; i < count; ++i) {
      reader_.integer(Scalar::int64, "the attribute of an element");
      const std::uint64_t kind = reader_.count(Scalar::int64, "the type of an element");
      if (kind >= element_kinds.size())
        reader_.fail_here("element " + std::to_string(i) + " is of type " + std::to_string(kind) +
                          "; the types are 0 to 7");
      elements_.emplace_back(&element_kinds[kind], corners_.size());
      for (std::size_t k = 0; k < element_kinds[kind].corner_count; ++k) {
        const std::uint64_t id = reader_.count(Scalar::int64, "a vertex of an element");
        if (id > 0xffffffff) reader_.fail_here("vertex " + std::to_string(id) + " is out of range");
        corners_.push_back(static_cast<std::uint32_t>(id));
      }
    }
  }

  void read_vertices() {
    vertex_count_ = reader_.count(Scalar::int64, "the number of vertices");
    // Curved meshes have no coordinates here.
    if (!reader_.text.skip_to_word() || reader_.text.accept("nodes")) return read_nodes();
    const std::uint64_t dimension = reader_.count(Scalar::int64, "the dimension of the vertices");
    check_dimension(dimension);
    reader_.expect(vertex_count_, dimension, Scalar::int8, "vertices");
    mesh_.positions.resize(vertex_count_);
    for (Vec3d& position : mesh_.positions) {
      for (std::uint64_t axis = 0; axis < dimension; ++axis)
        position[static_cast<int>(axis)] = reader_.number(Scalar::float64, "a coordinate");
    }
    has_positions_ = true;
  }

  void check_dimension(std::uint64_t dimension) const {
    if (dimension < 1 || dimension > 3)
      reader_.fail_here("the vertices have " + std::to_string(dimension) +
                        " coordinates; they may have 1 to 3");
  }

  /// A continuous finite element space has the vertices before its other nodes.
  void read_nodes() {
    TextScanner& text = reader_.text;
    expect("FiniteElementSpace");
    expect("FiniteElementCollection:");
    const std::string name(text.word());
    constexpr std::array<std::string_view, 4> continuous = {"H1", "Linear", "Quadratic", "Cubic"};
    if (std::none_of(continuous.begin(), continuous.end(),
                     [&](std::string_view start) { return name.starts_with(start); }))
      text.fail_here("the nodes are of the space " + in_quotes(name) +
                     ", which has no vertices; save the mesh with H1 nodes, or export it as .vtu");
    expect("VDim:");
    const std::uint64_t dimension = reader_.count(Scalar::int64, "the dimension of the nodes");
    check_dimension(dimension);
    expect("Ordering:");
    const bool is_by_nodes = reader_.count(Scalar::int64, "the ordering") == 0;
    std::vector<double> numbers;
    while (text.skip_to_word() && !text.accept("mfem_mesh_end"))
      numbers.push_back(reader_.number(Scalar::float64, "a coordinate"));
    const std::uint64_t nodes = numbers.size() / dimension;
    if (numbers.size() % dimension != 0 || nodes < vertex_count_)
      text.fail_here("the nodes have " + std::to_string(numbers.size()) + " coordinates for " +
                     std::to_string(vertex_count_) + " vertices");
    mesh_.positions.assign(vertex_count_, {});
    for (std::uint64_t i = 0; i < vertex_count_; ++i) {
      for (std::uint64_t axis = 0; axis < dimension; ++axis)
        mesh_.positions[i][static_cast<int>(axis)] =
            numbers[is_by_nodes ? axis * nodes + i : i * dimension + axis];
    }
    has_positions_ = true;
  }

  void expect(const char* word) {
    reader_.text.skip_to_word();
    if (const std::string_view found = reader_.text.word(); found != word)
      reader_.text.fail_expected(in_quotes(word), found);
  }

  std::string file_;
  ScalarReader reader_;
  std::uint64_t vertex_count_ = 0;
  bool has_positions_ = false;
  std::vector<std::uint32_t> corners_;
  std::vector<std::pair<const ElementKind*, std::size_t>> elements_;  // with their first corner
  ElementMesh mesh_;
};

}  // namespace

TriangleMesh read_mfem(std::string_view bytes, const std::string& file) {
  return MfemReader(bytes, file).read();
}

}  // namespace supple
