#include "studies/arity.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "base/text.hpp"
#include "judgement.hpp"
#include "studies/box_field.hpp"
#include "studies/colliding_children.hpp"
#include "studies/shape_pair.hpp"
#include "supple/broad_phase.hpp"
#include "supple/models.hpp"

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

/// Sums over the poses of one case with one arity.
struct Sum {
  std::uint64_t nodes = 0, bytes = 0, tests = 0, node_pairs = 0;
  std::uint32_t depth = 0;
  double mean_depth = 0, width = 0, seconds = 0, refit_seconds = 0;
  CollidingChildren colliding{};  ///< with leaves of one triangle
};

Sum measure(const Case& poses, std::uint32_t arity, std::uint32_t leaf_size, const ArityOptions& options) {
  Sum sum;
  for (const TriangleMesh& b : poses.b) {
    ObjectOctreeOptions octree;
    octree.arity = arity;
    octree.leaf_size = leaf_size;
    const PairCost cost = cost_of_pair(poses.a, b, octree, options.frames, options.threads);
    sum.nodes = cost.octree_a.nodes + cost.octree_b.nodes;
    sum.bytes = cost.octree_a.bytes + cost.octree_b.bytes;
    sum.depth = std::max(cost.octree_a.depth, cost.octree_b.depth);
    sum.mean_depth = (mean_depth(cost.octree_a) + mean_depth(cost.octree_b)) / 2;
    sum.width = (cost.octree_a.mean_node_width + cost.octree_b.mean_node_width) / 2;
    sum.tests += cost.stats.boxes_tested;
    sum.node_pairs += cost.stats.node_pairs_visited;
    if (leaf_size == 1) sum.colliding += colliding_children(node_pairs_of(poses.a, b, octree), arity);
    sum.seconds += cost.traversal_seconds;
    sum.refit_seconds += cost.refit_seconds / static_cast<double>(poses.b.size());
  }
  return sum;
}

/// Results by case and arity.
using Sums = std::vector<std::array<Sum, 3>>;

Sums measure_objects(const std::vector<Case>& all, std::uint32_t leaf_size, const ArityOptions& options,
                     Work& work, Table& table) {
  Sums sums;
  for (const Case& poses : all) {
    std::array<Sum, 3> row;
    for (std::size_t k = 0; k < arities.size(); ++k) {
      work.done(1, fmt::format("{}, {} children", poses.name, arities[k]));
      row[k] = measure(poses, arities[k], leaf_size, options);
      const Sum& sum = row[k];
      table.add({poses.name, std::uint64_t{leaf_size}, std::uint64_t{arities[k]}, sum.nodes,
                 std::uint64_t{sum.depth}, sum.mean_depth, sum.width, static_cast<double>(sum.bytes) / 1024,
                 sum.refit_seconds * 1e3, sum.node_pairs, sum.tests, sum.seconds * 1e3});
    }
    sums.push_back(row);
  }
  return sums;
}

struct SceneCost {
  double first_seconds = 0, step_seconds = 0;
  std::uint64_t regions = 0, tests = 0, pairs = 0;
  std::uint32_t depth = 0;
};

SceneCost cost_of_scene_tree(std::uint32_t arity, std::size_t count, const ArityOptions& options) {
  BoxField field(count, options.seed);
  BroadPhaseOptions broad_phase_options;
  broad_phase_options.scene_octree.arity = arity;
  broad_phase_options.method = BroadPhaseMethod::octree;
  broad_phase_options.threads = options.threads;
  BroadPhase broad_phase(broad_phase_options);
  SceneCost cost;
  cost.first_seconds = seconds_of([&] { broad_phase.find_object_pairs(field.boxes()); });
  std::vector<double> steps;
  for (int frame = 0; frame < options.frames; ++frame) {
    field.move();
    steps.push_back(seconds_of([&] { cost.pairs = broad_phase.find_object_pairs(field.boxes()).size(); }));
  }
  cost.step_seconds = least(steps);
  cost.tests = broad_phase.stats().object_pairs_tested;
  for (const SceneRegion& region : broad_phase.regions()) {
    ++cost.regions;
    cost.depth = std::max(cost.depth, region.level);
  }
  return cost;
}

