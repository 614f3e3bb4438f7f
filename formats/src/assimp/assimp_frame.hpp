#pragma once

#include <assimp/scene.h>

#include <string_view>

#include "animation/animated_model.hpp"

namespace supple {

/// Whether Assimp mirrors the format from left-handed to right-handed axes. `extension` is lower case, with
/// its dot.
bool is_mirrored_by_assimp(std::string_view extension);

/// What the file states about its coordinates, and the transform of the root node without the turn and the
/// scale that Assimp adds to it.
struct RootFrame {
  CoordinateFrame frame;
  Transform root = identity_transform;
};
RootFrame root_frame_of(const aiScene& scene, std::string_view extension);

/// The upper three rows of a matrix of Assimp.
Transform transform_of(const aiMatrix4x4& matrix);

}  // namespace supple
