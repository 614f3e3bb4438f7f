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

/// Reads a scene of section 7 from the text built into the program, by the name of its file in scenes/.
/// Throws `Error` when there is no such scene.
cli::Input table1_scene(const std::string& name);

}  // namespace supple::experiments
