#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "scene_view.hpp"

namespace supple::viewer {

/// Packs a scene view for a page without a server. Only the version of the library that wrote the bytes
/// reads them. Frames of a recording are packed as floats. Throws `Error` when the motion of an object
/// cannot be packed.
std::vector<std::byte> pack(const SceneView& show);
/// Adds the header of this version, with a checksum, to a packed scene without one. `pack` does so.
std::vector<std::byte> with_header(std::span<const std::byte> content);
/// Throws `Error` when `pack` of this version did not write the bytes.
SceneView unpack(std::span<const std::byte> bytes);

}  // namespace supple::viewer