using SceneCosts = std::vector<std::array<SceneCost, 3>>;

SceneCosts measure_scene_trees(const ArityOptions& options, Work& work, Table& table) {
  SceneCosts costs;
  for (const std::size_t count : options.box_counts) {
    std::array<SceneCost, 3> row;
    for (std::size_t k = 0; k < arities.size(); ++k) {
      work.done(1, fmt::format("scene tree of {} boxes, {} children", count, arities[k]));
      row[k] = cost_of_scene_tree(arities[k], count, options);
      table.add({std::uint64_t{count}, std::uint64_t{arities[k]}, row[k].regions, std::uint64_t{row[k].depth},
                 row[k].first_seconds * 1e3, row[k].step_seconds * 1e3, row[k].tests, row[k].pairs});
    }
    costs.push_back(row);
  }
  return costs;
}

/// The mean over the cases of a number divided by its value for eight children.
template <class Number>
std::array<double, 3> relative(const Sums& sums, Number&& number) {
  std::array<double, 3> mean{};
  for (const auto& row : sums)
    for (std::size_t k = 0; k < arities.size(); ++k)
      mean[k] += number(row[k]) / number(row[2]) / static_cast<double>(sums.size());
  return mean;
}

/// The quotient of a number with arity k and with arity j over the cases.
template <class Number>
Estimate quotient_of(const Sums& sums, std::size_t k, std::size_t j, Number&& number) {
  std::vector<double> quotients;
  for (const auto& row : sums) quotients.push_back(number(row[k]) / number(row[j]));
  return estimate_of(quotients);
}

template <class Number>
std::array<std::size_t, 3> fewest(const Sums& sums, Number&& number) {
  std::array<std::size_t, 3> wins{};
  for (const auto& row : sums) {
    const auto best = std::min_element(row.begin(), row.end(),
                                       [&](const Sum& a, const Sum& b) { return number(a) < number(b); });
    ++wins[static_cast<std::size_t>(best - row.begin())];
  }
  return wins;
}

double tests_of(const Sum& sum) {
  return static_cast<double>(sum.tests);
}
double seconds_of_sum(const Sum& sum) {
  return sum.seconds;
}

/// Volumes that a refit computes.
double volumes_of(const Sum& sum) {
  return static_cast<double>(sum.nodes) * sum.width;
}

Claim judge_better(const Sums& sums) {
  const auto tests = relative(sums, tests_of), volumes = relative(sums, volumes_of);
  const auto work = relative(sums, [](const Sum& sum) { return tests_of(sum) + volumes_of(sum); });
  const auto seconds = relative(sums, seconds_of_sum);
  const auto refit = relative(sums, [](const Sum& sum) { return sum.refit_seconds; });
  const auto fewest_tests = fewest(sums, tests_of), fastest = fewest(sums, seconds_of_sum);
  Claim claim{
      "four-and-eight", "2",
      "“For rigid bodies, binary trees are used, and for DO it has been shown that 4-ary trees or 8-ary "
      "trees give better performance” ([LAM01]). Read as: at least 5 % fewer volumes tested and "
      "refitted."};
  const std::size_t best = work[1] < work[2] ? 1 : 2;
  const Estimate gain =
      quotient_of(sums, best, 0, [](const Sum& sum) { return tests_of(sum) + volumes_of(sum); });
  claim.verdict = below(gain, 0.95);
  claim.number = gain;
  claim.quantity =
      fmt::format("volumes tested and refitted, {} children / two", best == 1 ? "four" : "eight");
  claim.reason = fmt::format(
      "Relative to eight children, tests of two volumes: {:.2f} with four children, {:.2f} with two. Volumes "
      "to refit: {:.2f} and {:.2f}. Both together: {:.2f} and {:.2f}. Of {} cases, two, four and eight "
      "children have the fewest tests in {}, {} and {}. Times: {:.2f} and {:.2f} for the traversal, {:.2f} "
      "and {:.2f} for the refit; two, four and eight children have the shortest traversal in {}, {} and {} "
      "cases. In Supple, nodes have room for eight children, which are tested at once. This favours eight "
      "children in time and is not a property of the tree. Counts do not depend on it.",
      tests[1], tests[0], volumes[1], volumes[0], work[1], work[0], sums.size(), fewest_tests[0],
      fewest_tests[1], fewest_tests[2], seconds[1], seconds[0], refit[1], refit[0], fastest[0], fastest[1],
      fastest[2]);
  return claim;
}

