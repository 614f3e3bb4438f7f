// Gmsh's .msh files (https://gmsh.info/doc/texinfo/gmsh.html#Gmsh-file-formats). A file has sections between
// lines such as $Nodes and $EndNodes. In binary files the content of the sections is binary, except that
// versions 1 and 2 write counts as text.

#include <array>
#include <optional>
#include <utility>

#include "core/quotes.hpp"
#include "elements/element_mesh.hpp"
#include "elements/node_numbers.hpp"
#include "elements/scalar_reader.hpp"
#include "readers.hpp"

namespace supple {
namespace {

/// The types of elements by order, from 1: their numbers in the file, and how many nodes they have. The
/// corners come first.
struct Family {
  int dimension;
  std::optional<Solid> solid;
  std::uint8_t corner_count;
  std::array<std::array<std::int16_t, 2>, 20> types;  // {number, nodes}; the rest is zero
};
constexpr std::array<Family, 8> families = {{
    {0, {}, 1, {{{15, 1}}}},
    {1,
     {},
     2,
     {{{1, 2}, {8, 3}, {26, 4}, {27, 5}, {28, 6}, {62, 7}, {63, 8}, {64, 9}, {65, 10}, {66, 11}, {84, 1}}}},
    {2,
     {},
     3,
     {{{2, 3},
       {9, 6},
       {20, 9},
       {21, 10},
       {22, 12},
       {23, 15},
       {24, 15},
       {25, 21},
       {42, 28},
       {43, 36},
       {44, 45},
       {45, 55},
       {46, 66},
       {52, 18},
       {53, 21},
       {54, 24},
       {55, 27},
       {56, 30}}}},
    {2,
     {},
     4,
     {{{3, 4},
       {10, 9},
       {16, 8},
       {36, 16},
       {37, 25},
       {38, 36},
       {39, 12},
       {40, 16},
       {41, 20},
       {47, 49},
       {48, 64},
       {49, 81},
       {50, 100},
       {51, 121},
       {57, 24},
       {58, 28},
       {59, 32},
       {60, 36},
       {61, 40}}}},
    {3,
     Solid::tetrahedron,
     4,
     {{{4, 4},
       {11, 10},
       {29, 20},
       {30, 35},
       {31, 56},
       {32, 22},
       {33, 28},
       {71, 84},
       {72, 120},
       {73, 165},
       {74, 220},
       {75, 286},
       {79, 34},
       {80, 40},
       {81, 46},
       {82, 52},
       {83, 58}}}},
    {3,
     Solid::hexahedron,
     8,
     {{{5, 8},
       {12, 27},
       {17, 20},
       {92, 64},
       {93, 125},
       {94, 216},
       {95, 343},
       {96, 512},
       {97, 729},
       {98, 1000},
       {99, 32},
       {100, 44},
       {101, 56},
       {102, 68},
       {103, 80},
       {104, 92},
       {105, 104}}}},
    {3,
     Solid::prism,
     6,
     {{{6, 6},
       {13, 18},
       {18, 15},
       {90, 40},
       {91, 75},
       {106, 126},
       {107, 196},
       {108, 288},
       {109, 405},
       {110, 550}}}},
    {3,
     Solid::pyramid,
     5,
     {{{7, 5},
       {14, 14},
       {19, 13},
       {118, 30},
       {119, 55},
       {120, 91},
       {121, 140},
       {122, 204},
       {123, 285},
       {124, 385}}}},
}};

struct ElementType {
  const Family* family = nullptr;
  std::size_t node_count = 0;
};

class GmshReader {
 public:
  GmshReader(std::string_view bytes, const std::string& file)
      : bytes_(bytes), file_(file), reader_(bytes, file, {}) {}

  TriangleMesh read() {
    for (bool has_nodes = false; reader_.text.skip_to_word();) {
      const std::string_view section = reader_.text.word();
      if (version_ == 0 && section != "$MeshFormat" && section != "$NOD" && section != "$Comments")
        reader_.text.fail_expected("'$MeshFormat' or '$NOD', with which a .msh file of Gmsh begins", section);
      if (section == "$MeshFormat") {
        read_format();
      } else if (section == "$NOD" || section == "$Nodes") {
        if (section == "$NOD") version_ = 1;
        if (std::exchange(has_nodes, true))
          reader_.text.fail_here("the section " + in_quotes(section) + " is there twice");
        version_ >= 4 ? read_node_blocks() : read_nodes();
        if (const auto twice = numbers_.sort())
          reader_.fail_here("two nodes have the number " + std::to_string(*twice));
      } else if (section == "$ELM" || section == "$Elements") {
        if (!has_nodes) reader_.text.fail_here("the elements come before the nodes");
        version_ >= 4   ? read_element_blocks()
        : version_ >= 2 ? read_elements()
                        : read_elements_of_version_1();
        expect_end(section);
        return mesh_.take_surface(file_);
      } else {
        skip_section(section);
        continue;
      }
      expect_end(section);
    }
    reader_.text.fail_here("the file ends before the elements ($Elements)");
  }

