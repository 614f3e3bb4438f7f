#include "studies/studies.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "studies/box_field.hpp"
#include "studies/colliding_children.hpp"
#include "studies/shape_pair.hpp"
#include "supple/broad_phase.hpp"
#include "supple/models.hpp"
#include "work.hpp"

namespace supple::experiments {
namespace {

constexpr std::array<std::uint32_t, 3> arities{2, 4, 8};

/// Two objects in several poses relative to each other.
struct Case {
  std::string name;
  TriangleMesh a;
  std::vector<TriangleMesh> b;
};

Case case_of(const std::string& name, const TriangleMesh& a, const TriangleMesh& b,
             std::vector<Vec3d> offsets) {
  Case result{name, a, {}};
  for (const Vec3d& offset : offsets) result.b.push_back(moved(turned(b), offset));
  return result;
}

std::vector<Case> cases(const ArityOptions& options) {
  const std::vector<Vec3d> offsets{{0.1, 0.05, 0.1}, {0.3, 0.1, 0.05}, {0.55, 0.15, 0.1}};
  const std::vector<Vec3d> crossing{{0.25, 0, 0}, {1, 0.125, 0.0625}, {1.75, 0.25, 0}};
  const auto pair = [&](const char* a, const char* b) {
    const std::string name = a == std::string_view(b) ? fmt::format("{}s", a) : fmt::format("{}, {}", a, b);
    return case_of(name, make_model(a), make_model(b), offsets);
  };
  std::vector<Case> all{pair("pawn", "fish"), pair("rabbit", "rabbit"), pair("human", "human")};
  if (options.with_bikes) all.push_back(pair("bike", "bike"));
  const TriangleMesh ball = make_icosphere(options.frequency),
                     torus = make_torus(options.rings, options.rings / 2);
  all.push_back(case_of(fmt::format("balls of {} triangles", ball.triangles.size()), ball, ball, crossing));
  all.push_back(case_of(fmt::format("tori of {} triangles", torus.triangles.size()), torus, torus,
                        {{0.1, 0, 0}, {0.5, 0, 0.1}, {0.9, 0.1, 0}}));
  return all;
}

double least(const std::vector<double>& seconds) {
  return *std::min_element(seconds.begin(), seconds.end());
}

/// Sums over the poses of a case with trees of `arity` children.
void measure(const Case& poses, std::uint32_t arity, std::uint32_t leaf_size, int rounds, Table& objects,
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
    if (leaf_size == 1) children += colliding_children(node_pairs_of(poses.a, b, octree), arity);
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

void measure_scene(std::uint32_t arity, std::size_t count, const ArityOptions& options, Table& table) {
  BoxField field(count, options.seed);
  BroadPhaseOptions broad_phase_options;
  broad_phase_options.scene_octree.arity = arity;
  broad_phase_options.method = BroadPhaseMethod::octree;
  broad_phase_options.threads = 1;
  BroadPhase broad_phase(broad_phase_options);
  const double first = seconds_of([&] { broad_phase.find_object_pairs(field.boxes()); });
  std::vector<double> steps;
  std::uint64_t pairs = 0, regions = 0;
  for (int round = 0; round < options.rounds; ++round) {
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

double mean_depth(const OctreeStatistics& octree) {
  double sum = 0;
  for (std::size_t level = 0; level < octree.leaves_by_level.size(); ++level)
    sum += static_cast<double>(level) * static_cast<double>(octree.leaves_by_level[level]);
  return octree.leaves == 0 ? 0 : sum / static_cast<double>(octree.leaves);
}

ArityOptions arity_options(bool quick) {
  ArityOptions options;
  if (!quick) return options;
  options.frequency = 32;
  options.rings = 128;
  options.with_bikes = false;
  options.box_counts = {1000, 10'000};
  options.rounds = 3;
  return options;
}

Results run_arity(const ArityOptions& options, bool show_progress) {
  const std::vector<Case> all = cases(options);
  Work work((2 * all.size() + options.box_counts.size()) * arities.size(), show_progress);
  Table objects{"arity_objects",
                {"objects", "leaf_size", "arity", "nodes", "depth", "mean_depth", "children_per_node",
                 "bytes", "node_pairs", "tests", "refit_seconds", "traversal_seconds"}},
      colliding{"arity_colliding_children", {"objects", "arity", "nodes", "children", "above_half", "most"}},
      scenes{"arity_scene",
             {"boxes", "arity", "regions", "depth", "tests", "pairs", "first_seconds", "step_seconds"}};
  for (const std::uint32_t leaf_size : {1u, ObjectOctreeOptions{}.leaf_size}) {
    for (const Case& poses : all) {
      for (const std::uint32_t arity : arities) {
        work.done(1, fmt::format("{}, {} children", poses.name, arity));
        measure(poses, arity, leaf_size, options.rounds, objects, colliding);
      }
    }
  }
  for (const std::size_t count : options.box_counts) {
    for (const std::uint32_t arity : arities) {
      work.done(1, fmt::format("scene tree of {} boxes, {} children", count, arity));
      measure_scene(arity, count, options, scenes);
    }
  }
  return {"arity",
          {{"seed", fmt::format("{}", options.seed)},
           {"poses of each case", fmt::format("{}", all.front().b.size())}},
          {std::move(objects), std::move(colliding), std::move(scenes)}};
}

}  // namespace supple::experiments
