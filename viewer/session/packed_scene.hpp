#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "scene_view.hpp"

namespace supple::viewer {

/// A show as bytes, for a page that has no server: read by the same version that wrote it. Frames of a
/// recording are packed as floats. Throws `Error` when an object moves in a way that cannot be packed.
std::vector<std::byte> pack(const SceneView& show);
/// Throws `Error` for bytes that `pack` did not write, or another version did.
SceneView unpack(std::span<const std::byte> bytes);

}  // namespace supple::viewer