 private:
  bool is_text() const { return reader_.encoding() == Encoding::text; }

  static std::string end_of(std::string_view section) { return "$End" + std::string(section.substr(1)); }

  void expect_end(std::string_view section) {
    reader_.text.skip_to_word();
    const std::string_view found = reader_.text.word();
    const std::string end =
        section == "$NOD" || section == "$ELM" ? "$END" + std::string(section.substr(1)) : end_of(section);
    if (found != end) reader_.text.fail_expected(in_quotes(end), found);
  }

  // Other sections may have any text or binary content.
  void skip_section(std::string_view section) {
    if (!section.starts_with('$')) reader_.text.fail_expected("a section such as $Elements", section);
    const std::string end = end_of(section);
    const std::size_t place = bytes_.find(end, reader_.text.offset());
    if (place == std::string_view::npos)
      reader_.text.fail_here("the section " + in_quotes(section) + " has no end");
    if (is_text()) {
      while (reader_.text.offset() < place) reader_.text.skip_line();
    } else {
      reader_.text.skip_bytes(place - reader_.text.offset());
    }
    expect_end(section);
  }

  void read_format() {
    version_ = reader_.number(Scalar::float64, "the version");
    if (!(version_ >= 2 && version_ < 3) && !(version_ >= 4 && version_ < 5))
      reader_.text.fail_here(
          "this version of Gmsh's format is not supported; in Gmsh, save the mesh as version 4.1 or 2.2");
    const std::int64_t is_binary = reader_.integer(Scalar::int32, "the type of the file");
    const std::int64_t size = reader_.integer(Scalar::int32, "the size of numbers");
    if (is_binary != 0 && is_binary != 1)
      reader_.text.fail_here("the type of the file is " + std::to_string(is_binary) + "; it may be 0 or 1");
    if (size != 8 && size != 4)
      reader_.text.fail_here("the size of numbers is " + std::to_string(size) + "; it may be 8 or 4");
    size_type_ = size == 8 ? Scalar::int64 : Scalar::int32;
    if (is_binary == 0) return;
    reader_.text.skip_line();
    reader_.set_binary(Encoding::little_endian);
    const std::int64_t one = reader_.integer(Scalar::int32, "the number 1, which tells the byte order");
    if (one == 0x01000000) {
      reader_.set_binary(Encoding::big_endian);
    } else if (one != 1) {
      reader_.fail_here("the number that tells the byte order is not 1");
    }
  }

  // Versions 1 and 2: the count as text, then the nodes.
  std::uint64_t text_count(const char* what) {
    reader_.text.skip_to_word();
    const std::int64_t count = reader_.text.integer(what);
    if (count < 0) reader_.text.fail_here(std::string(what) + " is " + std::to_string(count));
    begin_content();
    return static_cast<std::uint64_t>(count);
  }
  void begin_content() {
    if (!is_text()) reader_.text.skip_line();
  }

  Vec3d read_point() {
    const double x = reader_.number(Scalar::float64, "x");
    const double y = reader_.number(Scalar::float64, "y");
    return {x, y, reader_.number(Scalar::float64, "z")};
  }

  void read_nodes() {
    const std::uint64_t count = text_count("the number of nodes");
    reader_.expect(count, 4, Scalar::int32, "nodes");
    for (std::uint64_t i = 0; i < count; ++i) {
      numbers_.add(reader_.integer(Scalar::int32, "the number of a node"));
      mesh_.positions.push_back(read_point());
    }
  }

  // Version 4: blocks, one for each entity of the geometry.
  struct Block {
    int dimension = 0;
    std::int64_t kind = 0;  // of nodes: whether they have parameters; of elements: their type
    std::uint64_t count = 0;
  };
  std::uint64_t read_block_count() {
    begin_content();
    const std::uint64_t blocks = reader_.count(size_type_, "the number of blocks");
    reader_.count(size_type_, "a count");
    if (is_4_1()) reader_.skip(size_type_, 2, "the smallest and the largest number");
    return blocks;
  }
  Block read_block() {
    std::int64_t dimension = reader_.integer(Scalar::int32, "a dimension");
    const std::int64_t tag = reader_.integer(Scalar::int32, "an entity");
    if (!is_4_1()) dimension = tag;
    if (dimension < 0 || dimension > 3)
      reader_.fail_here("the dimension " + std::to_string(dimension) + " is not from 0 to 3");
    const std::int64_t kind = reader_.integer(Scalar::int32, "a type");
    return {static_cast<int>(dimension), kind, reader_.count(size_type_, "a count")};
  }
  bool is_4_1() const { return version_ >= 4.1; }
  Scalar tag_type() const { return is_4_1() ? size_type_ : Scalar::int32; }

