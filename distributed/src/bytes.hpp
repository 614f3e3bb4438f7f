#pragma once

#include <boost/crc.hpp>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "core/error.hpp"

namespace supple {

template <class Value>
concept Plain = std::is_trivially_copyable_v<Value>;

/// CRC-64 of ECMA-182: it differs for any change of up to 64 adjacent bits.
inline std::uint64_t checksum_of(std::initializer_list<std::span<const std::byte>> parts) {
  boost::crc_optimal<64, 0x42f0e1eba9ea3693u, ~std::uint64_t{0}, ~std::uint64_t{0}, true, true> checksum;
  for (const std::span<const std::byte> part : parts) checksum.process_bytes(part.data(), part.size());
  return checksum.checksum();
}

/// Appends values to a message.
class Writer {
 public:
  explicit Writer(std::vector<std::byte>& bytes) : bytes_(bytes) {}

  template <Plain Value>
  void put(const Value& value) {
    // Not `append`, where g++ 12 warns of a write that cannot happen.
    const std::size_t first = bytes_.size();
    bytes_.resize(first + sizeof value);
    std::memcpy(bytes_.data() + first, &value, sizeof value);
  }
  /// The number of values, then the values.
  template <Plain Value>
  void put_all(std::span<const Value> values) {
    put<std::uint64_t>(values.size());
    append(values.data(), values.size_bytes());
  }
  template <Plain Value>
  void put_all(const std::vector<Value>& values) {
    put_all(std::span<const Value>(values));
  }
  void put_all(const std::string& text) { put_all(std::span<const char>(text)); }
  std::size_t size() const { return bytes_.size(); }

 private:
  void append(const void* data, std::size_t size) {
    const auto* const first = static_cast<const std::byte*>(data);
    bytes_.insert(bytes_.end(), first, first + size);
  }

  std::vector<std::byte>& bytes_;
};

/// Takes values from a message in the order of `Writer`. Throws `Error` when it ends too early, as a file
/// that was damaged.
class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) : rest_(bytes) {}

  bool is_done() const { return rest_.empty(); }
  template <Plain Value>
  Value get() {
    if constexpr (std::is_same_v<Value, bool>) {
      return get<std::uint8_t>() != 0;  // a damaged byte is no bool
    } else {
      Value value;
      take(&value, sizeof value);
      return value;
    }
  }
  template <Plain Value>
  void append_all(std::vector<Value>& values) {
    const std::size_t first = values.size(), count = static_cast<std::size_t>(get<std::uint64_t>());
    if (count > rest_.size() / sizeof(Value)) fail(ends_early);
    values.resize(first + count);
    take(values.data() + first, count * sizeof(Value));
  }
  /// The bytes of the values that `put_all` wrote, in the message.
  template <Plain Value>
  std::span<const std::byte> bytes_of_all() {
    const auto count = static_cast<std::size_t>(get<std::uint64_t>());
    if (count > rest_.size() / sizeof(Value)) fail(ends_early);
    const std::span<const std::byte> bytes = rest_.first(count * sizeof(Value));
    rest_ = rest_.subspan(bytes.size());
    return bytes;
  }
  template <Plain Value>
  std::vector<Value> get_all() {
    std::vector<Value> values;
    append_all(values);
    return values;
  }

 private:
  static constexpr const char* ends_early = "the data ends too early";

  void take(void* to, std::size_t size) {
    if (size > rest_.size()) fail(ends_early);
    if (size != 0) std::memcpy(to, rest_.data(), size);
    rest_ = rest_.subspan(size);
  }

  std::span<const std::byte> rest_;
};

}  // namespace supple
