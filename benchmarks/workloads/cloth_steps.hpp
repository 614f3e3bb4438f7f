#pragma once

#include <optional>
#include <string>
#include <vector>

#include "supple/mesh.hpp"
#include "supple/types.hpp"

namespace supple::benchmarks {

/// Workload C: one mesh against itself while its vertices move on straight lines from `start` to `end`.
struct ClothStep {
  std::vector<Vec3d> start, end;
  std::vector<Triangle> triangles;
};

/// `cloth-ball` and `cloth-funnel` are real frames; returns nothing when their files are missing. `crumpled`
/// is generated: a sheet of 90,000 triangles whose folds pass through each other. `passing` are 64 spheres
/// that fly past one another, `rods` a bundle of 400 thin rods that turn. Throws `Error` for other names.
std::optional<ClothStep> make_cloth_step(const std::string& name);

}  // namespace supple::benchmarks
