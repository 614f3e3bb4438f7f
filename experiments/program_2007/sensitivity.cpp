#include "program_2007/sensitivity.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <variant>
#include <vector>

#include "base/files.hpp"
#include "fit.hpp"
#include "inputs/inputs.hpp"
#include "judgement.hpp"
#include "supple/error.hpp"
#include "table1/paper_table.hpp"
#include "table1/table1_runs.hpp"
#include "table1/table1_scenes.hpp"
#include "work.hpp"

namespace supple::experiments {
namespace {

constexpr std::array<std::uint32_t, 3> object_counts{3, 6, 9};
constexpr std::array volumes{BoundingVolume::aabb, BoundingVolume::sphere};

/// A value of one parameter of the method; all others have their defaults.
struct MethodSetting {
  std::string name;
  Table1Method method{};
};

/// A motion, and the methods that see it. One parameter differs from the defaults: of the motion or of the
/// method.
struct Motion {
  std::vector<MethodSetting> methods;
  std::optional<double> size{};
  std::function<void(MassSpringMotion&)> change{};
};

std::vector<MethodSetting> method_settings() {
  std::vector<MethodSetting> all{{"the scenes as they are"}};
  const auto add = [&](const std::string& name, const std::function<void(Table1Method&)>& change) {
    change(all.emplace_back(MethodSetting{name}).method);
  };
  for (const std::uint32_t level : {1u, 3u, 4u})
    add(fmt::format("level-allowed {} of the scene", level),
        [=](Table1Method& m) { m.scene.scene_octree.max_level = level; });
  for (const std::uint32_t level : {1u, 2u, 3u, 4u})
    add(fmt::format("level-allowed {} of the objects", level),
        [=](Table1Method& m) { m.octree.max_level = level; });
  for (const std::uint32_t size : {4u, 16u})
    add(fmt::format("leaves of up to {} triangles", size),
        [=](Table1Method& m) { m.octree.leaf_size = size; });
  add("spheres of eq. 3 and 4", [](Table1Method& m) { m.scene.comparison.sphere_fit = SphereFit::box; });
  return all;
}

std::vector<Motion> motions(bool quick) {
  std::vector<Motion> all{{method_settings()}};
  for (const double size : {4.0, 5.0, 8.0, 10.0}) all.push_back({{{fmt::format("cube of {}", size)}}, size});
  const auto add = [&](const std::string& name, const std::function<void(MassSpringMotion&)>& change) {
    all.push_back({{{name}}, {}, change});
  };
  for (const double factor : {0.25, 0.5, 2.0, 4.0})
    add(fmt::format("speed × {}", factor), [=](MassSpringMotion& m) { m.random_speed *= factor; });
  for (const double factor : {0.25, 0.5, 2.0})
    add(fmt::format("stiffness × {}", factor), [=](MassSpringMotion& m) {
      m.springs.stiffness *= factor;
      m.springs.bending_stiffness *= factor;
      m.springs.area_stiffness *= factor;
      m.springs.damping *= std::sqrt(factor);
    });
  for (const double factor : {0.0, 0.5, 2.0})
    add(fmt::format("forces × {}", factor), [=](MassSpringMotion& m) { m.random_force *= factor; });
  if (quick) {
    all.resize(2);
    all.front().methods.resize(2);
  }
  return all;
}

/// Collisions of a run by each clock, up to a factor: in simulated time, of the detection, of the program.
std::array<double, 3> by_clocks(std::uint64_t collisions, const RunCounts& run) {
  return {static_cast<double>(collisions), in_ten_minutes_of_detection(collisions, run),
          in_ten_minutes_of_program(collisions, run)};
}
constexpr std::array clock_names{"simulated time", "detection alone", "whole program"};

/// The runs of one setting: by number of objects, by volume, by seed.
using SettingRuns = std::array<std::array<std::vector<RunCounts>, volumes.size()>, object_counts.size()>;

/// The ratio of spheres to boxes over the runs.
Estimate ratio_of(const SettingRuns& runs, std::size_t objects, std::size_t clock, bool is_broad) {
  std::array<std::vector<double>, volumes.size()> numbers;
  for (std::size_t v = 0; v < volumes.size(); ++v) {
    for (const RunCounts& run : runs[objects][v])
      numbers[v].push_back(by_clocks(is_broad ? run.broad : run.narrow, run)[clock]);
  }
  return ratio_of_sums(numbers[1], numbers[0]);
}

/// Whether both are the same within two standard errors of their difference.
bool agree(const Estimate& ours, const Estimate& theirs) {
  return std::fabs(ours.mean - theirs.mean) <= 2 * std::hypot(ours.error, theirs.error);
}

/// One run of a motion with all its methods, boxes and spheres in turn.
std::vector<RunCounts> run_one(const Motion& motion, std::size_t objects, std::uint64_t seed,
                               double seconds) {
  std::vector<Variant> variants;
  for (const MethodSetting& setting : motion.methods) {
    for (const BoundingVolume volume : volumes) {
      variants.push_back({setting.method, volume});
      variants.back().method.scene.contacts = ContactKinds::none;
    }
  }
  const Table1Scene scene = mixed_scene(object_counts[objects], motion.size);
  const auto change = [&](cli::Input& input) {
    for (cli::InputObject& object : input.objects) {
      if (motion.change) motion.change(std::get<MassSpringMotion>(*object.motion));
    }
  };
  const auto steps =
      static_cast<std::uint64_t>(std::llround(seconds / read_scene(scene, {}, seed).simulation.time_step));
  return run_scene(
      scene, variants, seed, 1, [&](const RunCounts& so_far) { return so_far.steps < steps; }, change);
}

/// All runs of all settings, in the order of the motions and their methods.
std::vector<SettingRuns> run_all(const std::vector<Motion>& all, const SensitivityOptions& options,
                                 Work& work) {
  struct Task {
    const Motion* motion;
    std::size_t first_setting, objects, run;
  };
  std::vector<SettingRuns> results;
  std::vector<Task> tasks;
  for (const Motion& motion : all) {
    for (std::size_t o = 0; o < object_counts.size(); ++o) {
      for (std::size_t run = 0; run < options.runs; ++run) tasks.push_back({&motion, results.size(), o, run});
    }
    results.resize(results.size() + motion.methods.size());
  }
  for (SettingRuns& setting : results) {
    for (auto& of_objects : setting) {
      for (std::vector<RunCounts>& of_volume : of_objects) of_volume.resize(options.runs);
    }
  }
  std::mutex mutex;
  in_parallel(tasks.size(), options.threads, [&](std::size_t index) {
    const Task& task = tasks[index];
    std::vector<RunCounts> counts =
        run_one(*task.motion, task.objects, options.seed + task.run, options.seconds);
    const std::lock_guard lock(mutex);
    for (std::size_t i = 0; i < counts.size(); ++i) {
      results[task.first_setting + i / volumes.size()][task.objects][i % volumes.size()][task.run] =
          std::move(counts[i]);
    }
    work.done(1, task.motion->methods.front().name);
    return true;
  });
  return results;
}

constexpr std::size_t setting_column = 0, clock_column = 1, phase_column = 2,
                      converges_column = 3 + 2 * object_counts.size(), agrees_column = converges_column + 1;
constexpr const char* table_name = "sensitivity";

Table empty_table() {
  Table table{
      table_name,
      "Collisions with spheres for each collision with boxes, and whether all three agree with the paper "
      "within two standard errors",
      {{"setting", "Setting"}, {"clock", "Clock"}, {"phase", "Phase"}}};
  for (const std::uint32_t objects : object_counts) {
    table.columns.push_back({fmt::format("ratio_{}", objects), fmt::format("{} objects", objects)});
    table.columns.push_back({fmt::format("ratio_{}_error", objects), "± error", 2});
  }
  table.columns.push_back({"converges", "From 3 to 9"});
  table.columns.push_back({"agrees", "The paper's"});
  table.columns.push_back({"mean_strain", "Mean strain"});
  return table;
}

Table table_of(const std::vector<std::string>& names, const std::vector<SettingRuns>& results,
               std::uint32_t runs) {
  Table table = empty_table();
  for (std::size_t s = 0; s < names.size(); ++s) {
    double strain = 0;
    for (const RunCounts& run : results[s][2][0]) strain += run.strain.mean / runs;
    for (std::size_t clock = 0; clock < clock_names.size(); ++clock) {
      for (const bool is_broad : {true, false}) {
        std::vector<Cell> row{names[s], std::string(clock_names[clock]),
                              std::string(is_broad ? "broad" : "narrow")};
        std::array<Estimate, 3> ratios{};
        bool all_agree = true;
        for (std::size_t o = 0; o < object_counts.size(); ++o) {
          ratios[o] = ratio_of(results[s], o, clock, is_broad);
          row.push_back(cell_of(ratios[o].mean));
          row.push_back(cell_of(ratios[o].error));
          all_agree = all_agree && agree(ratios[o], *paper_ratio(object_counts[o], is_broad));
        }
        const double growth = ratios[2].mean - ratios[0].mean,
                     error = std::hypot(ratios[2].error, ratios[0].error);
        // Towards 1, as the paper's ratios grow from below.
        const bool converges =
            std::fabs(ratios[2].mean - 1) < std::fabs(ratios[0].mean - 1) && std::fabs(growth) > 2 * error;
        row.emplace_back(std::string(converges                       ? "nearer to 1"
                                     : std::fabs(growth) > 2 * error ? "other"
                                                                     : "undecided"));
        row.emplace_back(std::string(all_agree ? "yes" : "no"));
        row.emplace_back(strain);
        table.add(std::move(row));
      }
    }
  }
  return table;
}

/// The table of an earlier run, with its comments.
Table read_table(const std::filesystem::path& path) {
  Table table = empty_table();
  const std::string text = cli::read_text(path);
  const auto rows = parse_csv(text).rows;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    std::vector<Cell> row;
    for (std::size_t column = 0; column < rows[i].size(); ++column) {
      const std::string& field = rows[i][column];
      double number = 0;
      const auto [end, fault] = std::from_chars(field.data(), field.data() + field.size(), number);
      if (fault == std::errc{} && end == field.data() + field.size())
        row.emplace_back(number);
      else
        row.push_back(field.empty() ? Cell() : Cell(field));
    }
    table.add(std::move(row));
  }
  table.head = head_of(text);
  return table;
}

/// The paper has both phases, so a setting agrees with it by a clock when both do.
Claim judge(const Table& table) {
  const auto word = [&](std::size_t row, std::size_t column) {
    return std::get<std::string>(table.rows[row][column]);
  };
  std::size_t converging = 0, broad = 0, narrow = 0;
  std::string both_agree;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const bool is_broad = word(row, phase_column) == "broad", agrees = word(row, agrees_column) == "yes";
    converging += word(row, converges_column) == "nearer to 1";
    (is_broad ? broad : narrow) += agrees;
    // The row of the narrow phase follows that of the broad phase.
    if (is_broad && agrees && word(row + 1, agrees_column) == "yes")
      both_agree += fmt::format("{}{} ({})", both_agree.empty() ? "" : "; ", word(row, setting_column),
                                word(row, clock_column));
  }
  const std::size_t combinations = table.rows.size() / 2;
  return {
      "convergence",
      "7",
      "The ratio of spheres to boxes nears 1 from 3 to 9 objects: 0.50, 0.82 and 0.91 in the broad phase, "
      "0.42, 0.74 and 0.71 in the narrow phase, for some setting that the paper does not state.",
      verdict_of(!both_agree.empty()),
      fmt::format(
          "{} {} combinations of a setting and a clock, all three ratios are those of the paper within "
          "two standard errors in the broad phase for {} and in the narrow phase for {}, where the "
          "paper's own errors are large. In {} of {} rows, the ratio comes nearer to 1 from 3 to 9 "
          "objects by more than two standard errors.",
          both_agree.empty() ? "No setting gives both phases. Of"
                             : fmt::format("These give both phases: {}. Of", both_agree),
          combinations, broad, narrow, converging, table.rows.size()),
      Estimate{static_cast<double>(broad), NAN},
      fmt::format("of {} combinations of a setting and a clock with the paper's ratios in the broad phase",
                  combinations)};
}

}  // namespace

