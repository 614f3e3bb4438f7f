#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "supple/scene.hpp"

namespace supple::cli {

/// The text with each line break, tab or other control character made a blank: error messages are one line,
/// whatever a file is called.
std::string one_line(std::string text);

/// A table of more rows says how many it leaves out.
inline constexpr std::size_t most_rows = 40;

/// An object in a table: its number and name.
std::string name_of(const Scene& scene, ObjectId object);

/// The word that a mistyped one most likely stands for, or nothing when none is near.
std::optional<std::string> nearest_of(const std::string& mistyped, const std::vector<std::string>& words);

/// 1234567 as 1,234,567.
std::string grouped(std::uint64_t number);

/// `1 frame`, `2 frames`.
std::string counted(std::uint64_t number, const std::string& noun);
/// `1 query`, `2 queries`.
std::string counted(std::uint64_t number, const std::string& noun, const std::string& nouns);

}  // namespace supple::cli