Claim judge_depth(const Sums& sums) {
  double octants = 0;
  for (const auto& row : sums) octants += row[2].width / static_cast<double>(sums.size());
  Claim claim{
      "log-k", "7",
      "“This phase can be changed using k-ary trees …, so that the complexity would change in the log_k n”: "
      "the depth with two children is three times the depth with eight, and with four children 1.5 "
      "times."};
  const auto depth_of = [](const Sum& sum) { return sum.mean_depth; };
  const Estimate of_two = quotient_of(sums, 0, 2, depth_of), of_four = quotient_of(sums, 1, 2, depth_of);
  claim.verdict = both(within(of_two, 3 * 0.8, 3 * 1.2), within(of_four, 1.5 * 0.8, 1.5 * 1.2));
  claim.number = of_two;
  claim.quantity = "depth with two children / with eight";
  claim.reason = fmt::format(
      "With leaves of one triangle, the mean depth with two children is {} times the depth with eight, "
      "and with four children {} times; 20 % are allowed. Nodes of up to eight children have {:.1f} children "
      "on average, "
      "because a surface leaves octants empty and small nodes contain few triangles. So an octree of a "
      "surface is deeper than the logarithm of base eight.",
      text_of(of_two), text_of(of_four), octants);
  return claim;
}

/// The claims say half of the arity.
std::array<Claim, 2> judge_colliding_children(const Sums& sums, Table& table) {
  Claim claim{
      "colliding-children", "6, 7",
      "“The maximum number of nodes colliding”: 4 of 8 children in octrees, 2 of 4 in quadtrees, 1 of 2 in "
      "binary trees.",
      Verdict::holds};
  std::vector<std::string> found;
  std::uint64_t most_of_eight = 0;
  for (std::size_t k = 0; k < arities.size(); ++k) {
    CollidingChildren sum;
    for (const auto& row : sums) sum += row[k].colliding;
    const double mean = static_cast<double>(sum.children) / static_cast<double>(sum.nodes),
                 percent = 100 * static_cast<double>(sum.above) / static_cast<double>(sum.nodes);
    table.add({std::uint64_t{arities[k]}, std::uint64_t{arities[k] / 2}, std::uint64_t{sum.most}, mean,
               percent, sum.nodes});
    if (sum.above > 0) claim.verdict = Verdict::does_not_hold;
    if (arities[k] == 8) {
      most_of_eight = sum.most;
      claim.number = Estimate{static_cast<double>(sum.most), NAN};
      claim.quantity = "of eight children, at most";
    }
    found.push_back(fmt::format(
        "With {} children, up to {} collide, {:.1f} on average, and more than {} in {:.0f} % of the nodes.",
        arities[k], sum.most, mean, arities[k] / 2, percent));
  }
  claim.reason = fmt::format(
      "Counted over the colliding pairs of nodes of all cases, with leaves of one triangle: the children of "
      "a "
      "node that overlap a child of the other node. {}",
      fmt::join(found, " "));
  const std::uint64_t steps = 8 + 8 * most_of_eight;
  return {
      std::move(claim),
      {"steps-of-a-level", "7", "“A maximum number of steps equals 8 + 4(8) = 8(4+1)” for one pair of nodes.",
       verdict_of(most_of_eight <= 4),
       fmt::format("With up to {} colliding children, the eight children against the other node and each of "
                   "these against its eight children are up to {} tests.",
                   most_of_eight, steps),
       Estimate{static_cast<double>(steps), NAN}, "tests of a pair of nodes, at most"}};
}

