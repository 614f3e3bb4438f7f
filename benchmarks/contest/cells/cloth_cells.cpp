#include <algorithm>
#include <optional>

#include "contest/cells/cells.hpp"
#include "supple/continuous.hpp"
#include "supple/scene.hpp"

namespace supple::benchmarks {
namespace {

/// The candidates that the exact test confirms.
PairDigest touching(const ClothStep& step, std::span<const ElementPair> candidates) {
  const auto edges = edges_of(step.triangles);
  PairDigest digest;
  const auto corners = [&](const std::vector<Vec3d>& p, std::array<std::uint32_t, 4> v) {
    return std::array<Vec3d, 4>{p[v[0]], p[v[1]], p[v[2]], p[v[3]]};
  };
  for (const ElementPair& pair : candidates) {
    if (pair.is_edge_edge) {
      const std::array<std::uint32_t, 4> v{edges[pair.a][0], edges[pair.a][1], edges[pair.b][0],
                                           edges[pair.b][1]};
      if (first_impact(EdgeEdgeMotion{corners(step.start, v), corners(step.end, v)}))
        digest.add(pair.a, pair.b);
    } else {
      const Triangle& t = step.triangles[pair.b];
      const std::array<std::uint32_t, 4> v{pair.a, t[0], t[1], t[2]};
      if (first_impact(VertexFaceMotion{corners(step.start, v), corners(step.end, v)}))
        digest.add(pair.a, pair.b + (std::uint64_t{1} << 32));
    }
  }
  return digest;
}

struct KnownCounts {
  const char* cloth;
  std::size_t vertex_face, edge_edge;
};
/// Known counts for the real frames: pairs whose boxes overlap.
constexpr KnownCounts known_candidates[] = {{"cloth-funnel", 7319, 33770}, {"cloth-ball", 1655541, 5197332}};

void check_known(const Choice& choice, const std::string& cloth, std::span<const ElementPair> candidates) {
  const auto edge_edge = static_cast<std::size_t>(std::count_if(
      candidates.begin(), candidates.end(), [](const ElementPair& pair) { return pair.is_edge_edge; }));
  for (const KnownCounts& known : known_candidates) {
    if (known.cloth == cloth &&
        (known.edge_edge != edge_edge || known.vertex_face != candidates.size() - edge_edge))
      throw Disagreement(choice.cell + ": the others find " + std::to_string(candidates.size() - edge_edge) +
                         " / " + std::to_string(edge_edge) + " candidates, known are " +
                         std::to_string(known.vertex_face) + " / " + std::to_string(known.edge_edge));
  }
}

/// Reverses the step, so that every frame has new coordinates and the same pairs.
void turn_round(ClothStep& step) {
  step.start.swap(step.end);
}

/// The longest edge of the box around the start.
double size_of(const ClothStep& step) {
  Vec3d low = step.start.front(), high = low;
  for (const Vec3d& p : step.start) {
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], p[axis]);
      high[axis] = std::max(high[axis], p[axis]);
    }
  }
  return std::max({high.x - low.x, high.y - low.y, high.z - low.z});
}

/// Reflects the step, so that every frame has new positions and boxes, and the same pairs.
void reflect(ClothStep& step) {
  for (std::vector<Vec3d>* positions : {&step.start, &step.end}) {
    for (Vec3d& p : *positions) p = -p;
  }
}

}  // namespace

void run_cloth(const Choice& choice, const std::string& name, bool two_threads, Output& output) {
  auto step = make_cloth_step(name);
  if (!step) return output.skip("the frames of " + name + " are not there; set SUPPLE_DATA");
  output.value("triangles", static_cast<double>(step->triangles.size()));
  std::optional<PairDigest> expected;
  const auto others = other_cloth_contestants();
  if (!others.empty() && !two_threads && !choice.only_supple) {
    const auto first = others.front().make();
    first->prepare(*step);
    first->frame(*step);
    check_known(choice, name, first->candidates());
    expected = touching(*step, first->candidates());
  }
  Turns<ClothStep, Contestant<ClothStep>> turns;
  turns.add("Supple", 1, make_supple_cloth(1), *step);
  if (two_threads) turns.add("Supple, 2 threads", 2, make_supple_cloth(2), *step);
  if (!two_threads && !choice.only_supple) {
    for (const auto& entry : others) turns.add(entry.name, 1, entry.make(), *step);
  }
  turns.run(
      choice, *step, [&] { turn_round(*step); },
      [&](const std::vector<std::size_t>& ran, const auto&, const std::vector<Record>& records) {
        if (expected && records[0].pairs != *expected)
          throw Disagreement(choice.cell + ": Supple finds " + text_of(records[0].pairs) +
                             " that touch, exact verdicts on all candidates " + text_of(*expected));
        // Compare contacts with contacts, candidates with candidates.
        const std::size_t first = two_threads || records.size() < 2 ? 0 : 1;
        for (const std::size_t i : ran) {
          if (i >= first) check_equal(choice.cell, records[first], records[i]);
        }
      });
  output.records(turns.records());
}

