#pragma once

#include "inputs/inputs.hpp"
#include "options/options.hpp"
#include "session/scene_view.hpp"

namespace supple::cli {

/// Makes the scene view of an input: a simulation, or frames when a recording or files move the objects.
/// Reads all data of the frames of a recording except positions and contacts. Throws `Error` when the input
/// cannot be read, or when files move some objects and masses and springs move others.
viewer::SceneView build_scene_view(const Input& input, const ViewOptions& options);

}  // namespace supple::cli
