#pragma once

namespace supple {

/// The angle in turns with this cosine and sine, from 0 to a quarter turn. `std::acos` has other bits on
/// other machines.
double angle_in_turns(double cosine, double sine);

}  // namespace supple
