// VTK's XML files (https://docs.vtk.org/en/latest/vtk_file_formats/vtkxml_file_format.html) of polygons and
// unstructured grids. Arrays are text, base64, or bytes after the XML, which may be compressed.

#include <zlib.h>

#include <bit>
#include <vector>

#include "base64.hpp"
#include "core/error.hpp"
#include "core/quotes.hpp"
#include "elements/element_mesh.hpp"
#include "elements/scalar_reader.hpp"
#include "elements/vtk_cells.hpp"
#include "files/byte_order.hpp"
#include "files/number_text.hpp"
#include "readers.hpp"
#include "xml_nodes.hpp"

namespace supple {
namespace {

/// Bytes as they are, or in base64. Blocks of base64 may follow each other, each with its own padding.
class ByteSource {
 public:
  ByteSource(std::string_view text, bool is_base64) : text_(text), is_base64_(is_base64) {}

  /// At most so many bytes are left.
  std::size_t left() const { return text_.size() - place_ + 2; }

  /// Returns fewer bytes than the argument says where there are no more.
  std::string take(std::size_t count) {
    std::string bytes;
    if (!is_base64_) {
      bytes = text_.substr(place_, count);
      place_ += bytes.size();
      return bytes;
    }
    while (bytes.size() < count && place_ < text_.size()) {
      const char c = text_[place_++];
      const int digit = base64_digit(c);
      if (c == '=') bits_ = 0;
      if (digit < 0) continue;  // padding and line ends
      group_ = (group_ << 6 | static_cast<unsigned>(digit)) & 0xffffff;
      bits_ += 6;
      if (bits_ < 8) continue;
      bits_ -= 8;
      bytes += static_cast<char>(group_ >> bits_ & 0xff);
    }
    return bytes;
  }

 private:
  std::string_view text_;
  bool is_base64_;
  std::size_t place_ = 0;
  unsigned group_ = 0;
  int bits_ = 0;
};

class VtkXmlReader {
 public:
  VtkXmlReader(std::string_view bytes, const std::string& file)
      : file_(file), budget_((std::uint64_t{16} << 20) + 200 * std::uint64_t{bytes.size()}) {
    // Bytes after the XML may be any, also those that end an element.
    std::string text(bytes);
    if (const std::size_t tag = bytes.find("<AppendedData"); tag != std::string_view::npos) {
      const std::size_t end = bytes.find('>', tag), mark = bytes.find('_', end);
      if (end == std::string_view::npos || mark == std::string_view::npos)
        fail(file_ + ": the file ends before its appended data");
      appended_ = bytes.substr(mark + 1);
      text = std::string(bytes.substr(0, end + 1)) + "</AppendedData></VTKFile>";
    }
    const pugi::xml_parse_result result =
        document_.load_buffer(text.data(), text.size(), pugi::parse_escapes);
    if (!result)
      fail(file_ + ", byte " + std::to_string(result.offset) + ": " + one_line(result.description()));
  }

  TriangleMesh read() {
    const pugi::xml_node root = child(document_, "VTKFile");
    if (!root) fail(file_ + ": this is no XML of VTK: it has no element 'VTKFile'");
    order_ = attribute(root, "byte_order") == "BigEndian" ? std::endian::big : std::endian::little;
    has_wide_header_ = attribute(root, "header_type") == "UInt64";
    compressor_ = attribute(root, "compressor");
    const std::string encoding = attribute(child(root, "AppendedData"), "encoding");
    appended_is_base64_ = encoding == "base64";
    const std::string kind = attribute(root, "type");
    if (kind != "UnstructuredGrid" && kind != "PolyData")
      fail(file_ + ": a data set of type " + in_quotes(kind) +
           " has no surface here; save its surface as .vtp (in ParaView: Extract Surface)");
    for (const pugi::xml_node& piece : child(root, kind).children()) {
      if (name_of(piece) != "Piece") continue;
      first_ = mesh_.positions.size();
      read_points(piece);
      if (kind == "UnstructuredGrid") {
        read_cells(piece);
      } else {
        read_lists(child(piece, "Polys"), {VtkCellShape::polygon});
        read_lists(child(piece, "Strips"), {VtkCellShape::strip, 3});
      }
    }
    return mesh_.take_surface(file_);
  }

 private:
  /// `node` is a DataArray.
  [[noreturn]] void fail_at(const pugi::xml_node& node, const std::string& message) const {
    fail(file_ + ", array " + in_quotes(attribute(node, "Name")) + ": " + message);
  }

  std::uint64_t header_number(ByteSource& source, const pugi::xml_node& node) const {
    const std::string bytes = source.take(has_wide_header_ ? 8 : 4);
    if (bytes.size() < (has_wide_header_ ? 8u : 4u)) fail_at(node, "the file ends within its header");
    return has_wide_header_ ? load_scalar<std::uint64_t>(bytes.data(), order_)
                            : load_scalar<std::uint32_t>(bytes.data(), order_);
  }

