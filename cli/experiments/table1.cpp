#include "experiments/table1.hpp"

#include <fmt/core.h>

#include <string>
#include <utility>

#include "experiments/paper_table.hpp"
#include "experiments/table1_claims.hpp"
#include "experiments/table1_scenes.hpp"

namespace supple::experiments {
namespace {

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

/// The paper's row for a scene, if the paper has numbers for it.
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

/// Plots runs as points, ours and the paper's, for 3, 6 and 9 objects.
Plot counts_plot(const std::string& title, const std::vector<Runs>& all, std::uint64_t RunCounts::*member,
                 std::array<double, 5> PaperRow::*paper_member) {
  Plot plot{title, "objects", "collisions in ten minutes", false, true};
  plot.x_names = {{3, "3"}, {6, "6"}, {9, "9"}};
  int color = 0;
  for (const bool ours : {true, false}) {
    for (const BoundingVolume volume : table1_volumes) {
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

}  // namespace

Table1Options table1_options(bool quick) {
  Table1Options options;
  options.scenes = table1_scene_names();
  if (!quick) return options;
  options.scenes = {"table1_3", "table1_6", "table1_9", "three_humans"};
  options.simulated_seconds = 12;
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
      "Objects of masses and springs move through a cube whose border reflects them. A collision is counted "
      "when a pair of objects begins to collide: in the broad phase when their volumes begin to overlap; in "
      "the narrow phase, as in the paper, when leaves of both octrees begin to overlap; and exactly when "
      "triangles begin to intersect.";
  report.parameters = {
      {"runs", fmt::format("{} of each kind, seeds {} to {}", options.runs, options.seed,
                           options.seed + options.runs - 1)},
      {"simulated time", fmt::format("{} s per run", rounded(options.simulated_seconds))},
      {"by the clock",
       options.wall_clock ? fmt::format("{} s per run", rounded(*options.wall_clock)) : "not run"},
      {"spheres", "around the centre of the box, to the farthest vertex (eq. 5)"},
      {"octrees of objects", "leaves of one triangle"},
      {"parallel runs", options.threads == 0 ? "one per core" : fmt::format("{}", options.threads)},
      {"scenes", "built in; the scene files of the same names hold their parameters"}};
  report.claims = judge_table1(events, clock);

  Section by_events{"Counted by events in simulated time", {}};
  by_events.blocks.emplace_back(
      std::string("The same seeds give the same motion with boxes and with spheres. The paper does not give "
                  "the size of its scene and the speed of its objects. So compare rows with each other, not "
                  "single numbers with those of the paper. Its runs took ten minutes of real time."));
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
