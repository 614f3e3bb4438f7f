#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace supple::viewer {

/// Browsers open larger pages slowly or not at all.
inline constexpr std::uint64_t largest_page = 200'000'000;

/// Where the comment `<!--supple-cargo-->` of a page begins, which data replaces. Throws `Error` when the
/// page has none.
std::size_t place_of_cargo(std::string_view page);

/// Makes a page that needs no server. A packed scene view and the module are compressed with gzip and
/// embedded as base64 in elements `<script type="application/octet-stream;base64">` with the ids
/// `supple-scene` and `supple-wasm`. They replace the comment `<!--supple-cargo-->`. Throws `Error` when the
/// page has no such comment.
std::string page_with_cargo(std::string_view page, std::span<const std::byte> scene,
                            std::span<const std::byte> module);

/// Replaces the file once all content is written; until then the old file stays. Throws `Error` on failure.
void replace_file(const std::filesystem::path& path, std::string_view content);

}  // namespace supple::viewer
