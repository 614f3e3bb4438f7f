#pragma once

#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "supple/description.hpp"
#include "supple/mesh.hpp"
#include "supple/types.hpp"

namespace supple::viewer {

static_assert(std::endian::native == std::endian::little, "packed scenes are little-endian");

/// Values that are stored as their raw bytes.
template <class Value>
concept Plain = std::is_same_v<Value, std::uint8_t> || std::is_same_v<Value, std::uint32_t> ||
    std::is_same_v<Value, std::uint64_t> || std::is_same_v<Value, float> || std::is_same_v<Value, double> ||
    std::is_same_v<Value, Vec3d> || std::is_same_v<Value, Triangle> ||
    std::is_same_v<Value, std::array<std::uint32_t, 2>> || std::is_same_v<Value, char>;

/// Writes values one after the other. `fields(archive, value)` lists the members of a structure for both
/// archives.
class Packer {
 public:
  std::vector<std::byte> take() { return std::move(bytes_); }

  template <class... Values>
  void operator()(const Values&... values) {
    (put(values), ...);
  }

 private:
  template <Plain Value>
  void put(const Value& value) {
    put_bytes(&value, sizeof(value));
  }
  void put(bool value) { put(static_cast<std::uint8_t>(value)); }
  template <class Enumeration>
  requires std::is_enum_v<Enumeration>
  void put(Enumeration value) { put(static_cast<std::uint8_t>(value)); }
  template <Plain Value>
  void put(const std::vector<Value>& values) {
    put(std::uint64_t{values.size()});
    put_bytes(values.data(), values.size() * sizeof(Value));
  }
  template <class Value>
  void put(const std::vector<Value>& values) {
    put(std::uint64_t{values.size()});
    for (const Value& value : values) put(value);
  }
  void put(const std::string& text) {
    put(std::uint64_t{text.size()});
    put_bytes(text.data(), text.size());
  }
  template <class Value>
  void put(const std::optional<Value>& value) {
    put(value.has_value());
    if (value) put(*value);
  }
  template <class Structure>
  requires(std::is_class_v<Structure> && !Plain<Structure>) void put(const Structure& structure) {
    fields(*this, structure);
  }
  void put_bytes(const void* data, std::size_t size) {
    const auto* const first = static_cast<const std::byte*>(data);
    bytes_.insert(bytes_.end(), first, first + size);
  }

  std::vector<std::byte> bytes_;
};

/// Reads the output of `Packer`. After the first invalid value all further values are left unchanged. A
/// count never allocates more memory than the remaining bytes can fill.
class Unpacker {
 public:
  explicit Unpacker(std::span<const std::byte> bytes) : rest_(bytes) {}

  bool good() const { return is_good_; }
  bool at_end() const { return rest_.empty(); }
  void fail() { is_good_ = false; }

  template <class... Values>
  void operator()(Values&... values) {
    (get(values), ...);
  }

 private:
  template <Plain Value>
  void get(Value& value) {
    get_bytes(&value, sizeof(value));
  }
  void get(bool& value) {
    std::uint8_t number = 0;
    get(number);
    if (number > 1) fail();
    value = number == 1;
  }
  template <class Enumeration>
  requires std::is_enum_v<Enumeration>
  void get(Enumeration& value) {
    static_assert(Worded<Enumeration>);
    std::uint8_t number = 0;
    get(number);
    if (number >= words<Enumeration>.size()) return fail();
    value = static_cast<Enumeration>(number);
  }
  template <Plain Value>
  void get(std::vector<Value>& values) {
    values.resize(get_count(sizeof(Value)));
    get_bytes(values.data(), values.size() * sizeof(Value));
  }
  template <class Value>
  void get(std::vector<Value>& values) {
    // Each element takes at least one byte.
    const std::size_t count = get_count(1);
    values.clear();
    while (good() && values.size() < count) get(values.emplace_back());
  }
  void get(std::string& text) {
    text.resize(get_count(1));
    get_bytes(text.data(), text.size());
  }
  template <class Value>
  void get(std::optional<Value>& value) {
    bool is_there = false;
    get(is_there);
    value.reset();
    if (is_there && good()) get(value.emplace());
  }
  template <class Structure>
  requires(std::is_class_v<Structure> && !Plain<Structure>) void get(Structure& structure) {
    fields(*this, structure);
  }

  std::size_t get_count(std::size_t size) {
    std::uint64_t count = 0;
    get(count);
    if (!good() || count > rest_.size() / size) {
      fail();
      return 0;
    }
    return static_cast<std::size_t>(count);
  }
  void get_bytes(void* data, std::size_t size) {
    if (!good() || size > rest_.size()) return fail();
    if (size > 0) std::memcpy(data, rest_.data(), size);
    rest_ = rest_.subspan(size);
  }

  std::span<const std::byte> rest_;
  bool is_good_ = true;
};

}  // namespace supple::viewer
