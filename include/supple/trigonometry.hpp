#pragma once

namespace supple {

/// Sine and cosine of an angle in turns (1 is a full circle), with the same bits on every machine and
/// compiler. The standard library does not guarantee this. The error is at most 2 ulp of 1 for |turns| <
/// 2^20; multiples of a quarter turn are exact.
double sin_turns(double turns);
double cos_turns(double turns);

}  // namespace supple
