#include "program_2007/program_2007.hpp"

#include <fmt/core.h>

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/files.hpp"
#include "supple/error.hpp"
#include "supple/inspection.hpp"
#include "table1/table1_runs.hpp"
#include "table1/table1_scenes.hpp"
#include "work.hpp"

namespace supple::experiments {
namespace {

namespace fs = std::filesystem;

constexpr double longest_search = 120;  // simulated seconds

Simulation simulation_of(BoundingVolume volume, std::uint64_t seed) {
  Variant variant{{}, volume};
  variant.method.scene.contacts = ContactKinds::none;
  cli::Input input = read_scene(mixed_scene(9), {}, seed);
  return build_variant(input, variant);
}

/// A collision of two objects, at the step with the most pairs of leaves of the second after its begin.
struct Collision {
  ObjectId a, b;
  std::uint64_t step = 0;
};

std::size_t leaf_pairs(const NodePairList& list) {
  std::size_t count = 0;
  for (const NodePairList::Pair& pair : list.pairs) count += list.is_leaf_pair(pair);
  return count;
}

Collision find_collision(std::uint64_t seed) {
  Simulation simulation = simulation_of(BoundingVolume::aabb, seed);
  std::optional<Collision> found;
  std::size_t most = 0;
  std::uint64_t last = 0;
  while (simulation.time() < longest_search) {
    const DetectResult& result = simulation.step();
    if (!found && simulation.time() > 1 && !result.narrow_phase_events.begin.empty()) {
      const auto& pair = result.narrow_phase_events.begin.front();
      found = Collision{pair.a, pair.b, simulation.step_count()};
      last = simulation.step_count() + 50;
    }
    if (!found) continue;
    const std::size_t pairs = leaf_pairs(SceneInspector(simulation.scene()).node_pairs(found->a, found->b));
    if (pairs > most) {
      most = pairs;
      found->step = simulation.step_count();
    }
    if (simulation.step_count() >= last) return *found;
  }
  throw Error(fmt::format("figures: with the seed {} no objects collide in {} s; give another --seed", seed,
                          longest_search));
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

const std::vector<std::string> region_columns{"level", "number", "x", "y", "z", "edge", "leaf", "objects"};

std::vector<Cell> region_row(const SceneRegion& region) {
  return {std::uint64_t{region.level},   region.number,
          double{region.box.min.x},      double{region.box.min.y},
          double{region.box.min.z},      double{region.box.max.x} - double{region.box.min.x},
          std::uint64_t{region.is_leaf}, std::uint64_t{region.object_count}};
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

/// The boxes of the leaves that collide, each once.
void add_boxes(std::uint64_t frame, const Collision& collision, const NodePairList& list, Table& table) {
  std::array<std::vector<bool>, 2> in{std::vector<bool>(list.nodes_a.size()),
                                      std::vector<bool>(list.nodes_b.size())};
  for (const NodePairList::Pair& pair : list.pairs) {
    if (!list.is_leaf_pair(pair)) continue;
    in[0][pair.a] = true;
    in[1][pair.b] = true;
  }
  for (const std::size_t side : {0u, 1u}) {
    const auto& nodes = side == 0 ? list.nodes_a : list.nodes_b;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (!in[side][i]) continue;
      const auto& [low, high] = nodes[i].box;
      table.add({frame, std::uint64_t{side == 0 ? collision.a.index : collision.b.index},
                 std::uint64_t{nodes[i].level}, double{low.x}, double{low.y}, double{low.z}, double{high.x},
                 double{high.y}, double{high.z}});
    }
  }
}

void write_meshes(const fs::path& path, const std::vector<cli::InputObject>& objects) {
  std::string text;
  std::size_t first = 1;
  for (const cli::InputObject& object : objects) {
    text += fmt::format("o {}\n", object.mesh.name);
    for (const Vec3d& p : object.mesh.positions) text += fmt::format("v {} {} {}\n", p.x, p.y, p.z);
    for (const Triangle& t : object.mesh.triangles)
      text += fmt::format("f {} {} {}\n", first + t[0], first + t[1], first + t[2]);
    first += object.mesh.positions.size();
  }
  write_file(path, text);
}

}  // namespace

Results run_figures(const Request& request) {
  const int frames = request.quick ? 10 : 60;  // one per step, around the collision of figures 3 to 5
  const fs::path& folder = request.folder;
  make_folder(folder);
  Work work(3, request.show_progress);
  const Collision collision = find_collision(request.seed);
  work.done(1, "a collision");

  Modules modules;
  std::optional<Simulation> with_boxes;
  modules.precomputation =
      seconds_of([&] { with_boxes.emplace(simulation_of(BoundingVolume::aabb, request.seed)); });
  Simulation with_spheres = simulation_of(BoundingVolume::sphere, request.seed);
  const auto half = static_cast<std::uint64_t>(frames) / 2;
  const std::uint64_t first = collision.step > half ? collision.step - half : 0;
  Table snapshot{"figures_2", region_columns}, regions{"figures_regions", region_columns};
  regions.columns.insert(regions.columns.begin(), "frame");
  Table spheres{"figures_spheres", {"frame", "object", "x", "y", "z", "radius"}},
      boxes{"figures_boxes", {"frame", "object", "level", "x0", "y0", "z0", "x1", "y1", "z1"}};
  std::optional<Table> descent;
  std::string positions;
  for (std::uint64_t step = 1; step < first + static_cast<std::uint64_t>(frames); ++step) {
    modules.step(*with_boxes);
    with_spheres.step();
    if (step < first) continue;
    const std::uint64_t frame = step - first;
    const SceneInspector of_boxes(with_boxes->scene()), of_spheres(with_spheres.scene());
    for (const SceneRegion& region : of_spheres.regions()) {
      std::vector<Cell> row = region_row(region);
      if (step == collision.step) snapshot.add(row);
      row.insert(row.begin(), frame);
      regions.add(std::move(row));
    }
    for (const ObjectId id : with_spheres.scene().objects()) {
      const BoundingSphere sphere = of_spheres.cells(id, 0).front().sphere;
      spheres.add({frame, std::uint64_t{id.index}, double{sphere.center.x}, double{sphere.center.y},
                   double{sphere.center.z}, double{sphere.radius}});
      for (const Vec3d& p : with_spheres.positions(id)) {
        const std::array<float, 3> xyz{static_cast<float>(p.x), static_cast<float>(p.y),
                                       static_cast<float>(p.z)};
        positions.append(reinterpret_cast<const char*>(xyz.data()), sizeof xyz);
      }
    }
    const NodePairList list = of_boxes.node_pairs(collision.a, collision.b);
    add_boxes(frame, collision, list, boxes);
    if (step == collision.step) descent = descent_table(list);
  }
  work.done(1, "frames");
  const cli::Input input = read_scene(mixed_scene(9), {}, request.seed);
  write_meshes(folder / "figures.obj", input.objects);
  write_file(folder / "figures_positions.f32", positions);
  work.done(1, "files");

  const auto name = [&](ObjectId id) { return input.objects[id.index].mesh.name; };
  return {{modules_table(modules), std::move(snapshot), std::move(descent.value()), std::move(regions),
           std::move(spheres), std::move(boxes)},
          {{"frames", fmt::format("{}", frames)},
           {"middle", fmt::format("{}", collision.step - first)},
           {"objects", fmt::format("{} {}", collision.a.index, collision.b.index)},
           {"collision", fmt::format("{} and {} at {:.2f} s", name(collision.a), name(collision.b),
                                     static_cast<double>(collision.step) * input.simulation.time_step)},
           {"cube", fmt::format("{}", *edge_of(input))}}};
}

}  // namespace supple::experiments
