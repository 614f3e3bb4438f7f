#pragma once

#include <memory>

#include "contest/contestant.hpp"

namespace supple::benchmarks {

/// Radix sort along the axis of largest spread, then a sweep with vector instructions.
std::unique_ptr<BoxContestant> make_baseline_sweep();
/// Radix sort along that axis, distribution into columns of the other two axes, and a sweep of each column.
std::unique_ptr<BoxContestant> make_baseline_grid();

/// Embree 3 with `rtcCollide`: a low-quality rebuild for boxes, a refit for meshes.
std::unique_ptr<BoxContestant> make_embree_boxes();
std::unique_ptr<CopiesContestant> make_embree_copies();
std::unique_ptr<CopiesContestant> make_embree_copies_with_points();
std::unique_ptr<ClothContestant> make_embree_cloth();
/// The same with boxes at the start of the step, grown by the margin, and distances in plain double
/// precision.
std::unique_ptr<Contestant<ClothStep>> make_embree_near_cloth(double margin);
/// Closest points by `rtcPointQuery` and a triangle test in single precision; rays by `rtcIntersect1` in a
/// robust scene with refit.
std::unique_ptr<QueryContestant> make_embree_queries();

/// CGAL's `box_intersection_d`, which keeps no state between frames.
std::unique_ptr<BoxContestant> make_cgal_boxes();
std::unique_ptr<CopiesContestant> make_cgal_copies();
std::unique_ptr<ClothContestant> make_cgal_cloth();
/// `AABB_tree` and `Side_of_triangle_mesh`; for penetrations, the trees are built again in each frame.
std::unique_ptr<QueryContestant> make_cgal_queries();

/// FCL: for boxes a dynamic AABB tree, rebuilt in each frame (otherwise it slows down many times); for
/// meshes a tree of boxes with refit.
std::unique_ptr<BoxContestant> make_fcl_boxes();
std::unique_ptr<CopiesContestant> make_fcl_copies();
/// `distance` on trees of OBBRSS.
std::unique_ptr<QueryContestant> make_fcl_queries();

/// Bullet: for boxes `btDbvt` with every leaf updated and one pass of incremental optimisation; for meshes
/// the box tree of GImpact with refit.
std::unique_ptr<BoxContestant> make_bullet_boxes();
std::unique_ptr<CopiesContestant> make_bullet_copies();

/// ODE's sweep-and-prune space.
std::unique_ptr<BoxContestant> make_ode_boxes();

}  // namespace supple::benchmarks