  std::string take(ByteSource& source, std::uint64_t count, const pugi::xml_node& node) const {
    if (count > source.left()) fail_at(node, "announces more bytes than the file has");
    std::string bytes = source.take(count);
    if (bytes.size() < count) fail_at(node, "the file ends within it");
    return bytes;
  }

  std::string read_bytes(const pugi::xml_node& node, bool is_appended) {
    std::string_view text = node.child_value();
    if (is_appended) {
      const std::string offset = attribute(node, "offset");
      std::int64_t place = -1;
      parse_integer(offset.data(), offset.data() + offset.size(), place);
      if (place < 0 || static_cast<std::uint64_t>(place) > appended_.size())
        fail_at(node, "its offset " + in_quotes(offset) + " is outside of the appended data");
      text = appended_.substr(static_cast<std::size_t>(place));
    }
    ByteSource source(text, !is_appended || appended_is_base64_);
    if (compressor_.empty()) {
      const std::uint64_t count = header_number(source, node);
      return take(source, count, node);
    }
    if (compressor_ != "vtkZLibDataCompressor")
      fail_at(node, "its data are compressed by " + in_quotes(compressor_) +
                        ", which is not supported; save it with the compressor ZLib or without one");
    const std::uint64_t blocks = header_number(source, node), block_size = header_number(source, node),
                        last_size = header_number(source, node);
    if (blocks > source.left()) fail_at(node, "announces more blocks than the file has");
    std::vector<std::uint64_t> sizes;
    for (std::uint64_t i = 0; i < blocks; ++i) sizes.push_back(header_number(source, node));
    std::string bytes;
    for (std::uint64_t i = 0; i < blocks; ++i) {
      const std::uint64_t size = i + 1 == blocks && last_size != 0 ? last_size : block_size;
      if (size > budget_)
        fail_at(node, "the file expands to more than 16 MiB and 200 times its size; compress it less");
      budget_ -= size;
      const std::string packed = take(source, sizes[i], node);
      const std::size_t begin = bytes.size();
      bytes.resize(begin + size);
      uLongf length = size;
      if (uncompress(reinterpret_cast<Bytef*>(bytes.data() + begin), &length,
                     reinterpret_cast<const Bytef*>(packed.data()), packed.size()) != Z_OK ||
          length != size)
        fail_at(node, "its compressed data are damaged");
    }
    return bytes;
  }

  struct TypeName {
    std::string_view name;
    Scalar type;
  };
  Scalar type_of(const pugi::xml_node& node) const {
    constexpr TypeName names[] = {{"Int8", Scalar::int8},       {"UInt8", Scalar::uint8},
                                  {"Int16", Scalar::int16},     {"UInt16", Scalar::uint16},
                                  {"Int32", Scalar::int32},     {"UInt32", Scalar::uint32},
                                  {"Int64", Scalar::int64},     {"UInt64", Scalar::uint64},
                                  {"Float32", Scalar::float32}, {"Float64", Scalar::float64}};
    const std::string given = attribute(node, "type");
    for (const TypeName& known : names) {
      if (known.name == given) return known.type;
    }
    fail_at(node, "unknown type of numbers " + in_quotes(given));
  }

  /// The numbers of a DataArray: doubles, or integers.
  template <class Number>
  std::vector<Number> read_array(const pugi::xml_node& node) {
    std::vector<Number> numbers;
    const std::string format = attribute(node, "format");
    if (format == "ascii" || format.empty()) {
      const std::string_view text = node.child_value();
      const char* place = text.data();
      const char* const end = place + text.size();
      const auto skip_blanks = [&] {
        while (place != end && static_cast<unsigned char>(*place) <= ' ') ++place;
      };
      for (skip_blanks(); place != end; skip_blanks()) {
        const char* next = nullptr;
        if constexpr (std::is_same_v<Number, double>)
          next = parse_double(place, end, numbers.emplace_back());
        else
          next = parse_integer(place, end, numbers.emplace_back());
        if (next == nullptr || (next != end && static_cast<unsigned char>(*next) > ' '))
          fail_at(node, "expected a number, found " + in_quotes(std::string_view(place, end).substr(0, 20)));
        place = next;
      }
      return numbers;
    }
    if (format != "binary" && format != "appended") fail_at(node, "unknown format " + in_quotes(format));
    const Scalar type = type_of(node);
    if (std::is_same_v<Number, std::int64_t> && !is_integer(type)) fail_at(node, "must have an integer type");
    const std::string bytes = read_bytes(node, format == "appended");
    ScalarReader reader(bytes, file_, {});
    reader.set_binary(order_ == std::endian::big ? Encoding::big_endian : Encoding::little_endian);
    if (bytes.size() % size_of(type) != 0) fail_at(node, "ends within a number");
    numbers.reserve(bytes.size() / size_of(type));
    for (std::size_t i = 0; i < bytes.size() / size_of(type); ++i) {
      if constexpr (std::is_same_v<Number, double>)
        numbers.push_back(reader.number(type, "a number"));
      else
        numbers.push_back(reader.integer(type, "a number"));
    }
    return numbers;
  }

