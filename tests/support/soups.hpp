#pragma once

#include <cmath>
#include <cstdint>

#include "supple/mesh.hpp"
#include "support/random.hpp"

namespace supple {

/// Separate triangles of about `size` in a cube with half side `extent` around `center`.
inline TriangleMesh random_soup(std::uint32_t count, double extent, double size, std::uint64_t seed,
                                Vec3d center = {}) {
  RandomNumbers random(seed);
  TriangleMesh mesh;
  mesh.name = "soup";
  for (std::uint32_t t = 0; t < count; ++t) {
    const Vec3d p = center + random.vector(extent);
    for (int corner = 0; corner < 3; ++corner) mesh.positions.push_back(p + random.vector(size));
    mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  return mesh;
}

/// A sheet of columns × rows squares with shared vertices, crumpled so that it intersects itself.
inline TriangleMesh crumpled_sheet(std::uint32_t columns, std::uint32_t rows, double roughness,
                                   std::uint64_t seed) {
  RandomNumbers random(seed);
  TriangleMesh mesh;
  mesh.name = "crumpled sheet";
  for (std::uint32_t r = 0; r <= rows; ++r) {
    for (std::uint32_t c = 0; c <= columns; ++c) {
      mesh.positions.push_back(Vec3d{c / double(columns), 0, r / double(rows)} + random.vector(roughness));
    }
  }
  const std::uint32_t stride = columns + 1;
  for (std::uint32_t r = 0; r < rows; ++r) {
    for (std::uint32_t c = 0; c < columns; ++c) {
      const std::uint32_t p = r * stride + c;
      mesh.triangles.push_back({p, p + stride, p + 1});
      mesh.triangles.push_back({p + 1, p + stride, p + stride + 1});
    }
  }
  return mesh;
}

}  // namespace supple
