#include "supple/description.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/error.hpp"

namespace supple {

std::string text_of(double value) {
  char digits[32];
  return {digits, std::to_chars(digits, digits + sizeof(digits), value).ptr};
}

std::string text_of(const RootCube& cube) {
  std::string text;
  for (int axis = 0; axis < 3; ++axis) text += text_of(cube.corner[axis]) + ",";
  return text + text_of(cube.edge);
}

bool is_valid(const RootCube& cube) {
  constexpr double farthest = 1e36;
  const auto is_near = [](double coordinate) { return std::abs(coordinate) <= farthest; };
  return is_near(cube.corner.x) && is_near(cube.corner.y) && is_near(cube.corner.z) && cube.edge >= 1e-30 &&
         cube.edge <= farthest;
}

RootCube cube_around(Vec3d lowest, Vec3d highest) {
  const Vec3d size = highest - lowest, centre = lowest + 0.5 * size;
  const double edge = std::max({size.x, size.y, size.z}), half = 0.5 * edge;
  const RootCube cube{centre - Vec3d{half, half, half}, edge};
  if (!is_valid(cube))
    fail("no cube around the box from (" + text_of(lowest.x) + ", " + text_of(lowest.y) + ", " +
         text_of(lowest.z) + ") to (" + text_of(highest.x) + ", " + text_of(highest.y) + ", " +
         text_of(highest.z) + "): its corner and edge must be " + range_of_root_cube);
  return cube;
}

std::string text_of(const ValueRange& range, bool is_whole) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (range.powers_of_two) {
    std::string list;
    for (double value = range.lowest; value <= range.highest; value *= 2) {
      if (!list.empty()) list += 2 * value > range.highest ? " or " : ", ";
      list += text_of(value);
    }
    return list;
  }
  std::string text = is_whole ? "a whole number" : range.highest < infinity ? "a number" : "a finite number";
  const double lowest = is_whole && range.lowest < 0 ? 0 : range.lowest;
  if (range.excludes_lowest)
    text += " above " + text_of(lowest);
  else if (lowest > -infinity)
    text += " from " + text_of(lowest) + (range.highest < infinity ? "" : " up");
  if (range.highest < infinity) {
    text += " to ";
    // Whole numbers have no exponent: 4294967295. The greatest of 64 bits is no double; it rounds to 2^64.
    const std::uint64_t whole = range.highest < 0x1p64 ? static_cast<std::uint64_t>(range.highest)
                                                       : std::numeric_limits<std::uint64_t>::max();
    text += is_whole ? std::to_string(whole) : text_of(range.highest);
  }
  if (range.includes_zero) text += ", or 0";
  if (range.includes_infinity) text += ", or infinity for none";
  return text;
}

namespace {

[[noreturn]] void fail_with(std::string_view where, const char* structure, const char* name,
                            const std::string& value, const std::string& what) {
  std::string message(where);
  if (!message.empty()) message += ": ";
  message += structure;
  message += "::";
  message += name;
  message += " is " + value;
  message += "; it must be " + what;
  fail(message);
}

}  // namespace

void fail_range(std::string_view where, const char* structure, const char* name, std::uint64_t value,
                const ValueRange& range) {
  fail_with(where, structure, name, std::to_string(value), text_of(range, true));
}

void fail_range(std::string_view where, const char* structure, const char* name, double value,
                const ValueRange& range) {
  fail_with(where, structure, name, text_of(value), text_of(range, false));
}

void fail_range(std::string_view where, const char* structure, const char* name, Vec3d value) {
  fail_with(where, structure, name,
            "(" + text_of(value.x) + ", " + text_of(value.y) + ", " + text_of(value.z) + ")",
            "three finite numbers");
}

void fail_range(std::string_view where, const char* structure, const char* name, const RootCube& value) {
  fail_with(where, structure, name, text_of(value), range_of_root_cube);
}

void fail_range(std::string_view where, const char* structure, const char* name, std::uint64_t value,
                const std::string& words) {
  fail_with(where, structure, name, std::to_string(value), "one of " + words);
}

}  // namespace supple
