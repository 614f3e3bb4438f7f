#include <gtest/gtest.h>
#include <zlib.h>

#include <bit>
#include <string>
#include <vector>

#include "files/byte_order.hpp"
#include "supple/formats.hpp"
#include "unit/files/mesh_files.hpp"
#include "unit/formats/gltf_builder.hpp"

namespace supple::vtk_xml_test {

enum class Form { text, base64, raw, base64_after, zlib, zlib_after };

/// Writes arrays of a file of VTK in each of its forms.
class VtkXmlBuilder {
 public:
  VtkXmlBuilder(Form form, std::endian order, bool has_wide_header)
      : form_(form), order_(order), has_wide_header_(has_wide_header) {}

  template <class Number>
  std::string array(const char* type, const char* name, const std::vector<Number>& numbers) {
    std::string result = std::string("<DataArray type=\"") + type + "\" Name=\"" + name + "\" ";
    if (form_ == Form::text) {
      result += "NumberOfComponents=\"3\" format=\"ascii\">\n";
      for (const Number number : numbers) result += std::to_string(number) + "\n ";
      return result + "</DataArray>\n";
    }
    std::string bytes;
    for (const Number number : numbers) append(bytes, number);
    const bool is_after = form_ == Form::raw || form_ == Form::base64_after || form_ == Form::zlib_after;
    std::string content = encoded(bytes);
    if (!is_after) return result + "format=\"binary\">\n  " + content + "\n</DataArray>\n";
    result += "format=\"appended\" offset=\"" + std::to_string(after_.size()) + "\"/>\n";
    after_ += content;
    return result;
  }

  std::string file(const std::string& type, const std::string& pieces) const {
    const bool is_compressed = form_ == Form::zlib || form_ == Form::zlib_after;
    std::string text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"" + type +
                       "\" version=\"1.0\" byte_order=\"" +
                       (order_ == std::endian::big ? "BigEndian" : "LittleEndian") + "\" header_type=\"" +
                       (has_wide_header_ ? "UInt64" : "UInt32") + "\"" +
                       (is_compressed ? " compressor=\"vtkZLibDataCompressor\"" : "") + ">\n<" + type +
                       ">\n" + pieces + "</" + type + ">\n";
    if (!after_.empty())
      text += std::string("<AppendedData encoding=\"") + (form_ == Form::base64_after ? "base64" : "raw") +
              "\">\n _" + after_ + "\n</AppendedData>\n";
    return text + "</VTKFile>\n";
  }

 private:
  template <class Number>
  void append(std::string& bytes, Number number) const {
    std::string added;
    append_scalar(added, number);
    if (order_ == std::endian::big) std::reverse(added.begin(), added.end());
    bytes += added;
  }
  std::string header(const std::vector<std::size_t>& numbers) const {
    std::string bytes;
    for (const std::size_t number : numbers) {
      if (has_wide_header_)
        append(bytes, static_cast<std::uint64_t>(number));
      else
        append(bytes, static_cast<std::uint32_t>(number));
    }
    return bytes;
  }
  std::string encoded(const std::string& bytes) const {
    const bool is_text = form_ == Form::base64 || form_ == Form::base64_after || form_ == Form::zlib;
    if (form_ != Form::zlib && form_ != Form::zlib_after) {
      const std::string all = header({bytes.size()}) + bytes;
      return is_text ? base64(all) : all;
    }
    // Blocks of 40 bytes, and a shorter one.
    constexpr std::size_t block = 40;
    std::vector<std::size_t> numbers = {(bytes.size() + block - 1) / block, block, bytes.size() % block};
    std::string packed;
    for (std::size_t begin = 0; begin < bytes.size(); begin += block) {
      const std::string part = bytes.substr(begin, block);
      uLongf size = compressBound(part.size());
      std::string out(size, '\0');
      compress(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(part.data()),
               part.size());
      packed += out.substr(0, size);
      numbers.push_back(size);
    }
    return is_text ? base64(header(numbers)) + base64(packed) : header(numbers) + packed;
  }

