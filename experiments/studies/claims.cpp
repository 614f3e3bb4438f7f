#include "studies/claims.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "base/text.hpp"
#include "studies/box_field.hpp"
#include "supple/broad_phase.hpp"
#include "supple/inspection.hpp"
#include "supple/models.hpp"
#include "supple/option_descriptions.hpp"
#include "supple/scene.hpp"
#include "work.hpp"

namespace supple::experiments {
namespace {

/// Boxes and the spheres that enclose them, in arrays of numbers.
struct Volumes {
  std::array<std::vector<float>, 3> low, high, center;
  std::vector<float> radius;
};

Volumes make_volumes(const ClaimsOptions& options) {
  Volumes volumes;
  const BoxField field(options.volumes, options.seed);
  for (const Aabb& box : field.boxes()) {
    float squares = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const auto k = static_cast<std::size_t>(axis);
      volumes.low[k].push_back(box.min[axis]);
      volumes.high[k].push_back(box.max[axis]);
      volumes.center[k].push_back((box.min[axis] + box.max[axis]) / 2);
      squares += (box.max[axis] - box.min[axis]) * (box.max[axis] - box.min[axis]) / 4;
    }
    volumes.radius.push_back(std::sqrt(squares));
  }
  return volumes;
}

constexpr std::uint32_t bit(bool value) {
  return value ? 1 : 0;
}

/// The number of boxes that overlap box i: six comparisons each. Pointers and constants outside of the loop
/// let compilers vectorize both tests.
std::uint32_t overlapping_boxes(const Volumes& v, std::size_t i) {
  const std::array low{v.low[0].data(), v.low[1].data(), v.low[2].data()};
  const std::array high{v.high[0].data(), v.high[1].data(), v.high[2].data()};
  const float low_x = low[0][i], low_y = low[1][i], low_z = low[2][i];
  const float high_x = high[0][i], high_y = high[1][i], high_z = high[2][i];
  std::uint32_t count = 0;
  for (std::size_t j = 0; j < v.radius.size(); ++j) {
    count += bit(low[0][j] <= high_x) & bit(high[0][j] >= low_x) & bit(low[1][j] <= high_y) &
             bit(high[1][j] >= low_y) & bit(low[2][j] <= high_z) & bit(high[2][j] >= low_z);
  }
  return count;
}

/// The number of spheres that overlap sphere i: four multiplications, seven additions and a comparison each.
std::uint32_t overlapping_spheres(const Volumes& v, std::size_t i) {
  const std::array center{v.center[0].data(), v.center[1].data(), v.center[2].data()};
  const float* const radius = v.radius.data();
  const float center_x = center[0][i], center_y = center[1][i], center_z = center[2][i], radius_i = radius[i];
  std::uint32_t count = 0;
  for (std::size_t j = 0; j < v.radius.size(); ++j) {
    const float x = center[0][j] - center_x, y = center[1][j] - center_y, z = center[2][j] - center_z,
                reach = radius[j] + radius_i;
    count += x * x + y * y + z * z <= reach * reach;
  }
  return count;
}

/// Nanoseconds of a test, the fastest of several rounds over all pairs.
template <class Count>
std::pair<double, std::uint64_t> cost_of(const Volumes& volumes, int rounds, const Count& count_of) {
  std::vector<double> times;
  std::uint64_t found = 0;
  for (int round = 0; round < rounds; ++round) {
    found = 0;
    times.push_back(seconds_of([&] {
      for (std::size_t i = 0; i < volumes.radius.size(); ++i) found += count_of(volumes, i);
    }));
  }
  const auto tests = static_cast<double>(volumes.radius.size()) * static_cast<double>(volumes.radius.size());
  return {least(times) / tests * 1e9, found};
}

/// What an octree found for moving spheres.
struct RegionCost {
  double step_seconds = 0;
  std::uint64_t placements = 0, pairs = 0;
};

RegionCost cost_of_regions(RegionSphereTest test, const ClaimsOptions& options) {
  BroadPhaseOptions broad_phase_options;
  broad_phase_options.method = BroadPhaseMethod::octree;
  broad_phase_options.scene_octree.region_sphere_test = test;
  broad_phase_options.scene_octree.expand_at = 2;
  broad_phase_options.threads = 1;
  BroadPhase broad_phase(broad_phase_options);
  BoxField field(options.spheres, options.seed);
  std::vector<BoundingSphere> spheres(options.spheres);
  std::vector<double> steps;
  RegionCost cost;
  for (int round = 0; round <= options.rounds; ++round) {
    for (std::size_t i = 0; i < spheres.size(); ++i) {
      const Aabb& box = field.boxes()[i];
      spheres[i].radius = 0;
      for (int axis = 0; axis < 3; ++axis) {
        spheres[i].center[axis] = (box.min[axis] + box.max[axis]) / 2;
        spheres[i].radius = std::max(spheres[i].radius, (box.max[axis] - box.min[axis]) / 2);
      }
    }
    const double seconds = seconds_of([&] { cost.pairs = broad_phase.find_object_pairs(spheres).size(); });
    if (round > 0) steps.push_back(seconds);
    field.move();
  }
  cost.step_seconds = least(steps);
  for (const SceneRegion& region : broad_phase.regions()) cost.placements += region.object_count;
  return cost;
}

/// The depth of a regular octree whose leaves are single triangles.
OctreeStatistics regular_octree_of(const TriangleMesh& mesh) {
  Scene scene;
  return SceneInspector(scene).octree_statistics(
      scene.add(mesh, ObjectOptions{.octree = {.leaf_size = 1, .build = ObjectOctreeBuild::regular}}));
}

Table depth_table(const std::string& name, const std::string& caption) {
  return {name,
          caption,
          {{"triangles", "Triangles"},
           {"size", "Object size / triangle size"},
           {"depth", "Depth"},
           {"mean_depth", "mean"}}};
}

double mean_depth(const OctreeStatistics& octree) {
  double sum = 0;
  for (std::size_t level = 0; level < octree.leaves_by_level.size(); ++level)
    sum += static_cast<double>(level) * static_cast<double>(octree.leaves_by_level[level]);
  return sum / static_cast<double>(octree.leaves);
}

}  // namespace

