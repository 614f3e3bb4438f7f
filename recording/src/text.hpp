#pragma once

#include <charconv>
#include <string>

#include "supple/types.hpp"

namespace supple {

/// The fewest digits that identify the double.
inline std::string to_text(double value) {
  char digits[32];
  return {digits, std::to_chars(digits, digits + sizeof digits, value).ptr};
}

inline std::string to_text(Vec3d point) {
  std::string text = "(";
  return text.append(to_text(point.x) + ", " + to_text(point.y) + ", " + to_text(point.z) + ")");
}

}  // namespace supple
