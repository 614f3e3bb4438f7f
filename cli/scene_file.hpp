#pragma once

#include <filesystem>
#include <string>

#include "inputs.hpp"

namespace supple::cli {

/// Reads a scene file (docs/scene_file.md). Throws `Error` that names file, line and key and says what is
/// allowed; a key that means nothing there is an error too.
Input read_scene_file(const std::filesystem::path& path, const SceneOverrides& overrides = {});
/// The same of a text at hand, as if it were the contents of `path`.
Input read_scene_text(std::string text, const std::filesystem::path& path,
                      const SceneOverrides& overrides = {});

}  // namespace supple::cli
