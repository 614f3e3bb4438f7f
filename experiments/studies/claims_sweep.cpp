#include <fmt/core.h>

#include <array>
#include <string>
#include <vector>

#include "base/text.hpp"
#include "fit.hpp"
#include "judgement.hpp"
#include "studies/box_field.hpp"
#include "studies/claims.hpp"
#include "supple/broad_phase.hpp"
#include "supple/error.hpp"
#include "work.hpp"

namespace supple::experiments {
namespace {

/// Boxes of which every `stride`-th moves.
class PartlyMoving {
 public:
  PartlyMoving(std::size_t count, std::size_t stride, std::uint64_t seed)
      : field_(count, seed), stride_(stride), boxes_(field_.boxes().begin(), field_.boxes().end()) {}

  void move() {
    field_.move();
    for (std::size_t i = 0; i < boxes_.size(); i += stride_) boxes_[i] = field_.boxes()[i];
  }
  const std::vector<Aabb>& boxes() const { return boxes_; }

 private:
  BoxField field_;
  std::size_t stride_;
  std::vector<Aabb> boxes_;
};

/// Seconds of a step, the fastest of several, and the ratio of three axes to one over the steps.
struct SweepCost {
  double octree_seconds = 0, one_axis_seconds = 0, three_axes_seconds = 0;
  Estimate ratio{};
  std::uint64_t exchanges = 0, pairs = 0;
};

SweepCost cost_of_sweeps(std::size_t count, std::size_t stride, const ClaimsOptions& options) {
  PartlyMoving field(count, stride, options.seed);
  BroadPhase octree({.method = BroadPhaseMethod::octree, .threads = 1}),
      sweep({.method = BroadPhaseMethod::sweep, .threads = 1}),
      sweep3({.method = BroadPhaseMethod::sweep3, .threads = 1});
  for (BroadPhase* const method : {&octree, &sweep, &sweep3}) method->find_object_pairs(field.boxes());
  std::array<std::vector<double>, 3> seconds;
  SweepCost cost;
  for (int round = 0; round < options.rounds; ++round) {
    field.move();
    std::array<std::size_t, 3> pairs{};
    seconds[0].push_back(seconds_of([&] { pairs[0] = octree.find_object_pairs(field.boxes()).size(); }));
    seconds[1].push_back(seconds_of([&] { pairs[1] = sweep.find_object_pairs(field.boxes()).size(); }));
    seconds[2].push_back(seconds_of([&] { pairs[2] = sweep3.find_object_pairs(field.boxes()).size(); }));
    if (pairs[0] != pairs[1] || pairs[0] != pairs[2])
      throw Error("the octree, the sweep along one axis and the lists on three axes found different pairs");
    cost.exchanges = sweep3.stats().exchanges;
    cost.pairs = pairs[0];
  }
  cost.octree_seconds = least(seconds[0]);
  cost.one_axis_seconds = least(seconds[1]);
  cost.three_axes_seconds = least(seconds[2]);
  cost.ratio = ratio_of(seconds[2], seconds[1]);
  return cost;
}

}  // namespace

Finding sweeps_on_one_axis_and_three(const ClaimsOptions& options) {
  Finding finding{{"three-axes", "5",
                   "Sweep and prune keeps sorted lists on three axes ([Bar92]). Read as: this is faster than "
                   "to sort along "
                   "one axis in every step."},
                  {"claims_sweeps",
                   "Sweep and prune with lists on three axes, and with one axis",
                   {{"boxes", "Boxes"},
                    {"moving", "In motion"},
                    {"octree_ms", "Octree ms"},
                    {"one_axis_ms", "One axis ms"},
                    {"three_axes_ms", "Three axes ms"},
                    {"exchanges", "Exchanges"},
                    {"pairs", "Pairs"}}}};
  constexpr std::array<std::size_t, 2> strides{1, 100};
  std::array<std::size_t, 2> faster{}, slower{};  // cases, by stride
  std::array<Estimate, 2> ratio{};                // of the last number of boxes
  for (const std::size_t count : options.swept_boxes) {
    for (std::size_t s = 0; s < strides.size(); ++s) {
      const SweepCost cost = cost_of_sweeps(count, strides[s], options);
      finding.table.add({std::uint64_t{count}, strides[s] == 1 ? "all" : "1 %", cost.octree_seconds * 1e3,
                         cost.one_axis_seconds * 1e3, cost.three_axes_seconds * 1e3, cost.exchanges,
                         cost.pairs});
      ratio[s] = cost.ratio;
      faster[s] += below(ratio[s], 1) == Verdict::holds;
      slower[s] += below(ratio[s], 1) == Verdict::does_not_hold;
    }
  }
  const std::size_t cases = options.swept_boxes.size();
  if (faster[0] == cases && faster[1] == cases) finding.claim.verdict = Verdict::holds;
  if (slower[0] == cases && slower[1] == cases) finding.claim.verdict = Verdict::does_not_hold;
  finding.claim.number = ratio[0];
  finding.claim.quantity =
      fmt::format("time of three axes / of one, {} boxes, all in motion", options.swept_boxes.back());
  finding.claim.reason = fmt::format(
      "Lists on three axes are faster at {} of {} numbers of boxes when all boxes move, and at {} when 1 % "
      "of "
      "them move. For {} boxes a step takes {} and {} times as long as the sweep along one axis. "
      "Each "
      "list contains the ends of all boxes, however far apart along the other axes, so the number of "
      "exchanges "
      "grows faster than the number of boxes. The octree, the sweep and the lists find the same pairs.",
      faster[0], cases, faster[1], cli::grouped(options.swept_boxes.back()), text_of(ratio[0]),
      text_of(ratio[1]));
  return finding;
}

}  // namespace supple::experiments
