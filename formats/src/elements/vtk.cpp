// VTK's legacy files (https://docs.vtk.org/en/latest/vtk_file_formats/vtk_legacy_file_format.html): lines of
// keywords, followed by numbers as text or in big-endian binary.

#include <optional>
#include <vector>

#include "core/quotes.hpp"
#include "elements/element_mesh.hpp"
#include "elements/scalar_reader.hpp"
#include "elements/vtk_cells.hpp"
#include "readers.hpp"

namespace supple {
namespace {

struct TypeName {
  std::string_view name;
  Scalar type;
};
constexpr TypeName type_names[] = {
    {"char", Scalar::int8},          {"unsigned_char", Scalar::uint8},
    {"short", Scalar::int16},        {"unsigned_short", Scalar::uint16},
    {"int", Scalar::int32},          {"unsigned_int", Scalar::uint32},
    {"long", Scalar::int64},         {"unsigned_long", Scalar::uint64},
    {"vtktypeint64", Scalar::int64}, {"vtktypeuint64", Scalar::uint64},
    {"vtktypeint32", Scalar::int32}, {"vtktypeuint32", Scalar::uint32},
    {"vtkidtype", Scalar::int64},    {"float", Scalar::float32},
    {"double", Scalar::float64},
};

/// Lists of vertices: list i is ids[ends[i - 1]] to ids[ends[i] - 1].
struct Lists {
  std::vector<std::uint32_t> ids;
  std::vector<std::size_t> ends;

  std::span<const std::uint32_t> operator[](std::size_t i) const {
    const std::size_t first = i == 0 ? 0 : ends[i - 1];
    return std::span(ids).subspan(first, ends[i] - first);
  }
};

class VtkReader {
 public:
  VtkReader(std::string_view bytes, const std::string& file) : file_(file), reader_(bytes, file, {}) {}

  TriangleMesh read() {
    read_header();
    while (reader_.text.skip_to_word()) {
      const std::string keyword = lower_case_word();
      if (keyword == "dataset") {
        read_dataset();
      } else if (keyword == "points") {
        read_points();
      } else if (keyword == "cells") {
        cells_ = read_lists();
      } else if (keyword == "cell_types") {
        read_cells();
      } else if (keyword == "polygons") {
        add(read_lists(), {VtkCellShape::polygon});
      } else if (keyword == "triangle_strips") {
        add(read_lists(), {VtkCellShape::strip, 3});
      } else if (keyword == "vertices" || keyword == "lines") {
        read_lists();
      } else if (keyword == "metadata") {
        skip_metadata();
      } else if (keyword == "field") {
        skip_field();
      } else if (keyword == "point_data" || keyword == "cell_data") {
        break;
      } else {
        reader_.text.fail_expected("a keyword such as POINTS or CELLS", keyword);
      }
    }
    if (!cells_.ends.empty())
      reader_.text.fail_here("the file ends before the types of its cells (CELL_TYPES)");
    return mesh_.take_surface(file_);
  }

 private:
  // Keywords may have any case.
  std::string lower_case_word() {
    std::string word(reader_.text.word());
    for (char& c : word) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return word;
  }

  // The keywords and counts are text in every file.
  std::uint64_t text_count(const char* what) {
    const std::int64_t count = reader_.text.integer(what);
    if (count < 0) reader_.text.fail_here(std::string(what) + " is " + std::to_string(count));
    return static_cast<std::uint64_t>(count);
  }
  Scalar text_type() {
    const std::string name = lower_case_word();
    for (const TypeName& known : type_names) {
      if (known.name == name) return known.type;
    }
    reader_.text.fail_here("unknown type of numbers " + in_quotes(name));
  }
  // Binary numbers begin on the line after the keyword.
  void begin_numbers() {
    if (reader_.encoding() != Encoding::text) reader_.text.skip_line();
  }

  void read_header() {
    TextScanner& text = reader_.text;
    text.skip_to_word();
    if (!text.accept("# vtk DataFile"))
      text.fail_here("a legacy .vtk file begins with '# vtk DataFile Version'");
    text.skip_line();
    text.skip_line();  // the title
    text.skip_to_word();
    const std::string encoding = lower_case_word();
    if (encoding == "binary") {
      reader_.set_binary(Encoding::big_endian);
    } else if (encoding != "ascii") {
      text.fail_expected("'ASCII' or 'BINARY'", encoding);
    }
  }

  void read_dataset() {
    const std::string kind = lower_case_word();
    if (kind != "polydata" && kind != "unstructured_grid") {
      reader_.text.fail_here("a data set of type " + in_quotes(kind) +
                             " has no surface; save its surface as POLYDATA (in ParaView: Extract Surface)");
    }
  }

  void read_points() {
    const std::uint64_t count = text_count("the number of points");
    const Scalar type = text_type();
    begin_numbers();
    reader_.expect(count, 3, type, "points");
    if (!mesh_.positions.empty()) reader_.text.fail_here("the points are there twice");
    mesh_.positions.resize(count);
    for (Vec3d& position : mesh_.positions) {
      for (int axis = 0; axis < 3; ++axis) position[axis] = reader_.number(type, "a coordinate");
    }
  }

  std::uint32_t read_id(Scalar type) {
    const std::int64_t id = reader_.integer(type, "a point of a cell");
    if (id < 0 || static_cast<std::uint64_t>(id) >= mesh_.positions.size()) {
      reader_.fail_here("point " + std::to_string(id) + " of a cell is out of range; the file has " +
                        std::to_string(mesh_.positions.size()) + " points before it, counted from 0");
    }
    return static_cast<std::uint32_t>(id);
  }

