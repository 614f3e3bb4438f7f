#pragma once

#include "inputs/inputs.hpp"
#include "options/options.hpp"
#include "session/scene_view.hpp"

namespace supple::cli {

/// Throws `Error` in a build without the viewer.
void check_viewer();

/// Reads the input of a command that shows it. Throws `Error` when that fails, or for options that have no
/// effect on this input.
Input read_view_input(const ViewOptions& options);

/// Makes the scene view of an input: a simulation, or frames when a recording or files move the objects.
/// Reads all data of the frames of a recording except positions and contacts. Throws `Error` when the input
/// cannot be read, or when files move some objects and masses and springs move others.
viewer::SceneView build_scene_view(const Input& input, const ViewOptions& options);

}  // namespace supple::cli
