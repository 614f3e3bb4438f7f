#pragma once

#include "supple/options.hpp"

namespace supple {

/// Lets this process use the methods that only serve comparisons with the defaults:
/// `SceneOptions::bounding_volume` other than `aabb`, `ObjectOctreeOptions::build` other than `balanced`,
/// `BroadPhaseMethod::sweep`, `brute` and `sweep3`, `Descent::one_side_first`, `colliding_vertices` and
/// `lazy_refit`. Without this call, `Scene`, `Scene::add` and `BroadPhase` throw `Error` for these options.
/// Call it before; repeated calls and calls from several threads are allowed.
///
/// It needs a call because a linker leaves out what nothing names.
void use_comparison_methods();

/// The options with the method of the paper's program of 2007: the octree of the scene as in Figure 2, with
/// level 1 always there and 64 leaves at most (level-allowed = 2), the region test of the grown box, the
/// descent of Figure 4, the lazy refit, and the colliding vertices of both sides as its output. Other options
/// stay, with boxes instead of volumes that the paper does not have. Objects need `octree_of_2007`.
/// `SimulationOptions::fused_refit` belongs to the method, too, and the root of the scene octree is the cube
/// of the scene.
SceneOptions with_method_of_2007(SceneOptions options);
/// The paper's octree of an object: regular, down to single triangles.
ObjectOctreeOptions octree_of_2007();

}  // namespace supple