Claim judge_scene(const SceneCosts& costs) {
  Claim claim{
      "k-ary-scene", "7",
      "The broad phase “can be changed using k-ary trees to observe the performance”: all find the same "
      "pairs.",
      Verdict::holds};
  const auto& largest = costs.back();
  const auto ratio = [&](std::size_t k) { return largest[k].step_seconds / largest[2].step_seconds; };
  for (const auto& row : costs)
    if (row[0].pairs != row[2].pairs || row[1].pairs != row[2].pairs) claim.verdict = Verdict::does_not_hold;
  claim.reason = fmt::format(
      "For the largest scene, relative to eight children, a step takes {:.2f} times as long with four "
      "children and {:.2f} times with two; there are {:.2f} and {:.2f} times as many regions, and {:.2f} and "
      "{:.2f} times as many tests.",
      ratio(1), ratio(0), static_cast<double>(largest[1].regions) / static_cast<double>(largest[2].regions),
      static_cast<double>(largest[0].regions) / static_cast<double>(largest[2].regions),
      static_cast<double>(largest[1].tests) / static_cast<double>(largest[2].tests),
      static_cast<double>(largest[0].tests) / static_cast<double>(largest[2].tests));
  return claim;
}

Table objects_table() {
  return {"arity_objects",
          "Trees of objects",
          {{"objects", "Objects"},
           {"leaf_size", "Leaf size"},
           {"arity", "Children"},
           {"nodes", "Nodes"},
           {"depth", "Depth"},
           {"mean_depth", "mean"},
           {"children_per_node", "Children per node"},
           {"kib", "KiB"},
           {"refit_ms", "Refit ms"},
           {"node_pairs", "Node pairs"},
           {"tests", "Tests"},
           {"traversal_ms", "Traversal ms"}}};
}

Table colliding_table() {
  return {"arity_colliding_children",
          "Children of a node that collide with children of another node",
          {{"arity", "Children"},
           {"claimed", "Claimed maximum"},
           {"most", "Most"},
           {"mean", "Mean"},
           {"above_percent", "Above the claim %"},
           {"nodes", "Nodes"}}};
}

Table scene_table() {
  return {"arity_scene",
          "Trees of the scene",
          {{"boxes", "Boxes"},
           {"arity", "Children"},
           {"regions", "Regions"},
           {"depth", "Depth"},
           {"first_ms", "First step ms"},
           {"step_ms", "Step ms"},
           {"tests", "Tests"},
           {"pairs", "Pairs"}}};
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
  options.frames = 3;
  return options;
}

Report run_arity(const ArityOptions& options, bool show_progress) {
  const std::vector<Case> all = cases(options);
  Work work(2 * all.size() * arities.size() + options.box_counts.size() * arities.size(), show_progress);
  Table objects = objects_table(), scenes = scene_table(), colliding = colliding_table();
  const Sums single = measure_objects(all, 1, options, work, objects);
  const Sums usual = measure_objects(all, ObjectOctreeOptions{}.leaf_size, options, work, objects);
  const SceneCosts scene_costs = measure_scene_trees(options, work, scenes);

  Report report;
  report.name = "arity";
  report.title = "Trees of two, four and eight children";
  report.summary =
      "The same objects in the same poses, with trees that divide a cell into two, four or eight at each "
      "level. With leaves of one triangle, all three trees have the same leaves and differ only above them. "
      "The other leaves have up to 64 triangles, as by default. The contacts are the same for all trees.";
  report.parameters = {
      {"seed", fmt::format("{}", options.seed)},
      {"threads", options.threads == 0 ? "one per core" : fmt::format("{}", options.threads)},
      {"poses of each case",
       fmt::format("{}; node pairs, tests and times are sums over the poses", all.front().b.size())},
      {"steps", fmt::format("times are the minimum of {}", options.frames)}};
  auto [children, steps] = judge_colliding_children(single, colliding);
  report.claims = {judge_better(usual), judge_depth(single), std::move(children), std::move(steps),
                   judge_scene(scene_costs)};
  report.sections = {{"Trees of objects", {}, {std::move(colliding), std::move(objects)}},
                     {"Trees of the scene",
                      {"Boxes with sides of 0.5 to 1, one per eight units of volume, all in motion."},
                      {std::move(scenes)}}};
  return report;
}

}  // namespace supple::experiments
