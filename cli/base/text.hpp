#pragma once

#include <fmt/core.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "supple/error.hpp"
#include "supple/scene.hpp"
#include "supple/utf8.hpp"

namespace supple::cli {

/// Throws an `Error` with this message.
template <class... Args>
[[noreturn]] void fail(fmt::format_string<Args...> message, Args&&... args) {
  throw Error(fmt::format(message, std::forward<Args>(args)...));
}

/// A table prints at most this many rows, and then the number of omitted rows.
inline constexpr std::size_t most_rows = 40;

/// The number and name of an object, for tables.
std::string name_of(const Scene& scene, ObjectId object);

/// `v0` … `v2`, `e0` … `e2`, `f`.
std::string name_of(Feature feature);
/// `edge 3 5`, `face 7`.
std::string element_name(FeatureKind kind, const std::array<std::uint32_t, 2>& ids);
/// The kinds of the two elements of a pair, as in JSON and CSV: `vf`, `ee` and so on.
std::string kind_word(FeatureKind a, FeatureKind b);

/// The most likely intended word for a mistyped word, or nothing when no word is similar.
std::optional<std::string> nearest_of(const std::string& mistyped, const std::vector<std::string>& words);

/// 1234567 as 1,234,567.
std::string grouped(std::uint64_t number);

/// `1 frame`, `2 frames`; with `nouns`, `1 query`, `2 queries`.
std::string counted(std::uint64_t number, const std::string& noun, const std::string& nouns = "");

}  // namespace supple::cli
