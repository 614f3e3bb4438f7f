#pragma once

#include <filesystem>

#include "animation/animated_model.hpp"

namespace supple {

/// Reads a glTF 2.0 file, text or binary.
AnimatedModel read_gltf(const std::filesystem::path& path);

#ifdef SUPPLE_UFBX
/// Reads an FBX file by ufbx.
AnimatedModel read_fbx(const std::filesystem::path& path);
#endif

/// Reads a file of any format that Assimp reads, by its extension.
AnimatedModel read_with_assimp(const std::filesystem::path& path);

/// Reads a file of any supported format. A format without nodes gives a mesh only.
AnimatedModel read_model(const std::filesystem::path& path);

}  // namespace supple