  static pugi::xml_node array_in(const pugi::xml_node& node, std::string_view name) {
    for (const pugi::xml_node& candidate : node.children()) {
      if (name_of(candidate) == "DataArray" && (name.empty() || attribute(candidate, "Name") == name))
        return candidate;
    }
    return {};
  }

  std::vector<std::int64_t> integers_in(const pugi::xml_node& node, std::string_view name) {
    const pugi::xml_node array = array_in(node, name);
    if (!array) fail(file_ + ": " + std::string(node.name()) + " has no array " + in_quotes(name));
    return read_array<std::int64_t>(array);
  }

  void read_points(const pugi::xml_node& piece) {
    const pugi::xml_node array = array_in(child(piece, "Points"), {});
    if (!array) return;
    const std::vector<double> numbers = read_array<double>(array);
    const std::string announced = attribute(piece, "NumberOfPoints");
    if (numbers.size() % 3 != 0 || (!announced.empty() && announced != std::to_string(numbers.size() / 3)))
      fail_at(array, "has " + std::to_string(numbers.size()) + " coordinates for " + announced + " points");
    for (std::size_t i = 0; i < numbers.size(); i += 3)
      mesh_.positions.push_back({numbers[i], numbers[i + 1], numbers[i + 2]});
  }

  /// Calls `visit(number, ids)` for each list of points.
  template <class Visit>
  void for_each_list(const pugi::xml_node& node, Visit visit) {
    const std::vector<std::int64_t> ids = integers_in(node, "connectivity"),
                                    ends = integers_in(node, "offsets");
    const std::size_t points = mesh_.positions.size() - first_;
    std::vector<std::uint32_t> list;
    std::size_t begin = 0;
    for (std::size_t i = 0; i < ends.size(); ++i) {
      const auto end = static_cast<std::uint64_t>(ends[i]);
      if (end < begin || end > ids.size())
        fail(file_ + ": offset " + std::to_string(ends[i]) + " of cell " + std::to_string(i) +
             " is out of range; the offsets go up to at most " + std::to_string(ids.size()));
      list.clear();
      for (; begin < end; ++begin) {
        if (ids[begin] < 0 || static_cast<std::uint64_t>(ids[begin]) >= points)
          fail(file_ + ": point " + std::to_string(ids[begin]) + " of cell " + std::to_string(i) +
               " is out of range; the piece has " + std::to_string(points) + " points, counted from 0");
        list.push_back(static_cast<std::uint32_t>(first_ + static_cast<std::uint64_t>(ids[begin])));
      }
      visit(i, list);
    }
  }

  void add_cell(std::size_t number, const std::vector<std::uint32_t>& ids, const VtkCellShape& shape) {
    if (ids.size() < shape.corner_count)
      fail(file_ + ": cell " + std::to_string(number) + " has " + std::to_string(ids.size()) +
           " points; its type needs " + std::to_string(shape.corner_count));
    add_vtk_cell(mesh_, ids, shape);
  }

  void read_lists(const pugi::xml_node& node, const VtkCellShape& shape) {
    if (!array_in(node, {})) return;
    for_each_list(node, [&](std::size_t i, const auto& ids) { add_cell(i, ids, shape); });
  }

  void read_cells(const pugi::xml_node& piece) {
    const pugi::xml_node cells = child(piece, "Cells");
    if (!array_in(cells, {})) return;
    const std::vector<std::int64_t> types = integers_in(cells, "types");
    std::size_t count = 0;
    for_each_list(cells, [&](std::size_t i, const auto& ids) {
      if (i >= types.size()) fail(file_ + ": cell " + std::to_string(i) + " has no type");
      const std::optional<VtkCellShape> shape = vtk_shape_of(types[i]);
      if (!shape) fail(file_ + ": cell " + std::to_string(i) + unsupported_vtk_cell(types[i]));
      add_cell(i, ids, *shape);
      ++count;
    });
    if (count != types.size())
      fail(file_ + ": there are types of " + std::to_string(types.size()) + " cells, but " +
           std::to_string(count) + " cells");
  }

  std::string file_;
  std::uint64_t budget_;  // bytes that compressed data may still expand to
  pugi::xml_document document_;
  std::string_view appended_;
  std::endian order_ = std::endian::little;
  bool has_wide_header_ = false, appended_is_base64_ = false;
  std::string compressor_;
  std::size_t first_ = 0;  // vertex of the piece
  ElementMesh mesh_;
};

}  // namespace

TriangleMesh read_vtk_xml(std::string_view bytes, const std::string& file) {
  return VtkXmlReader(bytes, file).read();
}

}  // namespace supple