Finding cost_of_tests(const ClaimsOptions& options) {
  const Volumes volumes = make_volumes(options);
  const auto [box_ns, box_hits] = cost_of(volumes, options.rounds, overlapping_boxes);
  const auto [sphere_ns, sphere_hits] = cost_of(volumes, options.rounds, overlapping_spheres);
  Finding finding{
      {"“Spheres are generally more expensive when considering just a single pairwise test” (5.2).",
       Verdict::cannot_tell,
       {}},
      {"claims_tests",
       "One test of two volumes",
       {{"volume", "Volume"}, {"ns", "ns per test"}, {"overlaps", "Overlaps"}}}};
  finding.table.add({"boxes", box_ns, box_hits});
  finding.table.add({"spheres", sphere_ns, sphere_hits});
  const double ratio = sphere_ns / box_ns;
  if (ratio > 1.05) finding.claim.verdict = Verdict::holds;
  if (ratio < 0.95) finding.claim.verdict = Verdict::does_not_hold;
  finding.claim.reason = fmt::format(
      "A test of two spheres takes {:.2f} times as long as a test of two boxes ({} against {} ns, one volume "
      "against {} in arrays of floats). The paper counts 11 operations for spheres and 15 for boxes; six "
      "comparisons are enough for boxes.",
      ratio, rounded(sphere_ns), rounded(box_ns), cli::grouped(options.volumes));
  return finding;
}

Finding region_tests(const ClaimsOptions& options) {
  const RegionCost arvo = cost_of_regions(RegionSphereTest::arvo, options);
  const RegionCost grown = cost_of_regions(RegionSphereTest::grown_box, options);
  Finding finding{
      {"“It is easier to compute if a point, the centre of the sphere, is in the box” that is grown by "
       "the radius than Arvo's test (5.1).",
       Verdict::cannot_tell,
       {}},
      {"claims_regions",
       "Regions against spheres",
       {{"test", "Test"}, {"step_ms", "Step ms"}, {"placements", "Spheres in leaves"}, {"pairs", "Pairs"}}}};
  for (const auto& [name, cost] :
       {std::pair{words<RegionSphereTest>[0], arvo}, {words<RegionSphereTest>[1], grown}})
    finding.table.add({name, cost.step_seconds * 1e3, cost.placements, cost.pairs});
  const double ratio = grown.step_seconds / arvo.step_seconds;
  if (ratio < 0.95) finding.claim.verdict = Verdict::holds;
  if (ratio > 1.05) finding.claim.verdict = Verdict::does_not_hold;
  finding.claim.reason = fmt::format(
      "A step of {} moving spheres takes {:.2f} times as long with the grown box. It places spheres in "
      "{:.1f} % "
      "more leaves, because it reports spheres that are near a corner or an edge of a region but outside. "
      "The "
      "pairs are the same ({}).",
      cli::grouped(options.spheres), ratio,
      100 * (static_cast<double>(grown.placements) / static_cast<double>(arvo.placements) - 1),
      arvo.pairs == grown.pairs ? cli::grouped(arvo.pairs) : "they differ: an error");
  return finding;
}

