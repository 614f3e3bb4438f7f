#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace supple::viewer {

/// Browsers read larger pages slowly or not at all, and mail does not carry them.
inline constexpr std::uint64_t largest_page = 200'000'000;

/// A page that needs no server: the page with a packed show and the module that runs it inside, each
/// compressed by gzip, as base64 in an element `<script type="application/octet-stream;base64">` with the id
/// `supple-show` or `supple-wasm`. They take the place of the comment `<!--supple-cargo-->`. Throws `Error`
/// when the page has none.
std::string page_with_cargo(std::string_view page, std::span<const std::byte> show,
                            std::span<const std::byte> module);

/// Replaces the file when all is written; until then the old one stays. Throws `Error` when it cannot be.
void replace_file(const std::filesystem::path& path, std::string_view content);

}  // namespace supple::viewer
