#include "studies/scaling.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "base/text.hpp"
#include "judgement.hpp"
#include "studies/box_field.hpp"
#include "studies/shape_pair.hpp"
#include "supple/broad_phase.hpp"
#include "supple/comparison.hpp"
#include "supple/error.hpp"
#include "supple/models.hpp"

namespace supple::experiments {
namespace {

/// The methods of the broad phase, as indices of `methods`.
enum : std::size_t { octree_2007, octree, grid, sweep, brute };
constexpr std::array methods{BroadPhaseMethod::octree, BroadPhaseMethod::octree, BroadPhaseMethod::grid,
                             BroadPhaseMethod::sweep, BroadPhaseMethod::brute};
constexpr std::array<const char*, methods.size()> method_names{"octree of 2007", "octree", "grid",
                                                               "sweep and prune", "brute force"};

double n_log_n(double n) {
  return n * std::log(n);
}
/// 4^(log8 n) log n: the logarithms are of base 8 (section 6), so it is n^(2/3) log n.
double narrow_phase_formula(double n) {
  return std::pow(n, 2.0 / 3) * std::log(n);
}

/// Curves of one method against the number of objects.
struct BroadCurves {
  Points first_seconds, step_seconds, tests;
  std::vector<std::vector<double>> steps{};  ///< seconds of each step, by size
  bool stopped = false;                      ///< because the next size would take too long
};
using CurvesOfMethods = std::array<BroadCurves, methods.size()>;

struct BroadCost {
  double first_seconds = 0;
  std::vector<double> steps{};  ///< seconds
  std::uint64_t tests = 0, pairs = 0;
};

BroadCost cost_of_boxes(std::size_t method, std::size_t count, const ScalingOptions& options) {
  BoxField field(count, options.seed);
  BroadPhaseOptions broad_phase_options;
  if (method == octree_2007) broad_phase_options = broad_phase_of_2007(field);
  broad_phase_options.method = methods[method];
  broad_phase_options.threads = options.threads;
  BroadPhase broad_phase(broad_phase_options);
  BroadCost cost;
  cost.first_seconds = seconds_of([&] { broad_phase.find_object_pairs(field.boxes()); });
  if (cost.first_seconds < 0.1) {
    BroadPhase again(broad_phase_options);
    cost.first_seconds =
        std::min(cost.first_seconds, seconds_of([&] { again.find_object_pairs(field.boxes()); }));
  }
  // Long steps need no repetition, because they have little noise.
  const int frames = cost.first_seconds > 1 ? std::min(options.frames, 2) : options.frames;
  for (int frame = 0; frame < frames; ++frame) {
    field.move();
    cost.steps.push_back(
        seconds_of([&] { cost.pairs = broad_phase.find_object_pairs(field.boxes()).size(); }));
    cost.tests = broad_phase.stats().object_pairs_tested;
  }
  return cost;
}

/// All methods take the same steps, so the pairs of the last step must be equal.
bool measure_broad_phase(const ScalingOptions& options, Work& work, Table& table, CurvesOfMethods& curves) {
  bool same_pairs = true;
  for (const std::size_t count : options.object_counts) {
    std::optional<std::uint64_t> pairs;
    for (std::size_t m = 0; m < methods.size(); ++m) {
      work.done(1, fmt::format("{} boxes, {}", count, method_names[m]));
      const double n = static_cast<double>(count);
      if ((m == brute || m == octree_2007) && !curves[m].step_seconds.empty()) {
        const auto [last_n, last_seconds] = curves[m].step_seconds.back();
        curves[m].stopped =
            curves[m].stopped || last_seconds * (n / last_n) * (n / last_n) > options.brute_seconds;
      }
      if (curves[m].stopped) {
        table.add({std::string(method_names[m]), std::uint64_t{count}, {}, {}, {}, {}});
        continue;
      }
      const BroadCost cost = cost_of_boxes(m, count, options);
      curves[m].first_seconds.emplace_back(n, cost.first_seconds);
      curves[m].step_seconds.emplace_back(n, least(cost.steps));
      curves[m].steps.push_back(cost.steps);
      curves[m].tests.emplace_back(n, static_cast<double>(cost.tests));
      table.add({std::string(method_names[m]), std::uint64_t{count}, cost.first_seconds * 1e3,
                 least(cost.steps) * 1e3, cost.tests, cost.pairs});
      // A method with fewer steps is at another time of the motion.
      if (cost.first_seconds > 1) continue;
      same_pairs = same_pairs && pairs.value_or(cost.pairs) == cost.pairs;
      pairs = cost.pairs;
    }
  }
  return same_pairs;
}

/// Two ways for two surfaces to meet.
struct Pose {
  const char* name;
  const char* file_name;
  TriangleMesh (*place)(TriangleMesh mesh);
};

constexpr std::array<Pose, 2> poses{
    Pose{"crossing", "crossing",
         [](TriangleMesh mesh) {
           return moved(turned(std::move(mesh)), {1, 0.125, 0.0625});
         }},
    Pose{"coinciding", "coinciding", [](TriangleMesh mesh) { return turned(std::move(mesh)); }}};

struct NarrowCurves {
  Points tests, node_pairs, seconds;
};

struct ShapeCurves {
  std::array<NarrowCurves, 2> poses;
  Points build_seconds, refit_seconds, refit_reads, sphere_refit_seconds, sphere_refit_reads;
};

/// The number of triangle corners that are read to fit a sphere to each node and to the object: each triangle
/// once per level.
double sphere_reads(const OctreeStatistics& octree) {
  double levels = 0;
  for (std::size_t level = 0; level < octree.leaves_by_level.size(); ++level)
    levels += static_cast<double>((level + 1) * octree.leaves_by_level[level]);
  return 3 * levels * octree.mean_leaf_size;
}

void measure_shapes(const ScalingOptions& options, Work& work, Table& table, ShapeCurves& curves) {
  for (const std::uint32_t frequency : options.frequencies) {
    const TriangleMesh ball = make_icosphere(frequency);
    const double vertices = static_cast<double>(ball.positions.size());
    const int frames = ball.triangles.size() > 300'000 ? std::min(options.frames, 3) : options.frames;
    work.done(1, fmt::format("spheres about a ball of {} triangles", ball.triangles.size()));
    const PairCost spheres = cost_of_pair(ball, moved(ball, {4, 0, 0}), octree_of_2007(), std::min(frames, 2),
                                          options.threads, BoundingVolume::sphere);
    curves.sphere_refit_seconds.emplace_back(vertices, spheres.refit_seconds / 2);
    for (std::size_t p = 0; p < poses.size(); ++p) {
      work.done(1, fmt::format("two balls of {} triangles, {}", ball.triangles.size(), poses[p].name));
      const PairCost cost = cost_of_pair(ball, poses[p].place(ball), octree_of_2007(), frames,
                                         options.threads, BoundingVolume::aabb, Descent::one_side_first);
      NarrowCurves& pose = curves.poses[p];
      pose.tests.emplace_back(vertices, static_cast<double>(cost.stats.boxes_tested));
      pose.node_pairs.emplace_back(vertices, static_cast<double>(cost.stats.node_pairs_visited));
      pose.seconds.emplace_back(vertices, cost.traversal_seconds);
      if (p == 0) {
        curves.build_seconds.emplace_back(vertices, cost.build_seconds / 2);
        curves.refit_seconds.emplace_back(vertices, cost.refit_seconds / 2);
        curves.refit_reads.emplace_back(vertices, static_cast<double>(cost.stats.triangles_refitted) / 2);
        curves.sphere_refit_reads.emplace_back(vertices, sphere_reads(cost.octree_a));
      }
      table.add({std::string(poses[p].name), ball.positions.size(), ball.triangles.size(),
                 std::uint64_t{cost.octree_a.depth}, cost.build_seconds / 2 * 1e3,
                 cost.refit_seconds / 2 * 1e3, spheres.refit_seconds / 2 * 1e3, cost.traversal_seconds * 1e3,
                 cost.stats.node_pairs_visited, cost.stats.boxes_tested, cost.stats.candidate_pairs});
    }
  }
}

/// Seconds of a step of the other method divided by those of the octree, by size.
std::vector<Estimate> ratios(const BroadCurves& octree, const BroadCurves& other) {
  std::vector<Estimate> result;
  for (std::size_t i = 0; i < std::min(octree.steps.size(), other.steps.size()); ++i)
    result.push_back(ratio_of(other.steps[i], octree.steps[i]));
  return result;
}

std::string listed(const std::vector<Estimate>& values) {
  std::string text;
  for (const Estimate& value : values) text += (text.empty() ? "" : ", ") + text_of(value);
  return text;
}

Claim faster_than_brute(const CurvesOfMethods& curves) {
  const std::vector<Estimate> factors = ratios(curves[octree], curves[brute]);
  Claim claim{
      "better-than-brute-many", "7",
      "“Our Broad Phase method is better than the brute force Broad Phase”, for many objects and today's "
      "octree."};
  if (factors.empty()) return claim;
  claim.verdict = Verdict::holds;
  for (const Estimate& factor : factors) claim.verdict = both(claim.verdict, above(factor, 1));
  claim.number = factors.front();
  claim.quantity = fmt::format("time of brute force / of the octree, {} objects",
                               curves[octree].step_seconds.front().first);
  claim.reason = fmt::format("For a step, brute force takes {} times as long as the octree, for {} objects.",
                             listed(factors), sizes_of(curves[brute].step_seconds));
  if (claim.verdict == Verdict::does_not_hold)
    claim.reason += " For few objects, testing all pairs is less work than maintaining a tree.";
  return claim;
}

Claim comparable_with_sweep(const CurvesOfMethods& curves) {
  const std::vector<Estimate> factors = ratios(curves[octree], curves[sweep]);
  Claim claim{
      "like-sweep-many", "7",
      "“… and comparable with the sweep and prune method”, for many objects and today's octree. Read as: "
      "within a factor of two at every size."};
  if (factors.empty()) return claim;
  claim.verdict = Verdict::holds;
  for (const Estimate& factor : factors) claim.verdict = both(claim.verdict, within(factor, 0.5, 2));
  claim.number = factors.back();
  claim.quantity = fmt::format("time of sweep and prune / of the octree, {} objects",
                               curves[sweep].step_seconds.back().first);
  claim.reason =
      fmt::format("For a step, sweep and prune takes {} times as long as the octree, for {} objects.",
                  listed(factors), sizes_of(curves[sweep].step_seconds));
  if (claim.verdict == Verdict::does_not_hold && factors.back().mean > 2)
    claim.reason +=
        " As the scene grows in three directions, more and more boxes overlap along the swept axis.";
  return claim;
}

Claim less_than_quadratic(const Points& seconds, const Points& tests) {
  Claim claim{"below-quadratic", "8",
              "“The complexity of the algorithm in the Broad Phase is less than O(n²)”."};
  const PowerLaw time = fit_power_law(seconds), count = fit_power_law(tests);
  if (!(time.standard_error <= 0.25)) return claim;
  const Estimate exponent{time.exponent, time.standard_error};
  claim.verdict = both(below(exponent, 2), verdict_of(count.exponent < 2));
  claim.number = exponent;
  claim.quantity = "exponent of the time of a step";
  claim.reason = fmt::format(
      "With objects of similar size at constant density, the time of a step of the octree of 2007 grows with "
      "exponent {}, "
      "and its tests with {}. When all objects overlap, no method is better than n², because there are n² "
      "pairs to report.",
      text_of(time), text_of(count));
  return claim;
}

std::vector<Growth> broad_growths(const CurvesOfMethods& c) {
  const auto square = [](double n) { return n * n; };
  return {{"Octree of 2007, first step", "time", c[octree_2007].first_seconds, "n log n", n_log_n},
          {"Octree of 2007, step in motion", "time", c[octree_2007].step_seconds, "less than n²", square},
          {"Octree of 2007, step in motion", "tests", c[octree_2007].tests, "less than n²", square},
          {"Octree, first step", "time", c[octree].first_seconds, "n log n", n_log_n},
          {"Octree, step in motion", "time", c[octree].step_seconds, "less than n²", square},
          {"Octree, step in motion", "tests", c[octree].tests, "less than n²", square},
          {"Sweep and prune, first step", "time", c[sweep].first_seconds, "n log n", n_log_n},
          {"Sweep and prune, step in motion", "time", c[sweep].step_seconds, "n log n", n_log_n},
          {"Sweep and prune, step in motion", "tests", c[sweep].tests, "n log n", n_log_n},
          {"Brute force, step in motion", "time", c[brute].step_seconds, "n²", square},
          {"Brute force, step in motion", "tests", c[brute].tests, "n²", square},
          {"Grid, step in motion", "time", c[grid].step_seconds, "n log n", n_log_n},
          {"Grid, step in motion", "tests", c[grid].tests, "n log n", n_log_n}};
}

std::vector<Growth> shape_growths(const ShapeCurves& c) {
  const std::string formula = "4^(log8 n) log n";
  const auto linear = [](double n) { return n; };
  return {{"Surfaces that cross", "tests", c.poses[0].tests, formula, narrow_phase_formula},
          {"Surfaces that cross", "time", c.poses[0].seconds, formula, narrow_phase_formula},
          {"Surfaces that coincide", "tests", c.poses[1].tests, formula, narrow_phase_formula},
          {"Surfaces that coincide", "time", c.poses[1].seconds, formula, narrow_phase_formula},
          {"Building the octree", "time", c.build_seconds, "n log n", n_log_n},
          {"Refit with boxes", "time", c.refit_seconds, "n", linear},
          {"Refit with boxes", "triangles read", c.refit_reads, "n", linear},
          {"Refit with spheres about the vertices (eq. 5)", "time", c.sphere_refit_seconds, "n", linear}};
}

std::vector<Claim> judge_broad(const CurvesOfMethods& curves, const std::vector<Growth>& growths) {
  std::vector<Claim> claims;
  claims.push_back(judge_bounds("brute-force", "5",
                                "“In the Broad Phase, the brute force method takes O(n²)”.",
                                {growths[9], growths[10]}));
  claims.push_back(judge_bounds("sweep", "5", "Sweep and prune is O(n log n).", {growths[7], growths[8]}));
  if (claims.back().verdict == Verdict::does_not_hold)
    claims.back().reason +=
        " Sorting is n log n. The pairs that overlap along the swept axis add to this; at constant density "
        "in three dimensions they grow as n^(5/3).";
  claims.push_back(
      judge_bounds("region-tests", "7",
                   "The region-BV test of all objects takes O(n log n): placing all objects in regions, "
                   "the first step.",
                   {growths[0]}));
  claims.push_back(less_than_quadratic(curves[octree_2007].step_seconds, curves[octree_2007].tests));
  claims.push_back(faster_than_brute(curves));
  claims.push_back(comparable_with_sweep(curves));
  return claims;
}

/// A logarithmic factor hardly changes an exponent, so this compares the numbers of reads per vertex.
Claim judge_sphere_refit(const Points& reads, const Points& seconds) {
  Claim claim{"sphere-refit", "5.1", "Refitting spheres (eq. 5) takes O(V)."};
  if (reads.size() < 2) return claim;
  const double first = reads.front().second / reads.front().first,
               last = reads.back().second / reads.back().first;
  claim.verdict = verdict_of(last < 1.1 * first);
  claim.number = Estimate{last / first, NAN};
  claim.quantity = "reads of a vertex, largest mesh / smallest";
  claim.reason = fmt::format(
      "This is true for the single sphere of an object, which the paper describes. With a sphere in each "
      "node, every level reads all triangles. A vertex is read {:.0f} times on average at {} vertices and "
      "{:.0f} times at {}, so the refit is O(V log V). Times grow with exponent {}.",
      first, cli::grouped(static_cast<std::uint64_t>(reads.front().first)), last,
      cli::grouped(static_cast<std::uint64_t>(reads.back().first)), text_of(fit_power_law(seconds)));
  return claim;
}

std::vector<Claim> judge_narrow(const std::vector<Growth>& growths, const Points& reads) {
  std::vector<Claim> claims;
  claims.push_back(
      judge_bounds("narrow-phase", "6, 7, 8",
                   "The narrow phase is O(4^(log n) log n), log of base 8, which is n^(2/3) log n.",
                   {growths[0], growths[2], growths[1], growths[3]}));
  if (claims.back().verdict == Verdict::does_not_hold)
    claims.back().reason +=
        " When surfaces cross, only the nodes along a curve collide, about √n of them. When surfaces "
        "coincide, every leaf collides with another leaf, so every hierarchy needs at least n tests and the "
        "bound cannot hold. The bound assumes that each level divides n by eight, but a surface passes "
        "through about four of eight octants.";
  claims.push_back(
      judge_bounds("box-refit", "5.1", "Refitting the boxes takes O(V).", {growths[6], growths[5]}));
  claims.push_back(judge_sphere_refit(reads, growths[7].points));
  claims.push_back(judge_bounds("build", "6", "Building an object's octree takes O(n log n).", {growths[4]}));
  return claims;
}

Section broad_section(const ScalingOptions& options, Table table, const std::vector<Growth>& growths) {
  std::string paragraph = fmt::format(
      "Boxes with sides of 0.5 to 1, one per eight units of volume, all in motion. The time of a step is the "
      "minimum of {} steps after the first. Brute force and the octree of 2007 stop when a step could take "
      "longer "
      "than {} s. The octree of 2007 expands down to regions as large as the boxes; it decides the paper's "
      "claims "
      "on regions and on O(n²).",
      options.frames, rounded(options.brute_seconds));
  return {"Number of objects",
          {std::move(paragraph)},
          {std::move(table), exponents_table("scaling_broad_phase_exponents",
                                             "Fitted exponents: number of objects", "Objects", growths)}};
}

Section shape_section(Table table, const std::vector<Growth>& growths) {
  return {
      "Number of vertices",
      {"Two geodesic spheres of the same resolution. They either cross in a circle, or have the same center "
       "and different rotations, so that the surfaces coincide everywhere. Times are for the traversal to "
       "candidate triangles, without exact tests. Build and refit are for one object."},
      {std::move(table), exponents_table("scaling_vertices_exponents", "Fitted exponents: number of vertices",
                                         "Vertices", growths)}};
}

}  // namespace

ScalingOptions scaling_options(bool quick) {
  ScalingOptions options;
  options.object_counts = {1000, 3162, 10'000, 31'623, 100'000, 316'228, 1'000'000};
  options.frequencies = {8, 16, 32, 64, 128, 224};
  if (!quick) return options;
  options.object_counts = {1000, 3162, 10'000, 31'623, 100'000, 316'228};
  options.frequencies = {8, 16, 32, 64, 96};
  options.brute_seconds = 2;
  options.few_objects.rounds = 5;
  options.few_objects.steps_of_round = 5;
  return options;
}

Report run_scaling(const ScalingOptions& options, bool show_progress) {
  Work work(work_of(options.few_objects) + methods.size() * options.object_counts.size() +
                3 * options.frequencies.size(),
            show_progress);
  FewObjectsOptions few_options = options.few_objects;
  few_options.seed = options.seed;
  FewObjects few = measure_few_objects(few_options, work);
  Table boxes{"scaling_broad_phase",
              "Broad phase",
              {{"method", "Method"},
               {"objects", "Objects"},
               {"first_ms", "First step ms"},
               {"step_ms", "Step ms"},
               {"tests", "Tests"},
               {"pairs", "Pairs"}}};
  CurvesOfMethods broad;
  const bool same_pairs = measure_broad_phase(options, work, boxes, broad);
  Table shapes{"scaling_vertices",
               "Narrow phase",
               {{"pose", "Pose"},
                {"vertices", "Vertices"},
                {"triangles", "Triangles"},
                {"depth", "Depth"},
                {"build_ms", "Build ms"},
                {"refit_ms", "Refit ms"},
                {"sphere_refit_ms", "with spheres"},
                {"traversal_ms", "Traversal ms"},
                {"node_pairs", "Node pairs"},
                {"tests", "Tests"},
                {"candidates", "Candidates"}}};
  ShapeCurves narrow;
  measure_shapes(options, work, shapes, narrow);

  const std::vector<Growth> of_objects = broad_growths(broad), of_vertices = shape_growths(narrow);
  Report report;
  report.name = "scaling";
  report.title = "Growth of time with objects and with vertices";
  report.summary =
      "Times of the broad phase, of the narrow phase, and of building and refitting octrees, by the size of "
      "the problem. Powers are fitted by least squares on logarithms and compared with the paper's formulas. "
      "Numbers of tests do not depend on the machine; times do.";
  report.parameters = {
      {"seed", fmt::format("{}", options.seed)},
      {"threads", options.threads == 0 ? "one per core" : fmt::format("{}", options.threads)},
      {"octrees of objects", "those of 2007: regular, 8 children, leaves of single triangles; Figure 4"},
      {"exponent within a bound",
       fmt::format("no more than {} above it, or twice its standard error", exponent_tolerance)}};
  report.claims = {std::move(few.better_than_brute), std::move(few.comparable_with_sweep)};
  for (Claim& claim : judge_broad(broad, of_objects)) report.claims.push_back(std::move(claim));
  for (Claim& claim : judge_narrow(of_vertices, narrow.sphere_refit_reads))
    report.claims.push_back(std::move(claim));
  report.claims.push_back({"same-pairs", "", "All broad phases report the same pairs.",
                           verdict_of(same_pairs),
                           "Compared by their number, at every size at which they take the same steps."});
  report.sections.push_back({"Few objects, as in the paper",
                             {"Boxes with sides of 0.5 to 1, one per eight units of volume, all in motion, "
                              "one thread. The octree of 2007 "
                              "expands down to regions as large as the objects. The lists on three axes are "
                              "those of [Bar92]; all methods "
                              "find the same pairs. The two claims above are about these sizes."},
                             {std::move(few.table)}});
  report.sections.push_back(broad_section(options, std::move(boxes), of_objects));
  report.sections.push_back(shape_section(std::move(shapes), of_vertices));
  return report;
}

}  // namespace supple::experiments
