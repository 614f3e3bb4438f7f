#include "experiments/table1.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <mutex>
#include <set>
#include <thread>
#include <utility>

#include "experiments/paper_table.hpp"
#include "experiments/table1_scenes.hpp"
#include "text.hpp"

namespace supple::experiments {
namespace {

constexpr std::array volumes{BoundingVolume::aabb, BoundingVolume::sphere};

SimulationOptions simulation_options(const cli::Input& input, BoundingVolume volume, std::uint64_t seed,
                                     std::uint32_t threads) {
  SimulationOptions options = input.simulation;
  options.seed = seed;
  options.scene.bounding_volume = volume;
  options.scene.sphere_fit = SphereFit::vertices;
  options.scene.contact_points = false;
  options.scene.colliding_vertices = true;
  options.scene.threads = threads;
  return options;
}

/// Pairs that were not there before.
std::uint64_t count_new(const DetectResult& result, std::set<ObjectPair>& pairs) {
  std::set<ObjectPair> now;
  std::uint64_t fresh = 0;
  for (const CollidingVertices& group : result.colliding_vertex_groups) {
    if (group.a == group.b) continue;
    now.insert({group.a, group.b});
    fresh += !pairs.contains({group.a, group.b});
  }
  pairs = std::move(now);
  return fresh;
}

/// All runs of one scene with one volume.
struct Runs {
  std::string scene;
  std::size_t objects = 0;
  std::string models;
  BoundingVolume volume{};
  std::vector<RunCounts> counts;
  double run_seconds = 0;  ///< of a run, simulated or by the clock

