#include "studies/shape_pair.hpp"

#include <fmt/core.h>

#include <array>
#include <utility>

#include "supple/models.hpp"
#include "supple/scene.hpp"
#include "work.hpp"

namespace supple::experiments {
namespace {

ObjectOptions regular(ObjectOctreeOptions octree) {
  octree.build = ObjectOctreeBuild::regular;
  return ObjectOptions{.octree = octree};
}

}  // namespace

TriangleMesh turned(TriangleMesh mesh) {
  // The quaternion (5, 1, 2, 2) / √34.
  constexpr double w = 5, x = 1, y = 2, z = 2, n = w * w + x * x + y * y + z * z;
  const std::array<Vec3d, 3> rows{
      Vec3d{(n - 2 * (y * y + z * z)) / n, 2 * (x * y - w * z) / n, 2 * (x * z + w * y) / n},
      Vec3d{2 * (x * y + w * z) / n, (n - 2 * (x * x + z * z)) / n, 2 * (y * z - w * x) / n},
      Vec3d{2 * (x * z - w * y) / n, 2 * (y * z + w * x) / n, (n - 2 * (x * x + y * y)) / n}};
  const auto product = [](Vec3d row, Vec3d p) { return row.x * p.x + row.y * p.y + row.z * p.z; };
  for (Vec3d& p : mesh.positions) p = {product(rows[0], p), product(rows[1], p), product(rows[2], p)};
  return mesh;
}

TriangleMesh moved(TriangleMesh mesh, Vec3d offset) {
  for (Vec3d& p : mesh.positions) p = p + offset;
  return mesh;
}

PosedPair posed_pair(std::string name, const TriangleMesh& a, const TriangleMesh& b,
                     const std::vector<Vec3d>& offsets) {
  PosedPair pair{std::move(name), a, {}};
  for (const Vec3d& offset : offsets) pair.b.push_back(moved(turned(b), offset));
  return pair;
}

std::vector<PosedPair> posed_pairs(bool with_bikes, std::uint32_t frequency) {
  std::vector<PosedPair> all;
  const auto add = [&](const char* name, const char* a, const char* b) {
    all.push_back(posed_pair(name, make_model(a), make_model(b),
                             {{0.1, 0.05, 0.1}, {0.3, 0.1, 0.05}, {0.55, 0.15, 0.1}}));
  };
  add("pawn, fish", "pawn", "fish");
  add("rabbits", "rabbit", "rabbit");
  add("humans", "human", "human");
  if (with_bikes) add("bikes", "bike", "bike");
  const TriangleMesh ball = make_icosphere(frequency);
  all.push_back(posed_pair(fmt::format("balls of {} triangles", ball.triangles.size()), ball, ball,
                           {{0.25, 0, 0}, {1, 0.125, 0.0625}, {1.75, 0.25, 0}}));
  return all;
}

PairCost cost_of_pair(const TriangleMesh& a, const TriangleMesh& b, const ObjectOctreeOptions& octree,
                      int rounds, const SceneOptions& given) {
  SceneOptions options = given;
  options.contacts = ContactKinds::none;
  options.threads = 1;
  Scene scene(options);
  const ObjectOptions object = regular(octree);
  PairCost cost;
  ObjectId id_a, id_b;
  do {
    if (!cost.build.empty()) {
      scene.remove(id_a);
      scene.remove(id_b);
    }
    cost.build.push_back(seconds_of([&] {
      id_a = scene.add(a, object);
      id_b = scene.add(b, object);
    }));
  } while (cost.build.size() < 3);
  cost.octree_a = SceneInspector(scene).octree_statistics(id_a);
  cost.octree_b = SceneInspector(scene).octree_statistics(id_b);
  std::array<std::vector<Vec3d>, 2> places_a{a.positions, moved(a, {0x1p-30, 0, 0}).positions},
      places_b{b.positions, moved(b, {0, 0x1p-30, 0}).positions};
  scene.detect();
  for (int round = 1; round <= rounds; ++round) {
    scene.set_positions(id_a, places_a[static_cast<std::size_t>(round % 2)]);
    scene.set_positions(id_b, places_b[static_cast<std::size_t>(round % 2)]);
    const TimedDetection detection(scene);
    cost.stats = detection.result->stats;
    cost.refit.push_back(detection.refit);
    cost.traversal.push_back(detection.narrow);
  }
  return cost;
}

double mean_depth(const OctreeStatistics& octree) {
  double sum = 0;
  for (std::size_t level = 0; level < octree.leaves_by_level.size(); ++level)
    sum += static_cast<double>(level) * static_cast<double>(octree.leaves_by_level[level]);
  return octree.leaves == 0 ? 0 : sum / static_cast<double>(octree.leaves);
}

CollidingChildren colliding_children(const TriangleMesh& a, const TriangleMesh& b,
                                     const ObjectOctreeOptions& octree) {
  Scene scene(SceneOptions{.contacts = ContactKinds::none});
  const ObjectId id_a = scene.add(a, regular(octree)), id_b = scene.add(b, regular(octree));
  scene.detect();
  return colliding_children(SceneInspector(scene).node_pairs(id_a, id_b), octree.arity);
}

}  // namespace supple::experiments
