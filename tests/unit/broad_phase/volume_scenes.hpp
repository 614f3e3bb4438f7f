#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "geometry/aabb.hpp"
#include "geometry/sphere.hpp"
#include "supple/broad_phase.hpp"
#include "supple/types.hpp"
#include "support/random.hpp"

namespace supple::test {

inline constexpr float infinity = std::numeric_limits<float>::infinity();

/// Random numbers in single precision.
class Random : public RandomNumbers {
 public:
  using RandomNumbers::RandomNumbers;
  float uniform(float low, float high) {
    return low + (high - low) * static_cast<float>(bits() >> 40) * 0x1p-24f;
  }
  Vec3f point(float low, float high) {
    const float x = uniform(low, high), y = uniform(low, high);
    return {x, y, uniform(low, high)};
  }
};

inline constexpr std::array all_methods{BroadPhaseMethod::automatic, BroadPhaseMethod::octree,
                                        BroadPhaseMethod::grid,      BroadPhaseMethod::sweep,
                                        BroadPhaseMethod::brute,     BroadPhaseMethod::sweep3};

/// The independent reference: tests every pair of volumes.
template <class Volume>
std::vector<IndexPair> double_loop(const std::vector<Volume>& volumes) {
  std::vector<IndexPair> pairs;
  for (std::uint32_t a = 0; a < volumes.size(); ++a)
    for (std::uint32_t b = a + 1; b < volumes.size(); ++b)
      if (!volumes[a].empty() && !volumes[b].empty() && overlap(volumes[a], volumes[b]))
        pairs.push_back({a, b});
  return pairs;
}

inline Aabb box_around(Vec3f center, Vec3f half) {
  return {{center.x - half.x, center.y - half.y, center.z - half.z},
          {center.x + half.x, center.y + half.y, center.z + half.z}};
}

struct NamedBoxes {
  std::string name;
  std::vector<Aabb> boxes;
};

inline std::vector<Aabb> random_boxes(std::size_t count, float side, float size, std::uint64_t seed) {
  Random random(seed);
  std::vector<Aabb> boxes;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3f center = random.point(0, side);
    boxes.push_back(box_around(center, random.point(0.1f * size, size)));
  }
  return boxes;
}

/// Clusters of boxes whose sizes follow a Pareto law, a few of them as large as the scene.
inline std::vector<Aabb> clustered_boxes(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Aabb> boxes;
  Vec3f cluster;
  for (std::size_t i = 0; i < count; ++i) {
    if (i % 64 == 0) cluster = random.point(-10, 10);
    const float size = 0.01f / std::sqrt(random.uniform(0.0001f, 1));
    boxes.push_back(box_around(cluster + random.point(-0.5f, 0.5f), random.point(0.5f * size, size)));
  }
  return boxes;
}

/// Unit cells that share faces, edges and corners: every neighbour touches.
inline std::vector<Aabb> lattice_boxes(int side) {
  std::vector<Aabb> boxes;
  for (int i = 0; i < side * side * side; ++i) {
    const Vec3f low{static_cast<float>(i % side), static_cast<float>(i / side % side),
                    static_cast<float>(i / side / side)};
    boxes.push_back({low, low + Vec3f{1, 1, 1}});
  }
  return boxes;
}

