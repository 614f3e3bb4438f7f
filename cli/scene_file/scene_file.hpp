#pragma once

#include <filesystem>
#include <string>

#include "inputs/inputs.hpp"

namespace supple::cli {

/// Reads a scene file (docs/scene_file.md). Throws `Error`, also for an unknown key. The message names the
/// file, the line and the key, and says what is allowed.
Input read_scene_file(const std::filesystem::path& path, const SceneOverrides& overrides = {});
/// The same for a text in memory, as if it were the content of `path`.
Input read_scene_text(std::string text, const std::filesystem::path& path,
                      const SceneOverrides& overrides = {});

/// The options of the table [scene] alone. Throws `Error` in the same way.
SimulationOptions read_scene_options(const std::filesystem::path& path);

}  // namespace supple::cli
