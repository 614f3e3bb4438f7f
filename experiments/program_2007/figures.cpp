#include "program_2007/program_2007.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "supple/error.hpp"
#include "supple/inspection.hpp"
#include "table1/table1_runs.hpp"
#include "table1/table1_scenes.hpp"
#include "work.hpp"

namespace supple::experiments {
namespace {

constexpr double longest_search = 120;  // simulated seconds

Simulation simulation_of(BoundingVolume volume, std::uint64_t seed) {
  Variant variant{{}, volume};
  variant.method.scene.contacts = ContactKinds::none;
  cli::Input input = read_scene(mixed_scene(9), {}, seed);
  return build_variant(input, variant);
}

/// The processor seconds of each module, over the steps of a simulation.
struct Modules {
  double precomputation = 0, motion = 0, broad = 0, narrow = 0;
  std::uint64_t steps = 0;

  void step(Simulation& simulation) {
    const double seconds = seconds_of([&] { simulation.step(); });
    const StepStats& stats = simulation.scene().result().stats;
    const double share = seconds / (simulation.motion_seconds() + stats.total_seconds);  // of the wall clock
    ++steps;
    motion += share * simulation.motion_seconds();
    broad += share * (stats.refit_seconds + stats.broad_phase_seconds);
    narrow += share * (stats.traversal_seconds + stats.sort_and_events_seconds);
  }
};

Table modules_table(const Modules& modules) {
  Table table{"figures_1", {"module", "seconds", "per"}};
  const auto steps = static_cast<double>(modules.steps);
  table.add({"pre-computation", modules.precomputation, "program"});
  table.add({"physical simulation", modules.motion / steps, "step"});
  table.add({"broad phase", modules.broad / steps, "step"});
  table.add({"narrow phase", modules.narrow / steps, "step"});
  return table;
}

Table regions_table(const std::vector<SceneRegion>& regions) {
  Table table{"figures_2", {"level", "number", "x", "y", "z", "edge", "leaf", "objects"}};
  for (const SceneRegion& region : regions)
    table.add({std::uint64_t{region.level}, region.number, double{region.box.min.x}, double{region.box.min.y},
               double{region.box.min.z}, double{region.box.max.x} - double{region.box.min.x},
               std::uint64_t{region.is_leaf}, std::uint64_t{region.object_count}});
  return table;
}

Table descent_table(const NodePairList& list) {
  Table table{"figures_4", {"level", "pairs", "nodes_a", "nodes_b", "leaf_pairs"}};
  for (std::uint32_t level = 0; level < list.level_count(); ++level) {
    std::vector<bool> in_a(list.nodes_a.size()), in_b(list.nodes_b.size());
    std::uint64_t leaves = 0, of_a = 0, of_b = 0;
    for (const NodePairList::Pair& pair : list.pairs_of(level)) {
      of_a += !in_a[pair.a];
      of_b += !in_b[pair.b];
      in_a[pair.a] = in_b[pair.b] = true;
      leaves += list.is_leaf_pair(pair);
    }
    table.add({std::uint64_t{level}, std::uint64_t{list.pairs_of(level).size()}, of_a, of_b, leaves});
  }
  return table;
}

}  // namespace

Results run_figures(const Request& request) {
  const std::uint64_t frames = request.quick ? 10 : 60;  // one per step, around the collision
  Work work(1, request.show_progress);
  Modules modules;
  std::optional<Simulation> boxes;
  modules.precomputation =
      seconds_of([&] { boxes.emplace(simulation_of(BoundingVolume::aabb, request.seed)); });
  Simulation spheres = simulation_of(BoundingVolume::sphere, request.seed);
  const SceneInspector of_boxes(boxes->scene()), of_spheres(spheres.scene());

  // The first objects that collide, at the step with the most pairs of leaves of the second after.
  Results results;
  std::optional<ObjectPair> pair;
  std::ptrdiff_t most = 0;
  for (auto last = std::numeric_limits<std::uint64_t>::max(); boxes->step_count() < last;) {
    if (boxes->time() >= longest_search)
      throw Error(fmt::format("figures: with the seed {} no objects collide in {} s; give another --seed",
                              request.seed, longest_search));
    modules.step(*boxes);
    spheres.step();
    const Scene& scene = boxes->scene();
    const auto& begin = scene.result().narrow_phase_events.begin;
    if (!pair && boxes->time() > 1 && !begin.empty()) {
      pair = begin.front();
      last = boxes->step_count() + 50;
    }
    if (!pair) continue;
    const NodePairList list = of_boxes.node_pairs(pair->a, pair->b);
    const auto leaves =
        std::ranges::count_if(list.pairs, [&](const auto& nodes) { return list.is_leaf_pair(nodes); });
    if (leaves <= most) continue;
    most = leaves;
    const std::uint64_t step = boxes->step_count(), first = step - frames / 2;
    const Aabb a = of_boxes.bounds(pair->a), b = of_boxes.bounds(pair->b);
    const Vec3f place = (a.min + a.max + b.min + b.max) * 0.25f;
    results = {{Table{}, regions_table(of_spheres.regions()), descent_table(list)},
               {{"frames", fmt::format("{}-{}", first, first + frames - 1)},
                {"step", fmt::format("{}", step)},
                {"objects", fmt::format("{} {}", pair->a.index, pair->b.index)},
                {"place", fmt::format("{} {} {}", place.x, place.y, place.z)},
                {"collision", fmt::format("{} and {} at {:.2f} s", scene.options(pair->a).name,
                                          scene.options(pair->b).name, boxes->time())}}};
  }
  results.tables.front() = modules_table(modules);
  work.done(1, "a collision");
  return results;
}

}  // namespace supple::experiments
