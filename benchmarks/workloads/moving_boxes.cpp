#include "workloads/moving_boxes.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "supple/error.hpp"
#include "workloads/random_numbers.hpp"

namespace supple::benchmarks {
namespace {

constexpr double lattice = 0x1p-13;
constexpr std::size_t cluster_size = 512;

double side_of(std::string_view name, std::size_t count) {
  const double edge = cube_root(static_cast<double>(count));
  if (name == "u1") return 2 * edge;
  if (name == "u8") return edge;
  if (name == "clu") return 0.30 * edge;
  if (name == "cl8") return 0.13 * edge;
  throw Error("no box field is named '" + std::string(name) + "'; choose one of u1, u8, clu, cl8");
}

/// Reflects a coordinate into [0, side], several times if necessary.
void reflect(double& x, double& velocity, double side) {
  while (x < 0 || x > side) {
    x = x < 0 ? -x : 2 * side - x;
    velocity = -velocity;
  }
}

}  // namespace

MovingBoxes::MovingBoxes(std::string_view name, std::size_t count, std::uint64_t seed)
    : side_(side_of(name, count)), motions_(count), boxes_(count) {
  RandomNumbers random(seed);
  const bool clustered = name.starts_with("cl");
  const auto clusters = static_cast<double>((count + cluster_size - 1) / cluster_size);
  const double sigma = clustered ? 0.25 * side_ / cube_root(clusters) : 0;
  Vec3d cluster;
  for (std::size_t i = 0; i < count; ++i) {
    auto& [center, half_extent, velocity] = motions_[i];
    double size = 1;
    if (clustered) {
      if (i % cluster_size == 0) cluster = random.point_in_cube(side_);
      size = random.bounded_pareto(1.0 / 64, 16);
    }
    velocity = random.direction() * (0.1 * size);
    if (!clustered) center = random.point_in_cube(side_);
    for (int axis = 0; axis < 3; ++axis) {
      half_extent[axis] = 0.5 * size * (clustered ? random.uniform(0.5, 1) : 1);
      if (!clustered) continue;
      center[axis] = cluster[axis] + sigma * random.gaussian();
      reflect(center[axis], velocity[axis], side_);
    }
    snap(i);
  }
}

void MovingBoxes::snap(std::size_t box) {
  const auto& [center, half_extent, velocity] = motions_[box];
  for (int axis = 0; axis < 3; ++axis) {
    const double lower = 2 * std::floor((center[axis] - half_extent[axis]) / (2 * lattice));
    const double upper = 2 * std::floor((center[axis] + half_extent[axis]) / (2 * lattice)) + 1;
    boxes_[box].min[axis] = static_cast<float>(lower * lattice);
    boxes_[box].max[axis] = static_cast<float>(upper * lattice);
  }
}

void MovingBoxes::advance(std::size_t one_in) {
  for (std::size_t i = 0; i < motions_.size(); i += one_in) {
    auto& [center, half_extent, velocity] = motions_[i];
    for (int axis = 0; axis < 3; ++axis) {
      center[axis] += velocity[axis];
      reflect(center[axis], velocity[axis], side_);
    }
    snap(i);
  }
}

}  // namespace supple::benchmarks
