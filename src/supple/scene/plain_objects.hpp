#pragma once

#include "scene/brute_force_contacts.hpp"
#include "scene/brute_force_elements.hpp"
#include "scene/scene_object.hpp"

namespace supple {

/// What brute force reads of an object: without its edges and points of no triangle, at the end of the step.
PlainObject plain_object(const SceneObject& object);
/// With them, at both ends of the step.
PlainMovingObject plain_moving_object(const SceneObject& object);

}  // namespace supple