  // Before version 5, each list begins with its length. Since then, all offsets come first.
  Lists read_lists() {
    const std::uint64_t first = text_count("a number of cells");
    const std::uint64_t second = text_count("a number of points of cells");
    begin_numbers();
    if (reader_.encoding() == Encoding::text) reader_.text.skip_to_word();
    return reader_.text.accept("OFFSETS") ? read_lists_by_offsets(first, second)
                                          : read_lists_by_lengths(first);
  }

  Lists read_lists_by_lengths(std::uint64_t count) {
    reader_.expect(count, 1, Scalar::int32, "cells");
    Lists lists;
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::uint64_t length = reader_.count(Scalar::int32, "the number of points of a cell");
      reader_.expect(length, 1, Scalar::int32, "points of a cell");
      for (std::uint64_t k = 0; k < length; ++k) lists.ids.push_back(read_id(Scalar::int32));
      lists.ends.push_back(lists.ids.size());
    }
    return lists;
  }

  Lists read_lists_by_offsets(std::uint64_t offsets, std::uint64_t ids) {
    const Scalar offset_type = text_type();
    begin_numbers();
    reader_.expect(offsets, 1, offset_type, "offsets");
    Lists lists;
    for (std::uint64_t i = 0, previous = 0; i < offsets; ++i) {
      const std::uint64_t offset = reader_.count(offset_type, "an offset");
      if (offset < previous || offset > ids || (i == 0 && offset != 0))
        reader_.fail_here("offset " + std::to_string(offset) +
                          " is out of range; the offsets go up from 0 to at most " + std::to_string(ids));
      if (i > 0) lists.ends.push_back(offset);
      previous = offset;
    }
    reader_.text.skip_to_word();
    if (!reader_.text.accept("CONNECTIVITY"))
      reader_.text.fail_expected("'CONNECTIVITY'", reader_.text.word());
    const Scalar id_type = text_type();
    begin_numbers();
    reader_.expect(ids, 1, id_type, "points of cells");
    for (std::uint64_t i = 0; i < ids; ++i) lists.ids.push_back(read_id(id_type));
    return lists;
  }

  void read_cells() {
    const std::uint64_t count = text_count("the number of types");
    if (count != cells_.ends.size()) {
      reader_.text.fail_here("there are types of " + std::to_string(count) + " cells, but " +
                             std::to_string(cells_.ends.size()) + " cells before them");
    }
    begin_numbers();
    for (std::size_t i = 0; i < count; ++i) {
      const std::int64_t type = reader_.integer(Scalar::int32, "the type of a cell");
      const std::optional<VtkCellShape> shape = vtk_shape_of(type);
      if (!shape) {
        reader_.fail_here("cell " + std::to_string(i) + unsupported_vtk_cell(type));
      }
      add_cell(cells_[i], *shape, i);
    }
    cells_ = {};
  }

  void add(const Lists& lists, const VtkCellShape& shape) {
    for (std::size_t i = 0; i < lists.ends.size(); ++i) add_cell(lists[i], shape, i);
  }

  void add_cell(std::span<const std::uint32_t> ids, const VtkCellShape& shape, std::size_t number) {
    if (ids.size() < shape.corner_count) {
      reader_.fail_here("cell " + std::to_string(number) + " has " + std::to_string(ids.size()) +
                        " points; its type needs " + std::to_string(shape.corner_count));
    }
    add_vtk_cell(mesh_, ids, shape);
  }

  // Ends with an empty line.
  void skip_metadata() {
    reader_.text.skip_line();
    while (!reader_.text.at_line_end()) reader_.text.skip_line();
  }

  // Named arrays, such as the time of a simulation.
  void skip_field() {
    reader_.text.word();
    for (std::uint64_t arrays = text_count("the number of arrays"); arrays > 0; --arrays) {
      if (!reader_.text.skip_to_word()) reader_.text.fail_here("the file ends within its field data");
      const std::string name = lower_case_word();
      if (name == "metadata") {
        skip_metadata();
        ++arrays;
        continue;
      }
      const std::uint64_t components = text_count("the number of components");
      const std::uint64_t tuples = text_count("the number of tuples");
      reader_.expect(tuples, components, Scalar::int8, "values of field data");
      if (reader_.text.at_line_end()) reader_.text.fail_expected("a type of numbers", {});
      const std::string type_name = lower_case_word();
      if (type_name == "string") {
        skip_strings(components * tuples);
      } else {
        skip_numbers(type_name, components * tuples);
      }
    }
  }

  void skip_numbers(std::string_view type_name, std::uint64_t count) {
    for (const TypeName& known : type_names) {
      if (known.name != type_name) continue;
      begin_numbers();
      return reader_.skip(known.type, count, "a value of field data");
    }
    reader_.text.fail_here("unknown type of numbers " + in_quotes(type_name));
  }

  // In text, each string has a line. In binary, two bits say how many bytes its length has.
  void skip_strings(std::uint64_t count) {
    reader_.text.skip_line();
    for (std::uint64_t i = 0; i < count; ++i) {
      if (reader_.encoding() == Encoding::text) {
        reader_.text.skip_line();
        continue;
      }
      std::uint64_t length = reader_.count(Scalar::uint8, "a length");
      const std::size_t more = (std::size_t{1} << (3 - (length >> 6))) - 1;
      length &= 63;
      for (std::size_t k = 0; k < more; ++k) length = length << 8 | reader_.count(Scalar::uint8, "a length");
      reader_.skip(Scalar::uint8, length, "a string");
    }
  }

  std::string file_;
  ScalarReader reader_;
  Lists cells_;
  ElementMesh mesh_;
};

}  // namespace

TriangleMesh read_vtk(std::string_view bytes, const std::string& file) {
  return VtkReader(bytes, file).read();
}

}  // namespace supple
