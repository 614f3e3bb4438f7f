#pragma once

#include <memory>

#include "contest/contestant.hpp"

namespace supple::benchmarks {

/// Sorts by radix along the axis on which the boxes are spread most, and sweeps with vector lanes.
std::unique_ptr<BoxContestant> make_baseline_sweep();
/// Sorts by radix along that axis, deals the boxes out to columns of the other two, and sweeps each column.
std::unique_ptr<BoxContestant> make_baseline_grid();

/// Embree 3: built anew with low quality for boxes, refitted for meshes, `rtcCollide`.
std::unique_ptr<BoxContestant> make_embree_boxes();
std::unique_ptr<CopiesContestant> make_embree_copies();
std::unique_ptr<ClothContestant> make_embree_cloth();

/// CGAL's `box_intersection_d`, which keeps nothing from frame to frame.
std::unique_ptr<BoxContestant> make_cgal_boxes();
std::unique_ptr<CopiesContestant> make_cgal_copies();
std::unique_ptr<ClothContestant> make_cgal_cloth();

/// FCL: a dynamic AABB tree built anew each frame (left to drift, it takes many times as long); for meshes a
/// tree of boxes, refitted.
std::unique_ptr<BoxContestant> make_fcl_boxes();
std::unique_ptr<CopiesContestant> make_fcl_copies();

/// Bullet: `btDbvt` with every leaf updated and one pass of incremental optimisation; for meshes the box tree
/// of GImpact, refitted.
std::unique_ptr<BoxContestant> make_bullet_boxes();
std::unique_ptr<CopiesContestant> make_bullet_copies();

/// ODE's sweep-and-prune space.
std::unique_ptr<BoxContestant> make_ode_boxes();

}  // namespace supple::benchmarks
