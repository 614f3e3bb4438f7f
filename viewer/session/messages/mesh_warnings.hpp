#pragma once

#include <string>
#include <vector>

#include "scene_view.hpp"

namespace supple::viewer {

/// Sentences about meshes that cannot touch anything, in whole or in part: with vertices that are NaN or
/// infinite, and without triangles, edges and points. O(n).
std::vector<std::string> warnings_of_meshes(const SceneView& show);

}  // namespace supple::viewer
