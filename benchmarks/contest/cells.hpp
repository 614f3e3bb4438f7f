#pragma once

#include <string>

#include "contest/output.hpp"
#include "contest/turns.hpp"

namespace supple::benchmarks {

// What each kind of cell runs; `cell` is its name without the kind in front. All throw `Error` for a name
// that is none, and `Disagreement`.

/// FIELD/N, FIELD/N/drift, FIELD/N/one-percent, FIELD/N/one-in-K.
void run_boxes(const Choice& choice, const std::string& cell, Output& output);
/// SHAPExCOPIES, with -rest; with two threads, Supple on one and on two.
void run_copies(const Choice& choice, const std::string& cell, bool two_threads, Output& output);
/// A cloth of `make_cloth_step`.
void run_cloth(const Choice& choice, const std::string& cell, bool two_threads, Output& output);
/// How fast memory is read, from each level of caches.
void run_bandwidth(Output& output);
/// SHAPE: Supple's refit of one object against the ideal one.
void run_refit(const Choice& choice, const std::string& cell, Output& output);
/// SHAPE: all that a scene of two copies holds on the heap after some steps, and of it the octrees.
void run_memory(const std::string& cell, Output& output);

}  // namespace supple::benchmarks
