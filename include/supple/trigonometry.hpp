#pragma once

namespace supple {

/// Sine and cosine of an angle in turns (1 is a full circle), the same bits on every machine and compiler,
/// which the standard library does not promise: for motion that has to repeat. Within 2 ulp of 1 for
/// |turns| < 2^20; exact at multiples of a quarter turn.
double sin_turns(double turns);
double cos_turns(double turns);

}  // namespace supple
