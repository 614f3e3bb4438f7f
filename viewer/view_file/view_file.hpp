#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace supple::viewer {

/// Throws `Error` for a text that is no view (docs/viewer.md): says which member is wrong and what it must
/// be. `name` is the file, for the message.
void check_view(std::string_view text, const std::string& name);

/// Reads and checks a view file. Throws `Error` when it cannot be read or is no view.
std::string read_view(const std::filesystem::path& path);

/// The page with a JSON text in an element `<script type="application/json">` of this id, which the page
/// reads when it opens. Throws `Error` when the page has no place for it.
std::string page_with_json(std::string_view page, std::string_view id, std::string_view json);

/// The page for those who may only watch.
std::string page_of_spectators(std::string_view page);

}  // namespace supple::viewer
