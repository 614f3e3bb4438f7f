#include "studies/studies.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <string>

#include "studies/shape_pair.hpp"
#include "supple/comparison.hpp"
#include "supple/models.hpp"

namespace supple::experiments {
namespace {

/// Two ways for two surfaces to meet.
struct Pose {
  const char* name;
  TriangleMesh (*place)(TriangleMesh mesh);
};
constexpr std::array<Pose, 2> poses{
    Pose{"crossing",
         [](TriangleMesh mesh) {
           return moved(turned(std::move(mesh)), {1, 0.125, 0.0625});
         }},
    Pose{"coinciding", [](TriangleMesh mesh) { return turned(std::move(mesh)); }}};

/// The number of triangle corners that are read to fit a sphere to each node: each triangle once per level.
double sphere_reads(const OctreeStatistics& octree) {
  double levels = 0;
  for (std::size_t level = 0; level < octree.leaves_by_level.size(); ++level)
    levels += static_cast<double>((level + 1) * octree.leaves_by_level[level]);
  return 3 * levels * octree.mean_leaf_size;
}

/// `frequencies`: of icospheres, which have 20 f² triangles, ascending.
void measure_vertices(const std::vector<std::uint32_t>& frequencies, int rounds, Work& work, Table& counts,
                      Table& times) {
  for (const std::uint32_t frequency : frequencies) {
    const TriangleMesh ball = make_icosphere(frequency), aside = moved(ball, {4, 0, 0});
    const std::uint64_t vertices = ball.positions.size();
    const auto add_times = [&](const char* what, const std::vector<double>& seconds, double objects) {
      for (std::size_t round = 0; round < seconds.size(); ++round)
        times.add({std::string(what), vertices, std::uint64_t{round}, seconds[round] / objects});
    };
    work.done(1, fmt::format("spheres around a ball of {} triangles", ball.triangles.size()));
    SceneOptions spheres{.bounding_volume = BoundingVolume::sphere};
    add_times("refit, a sphere in each node",
              cost_of_pair(ball, aside, octree_of_2007(), std::min(rounds, 3), spheres).refit, 2);
    spheres.comparison.lazy_refit = true;
    add_times("refit, the sphere of the object",
              cost_of_pair(ball, aside, octree_of_2007(), rounds, spheres).refit, 2);
    for (const Pose& pose : poses) {
      work.done(1, fmt::format("two balls of {} triangles, {}", ball.triangles.size(), pose.name));
      const PairCost cost = cost_of_pair(ball, pose.place(ball), octree_of_2007(), rounds,
                                         {.comparison = {.descent = Descent::one_side_first}});
      if (&pose == &poses.front()) {
        add_times("build", cost.build, 2);
        add_times("refit, boxes", cost.refit, 2);
      }
      add_times(pose.name, cost.traversal, 1);
      counts.add({std::string(pose.name), vertices, std::uint64_t{ball.triangles.size()},
                  std::uint64_t{cost.octree_a.depth}, cost.stats.node_pairs_visited, cost.stats.boxes_tested,
                  cost.stats.candidate_pairs, static_cast<double>(cost.stats.triangles_refitted) / 2,
                  sphere_reads(cost.octree_a)});
    }
  }
}

}  // namespace

Results run_scaling(const Request& request) {
  BroadPhasesOptions broad_phases;
  broad_phases.seed = request.seed;
  std::vector<std::uint32_t> frequencies{8, 16, 32, 64, 128, 224};
  if (request.quick) {
    frequencies.resize(4);
    broad_phases.object_counts = {3, 6, 9, 100, 200, 1000, 3162, 10'000};
    broad_phases.longest_step = 0.2;
    broad_phases.rounds = 5;
  }
  Work work(2 * broad_phases.object_counts.size() + 3 * frequencies.size(), request.show_progress);
  Results results{{measure_broad_phases(broad_phases, work)}};
  Table counts{"scaling_vertices",
               {"pose", "vertices", "triangles", "depth", "node_pairs", "tests", "candidates",
                "triangles_refitted", "sphere_reads"}},
      times{"scaling_vertices_times", {"quantity", "vertices", "round", "seconds"}};
  measure_vertices(frequencies, request.quick ? 3 : 7, work, counts, times);
  results.tables.push_back(std::move(counts));
  results.tables.push_back(std::move(times));
  return results;
}

}  // namespace supple::experiments
