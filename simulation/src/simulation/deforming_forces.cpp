#include "simulation/deforming_forces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "geometry/vector.hpp"
#include "supple/trigonometry.hpp"

namespace supple {
namespace {

/// The vertices that receive forces.
struct Cloud {
  std::vector<std::size_t> vertices;
  std::vector<Vec3d> from_centre;
  double size = 0;  // longest side of the bounding box
};

Cloud cloud_of(std::span<const Vec3d> rest) {
  Cloud cloud;
  Vec3d sum, low, high;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    if (!is_finite(rest[i])) continue;
    if (cloud.vertices.empty()) low = high = rest[i];
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], rest[i][axis]);
      high[axis] = std::max(high[axis], rest[i][axis]);
    }
    sum = sum + rest[i];
    cloud.vertices.push_back(i);
  }
  if (cloud.vertices.empty()) return cloud;
  const Vec3d centre = sum * (1 / static_cast<double>(cloud.vertices.size()));
  for (const std::size_t i : cloud.vertices) cloud.from_centre.push_back(rest[i] - centre);
  cloud.size = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
  return cloud;
}

struct Wave {
  Vec3d force, along;
  double phase = 0;
};

std::array<Wave, 3> random_waves(Random& random, double size) {
  std::array<Wave, 3> waves;
  for (Wave& wave : waves) {
    wave.force = random.direction();
    wave.along = random.direction() * (1 / size);
    wave.phase = random.uniform();
  }
  return waves;
}

void remove_sum(std::vector<Vec3d>& forces) {
  Vec3d sum;
  for (const Vec3d& force : forces) sum = sum + force;
  const Vec3d mean = sum * (1 / static_cast<double>(forces.size()));
  for (Vec3d& force : forces) force = force - mean;
}

/// Subtracts a × r from each force, where J a is the total torque and J the inertia of unit masses. Points
/// on a line have no inertia about it, so that part of the torque remains.
void remove_torque(std::vector<Vec3d>& forces, const std::vector<Vec3d>& arms) {
  Vec3d torque;
  std::array<Vec3d, 3> inertia{};  // rows
  for (std::size_t i = 0; i < forces.size(); ++i) {
    const Vec3d r = arms[i];
    torque = torque + cross(r, forces[i]);
    for (int row = 0; row < 3; ++row) {
      auto& j = inertia[static_cast<std::size_t>(row)];
      j = j - r * r[row];
      j[row] += dot(r, r);
    }
  }
  const auto& [a, b, c] = inertia;
  const double determinant = dot(a, cross(b, c));
  const double trace = a.x + b.y + c.z;
  if (!(determinant > 1e-12 * trace * trace * trace)) return;
  const Vec3d turn =
      (torque.x * cross(b, c) + torque.y * cross(c, a) + torque.z * cross(a, b)) * (1 / determinant);
  for (std::size_t i = 0; i < forces.size(); ++i) forces[i] = forces[i] - cross(turn, arms[i]);
}

/// Connected components of the spring graph, as indices into the cloud.
std::vector<std::vector<std::size_t>> pieces_of(const Cloud& cloud, std::size_t vertex_count,
                                                std::span<const MassSpringBody::Spring> springs) {
  std::vector<std::size_t> parents(vertex_count);
  std::iota(parents.begin(), parents.end(), std::size_t{0});
  const auto root_of = [&](std::size_t vertex) {
    while (parents[vertex] != vertex) vertex = parents[vertex] = parents[parents[vertex]];
    return vertex;
  };
  for (const MassSpringBody::Spring& spring : springs) parents[root_of(spring.a)] = root_of(spring.b);
  std::map<std::size_t, std::vector<std::size_t>> by_root;
  for (std::size_t i = 0; i < cloud.vertices.size(); ++i) by_root[root_of(cloud.vertices[i])].push_back(i);
  std::vector<std::vector<std::size_t>> pieces;
  for (auto& [root, piece] : by_root) pieces.push_back(std::move(piece));
  return pieces;
}

/// Removes the total force and torque of one piece.
void keep_in_place(const std::vector<std::size_t>& piece, const Cloud& cloud, std::vector<Vec3d>& forces) {
  std::vector<Vec3d> its_forces, arms;
  for (const std::size_t i : piece) {
    its_forces.push_back(forces[i]);
    arms.push_back(cloud.from_centre[i]);
  }
  remove_sum(arms);
  remove_sum(its_forces);
  remove_torque(its_forces, arms);
  for (std::size_t i = 0; i < piece.size(); ++i) forces[piece[i]] = its_forces[i];
}

void scale_to(std::vector<Vec3d>& forces, double root_mean_square) {
  double squares = 0;
  for (const Vec3d& force : forces) squares += dot(force, force);
  if (!(squares > 0)) return;
  const double factor = root_mean_square * std::sqrt(static_cast<double>(forces.size()) / squares);
  for (Vec3d& force : forces) force = force * factor;
}

}  // namespace

std::vector<Vec3d> deforming_forces(std::span<const Vec3d> rest,
                                    std::span<const MassSpringBody::Spring> springs, double size,
                                    Random& random) {
  std::vector<Vec3d> all(rest.size());
  const Cloud cloud = cloud_of(rest);
  if (!(cloud.size > 0)) return all;
  std::vector<Vec3d> forces(cloud.vertices.size());
  for (const Wave& wave : random_waves(random, cloud.size)) {
    for (std::size_t i = 0; i < forces.size(); ++i)
      forces[i] = forces[i] + wave.force * sin_turns(dot(wave.along, cloud.from_centre[i]) + wave.phase);
  }
  for (const auto& piece : pieces_of(cloud, rest.size(), springs)) keep_in_place(piece, cloud, forces);
  scale_to(forces, size);
  for (std::size_t i = 0; i < forces.size(); ++i) all[cloud.vertices[i]] = forces[i];
  return all;
}

}  // namespace supple
