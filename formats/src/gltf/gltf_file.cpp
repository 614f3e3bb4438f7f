#include "gltf/gltf_file.hpp"

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <utility>

#include "base64.hpp"
#include "core/error.hpp"
#include "core/quotes.hpp"
#include "files/byte_order.hpp"
#include "files/file_access.hpp"
#include "supple/utf8.hpp"

namespace supple {
namespace {

constexpr std::string_view magic = "glTF";

/// Extensions that a file may require: those that this reader applies, and those that change no shape.
bool is_known(std::string_view extension) {
  constexpr std::array applied = {"KHR_mesh_quantization", "KHR_draco_mesh_compression",
                                  "EXT_meshopt_compression", "EXT_mesh_gpu_instancing",
                                  "KHR_animation_pointer"};
  constexpr std::array without_shape = {"KHR_materials_", "KHR_technique", "KHR_texture_",
                                        "EXT_texture_",   "MSFT_texture_", "MSFT_packing_",
                                        "KHR_lights_",    "KHR_xmp",       "EXT_lights_"};
  return std::find(applied.begin(), applied.end(), extension) != applied.end() ||
         std::any_of(without_shape.begin(), without_shape.end(),
                     [&](std::string_view start) { return extension.starts_with(start); });
}

/// Nothing when the text has another character.
std::optional<std::string> from_base64(std::string_view text) {
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3 + 3);
  unsigned group = 0;
  int bits = 0;
  for (const char c : text) {
    const int digit = base64_digit(c);
    if (digit < 0) return std::nullopt;
    group = (group << 6 | static_cast<unsigned>(digit)) & 0xffffff;
    bits += 6;
    if (bits >= 8) {
      bits -= 8;
      bytes += static_cast<char>(group >> bits & 0xff);
    }
  }
  return bytes;
}

int hex_digit(char c) {
  return c >= '0' && c <= '9'   ? c - '0'
         : c >= 'a' && c <= 'f' ? c - 'a' + 10
         : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                : -1;
}

/// `my%20mesh.bin` is `my mesh.bin`.
std::string without_percent_codes(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const int high = text[i] == '%' && i + 2 < text.size() ? hex_digit(text[i + 1]) : -1;
    const int low = high >= 0 ? hex_digit(text[i + 2]) : -1;
    if (low >= 0) {
      result += static_cast<char>(16 * high + low);
      i += 2;
    } else {
      result += text[i];
    }
  }
  return result;
}

/// The JSON of a file; names in it may be any bytes.
std::shared_ptr<const nlohmann::json> parse_json(std::string_view text, const std::string& file) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  try {
    return std::make_shared<nlohmann::json>(nlohmann::json::parse(valid_utf8(text)));
  } catch (const nlohmann::json::exception& error) {
    // "[json.exception.parse_error.101] parse error at line 1, column 2: …; last read: …"
    std::string_view reason = error.what();
    reason.remove_prefix(std::min(reason.find("] ") + 2, reason.size()));
    fail("cannot read " + file +
         ": the JSON is not valid: " + one_line(reason.substr(0, reason.find("; last read"))));
  }
}

}  // namespace

GltfFile::GltfFile(const std::filesystem::path& path) : path_(path), name_(shown(path)) {
  const std::string content = read_file(path);
  std::string json = content;
  if (content.starts_with(magic)) {
    json.clear();
    const auto number = [&](std::size_t place) {
      return load_scalar<std::uint32_t>(content.data() + place, std::endian::little);
    };
    if (content.size() < 12) fail(name_ + ": the file ends within its header");
    if (number(4) != 2)
      fail(name_ + ": has version " + in_quotes(std::to_string(number(4)) + ".0") +
           " of glTF; export it as glTF 2.0");
    for (std::size_t place = 12; place + 8 <= content.size();) {
      const std::uint64_t length = number(place);
      const std::string_view kind(content.data() + place + 4, 4);
      if (length > content.size() - place - 8)
        fail(name_ + ": the file ends within a chunk of " + std::to_string(length) +
             " bytes; was it copied completely?");
      const std::string_view chunk(content.data() + place + 8, length);
      if (kind == "JSON" && json.empty()) json = chunk;
      if (kind == std::string_view("BIN\0", 4) && binary_.empty()) binary_ = chunk;
      // A chunk is filled up to a multiple of four bytes, which some programs forget.
      const std::size_t end = place + 8 + length, padded = end + (4 - length % 4) % 4;
      const auto begins_binary = [&](std::size_t at) {
        return at + 8 <= content.size() &&
               std::string_view(content).substr(at + 4, 4) == std::string_view("BIN\0", 4);
      };
      place = begins_binary(end) && !begins_binary(padded) ? end : padded;
    }
  }
  document_ = parse_json(json, name_);
  check_version();
  check_extensions();
  buffers_.resize(root()["buffers"].size());
  views_.resize(root()["bufferViews"].size());
  for (std::uint64_t i = 0; i < buffers_.size(); ++i) {
    // A fallback has no bytes of its own.
    const GltfValue value = root()["buffers"].at(i);
    if (value["uri"] || (i == 0 && !binary_.empty())) bytes_ += buffer(i).size();
  }
}

