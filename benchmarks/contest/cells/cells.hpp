#pragma once

#include <string>

#include "contest/output.hpp"
#include "contest/turns.hpp"

namespace supple::benchmarks {

// The kinds of cells. `cell` is the name without the kind. All functions throw `Error` for an unknown name,
// and `Disagreement`.

/// FIELD/N, FIELD/N/drift, FIELD/N/one-percent, FIELD/N/one-in-K.
void run_boxes(const Choice& choice, const std::string& cell, Output& output);
/// SHAPExCOPIES, optionally with -rest. With two threads: Supple on one thread and on two.
void run_copies(const Choice& choice, const std::string& cell, bool two_threads, Output& output);
/// A cloth of `make_cloth_step`.
void run_cloth(const Choice& choice, const std::string& cell, bool two_threads, Output& output);
/// The candidates of a cloth by boxes alone.
void run_cloth_boxes(const Choice& choice, const std::string& cell, Output& output);
/// Proximity of a cloth with itself, with a margin of a thousandth of the cloth's size.
void run_near_cloth(const Choice& choice, const std::string& cell, Output& output);
/// The longest safe step of a cloth (`Scene::max_step`), that which keeps a tenth of all distances
/// (`Scene::collision_free_step`), and the median times of both and of `detect` for the same step;
/// ipc_toolkit.py compares.
void run_safe_step(const Choice& choice, const std::string& cell, Output& output);
/// A task of `make_query_task`: points, rays, or penetrations.
void run_queries(const Choice& choice, const std::string& cell, Output& output);
/// The read bandwidth of each cache level and of memory.
void run_bandwidth(Output& output);
/// SHAPE: Supple's refit of one object against the ideal refit.
void run_refit(const Choice& choice, const std::string& cell, Output& output);
/// SHAPE: the heap memory of a scene of two copies after some steps, and the part of its octrees. `moving`:
/// the copies move on paths (`Scene::set_motion`) and are searched for continuous contacts.
void run_memory(const std::string& cell, bool moving, Output& output);
/// SHAPE: the time to add an object with a balanced octree, with a regular octree, and on two threads.
void run_build(const Choice& choice, const std::string& cell, Output& output);
/// TRIANGLES: builds the octree of one sphere, refits it and searches it for self-collision, on one thread;
/// the build and the refit of Embree.
void run_scale(const Choice& choice, const std::string& triangles, Output& output);
/// The first frame in a new process, with Supple and with Embree: CLOTH is read from its files, added and
/// searched; the meshes of SHAPExCOPIES are there, and are added and searched.
void run_first_frame(const Choice& choice, const std::string& cell, Output& output);
/// SHAPExCOPIES: the distribution of the times of 10,000 frames (`Choice::rounds`, if given).
void run_frames(const Choice& choice, const std::string& cell, Output& output);
/// The distribution of the times of 5,000 frames (`Choice::rounds`, if given) of a tool on an organ, with
/// penetration, and with penetration and curves. The time of a frame is the least of four runs.
void run_surgery(const Choice& choice, Output& output);
/// The times of edits of an organ that a blade cuts, of frames with them, and of frames that remove the organ
/// and add it again; and of queries after all edits, of the edited octree and of a fresh one.
void run_cutting(const Choice& choice, Output& output);
/// A pile of crates and balls, with penetration or proximity: the median time of a frame with manifolds and
/// without, of the manifolds alone, and of a plain loop that makes its own.
void run_game(const Choice& choice, const std::string& cell, Output& output);

}  // namespace supple::benchmarks
