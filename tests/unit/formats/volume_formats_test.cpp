// Each reader of meshes with solids, against the boundary of random solids that the tests compute in another
// way and write in every variant of each format.

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <tuple>

#include "readers.hpp"
#include "support/volume_files.hpp"
#include "unit/files/mesh_files.hpp"

namespace supple::volume_formats_test {

constexpr Solid kinds[] = {Solid::tetrahedron, Solid::hexahedron, Solid::prism, Solid::pyramid};
constexpr FileWriter::Encoding encodings[] = {FileWriter::text, FileWriter::little, FileWriter::big};

/// Reads what `write` writes of random solids of each kind, and compares.
void check_boundaries(TriangleMesh (*read)(std::string_view, const std::string&),
                      const std::function<std::string(const Elements&)>& write) {
  for (const Solid kind : kinds) {
    for (unsigned seed = 1; seed <= 4; ++seed) {
      SCOPED_TRACE(testing::Message() << "kind " << int(kind) << ", seed " << seed);
      RandomNumbers random(seed);
      const Elements elements = random_solids(kind, random);
      const TriangleMesh mesh = read(write(elements), "file");
      EXPECT_EQ(mesh.positions, elements.positions());
      EXPECT_TRUE(covers(mesh, boundary_loops(elements)));
      EXPECT_EQ(error_of([&] { check_mesh(mesh); }), "");
    }
  }
}

int gmsh_type(const Elements::Element& element) {
  if (!element.is_solid) return element.corners.size() == 3 ? 2 : 3;
  return std::array{4, 5, 6, 7}[std::size_t(element.solid)];
}

// Numbers of nodes that are neither consecutive nor in order.
std::int64_t node_number(std::size_t vertex) {
  return 1000 - 7 * std::int64_t(vertex);
}

FileWriter gmsh_header(FileWriter::Encoding encoding, const std::string& version) {
  FileWriter file(encoding);
  file.line("$MeshFormat").line(version + (file.is_text() ? " 0 8" : " 1 8"));
  if (!file.is_text()) file.put(std::int32_t{1}).line("");
  file.line("$EndMeshFormat");
  // A section without meaning here, which any text or bytes may be in.
  file.line("$PhysicalNames").line("1").line("3 1 \"$Nodes\"").line("$EndPhysicalNames");
  if (!file.is_text()) file.line("$Entities").line(std::string("\0$\n\r\xff", 5)).line("$EndEntities");
  return file;
}

std::string gmsh_1(const Elements& mesh) {
  FileWriter file(FileWriter::text);
  file.line("$NOD").line(std::to_string(mesh.points.size()));
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    file.put(node_number(i));
    for (const int x : mesh.points[i]) file.put(double(x));
    file.end_row();
  }
  file.line("$ENDNOD").line("$ELM").line(std::to_string(mesh.elements.size()));
  int number = 0;
  for (const Elements::Element& element : mesh.elements) {
    file.put(++number).put(gmsh_type(element)).put(1).put(1).put(element.corners.size());
    for (const std::uint32_t corner : element.corners) file.put(node_number(corner));
    file.end_row();
  }
  return file.line("$ENDELM").bytes();
}

std::string gmsh_2(const Elements& mesh, FileWriter::Encoding encoding) {
  FileWriter file = gmsh_header(encoding, "2.2");
  file.line("$Nodes").line(std::to_string(mesh.points.size()));
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    file.put(std::int32_t(node_number(i)));
    for (const int x : mesh.points[i]) file.put(double(x));
    file.end_row();
  }
  file.line("").line("$EndNodes").line("$Elements").line(std::to_string(mesh.elements.size() + 1));
  const auto put_header = [&](std::int32_t number, std::int32_t type) {
    if (file.is_text()) {
      file.put(number).put(type).put(2).put(1).put(1);
    } else {
      file.put(type)
          .put(std::int32_t{1})
          .put(std::int32_t{2})
          .put(number)
          .put(std::int32_t{1})
          .put(std::int32_t{1});
    }
  };
  std::int32_t number = 0;
  put_header(++number, 15);  // a point
  file.put(std::int32_t(node_number(0))).end_row();
  for (const Elements::Element& element : mesh.elements) {
    put_header(++number, gmsh_type(element));
    for (const std::uint32_t corner : element.corners) file.put(std::int32_t(node_number(corner)));
    file.end_row();
  }
  return file.line("").line("$EndElements").bytes();
}

