#include "render/picture_names.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstddef>
#include <string_view>

#include "supple/error.hpp"

namespace supple::cli {

namespace {

[[noreturn]] void fail_of_pattern(const std::string& pattern) {
  throw Error(fmt::format(
      "--output: {}: write the place of the number once, as %d, or as %04d for four digits, and %% for a "
      "percent sign",
      pattern));
}

}  // namespace

PictureNames::PictureNames(const std::string& pattern) {
  std::string_view rest = pattern;
  while (!rest.empty()) {
    std::string& text = has_number_ ? after_ : before_;
    if (rest.front() != '%') {
      text += rest.front();
      rest.remove_prefix(1);
      continue;
    }
    rest.remove_prefix(1);
    if (rest.starts_with('%')) {
      text += '%';
      rest.remove_prefix(1);
      continue;
    }
    constexpr std::size_t most_digits = 2;  // of the width
    std::size_t count = 0;
    while (count < rest.size() && rest[count] >= '0' && rest[count] <= '9') ++count;
    const bool is_padded = count > 0 && count <= most_digits && rest.front() == '0';
    if ((count > 0 && !is_padded) || count == rest.size() || rest[count] != 'd' || has_number_)
      fail_of_pattern(pattern);
    for (const char digit : rest.substr(0, count)) digits_ = 10 * digits_ + (digit - '0');
    has_number_ = true;
    rest.remove_prefix(count + 1);
  }
}

std::string PictureNames::of(std::uint64_t frame) const {
  if (!has_number_) return before_;
  return fmt::format("{}{:0{}}{}", before_, frame, std::max(digits_, 1), after_);
}

}  // namespace supple::cli
