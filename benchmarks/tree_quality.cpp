// The benefit of rebuilding degraded octrees: each cell has a scene with rebuilds and one without, which run
// frame by frame in turn. `supple_tree_quality soup roll --frames 400 --continuous`

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

#include "supple/inspection.hpp"
#include "supple/supple.hpp"
#include "workloads/degrading_shapes.hpp"

namespace supple::benchmarks {
namespace {

struct Choice {
  std::vector<std::string> cells;
  std::size_t frames = 400;
  std::uint32_t threads = 1;
  bool continuous = false;
};

/// Processor time of the calling process in milliseconds.
double cpu_milliseconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

/// A scene and the times of its steps.
struct Contestant {
  Contestant(const DegradingShapes& shapes, const Choice& choice, bool rebuilds) : scene(options_of(choice)) {
    for (const auto& shape : shapes.shapes()) {
      ObjectOptions options;
      options.self_collision = shape.self_collision;
      options.octree.rebuild_degraded = rebuilds;
      objects.push_back(scene.add(shape.rest, options));
    }
  }

  static SceneOptions options_of(const Choice& choice) {
    SceneOptions options;
    options.threads = choice.threads;
    options.contact_points = false;
    if (choice.continuous) options.contacts = ContactKinds::continuous;
    return options;
  }

  void step(const DegradingShapes& shapes) {
    const double before = cpu_milliseconds();
    for (std::size_t i = 0; i < objects.size(); ++i) {
      scene.set_positions(objects[i], shapes.shapes()[i].positions);
    }
    const StepStats& stats = scene.detect().stats;
    const double taken = cpu_milliseconds() - before;
    milliseconds += taken;
    longest = std::max(longest, taken);
    refit += 1e3 * stats.refit_seconds;
    rebuild += 1e3 * stats.rebuild_seconds;
    traversal += 1e3 * stats.traversal_seconds;
    octrees += stats.octrees_rebuilt;
    triangles += stats.triangles_rebuilt;
    candidates += stats.candidate_pairs + stats.vertex_face_candidates + stats.edge_edge_candidates;
  }

  /// The sum over all octrees of the visits of a query, by the surface area heuristic.
  void add_costs() {
    for (const ObjectId object : objects) visits += SceneInspector(scene).octree_statistics(object).cost;
  }

  Scene scene;
  std::vector<ObjectId> objects;
  double milliseconds = 0, longest = 0, refit = 0, rebuild = 0, traversal = 0, visits = 0;
  std::uint64_t octrees = 0, triangles = 0, candidates = 0;
};

void check_equal(const DetectResult& p, const DetectResult& q) {
  if (std::equal(p.contacts.begin(), p.contacts.end(), q.contacts.begin(), q.contacts.end()) &&
      std::equal(p.continuous_contacts.begin(), p.continuous_contacts.end(), q.continuous_contacts.begin(),
                 q.continuous_contacts.end())) {
    return;
  }
  throw Error("contacts differ in frame " + std::to_string(p.step));
}

void run_cell(const std::string& cell, const Choice& choice) {
  DegradingShapes shapes(cell);
  Contestant built(shapes, choice, true), kept(shapes, choice, false);
  for (std::size_t frame = 0; frame < choice.frames; ++frame) {
    (frame % 2 == 0 ? built : kept).step(shapes);
    (frame % 2 == 0 ? kept : built).step(shapes);
    check_equal(built.scene.result(), kept.scene.result());
    built.add_costs();
    kept.add_costs();
    shapes.advance();
  }
  const double frames = static_cast<double>(choice.frames);
  const auto print = [&](const Contestant& side, const char* name) {
    std::printf("%-8s %-6s %9.3f %9.3f %9.3f %9.3f %9.3f %9.0f %7llu %11llu %13llu %6.2f\n", cell.c_str(),
                name, side.milliseconds / frames, side.refit / frames, side.rebuild / frames,
                side.traversal / frames, side.longest, side.visits / frames,
                static_cast<unsigned long long>(side.octrees),
                static_cast<unsigned long long>(side.triangles),
                static_cast<unsigned long long>(side.candidates), side.milliseconds / kept.milliseconds);
  };
  print(kept, "kept");
  print(built, "built");
  std::fflush(stdout);
}

Choice choice_of(int argument_count, char** arguments) {
  Choice choice;
  for (int i = 1; i < argument_count; ++i) {
    const std::string argument = arguments[i];
    const bool has_value = i + 1 < argument_count;
    if (argument == "--frames" && has_value)
      choice.frames = std::max(1ul, std::strtoul(arguments[++i], nullptr, 10));
    else if (argument == "--threads" && has_value)
      choice.threads = static_cast<std::uint32_t>(std::strtoul(arguments[++i], nullptr, 10));
    else if (argument == "--continuous")
      choice.continuous = true;
    else if (argument.starts_with("-"))
      throw Error("usage: supple_tree_quality [--frames N] [--threads N] [--continuous] [CELL...]");
    else
      choice.cells.push_back(argument);
  }
  if (choice.cells.empty()) {
    choice.cells.assign(DegradingShapes::names().begin(), DegradingShapes::names().end());
  }
  return choice;
}

void run(const Choice& choice) {
  std::printf("%-8s %-6s %9s %9s %9s %9s %9s %9s %7s %11s %13s %6s\n", "cell", "octree", "ms", "refit",
              "rebuild", "traverse", "longest", "visits", "octrees", "triangles", "candidates", "ratio");
  for (const std::string& cell : choice.cells) run_cell(cell, choice);
}

}  // namespace
}  // namespace supple::benchmarks

int main(int argument_count, char** arguments) {
  try {
    supple::benchmarks::run(supple::benchmarks::choice_of(argument_count, arguments));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "supple_tree_quality: %s\n", error.what());
    return 1;
  }
  return 0;
}