// Each half of the nodes and each element has a block of its own. The first block has parameters.
std::string gmsh_4(const Elements& mesh, FileWriter::Encoding encoding, bool is_4_1) {
  FileWriter file = gmsh_header(encoding, is_4_1 ? "4.1" : "4");
  const auto put_size = [&](std::size_t size) { file.put(std::uint64_t{size}); };
  const auto put_block = [&](int dimension, int kind, std::size_t count) {
    file.put(std::int32_t{is_4_1 ? dimension : 1}).put(std::int32_t{is_4_1 ? 1 : dimension});
    file.put(std::int32_t{kind});
    put_size(count);
    file.end_row();
  };
  const auto put_tag = [&](std::int64_t tag) {
    is_4_1 ? file.put(std::uint64_t(tag)) : file.put(std::int32_t(tag));
  };
  const std::size_t count = mesh.points.size(), half = count / 2;
  file.line("$Nodes");
  put_size(2);
  put_size(count);
  if (is_4_1) put_size(1), put_size(1000);
  file.end_row();
  for (const auto& [first, last] : {std::pair(std::size_t{0}, half), std::pair(half, count)}) {
    put_block(2, first == 0 ? 1 : 0, last - first);
    for (std::size_t i = first; is_4_1 && i < last; ++i) {
      put_tag(node_number(i));
      file.end_row();
    }
    for (std::size_t i = first; i < last; ++i) {
      if (!is_4_1) put_tag(node_number(i));
      for (const int x : mesh.points[i]) file.put(double(x));
      if (first == 0) file.put(0.5).put(0.25);
      file.end_row();
    }
  }
  file.line("").line("$EndNodes").line("$Elements");
  put_size(mesh.elements.size());
  put_size(mesh.elements.size());
  if (is_4_1) put_size(1), put_size(mesh.elements.size());
  file.end_row();
  std::int64_t number = 0;
  for (const Elements::Element& element : mesh.elements) {
    put_block(element.is_solid ? 3 : 2, gmsh_type(element), 1);
    put_tag(++number);
    for (const std::uint32_t corner : element.corners) put_tag(node_number(corner));
    file.end_row();
  }
  return file.line("").line("$EndElements").line("$NodeData").bytes();
}

TEST(Gmsh, BoundariesOfEveryVersion) {
  check_boundaries(read_gmsh, gmsh_1);
  for (const FileWriter::Encoding encoding : encodings) {
    SCOPED_TRACE(int(encoding));
    check_boundaries(read_gmsh, [&](const Elements& mesh) { return gmsh_2(mesh, encoding); });
    check_boundaries(read_gmsh, [&](const Elements& mesh) { return gmsh_4(mesh, encoding, false); });
    check_boundaries(read_gmsh, [&](const Elements& mesh) { return gmsh_4(mesh, encoding, true); });
  }
}

int vtk_type(const Elements::Element& element) {
  if (!element.is_solid) return element.corners.size() == 3 ? 5 : element.corners.size() == 4 ? 9 : 7;
  return std::array{10, 12, 13, 14}[std::size_t(element.solid)];
}

std::string vtk(const Elements& mesh, FileWriter::Encoding encoding, bool has_offsets, bool is_double) {
  FileWriter file(encoding);
  file.line(has_offsets ? "# vtk DataFile Version 5.1" : "# vtk DataFile Version 3.0").line("POINTS 9 float");
  file.line(file.is_text() ? "ASCII" : "BINARY").line("DATASET UNSTRUCTURED_GRID");
  file.line("FIELD FieldData 2").line("TIME 1 1 double").put(0.125).line("").line("NAMES 1 2 string");
  if (file.is_text()) {
    file.line("first name").line("CELLS");
  } else {
    file.put(std::uint8_t{0xC0 + 3}).line("ab").put(std::uint8_t{0x80}).put(std::uint8_t{2}).line("c");
  }
  file.line("POINTS " + std::to_string(mesh.points.size()) + (is_double ? " double" : " float"));
  for (const auto& point : mesh.points) {
    for (const int x : point) is_double ? file.put(double(x)) : file.put(float(x));
    file.end_row();
  }
  file.line("")
      .line("METADATA")
      .line("INFORMATION 1")
      .line("NAME L2_NORM_RANGE LOCATION vtkDataArray")
      .line("DATA 2 0 1")
      .line("");
  std::size_t corners = 0;
  for (const auto& element : mesh.elements) corners += element.corners.size();
  if (has_offsets) {
    file.line("CELLS " + std::to_string(mesh.elements.size() + 1) + ' ' + std::to_string(corners));
    file.line("OFFSETS vtktypeint64");
    std::int64_t offset = 0;
    file.put(offset);
    for (const auto& element : mesh.elements)
      file.put(offset += std::int64_t(element.corners.size())).end_row();
    file.line("").line("CONNECTIVITY vtktypeint64");
    for (const auto& element : mesh.elements) {
      for (const std::uint32_t corner : element.corners) file.put(std::int64_t{corner});
      file.end_row();
    }
  } else {
    file.line("CELLS " + std::to_string(mesh.elements.size()) + ' ' +
              std::to_string(corners + mesh.elements.size()));
    for (const auto& element : mesh.elements) {
      file.put(std::int32_t(element.corners.size()));
      for (const std::uint32_t corner : element.corners) file.put(std::int32_t(corner));
      file.end_row();
    }
  }
  file.line("").line("CELL_TYPES " + std::to_string(mesh.elements.size()));
  for (const auto& element : mesh.elements) file.put(std::int32_t{vtk_type(element)}).end_row();
  return file.line("").line("CELL_DATA 3").line("?").bytes();
}

