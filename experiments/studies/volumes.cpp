#include "studies/volumes.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/text.hpp"
#include "judgement.hpp"
#include "program_2007/replay.hpp"
#include "studies/shape_pair.hpp"
#include "supple/inspection.hpp"
#include "supple/models.hpp"
#include "supple/option_descriptions.hpp"
#include "supple/scene.hpp"
#include "work.hpp"

namespace supple::experiments {
namespace {

/// Objects and their positions in each frame.
struct Poses {
  std::string name;
  std::vector<TriangleMesh> objects;
  std::vector<std::vector<std::vector<Vec3d>>> frames{};  // frame, object, vertex
};

/// Two objects in three poses relative to each other.
Poses poses_of(const std::string& name, const TriangleMesh& a, const TriangleMesh& b,
               const std::vector<Vec3d>& offsets) {
  Poses result{name, {a, turned(b)}};
  for (const Vec3d& offset : offsets)
    result.frames.push_back({a.positions, moved(result.objects[1], offset).positions});
  return result;
}

/// Every tenth step of a scene.
Poses deforming(const Table1Scene& scene, const VolumesOptions& options) {
  Replay replay = replay_of(scene, options.seed, options.deformed_frames, 10);
  Poses result{replay.name + ", deforming", std::move(replay.objects)};
  for (Replay::Frame& frame : replay.frames) result.frames.push_back(std::move(frame.positions));
  return result;
}

std::vector<Poses> make_cases(const VolumesOptions& options) {
  const std::vector<Vec3d> offsets{{0.1, 0.05, 0.1}, {0.3, 0.1, 0.05}, {0.55, 0.15, 0.1}};
  const TriangleMesh ball = make_icosphere(options.frequency);
  std::vector<Poses> cases{
      poses_of("pawn, fish", make_model("pawn"), make_model("fish"), offsets),
      poses_of("rabbits", make_model("rabbit"), make_model("rabbit"), offsets),
      poses_of("humans", make_model("human"), make_model("human"), offsets),
      poses_of("balls", ball, ball, {{0.25, 0, 0}, {1, 0.125, 0.0625}, {1.75, 0.25, 0}})};
  if (options.with_bikes) cases.push_back(poses_of("bikes", make_model("bike"), make_model("bike"), offsets));
  cases.push_back(deforming(mixed_scene(9), options));
  cases.push_back(deforming({Table1Scene::Source::built_in, "three_humans"}, options));
  return cases;
}

/// One way to enclose and to build.
struct Variant {
  std::string name;
  BoundingVolume volume = BoundingVolume::aabb;
  SphereFit fit = SphereFit::vertices;
  ObjectOctreeOptions octree{};
  /// Encloses all triangles; otherwise contacts may be missing.
  bool is_conservative() const { return volume != BoundingVolume::sphere || fit != SphereFit::box; }
};

/// Boxes first.
std::vector<Variant> volume_variants() {
  std::vector<Variant> variants;
  for (std::size_t v = 0; v < words<BoundingVolume>.size(); ++v) {
    const auto volume = static_cast<BoundingVolume>(v);
    if (volume != BoundingVolume::sphere) {
      variants.push_back({words<BoundingVolume>[v], volume});
      continue;
    }
    for (std::size_t f = 0; f < words<SphereFit>.size(); ++f)
      variants.push_back(
          {fmt::format("sphere ({})", words<SphereFit>[f]), volume, static_cast<SphereFit>(f)});
  }
  return variants;
}

/// The default first.
std::vector<Variant> build_variants() {
  std::vector<Variant> variants;
  for (std::size_t b = 0; b < words<ObjectOctreeBuild>.size(); ++b)
    variants.push_back({words<ObjectOctreeBuild>[b], BoundingVolume::aabb, SphereFit::vertices, {
                          .build = static_cast<ObjectOctreeBuild>(b)
                        }});
  return variants;
}

/// Sums over the frames of one case; times are those of the fastest round.
struct Cost {
  double build_seconds = 0, refit_seconds = 0, query_seconds = 0;
  std::uint64_t bytes = 0, object_pairs = 0, node_pairs = 0, tests = 0, candidates = 0;
  std::vector<Contact> contacts{};