  void read_node_blocks() {
    for (std::uint64_t blocks = read_block_count(); blocks > 0; --blocks) {
      const Block block = read_block();
      reader_.expect(block.count, 4, Scalar::int32, "nodes");
      const auto read_number = [&] { numbers_.add(reader_.integer(tag_type(), "the number of a node")); };
      for (std::uint64_t i = 0; is_4_1() && i < block.count; ++i) read_number();
      for (std::uint64_t i = 0; i < block.count; ++i) {
        if (!is_4_1()) read_number();
        mesh_.positions.push_back(read_point());
        if (block.kind != 0)
          reader_.skip(Scalar::float64, static_cast<std::uint64_t>(block.dimension), "a parameter");
      }
    }
  }

  ElementType find_type(std::int64_t number) const {
    for (const Family& family : families) {
      for (const auto& [known, nodes] : family.types) {
        if (known == number && known != 0) return {&family, static_cast<std::size_t>(nodes)};
      }
    }
    reader_.fail_here("elements of type " + std::to_string(number) +
                      " are not supported; in Gmsh, save the mesh with elements of order 1");
  }

  // Reads the nodes of an element of the given type, and adds it.
  void read_element(const ElementType& type, Scalar number_type) {
    const Family& family = *type.family;
    if (family.dimension < 2 || type.node_count < family.corner_count) {
      reader_.skip(number_type, type.node_count, "a node");
      return;
    }
    std::array<std::uint32_t, 8> corners;
    for (std::size_t i = 0; i < family.corner_count; ++i) {
      const std::int64_t number = reader_.integer(number_type, "a node");
      const std::optional<std::uint32_t> id = numbers_.find(number);
      if (!id)
        reader_.fail_here("an element uses node " + std::to_string(number) +
                          ", which the file does not have");
      corners[i] = *id;
    }
    reader_.skip(number_type, type.node_count - family.corner_count, "a node");
    const auto used = std::span(corners).first(family.corner_count);
    if (family.solid) {
      mesh_.add_solid(*family.solid, used);
    } else {
      mesh_.add_polygon(used);
    }
  }

  void read_elements_of_version_1() {
    const std::uint64_t count = text_count("the number of elements");
    for (std::uint64_t i = 0; i < count; ++i) {
      reader_.integer(Scalar::int32, "the number of an element");
      const ElementType type = find_type(reader_.integer(Scalar::int32, "the type of an element"));
      reader_.skip(Scalar::int32, 2, "an entity");
      const std::uint64_t nodes = reader_.count(Scalar::int32, "the number of nodes");
      if (nodes != type.node_count)
        reader_.fail_here("an element has " + std::to_string(nodes) + " nodes; its type has " +
                          std::to_string(type.node_count));
      read_element(type, Scalar::int32);
    }
  }

  // Version 2. Binary files have groups of elements with equal type and number of tags.
  void read_elements() {
    const std::uint64_t count = text_count("the number of elements");
    for (std::uint64_t i = 0; i < count;) {
      if (is_text()) reader_.integer(Scalar::int32, "the number of an element");
      const ElementType type = find_type(reader_.integer(Scalar::int32, "the type of an element"));
      const std::uint64_t group = is_text() ? 1 : reader_.count(Scalar::int32, "the number of elements");
      const std::uint64_t tags = reader_.count(Scalar::int32, "the number of tags");
      if (group > count - i)
        reader_.fail_here("there are more elements than the " + std::to_string(count) +
                          " that the section announces");
      for (std::uint64_t k = 0; k < group; ++k) {
        reader_.skip(Scalar::int32, is_text() ? tags : tags + 1, "a tag");
        read_element(type, Scalar::int32);
      }
      i += group;
    }
  }

  void read_element_blocks() {
    for (std::uint64_t blocks = read_block_count(); blocks > 0; --blocks) {
      const Block block = read_block();
      const ElementType type = find_type(block.kind);
      for (std::uint64_t i = 0; i < block.count; ++i) {
        reader_.skip(tag_type(), 1, "the number of an element");
        read_element(type, tag_type());
      }
    }
  }

  std::string_view bytes_;
  std::string file_;
  ScalarReader reader_;
  double version_ = 0;
  Scalar size_type_ = Scalar::int64;
  NodeNumbers numbers_;
  ElementMesh mesh_;
};

}  // namespace

TriangleMesh read_gmsh(std::string_view bytes, const std::string& file) {
  return GmshReader(bytes, file).read();
}

}  // namespace supple