SensitivityOptions sensitivity_options(bool quick) {
  SensitivityOptions options;
  if (quick) {
    options.quick = true;
    options.seconds = 10;
    options.runs = 2;
  }
  return options;
}

Report run_sensitivity(const SensitivityOptions& options, const std::filesystem::path& folder, bool resume,
                       bool show_progress) {
  const std::filesystem::path path = folder / (std::string(table_name) + ".csv");
  Table table = empty_table();
  if (resume && std::filesystem::exists(path)) {
    table = read_table(path);
  } else {
    const std::vector<Motion> all = motions(options.quick);
    Work work(all.size() * object_counts.size() * options.runs, show_progress);
    const std::vector<SettingRuns> results = run_all(all, options, work);
    std::vector<std::string> names;
    for (const Motion& motion : all) {
      for (const MethodSetting& setting : motion.methods) names.push_back(setting.name);
    }
    table = table_of(names, results, options.runs);
  }
  Report report;
  report.name = "sensitivity";
  report.title = "Which settings give the convergence of the paper?";
  report.summary =
      "The paper does not state the size of its scene, the speed and the stiffness of its objects, nor "
      "level-allowed. This sweep changes one of them at a time and counts by all three clocks. Numbers by a "
      "clock are collisions in simulated time divided by the seconds that the detection, or the program, "
      "took "
      "for it. All methods see the same motion, step by step.";
  report.parameters = {{"seconds", fmt::format("{}", options.seconds)},
                       {"runs", fmt::format("{}", options.runs)},
                       {"seed", fmt::format("{}", options.seed)}};
  report.claims = {judge(table)};
  report.sections = {{"All settings", {}, {table}}};
  return report;
}

}  // namespace supple::experiments