  std::uint64_t false_candidates() const { return candidates - contacts.size(); }
  double seconds() const { return refit_seconds + query_seconds; }
};

std::vector<ObjectId> add_all(Scene& scene, const Poses& shapes, const Variant& variant) {
  std::vector<ObjectId> ids;
  for (const TriangleMesh& mesh : shapes.objects)
    ids.push_back(scene.add(mesh, ObjectOptions{.octree = variant.octree}));
  return ids;
}

Cost measure(const Poses& shapes, const Variant& variant, const VolumesOptions& options) {
  const SceneOptions scene_options{.bounding_volume = variant.volume,
                                   .contact_points = false,
                                   .threads = options.threads,
                                   .comparison = {.sphere_fit = variant.fit}};
  std::vector<double> builds, refits, queries;
  Cost cost;
  Scene scene(scene_options);
  std::vector<ObjectId> ids;
  for (int round = 0; round < options.rounds; ++round) {
    for (const ObjectId id : ids) scene.remove(id);
    builds.push_back(seconds_of([&] { ids = add_all(scene, shapes, variant); }));
    refits.push_back(0);
    queries.push_back(0);
    for (const auto& positions : shapes.frames) {
      for (std::size_t i = 0; i < ids.size(); ++i) scene.set_positions(ids[i], positions[i]);
      const DetectResult& result = scene.detect();
      const StepStats& stats = result.stats;
      refits.back() += stats.refit_seconds;
      queries.back() += stats.traversal_seconds + stats.exact_seconds;
      if (round > 0) continue;
      cost.object_pairs += stats.object_pairs;
      cost.node_pairs += stats.node_pairs_visited;
      cost.tests += stats.boxes_tested;
      cost.candidates += stats.candidate_pairs;
      cost.contacts.insert(cost.contacts.end(), result.contacts.begin(), result.contacts.end());
    }
    for (const ObjectId id : round == 0 ? ids : std::vector<ObjectId>{})
      cost.bytes += SceneInspector(scene).octree_statistics(id).bytes;
  }
  cost.build_seconds = least(builds);
  cost.refit_seconds = least(refits);
  cost.query_seconds = least(queries);
  return cost;
}

/// By case and variant.
using Costs = std::vector<std::vector<Cost>>;

Table cost_table(const std::string& name, const std::string& caption, const std::string& variant) {
  return {name,
          caption,
          {{"case", "Case"},
           {variant, variant == "volume" ? "Volume" : "Build"},
           {"build_ms", "Build ms"},
           {"refit_ms", "Refit ms"},
           {"query_ms", "Query ms"},
           {"kib", "KiB"},
           {"object_pairs", "Object pairs"},
           {"node_pairs", "Node pairs"},
           {"tests", "Tests"},
           {"candidates", "Candidates"},
           {"false_candidates", "False"},
           {"contacts", "Contacts"}}};
}

Costs measure_all(const std::vector<Poses>& cases, const std::vector<Variant>& variants,
                  const VolumesOptions& options, Work& work, Table& table) {
  Costs costs;
  for (const Poses& shapes : cases) {
    auto& row = costs.emplace_back();
    for (const Variant& variant : variants) {
      const Cost& cost = row.emplace_back(measure(shapes, variant, options));
      work.done(1, fmt::format("{}, {}", shapes.name, variant.name));
      table.add({shapes.name, variant.name, cost.build_seconds * 1e3, cost.refit_seconds * 1e3,
                 cost.query_seconds * 1e3, static_cast<double>(cost.bytes) / 1024, cost.object_pairs,
                 cost.node_pairs, cost.tests, cost.candidates, cost.false_candidates(),
                 std::uint64_t{cost.contacts.size()}});
    }
  }
  return costs;
}

/// The sum of a count over the cases divided by that of the first variant. Counts can be 0 in a case, so
/// means of quotients would say nothing.
template <class Count>
Cell relative_sum(const Costs& costs, std::size_t variant, const Count& count) {
  double sum = 0, sum_of_first = 0;
  for (const auto& row : costs) {
    sum += static_cast<double>(count(row[variant]));
    sum_of_first += static_cast<double>(count(row[0]));
  }
  return sum_of_first > 0 ? Cell(sum / sum_of_first) : Cell("none");
}

/// The geometric mean over the cases of a time or size divided by that of the first variant.
template <class Number>
double relative(const Costs& costs, std::size_t variant, const Number& number) {
  double sum = 0;
  for (const auto& row : costs) {
    const auto value = [&](const Cost& cost) { return std::max(static_cast<double>(number(cost)), 1e-9); };
    sum += std::log(value(row[variant]) / value(row[0]));
  }
  return std::exp(sum / static_cast<double>(costs.size()));
}

Claim judge_contacts(const std::string& id, const std::string& paper, const std::vector<Variant>& variants,
                     const Costs& costs) {
  bool all_equal = true;
  std::uint64_t contacts = 0, missed = 0;
  for (const auto& row : costs) {
    contacts += row[0].contacts.size();
    for (std::size_t v = 0; v < variants.size(); ++v) {
      if (variants[v].is_conservative())
        all_equal = all_equal && row[v].contacts == row[0].contacts;
      else
        missed += row[0].contacts.size() - row[v].contacts.size();
    }
  }
  Claim claim{id, "", paper, verdict_of(all_equal)};
  claim.reason = fmt::format("Over all cases and frames there are {} contacts.", cli::grouped(contacts));
  if (!std::all_of(variants.begin(), variants.end(), [](const Variant& v) { return v.is_conservative(); }))
    claim.reason += fmt::format(
        " Spheres made from boxes (equations 3 and 4) do not enclose their triangles and miss {} of them.",
        cli::grouped(missed));
  return claim;
}

/// Nodes of several spheres, which no variant has: a bound on their tests.
Claim judge_several_spheres(const std::vector<Variant>& variants, const Costs& costs) {
  constexpr double spheres = 2;
  std::vector<double> ratios;
  for (const auto& row : costs) {
    double fewest = static_cast<double>(row[0].tests);
    for (std::size_t v = 0; v < variants.size(); ++v) {
      if (variants[v].is_conservative()) fewest = std::min(fewest, static_cast<double>(row[v].tests));
    }
    if (row[0].tests > 0) ratios.push_back(spheres * spheres * fewest / static_cast<double>(row[0].tests));
  }
  const Estimate ratio = estimate_of(ratios);
  return {
      "several-spheres",
      "8",
      "“Making tighter nodes, using a method similar to [BO04]”, with several spheres in a node. Read as: "
      "two "
      "spheres in a node need fewer tests than a box.",
      below(ratio, 1),
      fmt::format(
          "A pair of nodes with two spheres each needs four tests, with four spheres sixteen. Even if these "
          "nodes were as tight as the tightest volume measured here, they would need {} times the tests of "
          "boxes (mean of the cases), each at least as expensive, and a medial axis would have to be found "
          "again in every step. So Supple has no such volume; SphereFit::minimal has the tightest single "
          "sphere.",
          text_of(ratio)),
      ratio,
      "tests with two spheres in a node / with boxes, at least"};
}

/// When a variant pays: how many queries for one refit make up for its slower refit.
std::string when_it_pays(const std::vector<Poses>& cases, const Costs& costs, std::size_t variant) {
  std::vector<std::string> pays, later;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const Cost &boxes = costs[i][0], &cost = costs[i][variant];
    const double saved = boxes.query_seconds - cost.query_seconds,
                 lost = cost.refit_seconds - boxes.refit_seconds;
    if (saved <= 0) continue;
    if (saved >= lost)
      pays.push_back(cases[i].name);
    else
      later.push_back(fmt::format("{} ({:.1f})", cases[i].name, lost / saved));
  }
  std::string text = pays.empty() ? "Pays in no case with one query per refit"
                                  : fmt::format("Pays with one query per refit: {}", fmt::join(pays, "; "));
  if (!later.empty()) text += fmt::format(". Pays with more queries per refit: {}", fmt::join(later, "; "));
  return text + ".";
}

Table summary_table(const std::string& name, const std::string& caption, const std::vector<Variant>& variants,
                    const std::vector<Poses>& cases, const Costs& costs) {
  Table table{name,
              caption,
              {{"variant", "Variant"},
               {"memory", "Memory"},
               {"build", "Build"},
               {"refit", "Refit"},
               {"node_pairs", "Node pairs"},
               {"false_candidates", "False candidates"},
               {"query", "Query"},
               {"refit_and_query", "Refit and query"},
               {"pays", "When it pays"}}};
  for (std::size_t v = 0; v < variants.size(); ++v) {
    const auto ratio = [&](const auto& number) { return Cell(relative(costs, v, number)); };
    table.add({variants[v].name, ratio([](const Cost& c) { return c.bytes; }),
               ratio([](const Cost& c) { return c.build_seconds; }),
               ratio([](const Cost& c) { return c.refit_seconds; }),
               relative_sum(costs, v, [](const Cost& c) { return c.node_pairs; }),
               relative_sum(costs, v, [](const Cost& c) { return c.false_candidates(); }),
               ratio([](const Cost& c) { return c.query_seconds; }),
               ratio([](const Cost& c) { return c.seconds(); }),
               v == 0 ? std::string("the measure") : when_it_pays(cases, costs, v)});
  }
  return table;
}

Section section_of(const std::string& heading, const std::string& measure, const std::vector<Poses>& cases,
                   const std::vector<Variant>& variants, const Costs& costs, Table all,
                   const std::string& name) {
  Table summary = summary_table(
      name + "_summary",
      fmt::format("Sizes and times: geometric means over the cases; counts: sums; {}: 1", measure), variants,
      cases, costs);
  return {heading, {}, {std::move(summary), std::move(all)}};
}

}  // namespace

