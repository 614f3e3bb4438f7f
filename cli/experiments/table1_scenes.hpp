#pragma once

#include <span>
#include <string>

#include "inputs.hpp"

namespace supple::experiments {

/// A scene file built into the program.
struct SceneText {
  const char* name;  ///< of the file, without its ending
  const char* text;
};

/// Generated from scenes/ when the program is built.
std::span<const SceneText> table1_scene_texts();

/// A scene of section 7 by the name of its file in scenes/, read from the text built into the program. Throws
/// `Error` when there is none of that name.
cli::Input table1_scene(const std::string& name);

}  // namespace supple::experiments
