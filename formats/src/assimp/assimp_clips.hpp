#pragma once

#include <assimp/scene.h>

#include <cstdint>
#include <map>
#include <string>

#include "animation/animated_model.hpp"

namespace supple {

using NodesByName = std::map<std::string, std::uint32_t>;

/// Adds the animations of the scene to the model. Their channels name nodes; those of morph targets name a
/// node or a mesh.
void read_clips(const aiScene& scene, const NodesByName& nodes, const NodesByName& nodes_of_meshes,
                AnimatedModel& model);

}  // namespace supple