Finding depth_of_small_triangles(const ClaimsOptions& options) {
  Finding finding{{"“Smaller primitives imply more depth in the octree” (7).", Verdict::cannot_tell, {}},
                  depth_table("claims_small_triangles", "A sphere of smaller and smaller triangles")};
  bool grows = true;
  double first = 0, last = -1;
  std::uint32_t doublings = 0;
  for (std::uint32_t f = 4; f <= options.largest_frequency; f *= 2) {
    const TriangleMesh mesh = make_icosphere(f);
    const OctreeStatistics octree = regular_octree_of(mesh);
    finding.table.add(
        {octree.triangles, std::uint64_t{2 * f}, std::uint64_t{octree.depth}, mean_depth(octree)});
    grows = grows && mean_depth(octree) > last;
    last = mean_depth(octree);
    if (f == 4)
      first = last;
    else
      ++doublings;
  }
  finding.claim.verdict = verdict_of(grows);
  finding.claim.reason =
      fmt::format("When the edges of the triangles are halved, the mean depth grows by {:.2f} levels.",
                  (last - first) / doublings);
  return finding;
}

Finding depth_of_many_triangles(const ClaimsOptions& options) {
  Finding finding{
      {"“The increase in the number of primitives does not mean a large depth in the BVH, assuming "
       "they are of the same size” (7).",
       Verdict::cannot_tell,
       {}},
      depth_table("claims_many_triangles", "A sheet of more and more triangles of one size")};
  double first = 0, last = 0;
  std::uint32_t doublings = 0;
  for (std::uint32_t n = 8; n <= 4 * options.largest_frequency; n *= 2) {
    const OctreeStatistics octree = regular_octree_of(make_cloth(n, n, n, n));
    finding.table.add({octree.triangles, std::uint64_t{n}, std::uint64_t{octree.depth}, mean_depth(octree)});
    last = mean_depth(octree);
    if (n == 8)
      first = last;
    else
      ++doublings;
  }
  const double growth = (last - first) / doublings;
  finding.claim.verdict = verdict_of(growth < 0.1);
  finding.claim.reason = fmt::format(
      "When a sheet of triangles of one size becomes twice as long and wide, the mean depth grows by {:.2f} "
      "levels: the depth follows the size of the object divided by the size of its triangles.",
      growth);
  return finding;
}

ClaimsOptions claims_options(bool quick) {
  ClaimsOptions options;
  if (!quick) return options;
  options.volumes = 2048;
  options.spheres = 10'000;
  options.swept_boxes = {100, 1000};
  options.largest_frequency = 32;
  options.motion_seconds = 2;
  options.rounds = 3;
  return options;
}

Report run_claims(const ClaimsOptions& options, bool show_progress) {
  const std::vector<std::pair<const char*, Finding (*)(const ClaimsOptions&)>> measurements{
      {"tests of two volumes", cost_of_tests},
      {"regions against spheres", region_tests},
      {"sweep and prune", sweeps_on_one_axis_and_three},
      {"depth and size of triangles", depth_of_small_triangles},
      {"depth and number of triangles", depth_of_many_triangles},
      {"refit after motion", refit_after_motion},
      {"primitives and motion", primitives_and_motion},
      {"stability of integrators", stability_of_integrators}};
  Work work(measurements.size(), show_progress);
  Report report;
  report.name = "claims";
  report.title = "Single claims of the paper";
  report.summary = "Claims of the paper that need no experiment of their own, each with what was measured.";
  report.parameters = {{"seed", fmt::format("{}", options.seed)},
                       {"threads", "1"},
                       {"times", fmt::format("minimum of {} rounds", options.rounds)}};
  Section section{"Measurements", {}};
  for (const auto& [name, measure] : measurements) {
    Finding finding = measure(options);
    report.claims.push_back(std::move(finding.claim));
    section.tables.push_back(std::move(finding.table));
    work.done(1, name);
  }
  report.sections.push_back(std::move(section));
  return report;
}

}  // namespace supple::experiments