  Form form_;
  std::endian order_;
  bool has_wide_header_;
  std::string after_;
};

template <class Test>
void for_each_form(Test test) {
  for (const Form form :
       {Form::text, Form::base64, Form::raw, Form::base64_after, Form::zlib, Form::zlib_after}) {
    for (const std::endian order : {std::endian::little, std::endian::big}) {
      for (const bool wide : {false, true}) {
        SCOPED_TRACE(static_cast<int>(form));
        test(VtkXmlBuilder(form, order, wide));
      }
    }
  }
}

TEST(VtkXml, UnstructuredGridsInEveryForm) {
  const TemporaryFolder folder;
  for_each_form([&](VtkXmlBuilder vtk) {
    // Two tetrahedra with a common face, a triangle of it, and a line.
    const std::string piece =
        "<Piece NumberOfPoints=\"5\" NumberOfCells=\"4\">\n<PointData>" +
        vtk.array<float>("Float32", "speed", {1, 2, 3, 4, 5}) + "</PointData>\n<Points>\n" +
        vtk.array<double>("Float64", "Points", {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, -1}) +
        "</Points>\n<Cells>\n" +
        vtk.array<std::int64_t>("Int64", "connectivity", {0, 1, 2, 3, 0, 2, 1, 4, 0, 1, 2, 3, 4}) +
        vtk.array<std::int32_t>("Int32", "offsets", {4, 8, 11, 13}) +
        vtk.array<std::uint8_t>("UInt8", "types", {10, 10, 5, 3}) + "</Cells>\n</Piece>\n";
    const TriangleMesh mesh = load_any_mesh(folder.write("a.vtu", vtk.file("UnstructuredGrid", piece)));
    ASSERT_EQ(mesh.positions.size(), 5u);
    EXPECT_EQ(mesh.positions[4], (Vec3d{0, 0, -1}));
    EXPECT_EQ(mesh.triangles,
              (std::vector<Triangle>{{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {0, 2, 4}, {2, 1, 4}, {1, 0, 4}}));
  });
}

TEST(VtkXml, PolygonsOfSeveralPieces) {
  const TemporaryFolder folder;
  for_each_form([&](VtkXmlBuilder vtk) {
    std::string pieces;
    for (int i = 0; i < 2; ++i) {
      const auto x = static_cast<float>(10 * i);
      pieces +=
          "<Piece NumberOfPoints=\"4\" NumberOfPolys=\"1\" NumberOfStrips=\"1\" NumberOfLines=\"1\">\n"
          "<Points>" +
          vtk.array<float>("Float32", "Points", {x, 0, 0, x + 1, 0, 0, x + 1, 1, 0, x, 1, 0}) +
          "</Points>\n<Lines>" + vtk.array<std::int32_t>("Int32", "connectivity", {0, 1}) +
          vtk.array<std::int32_t>("Int32", "offsets", {2}) + "</Lines>\n<Strips>" +
          vtk.array<std::int32_t>("Int32", "connectivity", {0, 1, 3}) +
          vtk.array<std::int32_t>("Int32", "offsets", {3}) + "</Strips>\n<Polys>" +
          vtk.array<std::int32_t>("Int32", "connectivity", {0, 1, 2, 3}) +
          vtk.array<std::int32_t>("Int32", "offsets", {4}) + "</Polys>\n</Piece>\n";
    }
    const TriangleMesh mesh = load_any_mesh(folder.write("a.VTP", vtk.file("PolyData", pieces)));
    EXPECT_EQ(mesh.positions.size(), 8u);
    EXPECT_EQ(mesh.triangles,
              (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 1, 3}, {4, 5, 6}, {4, 6, 7}, {4, 5, 7}}));
    EXPECT_EQ(mesh.polygons.quads, 2u);
  });
}

TEST(VtkXml, SaysWhatIsWrong) {
  const TemporaryFolder folder;
  const auto message_for = [&](const std::string& text) {
    const std::string path = folder.write("a.vtu", text);
    std::string message = error_of([&] { load_any_mesh(path); });
    EXPECT_NE(message.find(path), std::string::npos) << message;
    return message;
  };
  const auto grid = [](VtkXmlBuilder vtk, std::int64_t last_id, std::uint8_t type, std::int32_t end = 3) {
    return vtk.file("UnstructuredGrid",
                    "<Piece NumberOfPoints=\"3\" NumberOfCells=\"1\"><Points>" +
                        vtk.array<float>("Float32", "Points", {0, 0, 0, 1, 0, 0, 0, 1, 0}) +
                        "</Points><Cells>" +
                        vtk.array<std::int64_t>("Int64", "connectivity", {0, 1, last_id}) +
                        vtk.array<std::int32_t>("Int32", "offsets", {end}) +
                        vtk.array<std::uint8_t>("UInt8", "types", {type}) + "</Cells></Piece>");
  };
  const auto expect = [](const std::string& message, const char* part) {
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  for_each_form([&](const VtkXmlBuilder& vtk) {
    EXPECT_EQ(load_any_mesh(folder.write("a.vtu", grid(vtk, 2, 5))).triangles.size(), 1u);
    expect(message_for(grid(vtk, 3, 5)), "point 3 of cell 0 is out of range; the piece has 3");
    expect(message_for(grid(vtk, -1, 5)), "point -1 of cell 0 is out of range");
    expect(message_for(grid(vtk, 2, 42)), "cell 0 is of type 42, which is not supported");
    expect(message_for(grid(vtk, 2, 10)), "cell 0 has 3 points; its type needs 4");
    expect(message_for(grid(vtk, 2, 5, 4)), "offset 4 of cell 0 is out of range");
    const std::string whole = grid(vtk, 2, 5);
    for (std::size_t size = 0; size < whole.size(); size += 7) {
      const std::string path = folder.write("a.vtu", whole.substr(0, size));
      error_of([&] { load_any_mesh(path); });  // of any kind, or a mesh where only the end is missing
    }
  });
  const VtkXmlBuilder text(Form::text, std::endian::little, false);
  expect(
      message_for("<VTKFile type=\"PolyData\" compressor=\"vtkLZ4DataCompressor\"><PolyData><Piece><Points>"
                  "<DataArray type=\"Float32\" "
                  "format=\"binary\">AAAA</DataArray></Points></Piece></PolyData></VTKFile>"),
      "compressed by 'vtkLZ4DataCompressor', which is not supported; save it with the compressor ZLib");
  expect(message_for(text.file("ImageData", "")), "a data set of type 'ImageData' has no surface here");
  expect(
      message_for("<VTKFile type=\"UnstructuredGrid\" compressor=\"vtkZLibDataCompressor\"><UnstructuredGrid>"
                  "<Piece><Points><DataArray type=\"Float32\" format=\"binary\">" +
                  base64(std::string("\xff\xff\0\0\xff\xff\xff\xff\0\0\0\0", 12)) +
                  "</DataArray></Points></Piece></UnstructuredGrid></VTKFile>"),
      "announces more blocks than the file has");
}

}  // namespace supple::vtk_xml_test
