#include "studies/studies.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "plain/plain_broad_phase.hpp"
#include "program_2007/replay.hpp"
#include "studies/box_field.hpp"
#include "studies/shape_pair.hpp"
#include "supple/broad_phase.hpp"
#include "supple/models.hpp"
#include "supple/option_descriptions.hpp"
#include "supple/scene.hpp"
#include "work.hpp"

namespace supple::experiments {
namespace {

VolumeArrays volumes_of(const ClaimsOptions& options) {
  VolumeArrays volumes;
  const BoxField field(options.volumes, options.seed);
  for (const Aabb& box : field.boxes()) {
    float squares = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const auto k = static_cast<std::size_t>(axis);
      volumes.low[k].push_back(box.min[axis]);
      volumes.high[k].push_back(box.max[axis]);
      volumes.center[k].push_back((box.min[axis] + box.max[axis]) / 2);
      squares += (box.max[axis] - box.min[axis]) * (box.max[axis] - box.min[axis]) / 4;
    }
    volumes.radius.push_back(std::sqrt(squares));
  }
  return volumes;
}

constexpr std::uint32_t bit(bool value) {
  return value ? 1 : 0;
}

/// The number of boxes that overlap box i: six comparisons each. Pointers and constants outside of the loop
/// let compilers vectorize both tests.
std::uint32_t overlapping_boxes(const VolumeArrays& v, std::size_t i) {
  const std::array low{v.low[0].data(), v.low[1].data(), v.low[2].data()};
  const std::array high{v.high[0].data(), v.high[1].data(), v.high[2].data()};
  const float low_x = low[0][i], low_y = low[1][i], low_z = low[2][i];
  const float high_x = high[0][i], high_y = high[1][i], high_z = high[2][i];
  std::uint32_t count = 0;
  for (std::size_t j = 0; j < v.radius.size(); ++j) {
    count += bit(low[0][j] <= high_x) & bit(high[0][j] >= low_x) & bit(low[1][j] <= high_y) &
             bit(high[1][j] >= low_y) & bit(low[2][j] <= high_z) & bit(high[2][j] >= low_z);
  }
  return count;
}

/// The number of spheres that overlap sphere i: four multiplications, six additions and a comparison each.
std::uint32_t overlapping_spheres(const VolumeArrays& v, std::size_t i) {
  const std::array center{v.center[0].data(), v.center[1].data(), v.center[2].data()};
  const float* const radius = v.radius.data();
  const float center_x = center[0][i], center_y = center[1][i], center_z = center[2][i], radius_i = radius[i];
  std::uint32_t count = 0;
  for (std::size_t j = 0; j < v.radius.size(); ++j) {
    const float x = center[0][j] - center_x, y = center[1][j] - center_y, z = center[2][j] - center_z,
                reach = radius[j] + radius_i;
    count += x * x + y * y + z * z <= reach * reach;
  }
  return count;
}

/// Adds a row for a regular octree whose leaves are single triangles.
void add_depth(const char* surface, const TriangleMesh& mesh, std::uint64_t size, Table& table) {
  Scene scene;
  const OctreeStatistics octree = SceneInspector(scene).octree_statistics(
      scene.add(mesh, ObjectOptions{.octree = {.leaf_size = 1, .build = ObjectOctreeBuild::regular}}));
  table.add({std::string(surface), octree.triangles, size, std::uint64_t{octree.depth}, mean_depth(octree)});
}

/// Section 5.2: one test of two boxes, and of two spheres, by code with vectors and without.
Table cost_of_tests(const ClaimsOptions& options) {
  struct Code {
    const char *code, *volume;
    std::uint32_t (*count)(const VolumeArrays&, std::size_t);
  };
  constexpr std::array codes{
      Code{"vectors", "boxes", overlapping_boxes}, Code{"vectors", "spheres", overlapping_spheres},
      Code{"scalar", "boxes", plain_overlapping_boxes},
      Code{"scalar", "boxes without branches", plain_overlapping_boxes_without_branches},
      Code{"scalar", "spheres", plain_overlapping_spheres}};
  const VolumeArrays volumes = volumes_of(options);
  const std::uint64_t tests = std::uint64_t{options.volumes} * options.volumes;
  Table table{"claims_tests", {"code", "volume", "round", "seconds", "tests", "overlaps"}};
  for (int round = 0; round < options.rounds; ++round) {
    for (const Code& code : codes) {
      std::uint64_t found = 0;
      const double seconds = seconds_of([&] {
        for (std::size_t i = 0; i < options.volumes; ++i) found += code.count(volumes, i);
      });
      table.add({std::string(code.code), std::string(code.volume), static_cast<std::uint64_t>(round), seconds,
                 tests, found});
    }
  }
  return table;
}

/// Section 5.1: regions against spheres by both tests in turn, with a new octree and with one that follows.
Table region_tests(const ClaimsOptions& options) {
  BroadPhaseOptions broad_phase_options;
  broad_phase_options.method = BroadPhaseMethod::octree;
  broad_phase_options.scene_octree.expand_at = 2;
  broad_phase_options.threads = 1;
  std::array<std::unique_ptr<BroadPhase>, 2> following;
  const auto make = [&](std::size_t test) {
    broad_phase_options.scene_octree.region_sphere_test = static_cast<RegionSphereTest>(test);
    return std::make_unique<BroadPhase>(broad_phase_options);
  };
  for (std::size_t test = 0; test < 2; ++test) following[test] = make(test);
  BoxField field(options.spheres, options.seed);
  std::vector<BoundingSphere> spheres(options.spheres);
  Table table{"claims_regions", {"test", "round", "fresh_seconds", "step_seconds", "placements", "pairs"}};
  for (int round = 0; round <= options.rounds; ++round) {
    for (std::size_t i = 0; i < spheres.size(); ++i) {
      const Aabb& box = field.boxes()[i];
      spheres[i].radius = 0;
      for (int axis = 0; axis < 3; ++axis) {
        spheres[i].center[axis] = (box.min[axis] + box.max[axis]) / 2;
        spheres[i].radius = std::max(spheres[i].radius, (box.max[axis] - box.min[axis]) / 2);
      }
    }
    for (std::size_t test = 0; test < 2; ++test) {
      const auto fresh = make(test);
      std::uint64_t pairs = 0, placements = 0;
      const double of_fresh = seconds_of([&] { fresh->find_object_pairs(spheres); });
      const double of_step = seconds_of([&] { pairs = following[test]->find_object_pairs(spheres).size(); });
      for (const SceneRegion& region : following[test]->regions()) placements += region.object_count;
      // The first step of the octree that follows is that of a new one.
      if (round > 0)
        table.add({std::string(words<RegionSphereTest>[test]), static_cast<std::uint64_t>(round), of_fresh,
                   of_step, placements, pairs});
    }
    field.move();
  }
  return table;
}

/// Section 7: spheres of smaller and smaller triangles, and sheets of more and more triangles of one size.
/// `size` is that of the object in triangles.
Table depths(const ClaimsOptions& options) {
  Table table{"claims_depths", {"surface", "triangles", "size", "depth", "mean_depth"}};
  for (std::uint32_t f = 4; f <= options.largest_frequency; f *= 2)
    add_depth("sphere", make_icosphere(f), 2 * f, table);
  for (std::uint32_t n = 8; n <= 4 * options.largest_frequency; n *= 2)
    add_depth("sheet", make_cloth(n, n, n, n), n, table);
  return table;
}

/// Sections 5 and 7: boxes by the number of regions that they overlap, with regions as long as the longest
/// box.
Table regions_of_objects(const ClaimsOptions& options) {
  constexpr std::size_t most = 8;
  const BoxField field(options.spheres, options.seed);
  std::array<std::uint64_t, most + 1> with{};
  for (const Aabb& box : field.boxes()) {
    std::size_t regions = 1;
    for (int axis = 0; axis < 3; ++axis)
      regions *= std::floor(box.min[axis]) == std::floor(box.max[axis]) ? 1 : 2;
    ++with[regions];
  }
  Table table{"claims_object_regions", {"regions", "boxes"}};
  for (std::size_t regions = 1; regions <= most; regions *= 2)
    table.add({std::uint64_t{regions}, with[regions]});
  return table;
}

/// Section 5.1: the sphere of eq. 3 and 4, and that of eq. 5, around the models of the paper.
Table spheres_of_the_equations(const ClaimsOptions&) {
  Table table{"claims_spheres", {"model", "radius_box", "radius_vertices", "outside", "vertices"}};
  for (const char* const model : models) {
    const std::vector<Vec3d> positions = make_model(model).positions;
    const auto [low, high] = bounds_of(positions);
    const Vec3d edges = high - low;
    const double of_box = std::max({edges.x, edges.y, edges.z}) / 2;
    const Vec3d center_of_box = low + Vec3d{of_box, of_box, of_box};
    double of_vertices = 0;
    std::uint64_t outside = 0;
    for (const Vec3d& p : positions) {
      of_vertices = std::max(of_vertices, norm(p - (low + high) * 0.5));
      outside += norm(p - center_of_box) > of_box;
    }
    table.add({std::string(model), of_box, of_vertices, outside, std::uint64_t{positions.size()}});
  }
  return table;
}

}  // namespace

Results run_claims(const Request& request) {
  ClaimsOptions options{.seed = request.seed};
  if (request.quick)
    options = {.volumes = 2048,
               .spheres = 10'000,
               .largest_frequency = 32,
               .motion_seconds = 2,
               .rounds = 3,
               .seed = request.seed};
  constexpr std::array measurements{cost_of_tests,
                                    region_tests,
                                    depths,
                                    regions_of_objects,
                                    spheres_of_the_equations,
                                    translation_of_volumes,
                                    loops,
                                    steps_of_models,
                                    energies_of_integrators,
                                    areas_and_strains};
  Work work(measurements.size(), request.show_progress);
  Results results;
  for (const auto measure : measurements) work.done(1, results.tables.emplace_back(measure(options)).name);
  return results;
}

}  // namespace supple::experiments
