#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/vector.hpp"
#include "supple/models.hpp"
#include "supple/motion.hpp"
#include "support/soups.hpp"

namespace supple {

constexpr Integrator all_integrators[] = {Integrator::verlet, Integrator::symplectic_euler,
                                          Integrator::backward_euler};

/// A vertical chain with vertices `length` apart. A triangle with a repeated id acts as an edge.
inline TriangleMesh chain(std::uint32_t vertices, double length) {
  TriangleMesh mesh{"chain", {}, {}};
  for (std::uint32_t v = 0; v < vertices; ++v) {
    mesh.positions.push_back({0, -length * v, 0});
    if (v > 0) mesh.triangles.push_back({v - 1, v, v});
  }
  return mesh;
}

/// Two vertices on the x axis at ±length / 2.
inline TriangleMesh one_spring(double length) {
  return {"spring", {{-0.5 * length, 0, 0}, {0.5 * length, 0, 0}}, {{0, 1, 1}}};
}

inline std::vector<Vec3d> random_vectors(std::size_t count, double size, std::uint64_t seed) {
  RandomNumbers random(seed);
  std::vector<Vec3d> vectors;
  for (std::size_t i = 0; i < count; ++i) {
    vectors.push_back(random.vector(size));
  }
  return vectors;
}

/// Stretches along x, contracts along y and adds random offsets.
inline std::vector<Vec3d> deformed(const TriangleMesh& mesh, double stretch, double shake,
                                   std::uint64_t seed) {
  std::vector<Vec3d> positions = mesh.positions;
  const std::vector<Vec3d> noise = random_vectors(positions.size(), shake, seed);
  for (std::size_t v = 0; v < positions.size(); ++v) {
    const Vec3d p = positions[v];
    positions[v] = Vec3d{(1 + stretch) * p.x, p.y / (1 + stretch), p.z} + noise[v];
  }
  return positions;
}

inline double largest_difference(std::span<const Vec3d> a, std::span<const Vec3d> b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, norm(a[i] - b[i]));
  return largest;
}

inline void run(MassSpringBody& body, double seconds, int steps) {
  for (int i = 0; i < steps; ++i) body.step(seconds / steps);
}

}  // namespace supple
