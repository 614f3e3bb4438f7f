#pragma once

namespace supple {

/// Lets the scenes of this process find curves and make manifolds: `curves` and `manifolds` of `SceneOptions`
/// and of `DetectRequest`. Without this call, `Scene::detect` and `Scene::search` throw `Error` for them.
/// Call it before; repeated calls and calls from several threads are allowed.
///
/// It needs a call because a linker leaves out what nothing names.
void use_manifolds();

}  // namespace supple
