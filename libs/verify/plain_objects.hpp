#pragma once

#include "verify/brute_force_contacts.hpp"
#include "verify/brute_force_elements.hpp"
#include "world/object/world_object.hpp"

namespace supple {

/// What brute force reads of an object: without its edges and points of no triangle, at the end of the step.
PlainObject plain_object(const WorldObject& object);
/// With them, at both ends of the step.
PlainMovingObject plain_moving_object(const WorldObject& object);

}  // namespace supple
