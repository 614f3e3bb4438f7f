#pragma once

namespace supple {

/// Lets the scenes of this process make manifolds: `SceneOptions::manifolds` and `DetectRequest::manifolds`.
/// Without this call, `Scene::detect` throws `Error` for them. Call it before; repeated calls and calls from
/// several threads are allowed.
///
/// It needs a call because a linker leaves out what nothing names.
void use_manifolds();

}  // namespace supple
