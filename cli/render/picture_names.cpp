#include "render/picture_names.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <regex>

#include "base/text.hpp"

namespace supple::cli {

PictureNames::PictureNames(const std::string& pattern) {
  static const std::regex form("((?:[^%]|%%)*)(?:(%(?:0([0-9]?))?d)((?:[^%]|%%)*))?"), percent("%%");
  std::smatch parts;
  if (!std::regex_match(pattern, parts, form))
    fail(
        "--output: {}: write the place of the number once, as %d, or as %04d for four digits, and %% for a "
        "percent sign",
        pattern);
  before_ = std::regex_replace(parts[1].str(), percent, "%");
  after_ = std::regex_replace(parts[4].str(), percent, "%");
  has_number_ = parts[2].matched;
  if (parts[3].length() > 0) digits_ = std::stoi(parts[3]);
}

std::string PictureNames::of(std::uint64_t frame) const {
  if (!has_number_) return before_;
  return fmt::format("{}{:0{}}{}", before_, frame, std::max(digits_, 1), after_);
}

}  // namespace supple::cli
