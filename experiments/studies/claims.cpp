#include "studies/claims.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "base/text.hpp"
#include "fit.hpp"
#include "judgement.hpp"
#include "studies/arity.hpp"
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

/// The number of spheres that overlap sphere i: four multiplications, six additions and a comparison each.
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

/// Seconds of a round over all pairs, by round, and the pairs that overlap.
struct TestCost {
  std::vector<double> seconds;
  std::uint64_t found = 0;
};
template <class Count>
void add_round(const Volumes& volumes, TestCost& cost, const Count& count_of) {
  cost.found = 0;
  cost.seconds.push_back(seconds_of([&] {
    for (std::size_t i = 0; i < volumes.radius.size(); ++i) cost.found += count_of(volumes, i);
  }));
}

/// What an octree found for moving spheres.
struct RegionCost {
  std::vector<double> fresh_seconds, step_seconds;  ///< of each round: a new octree, and one that follows
  std::uint64_t placements = 0, pairs = 0;
};

/// Both tests in turn.
std::array<RegionCost, 2> cost_of_regions(const ClaimsOptions& options) {
  BroadPhaseOptions broad_phase_options;
  broad_phase_options.method = BroadPhaseMethod::octree;
  broad_phase_options.scene_octree.expand_at = 2;
  broad_phase_options.threads = 1;
  std::array<std::unique_ptr<BroadPhase>, 2> following;
  const auto make = [&](std::size_t test) {
    broad_phase_options.scene_octree.region_sphere_test = static_cast<RegionSphereTest>(test);
    return std::make_unique<BroadPhase>(broad_phase_options);
  };
  for (std::size_t test = 0; test < 2; ++test) following[test] = make(test);
  BoxField field(options.spheres, options.seed);
  std::vector<BoundingSphere> spheres(options.spheres);
  std::array<RegionCost, 2> costs;
  for (int round = 0; round <= options.rounds; ++round) {
    for (std::size_t i = 0; i < spheres.size(); ++i) {
      const Aabb& box = field.boxes()[i];
      spheres[i].radius = 0;
      for (int axis = 0; axis < 3; ++axis) {
        spheres[i].center[axis] = (box.min[axis] + box.max[axis]) / 2;
        spheres[i].radius = std::max(spheres[i].radius, (box.max[axis] - box.min[axis]) / 2);
      }
    }
    for (std::size_t test = 0; test < 2; ++test) {
      const auto fresh = make(test);
      const double of_fresh = seconds_of([&] { fresh->find_object_pairs(spheres); });
      const double of_step =
          seconds_of([&] { costs[test].pairs = following[test]->find_object_pairs(spheres).size(); });
      if (round == 0) continue;
      costs[test].fresh_seconds.push_back(of_fresh);
      costs[test].step_seconds.push_back(of_step);
    }
    field.move();
  }
  for (std::size_t test = 0; test < 2; ++test) {
    for (const SceneRegion& region : following[test]->regions())
      costs[test].placements += region.object_count;
  }
  return costs;
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

/// How the mean depth grows from each mesh to the next.
class Growths {
 public:
  void add(const TriangleMesh& mesh, std::uint64_t size, Table& table) {
    const OctreeStatistics octree = regular_octree_of(mesh);
    const double mean = mean_depth(octree);
    table.add({octree.triangles, size, std::uint64_t{octree.depth}, mean});
    if (last_) growths_.push_back(mean - *last_);
    last_ = mean;
  }
  Estimate estimate() const { return estimate_of(growths_); }

 private:
  std::optional<double> last_;
  std::vector<double> growths_;
};

}  // namespace

Finding cost_of_tests(const ClaimsOptions& options) {
  const Volumes volumes = make_volumes(options);
  TestCost boxes, spheres;
  for (int round = 0; round < options.rounds; ++round) {
    add_round(volumes, boxes, overlapping_boxes);
    add_round(volumes, spheres, overlapping_spheres);
  }
  const auto tests = static_cast<double>(volumes.radius.size()) * static_cast<double>(volumes.radius.size());
  const double box_ns = least(boxes.seconds) / tests * 1e9, sphere_ns = least(spheres.seconds) / tests * 1e9;
  Finding finding{{"test-cost", "5.2",
                   "“Spheres are generally more expensive when considering just a single pairwise test”."},
                  {"claims_tests",
                   "One test of two volumes",
                   {{"volume", "Volume"}, {"ns", "ns per test"}, {"overlaps", "Overlaps"}}}};
  finding.table.add({"boxes", box_ns, boxes.found});
  finding.table.add({"spheres", sphere_ns, spheres.found});
  const Estimate ratio = ratio_of(boxes.seconds, spheres.seconds);
  finding.claim.verdict = below(ratio, 1);
  finding.claim.number = ratio;
  finding.claim.quantity = "time of a test of boxes / of spheres";
  finding.claim.reason = fmt::format(
      "A test of two boxes takes {} times as long as a test of two spheres ({} against {} ns, one volume "
      "against {} in arrays of floats). The paper counts 11 operations for spheres and 15 for boxes; six "
      "comparisons are enough for boxes.",
      text_of(ratio), rounded(box_ns), rounded(sphere_ns), cli::grouped(options.volumes));
  return finding;
}

