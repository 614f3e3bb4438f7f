#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <string>

namespace supple {

/// Reads a scalar at `place`, in the given byte order and at any alignment.
template <class Scalar>
Scalar load_scalar(const char* place, std::endian order) {
  std::array<char, sizeof(Scalar)> bytes;
  std::copy_n(place, sizeof(Scalar), bytes.data());
  if (order != std::endian::native) std::reverse(bytes.begin(), bytes.end());
  return std::bit_cast<Scalar>(bytes);
}

/// Appends the bytes of `value`, least significant first.
template <class Scalar>
void append_scalar(std::string& text, Scalar value) {
  auto bytes = std::bit_cast<std::array<char, sizeof(Scalar)>>(value);
  if (std::endian::native != std::endian::little) std::reverse(bytes.begin(), bytes.end());
  text.append(bytes.data(), bytes.size());
}

}  // namespace supple
