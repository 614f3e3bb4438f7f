#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "files/byte_order.hpp"

namespace supple {

inline std::string base64(const std::string& bytes) {
  static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += i + k <= bytes.size() ? digits[group >> (18 - 6 * k) & 63] : '=';
    }
  }
  return text;
}

/// Makes a glTF file with one scene, whose root is node 0. Tests fill `json`.
class GltfBuilder {
 public:
  nlohmann::json json = {{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", {0}}}}}};

  /// Adds an accessor with numbers of any scalar type and returns its index.
  template <class Scalar>
  int add(const std::string& type, const std::vector<Scalar>& numbers, bool is_normalized = false) {
    const std::size_t width = type == "SCALAR" ? 1 : type == "VEC3" ? 3 : type == "VEC4" ? 4 : 16;
    json["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", numbers.size() * sizeof(Scalar)}});
    for (const Scalar number : numbers) append_scalar(bytes_, number);
    while (bytes_.size() % 4 != 0) bytes_ += '\0';
    nlohmann::json accessor = {{"bufferView", json["bufferViews"].size() - 1},
                               {"componentType", kind(Scalar{})},
                               {"count", numbers.size() / width},
                               {"type", type}};
    if (is_normalized) accessor["normalized"] = true;
    json["accessors"].push_back(accessor);
    return static_cast<int>(json["accessors"].size()) - 1;
  }

  /// Adds a view of raw bytes and returns its index.
  int add_bytes(const std::string& bytes) {
    json["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", bytes.size()}});
    bytes_ += bytes;
    while (bytes_.size() % 4 != 0) bytes_ += '\0';
    return static_cast<int>(json["bufferViews"].size()) - 1;
  }

  std::string text() const {
    nlohmann::json result = json;
    nlohmann::json buffer = {{"byteLength", bytes_.size()},
                             {"uri", "data:application/octet-stream;base64," + base64(bytes_)}};
    if (result.contains("buffers"))
      result["buffers"].insert(result["buffers"].begin(), buffer);
    else
      result["buffers"] = nlohmann::json::array({buffer});
    return result.dump();
  }

 private:
  static int kind(std::int8_t) { return 5120; }
  static int kind(std::uint8_t) { return 5121; }
  static int kind(std::int16_t) { return 5122; }
  static int kind(std::uint16_t) { return 5123; }
  static int kind(std::uint32_t) { return 5125; }
  static int kind(float) { return 5126; }

  std::string bytes_;
};

}  // namespace supple
