#pragma once

#include <cstdint>

namespace supple {

/// The number of threads that work when an option asks for `threads` of them (0: one for each core), at least
/// 1; the calling thread is one of them. There are fewer when the operating system refuses to create threads,
/// for example because of a limit of processes or of memory. All results are the same.
///
/// Every `Scene`, `BroadPhase` and body calls this, so a program needs it only to tell its user. A call that
/// asks for more threads than all calls before creates them; they stay until the process ends. It takes about
/// 0.3 ms for each. Any thread may call it.
std::uint32_t available_threads(std::uint32_t threads);

/// The number of cores that this process may use, at least 1.
std::uint32_t usable_cores();

}  // namespace supple