/// Degenerate scenes and ordinary ones.
inline std::vector<NamedBoxes> box_scenes() {
  std::vector<NamedBoxes> scenes;
  scenes.push_back({"none", {}});
  scenes.push_back({"one", {box_around({1, 2, 3}, {1, 1, 1})}});
  scenes.push_back({"only_empty", std::vector<Aabb>(5)});
  scenes.push_back({"random", random_boxes(600, 20, 0.8f, 1)});
  scenes.push_back({"dense", random_boxes(300, 4, 0.8f, 2)});
  scenes.push_back({"clustered", clustered_boxes(700, 3)});
  scenes.push_back({"lattice", lattice_boxes(7)});
  scenes.push_back(
      {"coincident", std::vector<Aabb>(150, box_around({0.3f, 0.3f, 0.3f}, {0.1f, 0.1f, 0.1f}))});
  scenes.push_back({"coincident_points", std::vector<Aabb>(90, box_around({0, 0, 0}, {0, 0, 0}))});

  NamedBoxes nested{"nested", {}};
  for (int i = 0; i < 60; ++i)
    nested.boxes.push_back(box_around({5, 5, 5}, Vec3f{1, 1, 1} * std::ldexp(1.0f, -i / 2)));
  scenes.push_back(nested);

  NamedBoxes giant{"giant_in_dust", random_boxes(500, 50, 0.05f, 4)};
  giant.boxes.insert(giant.boxes.begin() + 250, box_around({25, 25, 25}, {20, 20, 20}));
  scenes.push_back(giant);

  NamedBoxes flat{"flat", {}};
  Random random(5);
  for (int i = 0; i < 300; ++i)
    flat.boxes.push_back(box_around({random.uniform(0, 10), 3, random.uniform(0, 10)}, {0.3f, 0, 0.3f}));
  scenes.push_back(flat);

  NamedBoxes unbounded{"infinite", random_boxes(200, 10, 0.5f, 6)};
  unbounded.boxes[3] = {{-infinity, -infinity, -infinity}, {infinity, infinity, infinity}};
  unbounded.boxes[10] = {{5, -infinity, 5}, {6, infinity, 6}};
  unbounded.boxes[20] = {{infinity, infinity, infinity}, {infinity, infinity, infinity}};
  unbounded.boxes[30] = {{infinity, 1, 1}, {infinity, 9, 9}};
  unbounded.boxes[40] = {{-infinity, -infinity, -infinity}, {0, 0, 0}};
  unbounded.boxes[50] = {{3, 3, 3}, {infinity, infinity, infinity}};
  unbounded.boxes[60] = Aabb{};
  unbounded.boxes[61] = {{0, 0, 1}, {1, 1, 0}};
  scenes.push_back(unbounded);

  NamedBoxes huge{"scale_mixture", {}};
  for (int i = 0; i < 240; ++i) {
    const float scale = std::ldexp(1.0f, i - 120);
    huge.boxes.push_back(box_around(random.point(-scale, scale), Vec3f{1, 1, 1} * (scale * 0.25f)));
  }
  scenes.push_back(huge);

  NamedBoxes outliers{"far_outliers", random_boxes(400, 10, 0.3f, 7)};
  for (std::size_t i = 0; i < 5; ++i)
    outliers.boxes[40 * i] = box_around({1e30f, -1e35f, static_cast<float>(i) * 0.5f}, {1, 1, 0.3f});
  scenes.push_back(outliers);

  NamedBoxes distant{"far_from_origin", {}};
  for (int i = 0; i < 200; ++i)
    distant.boxes.push_back(box_around(Vec3f{1e7f, 1e7f, -1e7f} + random.point(-8, 8), {0.4f, 0.4f, 0.4f}));
  scenes.push_back(distant);
  return scenes;
}

/// Spheres at the centres of the boxes, with half the longest side as radius; empty for empty boxes.
inline std::vector<BoundingSphere> spheres_in(const std::vector<Aabb>& boxes) {
  std::vector<BoundingSphere> spheres;
  for (const Aabb& box : boxes) {
    BoundingSphere sphere;
    if (!box.empty()) {
      float width = 0;
      for (int axis = 0; axis < 3; ++axis) {
        sphere.center[axis] = 0.5f * box.min[axis] + 0.5f * box.max[axis];
        if (std::isnan(sphere.center[axis])) sphere.center[axis] = 0;
        const float side = box.max[axis] - box.min[axis];
        if (side > width) width = side;
      }
      sphere.radius = 0.5f * width;
    }
    spheres.push_back(sphere);
  }
  return spheres;
}

}  // namespace supple::test
