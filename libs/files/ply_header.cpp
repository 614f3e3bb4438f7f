#include "files/ply_header.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "core/quotes.hpp"

namespace supple::ply {
namespace {

constexpr std::pair<std::string_view, ScalarType> scalar_type_names[] = {
    {"char", ScalarType::int8},      {"int8", ScalarType::int8},       {"uchar", ScalarType::uint8},
    {"uint8", ScalarType::uint8},    {"short", ScalarType::int16},     {"int16", ScalarType::int16},
    {"ushort", ScalarType::uint16},  {"uint16", ScalarType::uint16},   {"int", ScalarType::int32},
    {"int32", ScalarType::int32},    {"uint", ScalarType::uint32},     {"uint32", ScalarType::uint32},
    {"float", ScalarType::float32},  {"float32", ScalarType::float32}, {"double", ScalarType::float64},
    {"float64", ScalarType::float64}};

class HeaderReader {
 public:
  explicit HeaderReader(TextScanner& scanner) : scanner_(scanner) {}

  Header read() {
    if (scanner_.word() != "ply") scanner_.fail_here("not a PLY file: it does not start with 'ply'");
    scanner_.skip_line();
    for (bool format_seen = false;; scanner_.skip_line()) {
      if (!scanner_.skip_to_word()) scanner_.fail_here("the file ends within the header");
      const std::string_view keyword = scanner_.word();
      if (keyword == "format") {
        read_format();
        format_seen = true;
      } else if (keyword == "element") {
        read_element();
      } else if (keyword == "property") {
        read_property();
      } else if (keyword == "end_header") {
        if (!format_seen) scanner_.fail_here("the header has no 'format' line");
        break;
      } else if (keyword != "comment" && keyword != "obj_info") {
        scanner_.fail_here("unknown keyword " + in_quotes(keyword) + " in the header");
      }
    }
    scanner_.skip_line();
    return std::move(header_);
  }

 private:
  void read_format() {
    const std::string_view name = scanner_.word();
    // In the order of `Encoding`.
    constexpr std::array<std::string_view, 3> names{"ascii", "binary_little_endian", "binary_big_endian"};
    const auto found = std::ranges::find(names, name);
    if (found == names.end()) {
      scanner_.fail_here("unknown format " + in_quotes(name) +
                         "; it may be ascii, binary_little_endian or binary_big_endian");
    }
    header_.encoding = static_cast<Encoding>(found - names.begin());
    if (const std::string_view version = scanner_.word(); version != "1.0") {
      scanner_.fail_here("unknown version " + in_quotes(version) + " of PLY; it may be 1.0");
    }
  }

  void read_element() {
    const std::string name(scanner_.word());
    const std::int64_t count = scanner_.integer("the number of elements");
    if (count < 0)
      scanner_.fail_here("element " + in_quotes(name) + " has the count " + std::to_string(count));
    for (const Element& other : header_.elements) {
      if (other.name == name) scanner_.fail_here("element " + in_quotes(name) + " is there twice");
    }
    header_.elements.push_back({name, static_cast<std::uint64_t>(count), {}});
  }

  void read_property() {
    if (header_.elements.empty()) scanner_.fail_here("a property comes before any element");
    Property property;
    std::string_view type = scanner_.word();
    if (type == "list") {
      property.count_type = scalar_type(scanner_.word());
      type = scanner_.word();
    }
    property.type = scalar_type(type);
    property.name = scanner_.word();
    if (property.name.empty()) scanner_.fail_expected("the name of a property", {});
    Element& element = header_.elements.back();
    for (const Property& other : element.properties) {
      if (other.name == property.name) {
        scanner_.fail_here("property " + in_quotes(property.name) + " of element " + in_quotes(element.name) +
                           " is there twice");
      }
    }
    if (property.count_type && !is_integer(*property.count_type)) {
      scanner_.fail_here("the count of list " + in_quotes(property.name) + " must be of an integer type");
    }
    if (is_vertex_list(property) && !is_integer(property.type)) {
      scanner_.fail_here("list " + in_quotes(property.name) + " must be of an integer type");
    }
    element.properties.push_back(std::move(property));
  }

  ScalarType scalar_type(std::string_view name) {
    for (const auto& [known, type] : scalar_type_names) {
      if (known == name) return type;
    }
    scanner_.fail_here("unknown type " + in_quotes(name) + " of a property");
  }

  TextScanner& scanner_;
  Header header_;
};

}  // namespace

Header read_header(TextScanner& scanner) {
  return HeaderReader(scanner).read();
}

}  // namespace supple::ply
