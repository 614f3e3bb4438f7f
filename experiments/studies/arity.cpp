#include "studies/studies.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <vector>

#include "studies/box_field.hpp"
#include "studies/shape_pair.hpp"
#include "supple/broad_phase.hpp"
#include "supple/models.hpp"
#include "work.hpp"

namespace supple::experiments {
namespace {

constexpr std::array<std::uint32_t, 3> arities{2, 4, 8};

double least(const std::vector<double>& seconds) {
  return *std::min_element(seconds.begin(), seconds.end());
}

/// Sums over the poses of a case with trees of `arity` children.
void measure(const PosedPair& poses, std::uint32_t arity, std::uint32_t leaf_size, int rounds, Table& objects,
             Table& colliding) {
  ObjectOctreeOptions octree;
  octree.arity = arity;
  octree.leaf_size = leaf_size;
  std::uint64_t tests = 0, node_pairs = 0;
  double refit = 0, traversal = 0;
  CollidingChildren children;
  PairCost cost;
  for (const TriangleMesh& b : poses.b) {
    cost = cost_of_pair(poses.a, b, octree, rounds);
    tests += cost.stats.boxes_tested;
    node_pairs += cost.stats.node_pairs_visited;
    refit += least(cost.refit) / static_cast<double>(poses.b.size());
    traversal += least(cost.traversal);
    if (leaf_size == 1) children += colliding_children(poses.a, b, octree);
  }
  const OctreeStatistics &a = cost.octree_a, &b = cost.octree_b;
  objects.add({poses.name, std::uint64_t{leaf_size}, std::uint64_t{arity}, a.nodes + b.nodes,
               std::uint64_t{std::max(a.depth, b.depth)}, (mean_depth(a) + mean_depth(b)) / 2,
               (a.mean_node_width + b.mean_node_width) / 2, a.bytes + b.bytes, node_pairs, tests, refit,
               traversal});
  if (leaf_size == 1)
    colliding.add({poses.name, std::uint64_t{arity}, children.nodes, children.children, children.above,
                   std::uint64_t{children.most}});
}

void measure_scene(std::uint32_t arity, std::size_t count, int rounds, std::uint64_t seed, Table& table) {
  BoxField field(count, seed);
  BroadPhaseOptions broad_phase_options;
  broad_phase_options.scene_octree.arity = arity;
  broad_phase_options.method = BroadPhaseMethod::octree;
  broad_phase_options.threads = 1;
  BroadPhase broad_phase(broad_phase_options);
  const double first = seconds_of([&] { broad_phase.find_object_pairs(field.boxes()); });
  std::vector<double> steps;
  std::uint64_t pairs = 0, regions = 0;
  for (int round = 0; round < rounds; ++round) {
    field.move();
    steps.push_back(seconds_of([&] { pairs = broad_phase.find_object_pairs(field.boxes()).size(); }));
  }
  std::uint32_t depth = 0;
  for (const SceneRegion& region : broad_phase.regions()) {
    ++regions;
    depth = std::max(depth, region.level);
  }
  table.add({std::uint64_t{count}, std::uint64_t{arity}, regions, std::uint64_t{depth},
             broad_phase.stats().object_pairs_tested, pairs, first, least(steps)});
}

}  // namespace

Results run_arity(const Request& request) {
  const int rounds = request.quick ? 3 : 5;
  std::vector<PosedPair> all = posed_pairs(!request.quick, request.quick ? 32 : 128);
  const std::uint32_t rings = request.quick ? 128 : 512;
  const TriangleMesh torus = make_torus(rings, rings / 2);
  all.push_back(posed_pair(fmt::format("tori of {} triangles", torus.triangles.size()), torus, torus,
                           {{0.1, 0, 0}, {0.5, 0, 0.1}, {0.9, 0.1, 0}}));
  std::vector<std::size_t> box_counts{1000, 10'000, 100'000};
  if (request.quick) box_counts.pop_back();
  Work work((2 * all.size() + box_counts.size()) * arities.size(), request.show_progress);
  Table objects{"arity_objects",
                {"objects", "leaf_size", "arity", "nodes", "depth", "mean_depth", "children_per_node",
                 "bytes", "node_pairs", "tests", "refit_seconds", "traversal_seconds"}},
      colliding{"arity_colliding_children", {"objects", "arity", "nodes", "children", "above_half", "most"}},
      scenes{"arity_scene",
             {"boxes", "arity", "regions", "depth", "tests", "pairs", "first_seconds", "step_seconds"}};
  for (const std::uint32_t leaf_size : {1u, ObjectOctreeOptions{}.leaf_size}) {
    for (const PosedPair& poses : all) {
      for (const std::uint32_t arity : arities) {
        work.done(1, fmt::format("{}, {} children", poses.name, arity));
        measure(poses, arity, leaf_size, rounds, objects, colliding);
      }
    }
  }
  for (const std::size_t count : box_counts) {
    for (const std::uint32_t arity : arities) {
      work.done(1, fmt::format("scene tree of {} boxes, {} children", count, arity));
      measure_scene(arity, count, rounds, request.seed, scenes);
    }
  }
  return {{std::move(objects), std::move(colliding), std::move(scenes)}};
}

}  // namespace supple::experiments
