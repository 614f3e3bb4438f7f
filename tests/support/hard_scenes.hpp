#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <ostream>
#include <vector>

#include "support/soups.hpp"

namespace supple {

/// Makes objects of a scene with one kind of degeneracy.
struct Family {
  const char* name;
  std::function<std::vector<TriangleMesh>(std::uint64_t seed)> make;
};
/// GoogleTest calls this function; ctest shows the name.
inline void PrintTo(const Family& family, std::ostream* out) {
  *out << family.name;
}

inline std::vector<TriangleMesh> random_soups(std::uint64_t seed) {
  return {random_soup(60, 1, 0.5, seed), random_soup(40, 1, 0.6, seed + 1, {0.5, 0, 0}),
          crumpled_sheet(6, 6, 0.12, seed + 2)};
}

/// Regular grids at heights that are equal or differ by one rounding step.
inline std::vector<TriangleMesh> near_touching_grids(std::uint64_t seed) {
  RandomNumbers random(seed);
  std::vector<TriangleMesh> meshes;
  for (int sheet = 0; sheet < 3; ++sheet) {
    TriangleMesh mesh = crumpled_sheet(4, 4, 0, 0);
    for (Vec3d& p : mesh.positions) {
      p.y = 0.75;
      const std::uint32_t way = random.below(3);
      if (way == 0) p.y = std::nextafter(p.y, 0);
      if (way == 1) p.y = std::nextafter(p.y, 1);
      if (sheet == 2) p.x += 0.125;
    }
    meshes.push_back(mesh);
  }
  return meshes;
}

inline std::vector<TriangleMesh> coplanar_stacks(std::uint64_t seed) {
  std::vector<TriangleMesh> meshes;
  RandomNumbers random(seed);
  for (int layer = 0; layer < 3; ++layer) {
    TriangleMesh mesh = random_soup(25, 1, 0.5, seed + layer);
    for (Vec3d& p : mesh.positions)
      p = {std::nearbyint(p.x * 4), std::nearbyint(p.y * 4), 1.0 * random.below(2)};
    meshes.push_back(mesh);
  }
  return meshes;
}

/// Nested copies of a sheet, two of them equal and one smaller by rounding only.
inline std::vector<TriangleMesh> nested(std::uint64_t seed) {
  std::vector<TriangleMesh> meshes;
  for (const double size : {1.0, 0.5, 1.0 - 0x1p-53, 1.0}) {
    TriangleMesh mesh = crumpled_sheet(3, 3, 0, seed);
    for (Vec3d& p : mesh.positions) p = {(p.x - 0.5) * size, (p.x + p.z - 1) * size, (p.z - 0.5) * size};
    meshes.push_back(mesh);
  }
  return meshes;
}

inline std::vector<TriangleMesh> duplicated(std::uint64_t seed) {
  TriangleMesh mesh = random_soup(20, 1, 0.7, seed);
  for (std::uint32_t t = 0; t < 20; ++t) mesh.triangles.push_back(mesh.triangles[t]);
  return {mesh, mesh};
}

/// Triangles on a coarse lattice; some are points or segments.
inline std::vector<TriangleMesh> zero_area(std::uint64_t seed) {
  std::vector<TriangleMesh> meshes;
  for (int object = 0; object < 2; ++object) {
    TriangleMesh mesh = random_soup(50, 1.2, 0.8, seed + object);
    RandomNumbers random(seed + 10);
    for (Vec3d& p : mesh.positions)
      p = {std::nearbyint(2 * p.x), std::nearbyint(2 * p.y), std::nearbyint(2 * p.z)};
    for (Triangle& triangle : mesh.triangles) {
      const std::uint32_t way = random.below(4);
      if (way == 0) mesh.positions[triangle[1]] = mesh.positions[triangle[0]];
      if (way == 1) triangle = {triangle[0], triangle[0], triangle[0]};
      if (way == 2) {
        mesh.positions[triangle[2]] = mesh.positions[triangle[0]] * 2 - mesh.positions[triangle[1]];
      }
    }
    meshes.push_back(mesh);
  }
  return meshes;
}

inline std::vector<TriangleMesh> scaled(std::uint64_t seed, double scale) {
  std::vector<TriangleMesh> meshes = random_soups(seed);
  for (TriangleMesh& mesh : meshes) {
    for (Vec3d& p : mesh.positions) p = p * scale;
  }
  return meshes;
}

/// Ordinary triangles; some have a corner near 1e30, others are scaled by 1e-30.
inline std::vector<TriangleMesh> mixed_scales(std::uint64_t seed) {
  std::vector<TriangleMesh> meshes = random_soups(seed);
  RandomNumbers random(seed);
  for (TriangleMesh& mesh : meshes) {
    for (const Triangle& triangle : mesh.triangles) {
      const std::uint32_t way = random.below(8);
      if (way == 0) mesh.positions[triangle[0]] = mesh.positions[triangle[0]] * 1e30;
      if (way == 1) {
        for (const std::uint32_t vertex : triangle) mesh.positions[vertex] = mesh.positions[vertex] * 1e-30;
      }
    }
  }
  return meshes;
}

inline std::vector<TriangleMesh> with_non_finite(std::uint64_t seed) {
  std::vector<TriangleMesh> meshes = random_soups(seed);
  RandomNumbers random(seed);
  const double values[] = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                           -std::numeric_limits<double>::infinity()};
  for (TriangleMesh& mesh : meshes) {
    for (Vec3d& p : mesh.positions) {
      if (random.below(12) == 0) p[static_cast<int>(random.below(3))] = values[random.below(3)];
    }
  }
  return meshes;
}

inline std::vector<Family> hard_families() {
  return {
      {"RandomSoups", random_soups},
      {"NearTouchingGrids", near_touching_grids},
      {"CoplanarStacks", coplanar_stacks},
      {"Nested", nested},
      {"Duplicated", duplicated},
      {"ZeroArea", zero_area},
      {"Huge", [](std::uint64_t seed) { return scaled(seed, 1e30); }},
      {"Tiny", [](std::uint64_t seed) { return scaled(seed, 1e-30); }},
      {"BeyondFloat", [](std::uint64_t seed) { return scaled(seed, 1e200); }},
      {"BelowFloat", [](std::uint64_t seed) { return scaled(seed, 1e-200); }},
      {"Denormal", [](std::uint64_t seed) { return scaled(seed, 1e-318); }},
      {"MixedScales", mixed_scales},
      {"NonFinite", with_non_finite},
  };
}

}  // namespace supple