void run_cloth_boxes(const Choice& choice, const std::string& name, Output& output) {
  auto step = make_cloth_step(name);
  if (!step) return output.skip("the frames of " + name + " are not there; set SUPPLE_DATA");
  output.value("triangles", static_cast<double>(step->triangles.size()));
  auto supple = make_supple_cloth_boxes(1);
  supple->prepare(*step);
  check_known(choice, name, supple->candidates());
  Turns<ClothStep, ClothContestant> turns;
  turns.add("Supple", 1, std::move(supple), *step);
  if (!choice.only_supple) {
    for (const auto& entry : other_cloth_contestants()) turns.add(entry.name, 1, entry.make(), *step);
  }
  turns.run(
      choice, *step, [&] { reflect(*step); }, same_pairs(choice.cell));
  output.records(turns.records());
}

void run_near_cloth(const Choice& choice, const std::string& name, Output& output) {
  auto step = make_cloth_step(name);
  if (!step) return output.skip("the frames of " + name + " are not there; set SUPPLE_DATA");
  const double margin = 1e-3 * size_of(*step);
  output.value("triangles", static_cast<double>(step->triangles.size()));
  output.value("margin", margin);
  Turns<ClothStep, Contestant<ClothStep>> turns;
  turns.add("Supple", 1, make_supple_near_cloth(1, margin, ProximityListing::features), *step);
  turns.add("Supple, elements", 1, make_supple_near_cloth(1, margin, ProximityListing::elements), *step);
  if (!choice.only_supple) {
    for (const auto& entry : other_near_cloth_contestants(margin))
      turns.add(entry.name, 1, entry.make(), *step);
  }
  turns.run(
      choice, *step, [&] { reflect(*step); },
      [&](const std::vector<std::size_t>& ran, const auto&, const std::vector<Record>& records) {
        // The listing of features has other pairs.
        for (const std::size_t i : ran) {
          if (i > 1 && std::find(ran.begin(), ran.end(), 1) != ran.end())
            check_equal(choice.cell, records[1], records[i]);
        }
      });
  output.records(turns.records());
}

/// The share of distances that additive CCD of the IPC Toolkit keeps.
constexpr double kept_share = 0.1;

void run_safe_step(const Choice& choice, const std::string& name, Output& output) {
  auto step = make_cloth_step(name);
  if (!step) return output.skip("the frames of " + name + " are not there; set SUPPLE_DATA");
  SceneOptions options;
  options.threads = 1;
  options.contacts = ContactKinds::continuous;
  Scene scene(options);
  const ObjectId cloth = scene.add(PositionsView(step->start), step->triangles, {.self_collision = true});
  scene.set_motion(cloth, step->start, step->end);
  output.value("safe step", scene.max_step().step);
  output.value("safe step that keeps a share of distances",
               scene.collision_free_step({.keep = kept_share}).step);
  std::vector<double> steps, keeping_steps, detections;
  const auto time = [&](std::vector<double>& times, auto run) {
    const double start = cpu_milliseconds();
    scene.set_motion(cloth, step->start, step->end);
    run();
    times.push_back(cpu_milliseconds() - start);
  };
  const double begin = cpu_milliseconds();
  while (steps.size() < 3 ||
         (steps.size() < choice.rounds && cpu_milliseconds() - begin < 1e3 * choice.seconds)) {
    time(steps, [&] { scene.max_step(); });
    time(keeping_steps, [&] { scene.collision_free_step({.keep = kept_share}); });
    time(detections, [&] { scene.detect(); });
  }
  output.value("milliseconds", quantile(steps, 0.5));
  output.value("milliseconds of collision_free_step", quantile(keeping_steps, 0.5));
  output.value("milliseconds of detect", quantile(detections, 0.5));
}

}  // namespace supple::benchmarks
