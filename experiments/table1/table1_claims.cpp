#include "table1/table1_claims.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include "judgement.hpp"
#include "table1/paper_table.hpp"
#include "table1/table1_clocks.hpp"

namespace supple::experiments {
namespace {

/// `holds` when a number is above 0 by more than two standard errors, `does_not_hold` when it is below.
Verdict verdict_above_zero(double number, double error) {
  if (number > 2 * error) return Verdict::holds;
  return number < -2 * error ? Verdict::does_not_hold : Verdict::cannot_tell;
}

std::vector<Both> of_table(std::vector<Both> scenes) {
  std::erase_if(scenes, [](const Both& both) { return !is_of_table(*both.boxes); });
  return scenes;
}

void append(std::string& list, const std::string& text) {
  if (!list.empty()) list += ", ";
  list += text;
}

/// `0.87 ± 0.03 (3 objects), …`
std::string ratios_text(const std::vector<Both>& scenes, const Quantity& quantity) {
  std::string list;
  for (const Both& both : scenes)
    append(list, fmt::format("{} ({})", text_of(sphere_ratio({both}, quantity)),
                             is_of_table(*both.boxes) ? fmt::format("{} objects", both.boxes->objects)
                                                      : both.boxes->scene.name));
  return list;
}
std::string ratios_text(const std::vector<Both>& scenes, Member member) {
  return ratios_text(scenes, number_of(member));
}

/// Holds when there are more collisions with boxes than with spheres.
Verdict more_with_boxes(const Estimate& ratio) {
  return verdict_above_zero(1 - ratio.mean, ratio.error);
}

Claim judge_more_with_boxes(const std::vector<Both>& scenes) {
  const Estimate broad = sphere_ratio(scenes, &RunCounts::broad);
  return {"more-with-boxes-simulated",
          "7",
          "“AABB allows more collisions than spheres”, counted in the same simulated time.",
          more_with_boxes(broad),
          fmt::format("In the broad phase, spheres begin {} times as many collisions as boxes; over all runs "
                      "{}. In the narrow phase: {}. The motion is the same with both, so the counts compare "
                      "only the volumes. A larger volume meets others more often, but it also touches them "
                      "longer, so two collisions can become one.",
                      ratios_text(scenes, &RunCounts::broad), text_of(broad),
                      ratios_text(scenes, &RunCounts::narrow)),
          broad,
          "collisions with spheres / with boxes, broad phase"};
}

Claim judge_clock(const std::vector<Both>& scenes, const char* what, const ByClock& clock) {
  const Estimate broad = sphere_ratio(scenes, clock.quantity(&RunCounts::broad));
  return {std::string("more-with-boxes-") + clock.name,
          "7",
          fmt::format("“AABB allows more collisions than spheres”, by the clock of {}.", what),
          more_with_boxes(broad),
          fmt::format("In the same time of {}, spheres begin {} times as many collisions as boxes in "
                      "the broad phase and {} in the narrow phase.",
                      what, ratios_text(scenes, clock.quantity(&RunCounts::broad)),
                      ratios_text(scenes, clock.quantity(&RunCounts::narrow))),
          broad,
          "collisions with spheres / with boxes, broad phase"};
}

Claim judge_proof_of_cost(const std::vector<Both>& scenes) {
  std::size_t differing = 0, total = 0;
  for (const auto& [boxes, spheres] : scenes) {
    for (std::size_t i = 0; i < boxes->counts.size(); ++i, ++total)
      differing += spheres->counts[i].broad != boxes->counts[i].broad;
  }
  return {
      "proof-of-cost", "7",
      "More collisions with boxes “proves that the overlapping test is less expensive than the test for "
      "spheres”.",
      differing > 0 ? Verdict::does_not_hold : Verdict::cannot_tell,
      fmt::format("In simulated time, the cost of a test has no influence. Still, {} of {} runs have "
                  "different numbers with the two volumes. The number of collisions depends on the shape of "
                  "the volumes and says nothing about the cost of their test.",
                  differing, total)};
}

Claim judge_narrow_is_fewer(const std::vector<Runs>& steps) {
  double broad = 0, narrow = 0, exact = 0;
  std::vector<double> differences;
  for (const Runs& runs : steps) {
    for (const RunCounts& run : runs.counts) {
      broad += static_cast<double>(run.broad);
      narrow += static_cast<double>(run.narrow);
      exact += static_cast<double>(run.exact);
      differences.push_back(static_cast<double>(run.broad) - static_cast<double>(run.narrow));
    }
  }
  const Estimate fewer = estimate_of(differences);
  Claim claim{
      "narrow-is-fewer",
      "7",
      "The narrow phase reports fewer collisions, and that it “takes more time to be computed … explains the "
      "smaller number”.",
      Verdict::cannot_tell,
      fmt::format("In simulated time, in which the time of the computation has no influence, a run has {} "
                  "collisions fewer in the narrow phase than in the broad phase.",
                  text_of(fewer)),
      fewer,
      "collisions of a run, broad phase − narrow phase"};
  const Verdict is_fewer = verdict_above_zero(fewer.mean, fewer.error);
  if (is_fewer == Verdict::cannot_tell) return claim;
  claim.verdict = Verdict::does_not_hold;
  claim.reason += fmt::format(
      " 100 collisions in the broad phase correspond to {:.0f} in the narrow phase and {:.0f} exact ones. {}",
      100 * narrow / broad, 100 * exact / broad,
      is_fewer == Verdict::holds
          ? "So they are fewer, but time does not explain it: volumes of objects can overlap while no leaves "
            "overlap."
          : "So they are not fewer: leaves can separate and meet again while the volumes overlap.");
  return claim;
}

/// The scene with a number of objects, or nothing.
std::vector<Both> with_objects(const std::vector<Both>& scenes, std::uint64_t objects) {
  for (const Both& both : scenes) {
    if (is_of_table(*both.boxes) && both.boxes->objects == objects) return {both};
  }
  return {};
}

/// Whether the mean ratio of one group is nearer to 1 than that of another.
Verdict nearer_to_one(const Estimate& ratio, const Estimate& other) {
  return verdict_above_zero(std::fabs(other.mean - 1) - std::fabs(ratio.mean - 1),
                            std::hypot(ratio.error, other.error));
}

std::optional<Claim> judge_ratio_tends_to_one(const std::vector<Both>& scenes) {
  const std::vector<Both> few = with_objects(scenes, 3), many = with_objects(scenes, 9);
  if (few.empty() || many.empty()) return std::nullopt;
  const Verdict verdict =
      nearer_to_one(sphere_ratio(many, &RunCounts::broad), sphere_ratio(few, &RunCounts::broad));
  return Claim{
      "ratio-nears-one",
      "7",
      "The ratio of spheres to boxes in the broad phase comes nearer to 1 from 3 to 9 objects.",
      verdict,
      fmt::format("Our ratios are {}; the paper's are 0.50, 0.82 and 0.91 for 3, 6 and 9 objects. {}",
                  ratios_text(scenes, &RunCounts::broad),
                  verdict == Verdict::holds ? "The distance from 1 shrinks by more than two standard errors."
                  : verdict == Verdict::cannot_tell
                      ? "The change from 3 to 9 is within twice its standard error."
                      : "The distance from 1 grows by more than two standard errors."),
      sphere_ratio(many, &RunCounts::broad),
      "collisions with spheres / with boxes, 9 objects, broad phase"};
}

/// Two numbers of collisions are almost the same when they differ by at most this part.
constexpr double almost_the_same = 0.1;

/// Whether the ratio of spheres to boxes is almost 1 in all scenes of at least `least` objects.
Verdict almost_one(const std::vector<Both>& scenes, std::uint64_t least, Member member) {
  Verdict verdict = Verdict::holds;
  for (const Both& both_runs : scenes) {
    if (both_runs.boxes->objects < least) continue;
    const Estimate ratio = sphere_ratio({both_runs}, member);
    verdict = both(verdict, verdict_above_zero(almost_the_same - std::fabs(ratio.mean - 1), ratio.error));
  }
  return verdict;
}

std::optional<Claim> judge_convergence(const std::vector<Both>& scenes) {
  constexpr std::uint64_t least_broad = 10, least_narrow = 20;
  const auto has = [&](std::uint64_t least) {
    return std::any_of(scenes.begin(), scenes.end(),
                       [&](const Both& both_runs) { return both_runs.boxes->objects >= least; });
  };
  if (!has(least_broad)) return std::nullopt;
  const Both& most_objects =
      *std::max_element(scenes.begin(), scenes.end(),
                        [](const Both& a, const Both& b) { return a.boxes->objects < b.boxes->objects; });
  Verdict verdict = almost_one(scenes, least_broad, &RunCounts::broad);
  verdict = both(verdict, has(least_narrow) ? almost_one(scenes, least_narrow, &RunCounts::narrow)
                                            : Verdict::cannot_tell);
  return Claim{
      "almost-the-same",
      "7",
      "The number with spheres “is almost the same … in the Broad Phase for 10 or more objects”, and in the "
      "narrow phase from “20 or more objects” on.",
      verdict,
      fmt::format("Spheres begin this many times as many collisions as boxes: in the broad phase {}; in the "
                  "narrow phase {}. Almost the same means here that they differ by at most {:.0f} %.{}",
                  ratios_text(scenes, &RunCounts::broad), ratios_text(scenes, &RunCounts::narrow),
                  100 * almost_the_same, has(least_narrow) ? "" : " No scene has 20 objects or more."),
      sphere_ratio({most_objects}, &RunCounts::broad),
      fmt::format("collisions with spheres / with boxes, {} objects, broad phase",
                  most_objects.boxes->objects)};
}

std::optional<Claim> judge_more_objects(const std::vector<Runs>& all) {
  Claim claim{"more-objects", "7", "With more objects a collision comes sooner.", Verdict::holds};
  for (const Runs& first : all) {
    if (!is_of_table(first)) continue;
    std::vector<const Runs*> same_volume;
    for (const Runs& runs : all) {
      if (is_of_table(runs) && runs.volume == first.volume) same_volume.push_back(&runs);
    }
    if (same_volume.size() < 2) return std::nullopt;
    if (same_volume.front() != &first) continue;  // the volume is judged already
    std::sort(same_volume.begin(), same_volume.end(),
              [](const Runs* a, const Runs* b) { return a->objects < b->objects; });
    std::string seconds, objects, pairs;
    for (const Runs* const runs : same_volume) {
      append(seconds, rounded(runs->seconds_for_one(&RunCounts::broad)));
      append(objects, fmt::format("{}", runs->objects));
      append(pairs, fmt::format("{}", runs->objects * (runs->objects - 1) / 2));
    }
    const Estimate few = same_volume.front()->estimate(&RunCounts::broad);
    const Estimate many = same_volume.back()->estimate(&RunCounts::broad);
    claim.verdict =
        both(claim.verdict, verdict_above_zero(many.mean - few.mean, std::hypot(few.error, many.error)));
    if (!claim.number) {
      claim.number = quotient(many, few);
      claim.quantity = fmt::format("collisions with {} / with {} objects, {}", same_volume.back()->objects,
                                   same_volume.front()->objects, word_of(first.volume));
    }
    claim.reason += fmt::format("{} in the broad phase: one every {} s for {} objects, which are {} pairs. ",
                                word_of(first.volume), seconds, objects, pairs);
  }
  if (claim.reason.empty()) return std::nullopt;
  claim.reason.pop_back();
  return claim;
}

std::optional<Claim> judge_smaller_scene(const std::vector<Runs>& all) {
  Claim claim{"smaller-scene", "7",
              "“The smaller the size of the scene, the larger the number of collisions”.", Verdict::holds};
  for (const Runs& other : all) {
    const Runs* const first = find(all, other.scene.name, other.volume);
    if (other.is_first_size || first == nullptr || !first->edge || !other.edge) continue;
    const bool is_smaller = *other.edge < *first->edge;
    const Runs &small = is_smaller ? other : *first, &large = is_smaller ? *first : other;
    const Estimate in_small = small.estimate(&RunCounts::broad), in_large = large.estimate(&RunCounts::broad);
    claim.verdict = both(claim.verdict, verdict_above_zero(in_small.mean - in_large.mean,
                                                           std::hypot(in_small.error, in_large.error)));
    if (!claim.number) {
      claim.number = quotient(in_small, in_large);
      claim.quantity = fmt::format("collisions with edge {} / with edge {}, {}", *small.edge, *large.edge,
                                   word_of(other.volume));
    }
    append(claim.reason,
           fmt::format("{} collisions in the broad phase with edge {} and {} with edge {} ({}, {})",
                       text_of(in_small), *small.edge, text_of(in_large), *large.edge, other.scene.name,
                       word_of(other.volume)));
  }
  if (claim.reason.empty()) return std::nullopt;
  claim.reason += '.';
  return claim;
}

/// The time of a step of the whole program.
std::optional<Claim> judge_interactive(const std::vector<Runs>& all) {
  constexpr double longest = 1.0 / 30;
  Claim claim{
      "interactive", "8",
      "The program is “able to compute all the contacts among multiple objects at interactive rates”. "
      "Read as: motion and detection of a step take less than 1/30 s in the scenes of Table 1.",
      Verdict::holds};
  for (const Runs& runs : all) {
    std::vector<double> program, detection;
    for (const RunCounts& run : runs.counts) {
      const auto steps = static_cast<double>(run.steps);
      program.push_back((run.detection_seconds + run.motion_seconds) / steps);
      detection.push_back(run.detection_seconds / steps);
    }
    const Estimate step = estimate_of(program);
    append(claim.reason,
           fmt::format("{} ms, {} of them for the detection ({}, {})", rounded(step.mean * 1e3, 2),
                       rounded(estimate_of(detection).mean * 1e3, 2), runs.scene.name, word_of(runs.volume)));
    if (!is_of_table(runs) || runs.objects > 9) continue;
    claim.verdict = both(claim.verdict, below(step, longest));
    if (!claim.number || step.mean > claim.number->mean / 1e3) {
      claim.number = Estimate{step.mean * 1e3, step.error * 1e3};
      claim.quantity = fmt::format("ms of a step, {} objects, {}", runs.objects, word_of(runs.volume));
    }
  }
  if (!claim.number) return std::nullopt;
  claim.reason = "A step takes " + claim.reason + ". On a machine of today, not of 2007.";
  return claim;
}

std::optional<Claim> judge_complex_models(const std::vector<Both>& scenes) {
  std::vector<Both> complex = scenes;
  std::erase_if(complex, [](const Both& both_runs) {
    return both_runs.boxes->scene.source != Table1Scene::Source::built_in;
  });
  const std::vector<Both> simple = with_objects(scenes, 3);
  if (complex.empty() || simple.empty()) return std::nullopt;
  const Estimate of_simple = sphere_ratio(simple, &RunCounts::broad);
  return Claim{
      "complex-models",
      "7",
      "With more complex objects (human, bike) there are “about one or two collisions more with AABBs than "
      "with spheres”: the difference goes away.",
      nearer_to_one(sphere_ratio(complex, &RunCounts::broad), of_simple),
      fmt::format(
          "The ratio of collisions with spheres to collisions with boxes in the broad phase: {}; three "
          "simple objects {}. The difference between a sphere and a box depends on the shape of the "
          "object, not on the number of its vertices.",
          ratios_text(complex, &RunCounts::broad), text_of(of_simple)),
      sphere_ratio(complex, &RunCounts::broad),
      "collisions with spheres / with boxes, human and bike"};
}

/// Our own claim: exact contacts do not depend on volumes.
std::optional<Claim> judge_exact_equal(const std::vector<Runs>& steps) {
  std::size_t differing = 0, total = 0;
  for (const Runs& runs : steps) {
    const auto other = std::find_if(steps.begin(), steps.end(), [&](const Runs& r) {
      return r.scene.name == runs.scene.name && r.edge == runs.edge;
    });
    if (&*other == &runs) continue;
    for (std::size_t i = 0; i < runs.counts.size(); ++i, ++total)
      differing += runs.counts[i].exact != other->counts[i].exact;
  }
  if (total == 0) return std::nullopt;
  return Claim{
      "exact-counts-equal", "", "Exact contacts are the same with all volumes.", verdict_of(differing == 0),
      fmt::format("{} of {} runs have another number than the run with the first volume and the same "
                  "seed.{}",
                  differing, total,
                  differing > 0 ? " Spheres of eq. 3 and 4 do not enclose all vertices, so detection "
                                  "with them misses contacts."
                                : "")};
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
  return {"averages", "7", "The averages of the text are those of Table 1.", verdict_of(differing == 0),
          fmt::format(
              "{} of {} agree, {} were cut off after two decimals instead of rounded, and {} {} "
              "not agree{}. The text gives 18, 35, 32, 17, 21 as the results of the broad phase with "
              "spheres. In the table these are the results with AABBs, and the averages fit the table.",
              agreeing, agreeing + cut + differing, cut, differing, differing == 1 ? "does" : "do", which)};
}

}  // namespace

std::vector<Claim> judge_table1(const std::vector<Runs>& steps, const std::vector<Runs>& program) {
  std::vector<Claim> claims;
  const auto add = [&](std::optional<Claim> claim) {
    if (claim) claims.push_back(std::move(*claim));
  };
  const auto clocks = by_clocks(steps, program);
  const std::vector<Both> by_steps = with_both(steps);
  if (!of_table(by_steps).empty()) add(judge_more_with_boxes(of_table(by_steps)));
  if (const auto scenes = of_table(with_both(*clocks[1].runs)); !scenes.empty())
    add(judge_clock(scenes, "detection", clocks[1]));
  if (const auto scenes = of_table(with_both(*clocks[2].runs)); !scenes.empty())
    add(judge_clock(scenes, "detection and motion", clocks[2]));
  if (!by_steps.empty()) add(judge_proof_of_cost(by_steps));
  if (!steps.empty()) add(judge_narrow_is_fewer(steps));
  // Both ways of counting can decide the other claims; simulated time does not depend on the machine.
  const std::vector<Runs>& all = steps.empty() ? program : steps;
  const std::vector<Both> scenes = with_both(all);
  const std::size_t first = claims.size();
  add(judge_ratio_tends_to_one(of_table(scenes)));
  add(judge_convergence(of_table(scenes)));
  add(judge_more_objects(all));
  add(judge_smaller_scene(all));
  add(judge_complex_models(scenes));
  add(judge_interactive(all));
  for (std::size_t i = first; steps.empty() && i < claims.size(); ++i)
    claims[i].reason = "By the clock. " + claims[i].reason;
  add(judge_exact_equal(steps));
  add(judge_paper_arithmetic());
  return claims;
}

}  // namespace supple::experiments
