#include "studies/studies.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "plain/plain_broad_phase.hpp"
#include "studies/box_field.hpp"
#include "supple/broad_phase.hpp"
#include "supple/comparison.hpp"
#include "supple/error.hpp"

namespace supple::experiments {
namespace {

/// A method while it follows the boxes.
struct Following {
  std::function<std::size_t(const std::vector<Aabb>&)> step;  ///< the number of pairs
  std::function<std::uint64_t()> tests;                       ///< of the last step; of sweep3, exchanges
};

Following of_library(const BroadPhaseOptions& options) {
  const auto broad_phase = std::make_shared<BroadPhase>(options);
  return {[=](const std::vector<Aabb>& boxes) { return broad_phase->find_object_pairs(boxes).size(); },
          [=] {
            const BroadPhaseStats& stats = broad_phase->stats();
            return options.method == BroadPhaseMethod::sweep3 ? stats.exchanges : stats.object_pairs_tested;
          }};
}
Following of_library(BroadPhaseMethod method) {
  BroadPhaseOptions options;
  options.method = method;
  options.threads = 1;
  return of_library(options);
}
Following plain(std::shared_ptr<PlainBroadPhase> program) {
  return {[=](const std::vector<Aabb>& boxes) { return program->step(boxes); },
          [=] { return program->tests(); }};
}

struct Method {
  const char* name;
  bool is_quadratic;  ///< or may be
  Following (*start)(const BoxField& field);
};
constexpr std::array methods{
    Method{"octree of 2007", true,
           [](const BoxField& field) { return of_library(broad_phase_of_2007(field)); }},
    Method{"octree of 2007, level-allowed grows", false,
           [](const BoxField& field) { return of_library(broad_phase_of_2007(field, true)); }},
    Method{"octree", false, [](const BoxField&) { return of_library(BroadPhaseMethod::octree); }},
    Method{"grid", false, [](const BoxField&) { return of_library(BroadPhaseMethod::grid); }},
    Method{"sweep", false, [](const BoxField&) { return of_library(BroadPhaseMethod::sweep); }},
    Method{"sweep3", true, [](const BoxField&) { return of_library(BroadPhaseMethod::sweep3); }},
    Method{"brute force", true, [](const BoxField&) { return of_library(BroadPhaseMethod::brute); }},
    Method{"plain octree", true,
           [](const BoxField& field) {
             const RootCube cube = field.cube();
             return plain(
                 plain_octree(cube.corner, cube.edge, broad_phase_of_2007(field).scene_octree.max_level));
           }},
    Method{"plain sweep3", true, [](const BoxField&) { return plain(plain_three_lists()); }},
    Method{"plain sweep", true, [](const BoxField&) { return plain(plain_sweep()); }},
    Method{"plain brute force", true, [](const BoxField&) { return plain(plain_brute_force()); }}};

constexpr std::size_t stride_of_few = 100;

/// All methods in turn. `longest[m]`: the seconds of the slowest step of a method so far; those that would
/// take too long at `skipped[m]` are left out.
void measure_methods(std::size_t count, std::size_t stride, const BroadPhasesOptions& options,
                     const std::vector<bool>& skipped, std::vector<double>& longest, Table& table) {
  BoxField field(count, options.seed, stride);
  const std::size_t steps = std::max<std::size_t>(30'000 / count, 1);
  const int rounds =
      count < 100'000 ? options.rounds : std::min(options.rounds, 5);  // long steps have little noise
  std::vector<std::optional<Following>> all(methods.size());
  for (int round = 0; round <= rounds; ++round) {
    std::vector<std::vector<Aabb>> frames;
    for (std::size_t step = 0; step < (round == 0 ? 1 : steps); ++step) {
      field.move();
      frames.push_back(field.boxes());
    }
    std::optional<std::size_t> pairs;
    for (std::size_t m = 0; m < methods.size(); ++m) {
      if (skipped[m]) continue;
      if (round == 0) all[m] = methods[m].start(field);
      std::size_t found = 0;
      const double seconds = seconds_of([&] {
                               for (const std::vector<Aabb>& boxes : frames) found = all[m]->step(boxes);
                             }) /
                             static_cast<double>(frames.size());
      if (pairs.value_or(found) != found)
        throw Error(fmt::format("{}: found {} pairs of {} boxes, other methods {}", methods[m].name, found,
                                count, *pairs));
      pairs = found;
      longest[m] = std::max(longest[m], seconds);
      table.add({std::string(methods[m].name), std::string(stride == 1 ? "all" : "1 %"), std::uint64_t{count},
                 static_cast<std::uint64_t>(round), seconds, all[m]->tests(), std::uint64_t{found}});
    }
  }
}

}  // namespace

Table measure_broad_phases(const BroadPhasesOptions& options, Work& work) {
  Table table{"scaling_broad_phase", {"method", "moving", "boxes", "round", "seconds", "tests", "pairs"}};
  for (const std::size_t stride : {std::size_t{1}, stride_of_few}) {
    std::vector<double> longest(methods.size());
    std::vector<bool> skipped(methods.size());
    std::size_t before = 0;
    for (const std::size_t boxes : options.object_counts) {
      work.done(1, fmt::format("broad phase of {} boxes", boxes));
      if (stride > 1 && (boxes < 100 || boxes > 31'623)) continue;
      const double growth = before == 0 ? 1 : static_cast<double>(boxes) / static_cast<double>(before);
      for (std::size_t m = 0; m < methods.size(); ++m) {
        skipped[m] =
            skipped[m] || (methods[m].is_quadratic && longest[m] * growth * growth > options.longest_step);
        longest[m] = 0;
      }
      measure_methods(boxes, stride, options, skipped, longest, table);
      before = boxes;
    }
  }
  return table;
}

}  // namespace supple::experiments