TEST(Vtk, BoundariesOfEveryVersion) {
  for (const FileWriter::Encoding encoding : {FileWriter::text, FileWriter::big}) {
    for (const bool has_offsets : {false, true}) {
      for (const bool is_double : {false, true}) {
        SCOPED_TRACE(testing::Message() << int(encoding) << has_offsets << is_double);
        check_boundaries(read_vtk,
                         [&](const Elements& mesh) { return vtk(mesh, encoding, has_offsets, is_double); });
      }
    }
  }
}

std::string medit(const Elements& mesh, bool has_references) {
  FileWriter file(FileWriter::text);
  file.line("MeshVersionFormatted 2").line("# a comment").line("Dimension").line("3");
  file.line("Vertices " + std::to_string(mesh.points.size()));
  for (const auto& point : mesh.points) {
    for (const int x : point) file.put(double(x));
    if (has_references) file.put(7);
    file.end_row();
  }
  file.line("Corners 2").line("1 2").line("Edges 1").line("1 2 0");
  constexpr const char* names[] = {"Tetrahedra", "Hexahedra", "Prisms", "Pyramids"};
  for (const Elements::Element& element : mesh.elements) {
    file.line(std::string(names[int(element.solid)]) + " 1");
    for (const std::uint32_t corner : element.corners) file.put(corner + 1);
    if (has_references) file.put(0);
    file.end_row();
  }
  return file.line("End").bytes();
}

std::string medit_binary(const Elements& mesh, FileWriter::Encoding encoding, int version) {
  FileWriter file(encoding);
  file.put(std::int32_t{1}).put(std::int32_t{version});
  const auto put_integer = [&](std::int64_t value) {
    version == 4 ? file.put(value) : file.put(std::int32_t(value));
  };
  const auto put_real = [&](int value) { version == 1 ? file.put(float(value)) : file.put(double(value)); };
  const auto put_keyword = [&](int code, std::size_t size) {
    const std::size_t place = version < 3 ? 4 : 8;
    const std::size_t next = file.size() + 4 + place + size;
    file.put(std::int32_t{code});
    version < 3 ? file.put(std::int32_t(next)) : file.put(std::int64_t(next));
  };
  const std::size_t integer = version == 4 ? 8 : 4, real = version == 1 ? 4 : 8;
  put_keyword(3, 4);
  file.put(std::int32_t{3});
  put_keyword(60, 5);  // a keyword without meaning here
  file.line("abcd");
  put_keyword(4, integer + mesh.points.size() * (3 * real + integer));
  put_integer(std::int64_t(mesh.points.size()));
  for (const auto& point : mesh.points) {
    for (const int x : point) put_real(x);
    put_integer(7);
  }
  for (const Elements::Element& element : mesh.elements) {
    put_keyword(std::array{8, 10, 9, 49}[std::size_t(element.solid)], integer * (2 + element.corners.size()));
    put_integer(1);
    for (const std::uint32_t corner : element.corners) put_integer(std::int64_t{corner} + 1);
    put_integer(0);
  }
  file.put(std::int32_t{54});
  version < 3 ? file.put(std::int32_t{0}) : file.put(std::int64_t{0});
  return file.bytes();
}

TEST(Medit, BoundariesOfEveryVersion) {
  for (const bool has_references : {true, false})
    check_boundaries(read_medit, [&](const Elements& mesh) { return medit(mesh, has_references); });
  for (const FileWriter::Encoding encoding : {FileWriter::little, FileWriter::big}) {
    for (int version = 1; version <= 4; ++version) {
      SCOPED_TRACE(version);
      check_boundaries(read_medit_binary,
                       [&](const Elements& mesh) { return medit_binary(mesh, encoding, version); });
    }
  }
}

TEST(Tetgen, BoundariesFromZeroAndOne) {
  for (const int first : {0, 1}) {
    for (unsigned seed = 1; seed <= 8; ++seed) {
      RandomNumbers random(seed);
      const Elements elements = random_solids(Solid::tetrahedron, random);
      std::string nodes = "# made by a test\n" + std::to_string(elements.points.size()) + "  3  1  1\n";
      int number = first;
      for (const auto& [x, y, z] : elements.points) {
        nodes += std::to_string(number++) + "  " + std::to_string(x) + ' ' + std::to_string(y) + ".0 " +
                 std::to_string(z) + "e0  0.5 -1\n";
      }
      std::string solids = std::to_string(elements.elements.size()) + " 4 1\n";
      number = first;
      for (const Elements::Element& element : elements.elements) {
        solids += std::to_string(number++);
        for (const std::uint32_t corner : element.corners)
          solids += "   " + std::to_string(int(corner) + first);
        solids += "  17 # region\n";
      }
      const TriangleMesh mesh = read_tetgen({nodes, "a.node"}, {solids, "a.ele"}, {});
      EXPECT_EQ(mesh.positions, elements.positions());
      EXPECT_TRUE(covers(mesh, boundary_loops(elements))) << seed;
    }
  }
}

}  // namespace supple::volume_formats_test
