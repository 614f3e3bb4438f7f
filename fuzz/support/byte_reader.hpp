#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>

#include "supple/types.hpp"

namespace supple::fuzz {

/// Turns the bytes of an input into values. Behind the last byte, every value is made from zeros.
class ByteReader {
 public:
  ByteReader(const std::uint8_t* data, std::size_t size) : rest_(data, size) {}

  bool at_end() const { return rest_.empty(); }
  std::uint8_t byte() { return static_cast<std::uint8_t>(bits(1)); }
  /// Uniform in [0, count) for random bytes; count is at most 256.
  std::uint32_t below(std::uint32_t count) { return byte() * count >> 8; }
  bool flag() { return (byte() & 1) != 0; }
  /// An unsigned number of `count` bytes, 1 to 8.
  std::uint64_t bits(std::size_t count) {
    std::uint64_t value = 0;
    const std::size_t taken = count < rest_.size() ? count : rest_.size();
    if (taken > 0) std::memcpy(&value, rest_.data(), taken);
    rest_ = rest_.subspan(taken);
    return value;
  }
  /// The bytes that are left.
  std::string_view text() const { return {reinterpret_cast<const char*>(rest_.data()), rest_.size()}; }

 private:
  std::span<const std::uint8_t> rest_;
};

/// Coordinates of one kind for a whole input: in a mixture of all kinds, the large coordinates would decide
/// everything.
class CoordinateReader {
 public:
  explicit CoordinateReader(ByteReader& bytes) : bytes_(bytes), kind_(bytes.below(kind_count)) {
    if (kind_ == scaled_lattice) exponent_ = static_cast<int>(bytes.bits(2) % 1900) - 1000;
  }

  double operator()() {
    switch (kind_) {
      case small_lattice:
        return static_cast<int>(bytes_.below(5)) - 2;
      case lattice:
        return static_cast<std::int8_t>(bytes_.byte());
      case scaled_lattice:
        return std::ldexp(static_cast<std::int8_t>(bytes_.byte()), exponent_);
      case near_lattice: {
        const std::uint8_t byte = bytes_.byte();
        double value = static_cast<int>(byte & 7) - 3;
        for (int i = byte >> 6; i > 0; --i) value = std::nextafter(value, (byte & 8) != 0 ? 1e9 : -1e9);
        return value;
      }
      case uniform:
        return static_cast<double>(bytes_.bits(4)) * 0x1p-32 - 0.5;
      case fine:
        return static_cast<double>(static_cast<std::int64_t>(bytes_.bits(8))) * 0x1p-63;
      case some_exponents:
        return std::ldexp(static_cast<std::int8_t>(bytes_.byte()), static_cast<int>(bytes_.below(81)) - 40);
      default:
        return std::bit_cast<double>(bytes_.bits(8));
    }
  }
  Vec3d point() {
    const double x = (*this)(), y = (*this)();
    return {x, y, (*this)()};
  }
  /// Whether exact arithmetic on these coordinates takes microseconds; that on any bits can take seconds.
  bool is_quick() const { return kind_ != any_bits; }
  /// Whether coordinates are at most 2^7 in size.
  bool is_small() const { return kind_ != scaled_lattice && kind_ != some_exponents && kind_ != any_bits; }

 private:
  enum Kind : std::uint32_t {
    small_lattice,
    lattice,
    scaled_lattice,
    near_lattice,
    uniform,
    fine,
    some_exponents,
    any_bits,
    kind_count
  };

  ByteReader& bytes_;
  std::uint32_t kind_;
  int exponent_ = 0;
};

}  // namespace supple::fuzz