  std::vector<double> numbers(std::uint64_t RunCounts::*member) const {
    std::vector<double> result;
    for (const RunCounts& run : counts) result.push_back(static_cast<double>(run.*member));
    return result;
  }
  double mean_of(std::uint64_t RunCounts::*member) const { return mean(numbers(member)); }
  double seconds_for_one(std::uint64_t RunCounts::*member) const { return run_seconds / mean_of(member); }
};

const Runs* find(const std::vector<Runs>& all, const std::string& scene, BoundingVolume volume) {
  const auto found = std::find_if(all.begin(), all.end(),
                                  [&](const Runs& r) { return r.scene == scene && r.volume == volume; });
  return found == all.end() ? nullptr : &*found;
}

Runs start_of(const std::string& scene, const cli::Input& input, BoundingVolume volume, double run_seconds) {
  Runs runs{scene, input.objects.size(), {}, volume, {}, run_seconds};
  for (const cli::InputObject& object : input.objects) {
    const std::string model = object.mesh.name.substr(0, object.mesh.name.find(' '));
    if (runs.models.find(model) == std::string::npos)
      runs.models += (runs.models.empty() ? "" : ", ") + model;
  }
  return runs;
}

std::uint64_t vertices_of(const cli::Input& input) {
  std::uint64_t vertices = 0;
  for (const cli::InputObject& object : input.objects) vertices += object.mesh.positions.size();
  return vertices;
}

/// One run to be made: which of all runs, and how many steps.
struct Task {
  std::size_t runs, run;
  std::uint64_t steps, vertices;
};

/// Empty runs of every scene with both volumes, and the tasks that fill them.
std::vector<Runs> plan(const Table1Options& options, std::vector<Task>& tasks) {
  std::vector<Runs> all;
  for (const std::string& scene : options.scenes) {
    const cli::Input input = table1_scene(scene);
    const auto steps =
        static_cast<std::uint64_t>(std::llround(options.simulated_seconds / input.simulation.time_step));
    for (const BoundingVolume volume : volumes) {
      for (std::uint32_t run = 0; run < options.runs; ++run)
        tasks.push_back({all.size(), run, steps, vertices_of(input)});
      all.push_back(start_of(scene, input, volume, options.simulated_seconds));
      all.back().counts.resize(options.runs);
    }
  }
  // The longest first, so that no thread ends with one of them alone.
  std::stable_sort(tasks.begin(), tasks.end(),
                   [](const Task& a, const Task& b) { return a.steps * a.vertices > b.steps * b.vertices; });
  return all;
}

/// Runs are independent of each other: each has one thread, and several are under way at a time.
std::vector<Runs> run_by_events(const Table1Options& options, bool show_progress) {
  std::vector<Task> tasks;
  std::vector<Runs> all = plan(options, tasks);
  std::uint64_t total = 0;
  for (const Task& task : tasks) total += task.steps * task.vertices;
  Work work(total, show_progress);
  std::mutex mutex;
  std::size_t next = 0;
  std::exception_ptr fault;
  const auto run_tasks = [&] {
    for (;;) {
      std::size_t taken = 0;
      {
        const std::lock_guard lock(mutex);
        if (next == tasks.size() || fault) return;
        taken = next++;
      }
      const Task& task = tasks[taken];
      Runs& runs = all[task.runs];
      const std::string what =
          fmt::format("run {} of {}: {}, {}", taken + 1, tasks.size(), runs.scene, name_of(runs.volume));
      try {
        runs.counts[task.run] =
            run_scene(runs.scene, runs.volume, options.seed + task.run, 1, [&](std::uint64_t steps) {
              constexpr std::uint64_t often = 64;
              if (steps > 0 && steps % often == 0) {
                const std::lock_guard lock(mutex);
                work.done(often * task.vertices, what);
              }
              return steps < task.steps;
            });
      } catch (...) {
        const std::lock_guard lock(mutex);
        fault = std::current_exception();
      }
    }
  };
  const unsigned cores = std::max(std::thread::hardware_concurrency(), 1u);
  std::vector<std::thread> threads;
  for (unsigned i = 1; i < (options.threads == 0 ? cores : options.threads); ++i)
    threads.emplace_back(run_tasks);
  run_tasks();
  for (std::thread& thread : threads) thread.join();
  if (fault) std::rethrow_exception(fault);
  return all;
}

std::vector<Runs> run_by_clock(const Table1Options& options, double run_seconds, bool show_progress) {
  Work work(options.scenes.size() * volumes.size() * options.runs, show_progress);
  std::vector<Runs> all;
  for (const std::string& scene : options.scenes) {
    const cli::Input input = table1_scene(scene);
    for (const BoundingVolume volume : volumes) {
      Runs& runs = all.emplace_back(start_of(scene, input, volume, run_seconds));
      for (std::uint32_t run = 0; run < options.runs; ++run) {
        const auto start = std::chrono::steady_clock::now();
        runs.counts.push_back(
            run_scene(scene, volume, options.seed + run, options.threads, [&](std::uint64_t) {
              return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() <
                     run_seconds;
            }));
        work.done(1, fmt::format("by the clock: {}, {}, run {} of {}", scene, name_of(volume), run + 1,
                                 options.runs));
      }
    }
  }
  return all;
}

Table counts_table(const std::string& name, const std::string& caption, const std::vector<Runs>& all,
                   std::uint64_t first_seed) {
  Table table{name,
              caption,
              {{"scene", "Scene"},
               {"objects", "Objects"},
               {"models", "Models"},
               {"volume", "Volume"},
               {"seed", "Seed"},
               {"broad", "Broad phase"},
               {"narrow", "Narrow phase"},
               {"exact", "Exact"},
               {"steps", "Steps"},
               {"failure", "Broke off"}}};
  for (const Runs& runs : all) {
    for (std::size_t i = 0; i < runs.counts.size(); ++i) {
      const RunCounts& run = runs.counts[i];
      table.add({runs.scene, runs.objects, runs.models, std::string(name_of(runs.volume)), first_seed + i,
                 run.broad, run.narrow, run.exact, run.steps,
                 run.failure.empty() ? Cell() : Cell(run.failure)});
    }
  }
  return table;
}

/// The paper's row for a scene; of the scenes of other models it gives no numbers.
const PaperRow* paper_row_of(const Runs& runs) {
  return runs.scene.rfind("table1_", 0) == 0
             ? paper_row(static_cast<std::uint32_t>(runs.objects), runs.volume)
             : nullptr;
}

Table means_table(const std::string& name, const std::string& caption, const std::vector<Runs>& all) {
  Table table{name,
              caption,
              {{"scene", "Scene"},
               {"volume", "Volume"},
               {"broad_mean", "Broad: mean"},
               {"broad_seconds", "seconds each"},
               {"paper_broad_seconds", "paper"},
               {"narrow_mean", "Narrow: mean"},
               {"narrow_seconds", "seconds each"},
               {"paper_narrow_seconds", "paper"},
               {"exact_mean", "Exact: mean"},
               {"exact_seconds", "seconds each"}}};
  for (const Runs& runs : all) {
    const PaperRow* paper = paper_row_of(runs);
    table.add({runs.scene, std::string(name_of(runs.volume)), runs.mean_of(&RunCounts::broad),
               runs.seconds_for_one(&RunCounts::broad),
               paper ? Cell(seconds_per_collision(paper->broad)) : Cell(), runs.mean_of(&RunCounts::narrow),
               runs.seconds_for_one(&RunCounts::narrow),
               paper ? Cell(seconds_per_collision(paper->narrow)) : Cell(), runs.mean_of(&RunCounts::exact),
               runs.seconds_for_one(&RunCounts::exact)});
  }
  return table;
}

/// Runs as points, ours beside the paper's, for 3, 6 and 9 objects.
Plot counts_plot(const std::string& title, const std::vector<Runs>& all, std::uint64_t RunCounts::*member,
                 std::array<double, 5> PaperRow::*paper_member) {
  Plot plot{title, "objects", "collisions in ten minutes", false, true};
  plot.x_names = {{3, "3"}, {6, "6"}, {9, "9"}};
  int color = 0;
  for (const bool ours : {true, false}) {
    for (const BoundingVolume volume : volumes) {
      Series series{fmt::format("{}, {}", name_of(volume), ours ? "ours" : "the paper's"),
                    {},
                    Series::Style::points,
                    color};
      const double aside = 0.3 * (color - 1.5);
      for (const Runs& runs : all) {
        const PaperRow* paper = paper_row_of(runs);
        if (paper == nullptr || runs.volume != volume) continue;
        if (ours) {
          for (const double n : runs.numbers(member))
            series.points.emplace_back(paper->objects + aside, n * 600 / runs.run_seconds);
        } else {
          for (const double n : paper->*paper_member) series.points.emplace_back(paper->objects + aside, n);
        }
      }
      plot.series.push_back(std::move(series));
      ++color;
    }
  }
  return plot;
}

/// A mean and its standard error; NaN when there are too few numbers.
struct Estimate {
  double mean = std::nan(""), error = std::nan("");
};

Estimate estimate_of(const std::vector<double>& values) {
  Estimate result;
  if (values.empty()) return result;
  result.mean = mean(values);
  if (values.size() < 2) return result;
  double squares = 0;
  for (const double value : values) squares += (value - result.mean) * (value - result.mean);
  const double count = static_cast<double>(values.size());
  result.error = std::sqrt(squares / (count - 1) / count);
  return result;
}

/// Spheres over boxes, run by run: the same seed is the same motion. Runs in which boxes count nothing are
/// left out.
std::vector<double> sphere_ratios(const std::vector<Runs>& all, const std::vector<std::string>& scenes,
                                  std::uint64_t RunCounts::*member) {
  std::vector<double> ratios;
  for (const std::string& scene : scenes) {
    const Runs* boxes = find(all, scene, BoundingVolume::aabb);
    const Runs* spheres = find(all, scene, BoundingVolume::sphere);
    if (boxes == nullptr || spheres == nullptr) continue;
    for (std::size_t i = 0; i < boxes->counts.size(); ++i) {
      const auto in_boxes = boxes->counts[i].*member, in_spheres = spheres->counts[i].*member;
      if (in_boxes > 0) ratios.push_back(static_cast<double>(in_spheres) / static_cast<double>(in_boxes));
    }
  }
  return ratios;
}

const std::vector<std::string>& table_scenes() {
  static const std::vector<std::string> scenes{"table1_3", "table1_6", "table1_9"};
  return scenes;
}

std::string text_of(const Estimate& estimate) {
  if (!std::isfinite(estimate.mean)) return "–";
  return std::isfinite(estimate.error) ? fmt::format("{:.2f} ± {:.2f}", estimate.mean, estimate.error)
                                       : fmt::format("{:.2f}", estimate.mean);
}

/// `0.87 ± 0.03 (3 objects), …` for the scenes of Table 1 that were run.
std::string ratios_text(const std::vector<Runs>& all, std::uint64_t RunCounts::*member) {
  std::string text;
  for (const std::string& scene : table_scenes()) {
    const Estimate ratio = estimate_of(sphere_ratios(all, {scene}, member));
    if (!std::isfinite(ratio.mean)) continue;
    text += fmt::format("{}{} ({} objects)", text.empty() ? "" : ", ", text_of(ratio), scene.substr(7));
  }
  return text;
}

/// More with boxes when the mean ratio is below 1 by two standard errors.
Verdict more_with_boxes(const Estimate& ratio) {
  if (ratio.mean + 2 * ratio.error < 1) return Verdict::holds;
  return ratio.mean - 2 * ratio.error > 1 ? Verdict::does_not_hold : Verdict::cannot_tell;
}

Claim judge_more_with_boxes(const std::vector<Runs>& events) {
  const Estimate broad = estimate_of(sphere_ratios(events, table_scenes(), &RunCounts::broad));
  return {
      "“AABB allows more collisions than spheres” (7), counted by events in the same simulated time.",
      more_with_boxes(broad),
      fmt::format(
          "In the broad phase spheres begin {} times as many collisions as boxes, all runs together {}; in "
          "the "
          "narrow phase {}. The motion is the same with both, so that the counts compare the volumes and "
          "nothing else. A larger volume meets others more often, but it also stays in touch for longer, and "
          "what was two collisions becomes one.",
          ratios_text(events, &RunCounts::broad), text_of(broad), ratios_text(events, &RunCounts::narrow))};
}

Claim judge_proof_of_cost(const std::vector<Runs>& events) {
  std::size_t differing = 0, total = 0;
  for (const Runs& spheres : events) {
    if (spheres.volume != BoundingVolume::sphere) continue;
    const Runs* boxes = find(events, spheres.scene, BoundingVolume::aabb);
    for (std::size_t i = 0; boxes != nullptr && i < spheres.counts.size(); ++i, ++total)
      differing += spheres.counts[i].broad != boxes->counts[i].broad;
  }
  return {
      "More collisions with boxes “proves that the overlapping test is less expensive than the test for "
      "spheres” (7).",
      differing > 0 ? Verdict::does_not_hold : Verdict::cannot_tell,
      fmt::format(
          "Counted in simulated time no test has a price, and still the numbers of {} of {} runs differ "
          "between "
          "the volumes. A number of collisions depends on the shape of the volumes, and proves nothing about "
          "the cost of their test.",
          differing, total)};
}

Claim judge_narrow_is_fewer(const std::vector<Runs>& events) {
  Claim claim{
      "The narrow phase reports fewer collisions, and that it “takes more time to be computed … explains the "
      "smaller number” (7).",
      Verdict::cannot_tell,
      {}};
  double broad = 0, narrow = 0, exact = 0;
  bool fewer = !events.empty();
  for (const Runs& runs : events) {
    broad += runs.mean_of(&RunCounts::broad);
    narrow += runs.mean_of(&RunCounts::narrow);
    exact += runs.mean_of(&RunCounts::exact);
    fewer = fewer && runs.mean_of(&RunCounts::narrow) <= runs.mean_of(&RunCounts::broad);
  }
  if (!(broad > 0)) return claim;
  claim.verdict = Verdict::does_not_hold;
  claim.reason = fmt::format(
      "The numbers: over all scenes, for 100 collisions in the broad phase there are {:.0f} in the narrow "
      "phase and {:.0f} "
      "exact ones{}. The explanation: these are counted in simulated time, in which nothing takes longer. "
      "They are other "
      "numbers because volumes of objects overlap without their leaves doing so, and leaves may part and "
      "meet again while "
      "the volumes overlap.",
      100 * narrow / broad, 100 * exact / broad,
      fewer ? "; in every scene the narrow phase has no more" : "; but not in every scene are there fewer");
  return claim;
}

Claim judge_ratio_tends_to_one(const std::vector<Runs>& events) {
  Claim claim{
      "With spheres the number of collisions “is almost the same as that in the Broad Phase for 10 or more "
      "objects” "
      "(7): the ratio of spheres to boxes comes nearer to 1 from 3 to 9 objects.",
      Verdict::cannot_tell,
      {}};
  const Estimate few = estimate_of(sphere_ratios(events, {"table1_3"}, &RunCounts::broad));
  const Estimate many = estimate_of(sphere_ratios(events, {"table1_9"}, &RunCounts::broad));
  const double nearer = std::fabs(few.mean - 1) - std::fabs(many.mean - 1);
  const bool clear = std::fabs(nearer) > 2 * std::hypot(few.error, many.error);
  if (clear) claim.verdict = verdict_of(nearer > 0);
  claim.reason = fmt::format(
      "Ours are {}; the paper's 0.50, 0.82 and 0.91. {} The volumes of a pair depend on the two objects "
      "alone: the ratio has "
      "no reason to depend on how many others there are.",
      ratios_text(events, &RunCounts::broad),
      clear ? "What change there is comes from which models meet."
            : "The change from 3 to 9 is within twice its standard error.");
  return claim;
}

Claim judge_more_objects(const std::vector<Runs>& events) {
  Claim claim{"With more objects a collision comes sooner (7).", Verdict::holds, {}};
  for (const BoundingVolume volume : volumes) {
    std::string text;
    double last = 0, first = 0;
    for (const char* const scene : {"table1_3", "table1_6", "table1_9"}) {
      const Runs* runs = find(events, scene, volume);
      if (runs == nullptr) continue;
      const double seconds = runs->seconds_for_one(&RunCounts::broad);
      if (last != 0 && !(seconds < last)) claim.verdict = Verdict::does_not_hold;
      if (first == 0) first = seconds;
      last = seconds;
      text += fmt::format("{}{}", text.empty() ? "" : ", ", rounded(seconds));
    }
    claim.reason +=
        fmt::format("{} in the broad phase: one every {} s for 3, 6 and 9 objects. ", name_of(volume), text);
    if (first == 0 || first == last) claim.verdict = Verdict::cannot_tell;
  }
  claim.reason += "There are 3, 15 and 36 pairs.";
  return claim;
}

Claim judge_complex_models(const std::vector<Runs>& events) {
  Claim claim{
      "With more complex objects (human, bike) there are “about one or two collisions more with AABBs than "
      "with "
      "spheres” (7): the difference goes away.",
      Verdict::cannot_tell,
      {}};
  const Estimate simple = estimate_of(sphere_ratios(events, {"table1_3"}, &RunCounts::broad));
  const Estimate complex =
      estimate_of(sphere_ratios(events, {"three_humans", "three_bikes"}, &RunCounts::broad));
  const double nearer = std::fabs(simple.mean - 1) - std::fabs(complex.mean - 1);
  if (std::fabs(nearer) > 2 * std::hypot(simple.error, complex.error)) claim.verdict = verdict_of(nearer > 0);
  claim.reason = "Spheres begin so many times as many collisions as boxes: ";
  for (const char* const scene : {"three_humans", "three_bikes"}) {
    const Estimate ratio = estimate_of(sphere_ratios(events, {scene}, &RunCounts::broad));
    if (std::isfinite(ratio.mean)) claim.reason += fmt::format("{} {}, ", scene, text_of(ratio));
  }
  claim.reason += fmt::format(
      "three simple objects {}. How far a sphere and a box of an object differ is a matter of its shape, not "
      "of the number "
      "of its vertices.",
      text_of(simple));
  return claim;
}

/// Ours: exact contacts know nothing of volumes.
Claim judge_exact_equal(const std::vector<Runs>& events) {
  Claim claim{"Exact contacts are the same with boxes and with spheres (ours).", Verdict::holds, {}};
  for (const Runs& runs : events) {
    const Runs* other = find(events, runs.scene, BoundingVolume::aabb);
    if (other != nullptr && runs.numbers(&RunCounts::exact) != other->numbers(&RunCounts::exact))
      claim.verdict = Verdict::does_not_hold;
  }
  claim.reason = "Run by run, in all scenes.";
  return claim;
}

Claim judge_clock(const std::vector<Runs>& clock) {
  const Estimate broad = estimate_of(sphere_ratios(clock, table_scenes(), &RunCounts::broad));
  return {"By the clock, as the paper counts: boxes allow more collisions than spheres (7).",
          more_with_boxes(broad),
          fmt::format("Spheres begin {} times as many collisions as boxes in the same time by the clock, in "
                      "which they take "
                      "{} times as many steps.",
                      ratios_text(clock, &RunCounts::broad), ratios_text(clock, &RunCounts::steps))};
}

Claim judge_paper_arithmetic() {
  std::size_t cut = 0, differing = 0, agreeing = 0;
  std::string which;
  const Table arithmetic = paper_arithmetic();
  for (const auto& row : arithmetic.rows) {
    const auto& comparison = std::get<std::string>(row.back());
    cut += comparison == "cut off, not rounded";
    differing += comparison == "differs";
    if (comparison == "differs")
      which += fmt::format("{}{} objects, {}, {} phase: {:.2f} s by the table, {:.2f} s in the text",
                           which.empty() ? " (" : "; ", std::get<std::uint64_t>(row[0]),
                           std::get<std::string>(row[1]), std::get<std::string>(row[2]),
                           std::get<double>(row[4]), std::get<double>(row[5]));
    agreeing += comparison == "agrees";
  }
  if (!which.empty()) which += ')';
  return {
      "The averages of section 7 are those of Table 1.", verdict_of(differing == 0),
      fmt::format(
          "{} of {} agree, {} were cut off after two decimals rather than rounded, {} not at all{}. The text "
          "gives "
          "18, 35, 32, 17, 21 as the broad phase's results with spheres; in the table they are those of "
          "AABBs, "
          "and the averages fit the table.",
          agreeing, agreeing + cut + differing, cut, differing, which)};
}

}  // namespace

RunCounts run_scene(const std::string& scene, BoundingVolume volume, std::uint64_t seed,
                    std::uint32_t threads, const std::function<bool(std::uint64_t steps)>& go_on) {
  const cli::Input input = table1_scene(scene);
  Simulation simulation(simulation_options(input, volume, seed, threads));
  for (const cli::InputObject& object : input.objects) {
    ObjectOptions options = object.options;
    options.octree.leaf_size = 1;
    simulation.add(object.mesh, options, std::get<MassSpringMotion>(*object.motion));
  }
  RunCounts counts;
  std::set<ObjectPair> pairs;
  const auto count = [&](const DetectResult& result) {
    counts.broad += result.volume_events.begin.size();
    counts.exact += result.contact_events.begin.size();
    counts.narrow += count_new(result, pairs);
  };
  count(simulation.detect());
  try {
    while (go_on(counts.steps)) {
      count(simulation.step());
      ++counts.steps;
    }
  } catch (const MotionError& error) {
    counts.failure = error.what();
  }
  return counts;
}

Table1Options table1_options(bool quick) {
  Table1Options options;
  options.scenes = table1_scene_names();
  if (!quick) return options;
  options.scenes = {"table1_3", "table1_6", "table1_9", "three_humans"};
  options.runs = 2;
  options.simulated_seconds = 6;
  return options;
}

Report run_table1(const Table1Options& options, bool show_progress) {
  const std::vector<Runs> events = run_by_events(options, show_progress);
  std::vector<Runs> clock;
  if (options.wall_clock) clock = run_by_clock(options, *options.wall_clock, show_progress);

  Report report;
  report.name = "table1";
  report.title = "The paper's Table 1: collisions of 3, 6 and 9 objects";
  report.summary =
      "Objects of masses and springs move through a cube and are turned back at its border. A collision is "
      "counted when a "
      "pair of objects begins to collide: in the broad phase when their volumes begin to overlap; in the "
      "narrow phase, as "
      "the paper has it, when leaves of both octrees begin to overlap; and exactly, when triangles begin to "
      "intersect.";
  report.parameters = {
      {"runs", fmt::format("{} of each kind, seeds {} to {}", options.runs, options.seed,
                           options.seed + options.runs - 1)},
      {"simulated time", fmt::format("{} s a run", rounded(options.simulated_seconds))},
      {"by the clock",
       options.wall_clock ? fmt::format("{} s a run", rounded(*options.wall_clock)) : "not run"},
      {"spheres", "about the box's centre, to the farthest vertex (eq. 5)"},
      {"octrees of objects", "leaves of one triangle"},
      {"runs at a time", options.threads == 0 ? "one a core" : fmt::format("{}", options.threads)},
      {"scenes", "built in; the scene files of the same names hold their parameters"}};
  report.claims = {judge_more_with_boxes(events), judge_proof_of_cost(events),
                   judge_narrow_is_fewer(events), judge_ratio_tends_to_one(events),
                   judge_more_objects(events),    judge_complex_models(events),
                   judge_exact_equal(events),     judge_paper_arithmetic()};
  if (!clock.empty()) report.claims.insert(report.claims.begin() + 1, judge_clock(clock));

  Section by_events{"Counted by events in simulated time", {}};
  by_events.blocks.emplace_back(std::string(
      "The same seeds give the same motion with boxes and with spheres. The paper does not say how large its "
      "scene and how fast its objects were, so that numbers compare from row to row, not with the paper's "
      "one by "
      "one. Its runs were of ten minutes by the clock."));
  by_events.blocks.emplace_back(counts_plot("Broad phase", events, &RunCounts::broad, &PaperRow::broad));
  by_events.blocks.emplace_back(counts_plot("Narrow phase", events, &RunCounts::narrow, &PaperRow::narrow));
  by_events.blocks.emplace_back(means_table("table1_means", "Averages over the runs", events));
  by_events.blocks.emplace_back(counts_table("table1_runs", "Every run", events, options.seed));
  report.sections.push_back(std::move(by_events));
  if (!clock.empty()) {
    Section by_clock{"Counted by the clock, as the paper did", {}};
    by_clock.blocks.emplace_back(
        counts_plot("Broad phase, by the clock", clock, &RunCounts::broad, &PaperRow::broad));
    by_clock.blocks.emplace_back(means_table("table1_clock_means", "Averages over the runs", clock));
    by_clock.blocks.emplace_back(counts_table("table1_clock_runs", "Every run", clock, options.seed));
    report.sections.push_back(std::move(by_clock));
  }
  Section paper{"The paper's own numbers", {}};
  paper.blocks.emplace_back(paper_arithmetic());
  report.sections.push_back(std::move(paper));
  return report;
}

}  // namespace supple::experiments