void GltfFile::check_version() const {
  // Version 1.0 has objects instead of arrays, and its number may be a number.
  const auto is_object = [&](const char* key) {
    const auto found = document_->is_object() ? document_->find(key) : document_->end();
    return found != document_->end() && found->is_object();
  };
  std::string version;
  if (is_object("asset")) {
    const auto given = (*document_)["asset"].find("version");
    if (given != (*document_)["asset"].end())
      version = given->is_string() ? given->get<std::string>() : given->dump();
  }
  if (version.empty() && (is_object("meshes") || is_object("accessors") || is_object("nodes")))
    version = "1.0";
  if (!version.starts_with("2."))
    fail(name_ + ": has " +
         (version.empty() ? "no asset.version" : "version " + in_quotes(version) + " of glTF") +
         "; export it as glTF 2.0");
}

void GltfFile::check_extensions() const {
  const GltfValue required = root()["extensionsRequired"];
  for (std::uint64_t i = 0; i < required.size(); ++i) {
    const std::string extension = required.at(i).text();
    if (!is_known(extension))
      fail(name_ + ": requires the extension " + in_quotes(extension) +
           ", which is not supported; export the file without it");
  }
}

std::string GltfFile::read_uri(const GltfValue& uri) const {
  const std::string text = uri.text();
  if (text.starts_with("data:")) {
    const std::size_t comma = text.find(',');
    std::optional<std::string> bytes;
    if (comma != std::string::npos && std::string_view(text).substr(0, comma).ends_with(";base64"))
      bytes = from_base64(std::string_view(text).substr(comma + 1));
    if (!bytes) uri.fail_here("expected data in base64, data:...;base64,...");
    return *std::move(bytes);
  }
  if (text.find("://") != std::string::npos)
    uri.fail_here("is an address on the network, " + in_quotes(text) + "; download it next to the file");
  return read_file(path_.parent_path() / without_percent_codes(text));
}

std::string_view GltfFile::buffer(std::uint64_t index) {
  const GltfValue value = root()["buffers"].at(index);
  std::optional<std::string>& bytes = buffers_[index];
  if (!bytes) {
    if (value["uri"])
      bytes = read_uri(value["uri"]);
    else if (index == 0 && !binary_.empty())
      bytes = std::move(binary_);
    else
      value.fail_here("has no \"uri\", and the file has no binary part for it");
  }
  const std::uint64_t length = value["byteLength"].whole();
  if (length > bytes->size())
    value.fail_here("announces " + std::to_string(length) + " bytes, but has " +
                    std::to_string(bytes->size()) + "; was it copied completely?");
  return std::string_view(*bytes).substr(0, length);
}

/// The bytes that `buffer`, `byteOffset` and `byteLength` describe.
std::string_view GltfFile::bytes_in(const GltfValue& place) {
  const std::string_view bytes = buffer(place["buffer"].index(buffers_.size(), "buffer"));
  const std::uint64_t offset = place["byteOffset"].whole_or(0), length = place["byteLength"].whole();
  if (offset > bytes.size() || length > bytes.size() - offset)
    place.fail_here("goes past the end of its buffer of " + std::to_string(bytes.size()) + " bytes");
  return bytes.substr(offset, length);
}

std::string_view GltfFile::view(std::uint64_t index) {
  const GltfValue value = root()["bufferViews"].at(index);
  const GltfValue compression = value["extensions"]["EXT_meshopt_compression"];
  if (!compression) return bytes_in(value);
  std::optional<std::string>& bytes = views_[index];
  if (!bytes) bytes = decompressed(value, compression);
  return *bytes;
}

std::string GltfFile::decompressed(const GltfValue& view, const GltfValue& extension) {
  const std::string_view from = bytes_in(extension);
  const auto* data = reinterpret_cast<const unsigned char*>(from.data());
  const std::uint64_t count = extension["count"].whole(), stride = extension["byteStride"].whole();
  const std::string mode = extension["mode"].text(), filter = extension["filter"].text_or("NONE");
  const bool is_attributes = mode == "ATTRIBUTES";
  if (is_attributes ? stride % 4 != 0 || stride < 4 || stride > 256 : stride != 2 && stride != 4)
    extension["byteStride"].fail_here(std::to_string(stride) + " is not allowed with this mode");
  // 256 is more than any of the codes can compress.
  if (count > 256 * (from.size() + 1) || (mode == "TRIANGLES" && count % 3 != 0))
    extension["count"].fail_here("is not possible for " + std::to_string(from.size()) + " compressed bytes");
  std::string bytes(count * stride, '\0');
  int status = -1;
  if (is_attributes)
    status = meshopt_decodeVertexBuffer(bytes.data(), count, stride, data, from.size());
  else if (mode == "TRIANGLES")
    status = meshopt_decodeIndexBuffer(bytes.data(), count, stride, data, from.size());
  else if (mode == "INDICES")
    status = meshopt_decodeIndexSequence(bytes.data(), count, stride, data, from.size());
  else
    extension["mode"].fail_here(in_quotes(mode) + " is not one of ATTRIBUTES, TRIANGLES and INDICES");
  if (status != 0) view.fail_here("the data of EXT_meshopt_compression are damaged; export the file again");
  // The filters work in place, on whole groups of numbers.
  if (filter == "OCTAHEDRAL" && (stride == 4 || stride == 8))
    meshopt_decodeFilterOct(bytes.data(), count, stride);
  else if (filter == "QUATERNION" && stride == 8)
    meshopt_decodeFilterQuat(bytes.data(), count, stride);
  else if (filter == "EXPONENTIAL" && is_attributes)
    meshopt_decodeFilterExp(bytes.data(), count, stride);
  else if (filter != "NONE")
    extension["filter"].fail_here(in_quotes(filter) + " is not allowed here");
  return bytes;
}

}  // namespace supple
