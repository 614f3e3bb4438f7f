#include "program_2007/few_objects.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <string>

#include "fit.hpp"
#include "judgement.hpp"
#include "studies/box_field.hpp"
#include "supple/broad_phase.hpp"
#include "supple/error.hpp"

namespace supple::experiments {
namespace {

enum : std::size_t { octree_of_2007_method, octree, sweep, sweep3, brute, grid, method_count };
constexpr std::array<const char*, method_count> method_names{
    "octree of 2007", "octree", "sweep and prune", "sweep and prune on three axes", "brute force", "grid"};

BroadPhaseOptions options_of(std::size_t method, const BoxField& field) {
  if (method == octree_of_2007_method) return broad_phase_of_2007(field);
  BroadPhaseOptions options;
  options.threads = 1;
  options.method = method == sweep    ? BroadPhaseMethod::sweep
                   : method == sweep3 ? BroadPhaseMethod::sweep3
                   : method == brute  ? BroadPhaseMethod::brute
                   : method == grid   ? BroadPhaseMethod::grid
                                      : BroadPhaseMethod::octree;
  return options;
}

/// One method over the same motion.
class Method {
 public:
  Method(std::size_t method, const BoxField& field)
      : broad_phase_(options_of(method, field)), counts_exchanges_(method == sweep3) {
    broad_phase_.find_object_pairs(field.boxes());
  }
  std::size_t step(const std::vector<Aabb>& boxes) { return broad_phase_.find_object_pairs(boxes).size(); }
  std::uint64_t tests() const {
    const BroadPhaseStats& stats = broad_phase_.stats();
    return counts_exchanges_ ? stats.exchanges : stats.object_pairs_tested;
  }

 private:
  BroadPhase broad_phase_;
  bool counts_exchanges_;
};

/// Seconds of a step, by method and round; tests of the last step.
struct Costs {
  std::array<std::vector<double>, method_count> seconds;
  std::array<std::uint64_t, method_count> tests{};
  std::uint64_t pairs = 0;
};

Costs measure(std::size_t count, const FewObjectsOptions& options) {
  BoxField field(count, options.seed);
  std::vector<std::unique_ptr<Method>> methods;
  for (std::size_t m = 0; m < method_count; ++m) methods.push_back(std::make_unique<Method>(m, field));
  const auto steps =
      static_cast<std::size_t>(options.steps_of_round) * std::max<std::size_t>(1000 / count, 1);
  Costs costs;
  for (int round = 0; round < options.rounds; ++round) {
    std::vector<std::vector<Aabb>> frames;
    for (std::size_t step = 0; step < steps; ++step) {
      field.move();
      frames.emplace_back(field.boxes().begin(), field.boxes().end());
    }
    std::optional<std::size_t> pairs;
    for (std::size_t m = 0; m < method_count; ++m) {
      std::size_t found = 0;
      const double seconds = seconds_of([&] {
        for (const std::vector<Aabb>& boxes : frames) found = methods[m]->step(boxes);
      });
      costs.seconds[m].push_back(seconds / static_cast<double>(steps));
      costs.tests[m] = methods[m]->tests();
      if (pairs.value_or(found) != found) throw Error("the methods of the broad phase found different pairs");
      pairs = found;
    }
    costs.pairs = *pairs;
  }
  return costs;
}

}  // namespace

std::uint64_t work_of(const FewObjectsOptions& options) {
  return options.object_counts.size();
}

FewObjects measure_few_objects(const FewObjectsOptions& options, Work& work) {
  constexpr std::size_t largest_of_paper = 9;
  FewObjects result;
  result.table = {"scaling_few_objects",
                  "Microseconds of a step (median of the rounds), and the ratio to the octree of 2007",
                  {{"objects", "Objects"},
                   {"method", "Method"},
                   {"step_us", "Step µs"},
                   {"step_error", "± error", 2},
                   {"times", "× octree of 2007"},
                   {"times_error", "± error", 2},
                   {"tests", "Tests or exchanges"},
                   {"pairs", "Pairs"}}};
  std::string of_brute, of_sweep;
  std::optional<Verdict> beats_brute, like_sweep;
  std::optional<std::size_t> crossing;
  for (const std::size_t count : options.object_counts) {
    const Costs costs = measure(count, options);
    std::array<Estimate, method_count> ratios{};
    for (std::size_t m = 0; m < method_count; ++m) {
      ratios[m] = ratio_of(costs.seconds[m], costs.seconds[octree_of_2007_method]);
      std::vector<double> microseconds = costs.seconds[m];
      for (double& number : microseconds) number *= 1e6;
      const Estimate step = median_of(microseconds);
      result.table.add({std::uint64_t{count}, std::string(method_names[m]), step.mean, step.error,
                        ratios[m].mean, ratios[m].error, costs.tests[m], costs.pairs});
    }
    const auto append = [&](std::string& list, const Estimate& ratio) {
      list += fmt::format("{}{} ({})", list.empty() ? "" : ", ", text_of(ratio), count);
    };
    append(of_brute, ratios[brute]);
    append(of_sweep, ratios[sweep]);
    // Brute force takes more time: its ratio is above 1.
    const Verdict below_one = below(ratios[brute], 1);
    if (below_one == Verdict::does_not_hold && !crossing) crossing = count;
    if (below_one != Verdict::does_not_hold) crossing.reset();
    const Verdict better = below_one == Verdict::holds           ? Verdict::does_not_hold
                           : below_one == Verdict::does_not_hold ? Verdict::holds
                                                                 : Verdict::cannot_tell;
    if (count == largest_of_paper) {
      result.better_than_brute.number = ratios[brute];
      result.comparable_with_sweep.number = ratios[sweep];
    }
    if (count <= largest_of_paper) beats_brute = beats_brute ? both(*beats_brute, better) : better;
    const Verdict similar = within(ratios[sweep], 0.5, 2);
    if (count <= largest_of_paper) like_sweep = like_sweep ? both(*like_sweep, similar) : similar;
    work.done(1, fmt::format("broad phase of {} boxes", count));
  }
  result.better_than_brute = {
      "better-than-brute",
      "7",
      "“Our Broad Phase method is better than the brute force Broad Phase”, at the sizes of the paper: 3, 6 "
      "and "
      "9 objects.",
      beats_brute.value_or(Verdict::cannot_tell),
      fmt::format(
          "Brute force takes this many times the time of the octree of 2007 (number of objects): {}. {}",
          of_brute,
          crossing ? fmt::format("From {} objects on, the octree takes less time.", *crossing)
                   : "The octree does not take less time at any of these sizes."),
      result.better_than_brute.number,
      "time of brute force / of the octree of 2007, 9 objects"};
  result.comparable_with_sweep = {
      "like-sweep",
      "7",
      "“… and comparable with the sweep and prune method”, at the sizes of the paper. Read as: within a "
      "factor "
      "of two.",
      like_sweep.value_or(Verdict::cannot_tell),
      fmt::format(
          "Sweep and prune takes this many times the time of the octree of 2007 (number of objects): {}.",
          of_sweep),
      result.comparable_with_sweep.number,
      "time of sweep and prune / of the octree of 2007, 9 objects"};
  return result;
}

}  // namespace supple::experiments