Finding region_tests(const ClaimsOptions& options) {
  const std::array<RegionCost, 2> costs = cost_of_regions(options);
  const auto& [arvo, grown] = costs;
  Finding finding{
      {"grown-box", "5.1",
       "“It is easier to compute if a point, the centre of the sphere, is in the box” that is grown by "
       "the radius than Arvo's test."},
      {"claims_regions",
       "Regions against spheres",
       {{"test", "Test"},
        {"fresh_ms", "New octree ms"},
        {"step_ms", "Step ms"},
        {"placements", "Spheres in leaves"},
        {"pairs", "Pairs"}}}};
  for (std::size_t test = 0; test < 2; ++test) {
    finding.table.add({words<RegionSphereTest>[test], least(costs[test].fresh_seconds) * 1e3,
                       least(costs[test].step_seconds) * 1e3, costs[test].placements, costs[test].pairs});
  }
  const Estimate fresh = ratio_of(grown.fresh_seconds, arvo.fresh_seconds),
                 step = ratio_of(grown.step_seconds, arvo.step_seconds);
  finding.claim.verdict = below(fresh, 1);
  finding.claim.number = fresh;
  finding.claim.quantity = "time of a new octree, grown box / Arvo's test";
  finding.claim.reason = fmt::format(
      "A new octree of {} spheres takes {} times as long with the grown box; this decides, because nothing "
      "is kept. A "
      "step in motion takes {} times as long, where the grown box keeps what stays in its regions and Arvo's "
      "test "
      "does not. The grown box places spheres in {:.1f} % more leaves, because it reports spheres that are "
      "near a "
      "corner or an edge of a region but outside. The pairs are the same ({}).",
      cli::grouped(options.spheres), text_of(fresh), text_of(step),
      100 * (static_cast<double>(grown.placements) / static_cast<double>(arvo.placements) - 1),
      arvo.pairs == grown.pairs ? cli::grouped(arvo.pairs) : "they differ: an error");
  return finding;
}

Finding depth_of_small_triangles(const ClaimsOptions& options) {
  Finding finding{{"smaller-primitives", "7", "“Smaller primitives imply more depth in the octree”."},
                  depth_table("claims_small_triangles", "A sphere of smaller and smaller triangles")};
  Growths growths;
  for (std::uint32_t f = 4; f <= options.largest_frequency; f *= 2)
    growths.add(make_icosphere(f), 2 * f, finding.table);
  const Estimate growth = growths.estimate();
  finding.claim.verdict = above(growth, 0.5);
  finding.claim.reason = fmt::format(
      "When the edges of the triangles are halved, the mean depth grows by {} levels.", text_of(growth));
  finding.claim.number = growth;
  finding.claim.quantity = "levels for triangles of half the size";
  return finding;
}

Finding depth_of_many_triangles(const ClaimsOptions& options) {
  Finding finding{
      {"more-primitives", "7",
       "“The increase in the number of primitives does not mean a large depth in the BVH, assuming "
       "they are of the same size”."},
      depth_table("claims_many_triangles", "A sheet of more and more triangles of one size")};
  Growths growths;
  for (std::uint32_t n = 8; n <= 4 * options.largest_frequency; n *= 2)
    growths.add(make_cloth(n, n, n, n), n, finding.table);
  const Estimate growth = growths.estimate();
  finding.claim.verdict = below(growth, 0.1);
  finding.claim.reason = fmt::format(
      "When a sheet of triangles of one size becomes twice as long and wide, the mean depth grows by {} "
      "levels: the depth follows the size of the object divided by the size of its triangles.",
      text_of(growth));
  finding.claim.number = growth;
  finding.claim.quantity = "levels for four times as many triangles of one size";
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
      {"regions of an object", regions_of_objects},
      {"leaves of levels", leaves_of_levels},
      {"spheres of the equations", spheres_of_the_equations},
      {"translation", translation_of_volumes},
      {"one loop", one_loop},
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
