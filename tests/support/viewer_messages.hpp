#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace supple {

/// A parsed message of the viewer (viewer/PROTOCOL.md). The parser is independent of the code that writes
/// messages. Throws `std::runtime_error` for invalid messages.
class ViewerMessage {
 public:
  static constexpr std::uint32_t no_object = 0xffffffff;
  enum Kind : std::uint16_t { scene = 1, frame, answer, failure, series };
  struct Section {
    std::uint32_t count = 0;
    std::vector<std::byte> data;
  };

  explicit ViewerMessage(std::span<const std::byte> bytes) {
    require(bytes.size() >= 16 && reinterpret_cast<std::uintptr_t>(bytes.data()) % 16 == 0, "header");
    require(word(bytes, 0) == 0x4c505553, "magic number");
    require((word(bytes, 4) & 0xffff) == 2, "version");
    kind = static_cast<Kind>(word(bytes, 4) >> 16);
    require(word(bytes, 8) == bytes.size() && bytes.size() % 16 == 0, "length");
    std::size_t place = 16;
    for (std::uint32_t s = 0; s < word(bytes, 12); ++s) place = read_section(bytes, place);
    require(place == bytes.size(), "end");
    if (kind != series) {
      const std::vector<char> text = values<char>(1);
      json = nlohmann::json::parse(text.begin(), text.end());
    }
  }

  bool has(std::uint32_t tag, std::uint32_t object = no_object) const {
    return sections.contains({tag, object});
  }
  const Section& section(std::uint32_t tag, std::uint32_t object = no_object) const {
    require(has(tag, object), "section");
    return sections.at({tag, object});
  }
  template <class Value>
  std::vector<Value> values(std::uint32_t tag, std::uint32_t object = no_object) const {
    const Section& found = section(tag, object);
    require(found.data.size() % sizeof(Value) == 0, "size of elements");
    std::vector<Value> values(found.data.size() / sizeof(Value));
    if (!values.empty()) std::memcpy(values.data(), found.data.data(), found.data.size());
    return values;
  }

  Kind kind{};
  nlohmann::json json;
  std::map<std::pair<std::uint32_t, std::uint32_t>, Section> sections;  // by tag and object

 private:
  static void require(bool holds, const char* what) {
    if (!holds) throw std::runtime_error(std::string("malformed message: ") + what);
  }
  static std::uint32_t word(std::span<const std::byte> bytes, std::size_t place) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + place, sizeof(value));
    return value;
  }
  std::size_t read_section(std::span<const std::byte> bytes, std::size_t place) {
    require(place + 16 <= bytes.size(), "section's header");
    const std::uint32_t tag = word(bytes, place), object = word(bytes, place + 4);
    const std::size_t length = word(bytes, place + 12), padded = (length + 15) / 16 * 16;
    const std::size_t data = place + 16;
    require(padded <= bytes.size() - data, "section's length");
    for (std::size_t i = length; i < padded; ++i) require(bytes[data + i] == std::byte{0}, "padding");
    const auto all = bytes.subspan(data, length);
    const bool is_new =
        sections.insert({{tag, object}, {word(bytes, place + 8), {all.begin(), all.end()}}}).second;
    require(is_new, "a section comes twice");
    return data + padded;
  }
};

}  // namespace supple