VolumesOptions volumes_options(bool quick) {
  VolumesOptions options;
  if (!quick) return options;
  options.with_bikes = false;
  options.frequency = 16;
  options.deformed_frames = 5;
  options.rounds = 2;
  return options;
}

Report run_volumes(const VolumesOptions& options, bool show_progress) {
  const std::vector<Poses> cases = make_cases(options);
  const std::vector<Variant> volumes = volume_variants(), builds = build_variants();
  Work work(cases.size() * (volumes.size() + builds.size()), show_progress);
  Table volume_costs = cost_table("volumes", "Bounding volumes", "volume");
  Table build_costs = cost_table("volumes_builds", "Ways to build, with boxes", "build");
  const Costs of_volumes = measure_all(cases, volumes, options, work, volume_costs);
  const Costs of_builds = measure_all(cases, builds, options, work, build_costs);

  Report report;
  report.name = "volumes";
  report.title = "Bounding volumes and ways to build an octree";
  report.summary =
      "The paper uses boxes and spheres, and names tighter nodes, oriented boxes and bottom-up construction "
      "as "
      "future work (8). This experiment compares all of them on the same objects in the same frames. Octrees "
      "have the default leaves.";
  report.parameters = {
      {"seed", fmt::format("{}", options.seed)},
      {"threads", options.threads == 0 ? "one per core" : fmt::format("{}", options.threads)},
      {"frames",
       fmt::format("three poses of two objects; {} frames of each deforming scene; counts and times "
                   "are sums over the frames",
                   options.deformed_frames)},
      {"times", fmt::format("minimum of {} rounds; a query is the search for candidates and the exact tests",
                            options.rounds)}};
  report.claims = {
      judge_contacts("same-contacts-volumes",
                     "All volumes that enclose their triangles give the same contacts.", volumes, of_volumes),
      judge_contacts("same-contacts-builds", "All ways to build an octree give the same contacts.", builds,
                     of_builds),
      judge_several_spheres(volumes, of_volumes)};
  report.sections = {
      section_of("Bounding volumes", "boxes", cases, volumes, of_volumes, std::move(volume_costs), "volumes"),
      section_of("Ways to build", "balanced", cases, builds, of_builds, std::move(build_costs),
                 "volumes_builds")};
  return report;
}

}  // namespace supple::experiments
