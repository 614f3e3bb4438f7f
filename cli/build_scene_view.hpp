#pragma once

#include "inputs.hpp"
#include "options.hpp"
#include "session/scene_view.hpp"

namespace supple::cli {

/// What the viewer shows of an input: a simulation; or, when objects are moved by a recording or by files,
/// their frames. Reads all that a recording says of its frames besides positions and contacts. Throws `Error`
/// when it cannot be read, or when some objects are moved by files and others by masses and springs.
viewer::SceneView build_scene_view(const Input& input, const ViewOptions& options);

}  // namespace supple::cli
