#include "scene/rebuild_policy.hpp"

#include <algorithm>
#include <utility>

namespace supple {
namespace {

/// Refits in a row of which the quality is measured once the octree was found degraded.
constexpr std::uint32_t refits_watched = 16;
/// What is the same however small the degraded part, and sorting all of the octree.
constexpr double price_of_relinking = 10, price_of_building = 50;
/// Of what queries of the degraded parts cost, that a new tree must save: leaves that are patches of the
/// surface stay good for longer than those that are parts of space. And where the surface is smooth, more of
/// them cannot touch themselves.
constexpr double least_saving = 0.5, least_saving_of_smooth = 0.75;
constexpr double most_patience = 1024;

}  // namespace

/// A tree degrades over many steps, mostly: it is looked at now and then, not in time with a motion that
/// repeats, and all the time when it has lately been found degraded.
void RebuildPolicy::after_refit(const TreeBoxes& tree) {
  if (!is_allowed_ || --refits_until_measured_ > 0) return;
  quality_.measure(tree);
  if (is_degraded()) refits_to_watch_ = refits_watched;
  refits_until_measured_ = 1;
  if (refits_to_watch_ > 0) {
    --refits_to_watch_;
  } else {
    random_ = random_ * 1664525 + 1013904223;
    refits_until_measured_ += random_ >> 28;
  }
}

std::uint64_t RebuildPolicy::degraded_triangles(const ObjectOctree& octree) const {
  std::uint64_t count = 0;
  for (const std::uint32_t node : degraded_nodes()) count += octree.nodes()[node].size();
  return count;
}

double RebuildPolicy::price() const {
  return price_of_relinking + price_of_building * quality_.share();
}

bool RebuildPolicy::count_queries(double queries) {
  waste_ += queries * quality_.saving();
  return waste_ >= patience_ * price();
}

bool RebuildPolicy::accept(const TreeBoxes& rebuilt, std::span<const std::uint32_t> old_nodes,
                           const TreeBoxes& present, bool is_smooth) {
  waste_ = 0;
  TreeQuality quality = quality_;
  quality.update_references(rebuilt, old_nodes);
  const double least = is_smooth ? least_saving_of_smooth : least_saving;
  if (!(quality_.cost() - quality.cost() >= least * quality_.degraded_cost())) {
    quality_.set_references(present);
    patience_ = std::min(2 * patience_, most_patience);
    return false;
  }
  quality_ = std::move(quality);
  patience_ = std::max(patience_ / 2, 1.0);
  refits_until_measured_ = 1;
  refits_to_watch_ = refits_watched;
  return true;
}

void RebuildPolicy::report(const TreeBoxes& tree, OctreeStatistics& statistics) const {
  TreeQuality quality = quality_;
  quality.measure(tree);
  statistics.cost = quality.cost();
  statistics.degradation = quality.degradation();
}

}  // namespace supple
