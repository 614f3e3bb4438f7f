#include "assimp/collada_text.hpp"

#include <map>
#include <sstream>
#include <vector>

#include "core/error.hpp"
#include "core/quotes.hpp"
#include "xml_nodes.hpp"
#include "zip_reader.hpp"

namespace supple {
namespace {

struct Walker : pugi::xml_tree_walker {
  bool for_each(pugi::xml_node& node) override {
    const std::string_view name = name_of(node);
    if (name.ends_with("_array")) arrays.try_emplace(attribute(node, "id"), node);
    if (name == "accessor") accessors.push_back(node);
    return true;
  }

  std::map<std::string, pugi::xml_node> arrays;
  std::vector<pugi::xml_node> accessors;
};

std::uint64_t whole_or(const pugi::xml_node& node, const char* name, std::uint64_t absent) {
  const pugi::xml_attribute given = node.attribute(name);
  return given ? given.as_ullong() : absent;
}

/// How many values of an array an element of the accessor has.
std::uint64_t width_of(const pugi::xml_node& accessor, std::uint64_t stride) {
  std::uint64_t width = 0;
  for (const pugi::xml_node& param : accessor.children()) {
    if (name_of(param) != "param") continue;
    const std::string type = attribute(param, "type");
    width += type == "float4x4" ? 16 : type == "float3x3" ? 9 : 1;
  }
  return width == 0 ? stride : width;
}

/// Parses any encoding of XML.
void parse(std::string_view bytes, const std::string& file, pugi::xml_document& document) {
  constexpr unsigned options = pugi::parse_default | pugi::parse_trim_pcdata;
  const pugi::xml_parse_result result = document.load_buffer(bytes.data(), bytes.size(), options);
  if (!result) fail(file + ", byte " + std::to_string(result.offset) + ": " + one_line(result.description()));
}

std::string text_of(const pugi::xml_document& document) {
  std::ostringstream text;
  document.save(text, "", pugi::format_raw, pugi::encoding_utf8);
  return text.str();
}

}  // namespace

std::string xml_in_utf8(std::string_view bytes, const std::string& file) {
  pugi::xml_document document;
  parse(bytes, file, document);
  return text_of(document);
}

std::string collada_text(std::string_view bytes, const std::string& file) {
  std::string unpacked;
  if (bytes.starts_with("PK\x03\x04")) {
    ZipReader archive(bytes, file);
    unpacked = archive.read(archive.name_ending_with(".dae"));
    bytes = unpacked;
  }
  pugi::xml_document document;
  parse(bytes, file, document);
  Walker walker;
  document.traverse(walker);
  for (const pugi::xml_node& accessor : walker.accessors) {
    const std::string source = attribute(accessor, "source");
    const auto array = walker.arrays.find(source.empty() ? source : source.substr(1));
    const std::uint64_t count = whole_or(accessor, "count", 0), stride = whole_or(accessor, "stride", 1);
    if (array == walker.arrays.end() || count == 0) continue;
    const std::uint64_t offset = whole_or(accessor, "offset", 0), width = width_of(accessor, stride);
    const std::uint64_t available = whole_or(array->second, "count", 0);
    if (offset > available || width > available - offset ||
        (count > 1 && stride > (available - offset - width) / (count - 1))) {
      fail(file + ": array " + in_quotes(array->first) + " has a count of " + std::to_string(available) +
           ", fewer than the " + std::to_string(count) + " elements of its accessor need (stride " +
           std::to_string(stride) + "); export the file again");
    }
  }
  return text_of(document);
}

}  // namespace supple
