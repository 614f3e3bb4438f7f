// Safe steps of `ImpactPass`.
//
// The time of a pair of objects is the first one at which two of their elements are at the distance that they
// keep, when both objects move by the same part of their ways. Its free part p is one up to which the
// elements keep their distances at any two parts of the ways, both at most p: along the direction n between
// their closest points at the start, two elements are D apart. When the vertices of one move by at most w_a
// towards the other along n, and those of the other by at most w_b, they come nearer by at most p (w_a +
// w_b).
//
// An island is a set of objects that move by the same part. Islands start as single objects, with the times
// of their pairs with themselves and with objects that do not move. Then those are joined that have a pair
// whose free part is below the longer one of their parts; the joined island has the least of the times of all
// its pairs. Parts only decrease, so that every pair remains safe: within an island by its time, between
// islands by its free part. Pairs of objects that no search looks at have such distant boxes around
// their ways that they keep their distances at any parts.

#include <algorithm>
#include <cstddef>
#include <functional>
#include <iterator>
#include <numeric>
#include <tuple>
#include <utility>

#include "answers/impact/impact_pass.hpp"
#include "contact/impact/first_impact.hpp"
#include "contact/impact/safe_time.hpp"
#include "geometry/vector.hpp"

namespace supple {

SafeStep ImpactPass::find_safe_step(const PassInput& input, std::span<const MovingObject> objects,
                                    const ImpactSearchOptions& options,
                                    const std::optional<StepOptions>& step, const FirstOfAll& first_of_all) {
  start_steps(input, objects, options, step);
  const Parallel& parallel = input.parallel;
  island_.assign(objects_.size(), 0);
  latest_of_job_.assign(jobs_.size(), 0);
  near_.clear();
  limits_.clear();
  safe_.assign(1, {});
  const auto go_on = [&] {
    safe_[0] = first_in(safe_[0], first_of_all);
    return safe_[0].step > 0 && !safe_[0].stopped;
  };
  std::optional<ContinuousContact> contact;
  if (step_) {
    search_until(Search::safe_step, 1, parallel);
    list_limits();
  } else if (const Earliest* const earliest = search_earliest(Search::longest, 1, parallel)) {
    contact = earliest->contact;
  }
  limit_near(list_near(), {}, parallel);
  for (const StepLimit& limit : limits_) shorten(0, limit);
  if (contact && contact->toi < safe_[0].step) safe_[0] = {contact->toi, pair_of_contact(*contact)};
  if (go_on() && step_) prove_rounded_positions(first_of_all, parallel);
  return safe_[0].stopped ? SafeStep{0, {}, true} : safe_[0];
}

/// What all processes found first, with what this one found.
SafeStep ImpactPass::first_in(SafeStep own, const FirstOfAll& first_of_all) const {
  own.stopped = stop_.stop_requested();
  return first_of_all ? first_of_all(own) : own;
}

std::vector<ObjectStep> ImpactPass::find_safe_steps(const PassInput& input,
                                                    std::span<const MovingObject> objects,
                                                    const ImpactSearchOptions& options,
                                                    const StepOptions& step) {
  start_steps(input, objects, options, step);
  island_.resize(objects.size());
  std::iota(island_.begin(), island_.end(), 0u);
  if (const std::size_t count = std::max(objects.size(), jobs_.size()); latest_.size() < count)
    latest_ = std::vector<std::atomic<float>>(count);
  all_limits_.clear();
  near_.clear();
  std::vector<std::uint32_t> inside, between;
  for (const std::uint32_t job : all_jobs_) (is_between_islands(job) ? between : inside).push_back(job);
  search_islands(inside, input.parallel);
  for (const std::uint32_t job : between) {
    latest_of_job_[job] = job;
    latest_[job] = latest_true_time(longest_step(job));
  }
  search(Search::free, between, input.parallel);
  list_limits();
  for (const StepLimit& limit : limits_) {
    const auto [first, last] = std::minmax({island_of(jobs_[limit.job].a), island_of(jobs_[limit.job].b)});
    island_[last] = first;
  }
  std::erase_if(between, [&](std::uint32_t job) { return is_between_islands(job); });
  search_islands(between, input.parallel);
  prove_rounded_positions({}, input.parallel);
  if (stop_.stop_requested()) {
    // All that move are one island, of the first of them.
    auto root = static_cast<std::uint32_t>(objects.size());
    safe_.assign(objects.size(), {1, {}, true});
    for (std::uint32_t object = 0; object < objects.size(); ++object) {
      const bool is_moving = objects[object].ways != nullptr && moves(object);
      if (is_moving) root = std::min(root, object);
      if (is_moving) safe_[object].step = 0;
      island_[object] = is_moving ? root : object;
    }
  }
  std::vector<ObjectStep> steps;
  for (std::uint32_t object = 0; object < objects.size(); ++object) {
    if (objects[object].ways == nullptr) continue;  // a free slot
    steps.push_back({objects[object].id, objects[island_of(object)].id, safe_[island_of(object)]});
  }
  return steps;
}

void ImpactPass::start_steps(const PassInput& input, std::span<const MovingObject> objects,
                             const ImpactSearchOptions& options, const std::optional<StepOptions>& step) {
  start(input, objects, options);
  step_ = step;
  search_ = Search::longest;
  options_.impact.max_time = 1;
  options_.impact.skip_parting = true;
  all_jobs_.clear();
  for (std::uint32_t job = 0; job < jobs_.size(); ++job) {
    if (moves(jobs_[job].a) || moves(jobs_[job].b)) all_jobs_.push_back(job);
  }
  // Elements that come near fast do so early, which shortens the searches of others.
  std::vector<double> approaches(jobs_.size());
  for (const std::uint32_t job : all_jobs_) approaches[job] = largest_approach(job);
  const auto place = [&](std::uint32_t job) { return std::pair(approaches[job], ~job); };
  std::ranges::sort(all_jobs_, std::greater<>(), place);
}

/// Finds the limits of jobs within islands, up to the steps of these islands, and shortens them.
void ImpactPass::search_islands(std::span<const std::uint32_t> jobs, const Parallel& parallel) {
  limit_islands();
  for (const std::uint32_t job : jobs) {
    latest_of_job_[job] = island_of(mover_of(job));
    latest_of(job) = latest_true_time(safe_[latest_of_job_[job]].step);
  }
  search(Search::safe_step, jobs, parallel);
  list_limits();
  limit_near(list_near(), {}, parallel);
  all_limits_.insert(all_limits_.end(), limits_.begin(), limits_.end());
  std::sort(all_limits_.begin(), all_limits_.end(), limits_before);
  limit_islands();
}

/// Gives islands the steps of their limits.
void ImpactPass::limit_islands() {
  safe_.assign(objects_.size(), {});
  for (const StepLimit& limit : all_limits_) shorten(island_of(mover_of(limit.job)), limit);
}

std::uint32_t ImpactPass::island_of(std::uint32_t object) const {
  while (island_[object] != object) object = island_[object];
  return object;
}
bool ImpactPass::moves(std::uint32_t object) const {
  return objects_[object].ways->longest > 0;
}
/// An object of the job that moves.
std::uint32_t ImpactPass::mover_of(std::uint32_t job) const {
  return moves(jobs_[job].a) ? jobs_[job].a : jobs_[job].b;
}
/// The longer of the steps of the two objects.
double ImpactPass::longest_step(std::uint32_t job) const {
  return std::max(safe_[island_of(jobs_[job].a)].step, safe_[island_of(jobs_[job].b)].step);
}
/// Whether both objects of the job move, in different islands.
bool ImpactPass::is_between_islands(std::uint32_t job) const {
  const auto& [a, b] = jobs_[job];
  return moves(a) && moves(b) && island_of(a) != island_of(b);
}

/// Limits are listed in canonical order, so that the first of several at the same time counts.
void ImpactPass::shorten(std::uint32_t island, const StepLimit& limit) {
  if (limit.time < safe_[island].step) safe_[island] = {limit.time, limit.pair};
}

/// Shortens the parts of islands until the positions that they round to are reached without contact.
void ImpactPass::prove_rounded_positions(const FirstOfAll& first_of_all, const Parallel& parallel) {
  const bool is_one = safe_.size() == 1;
  const auto island_of_job = [&](std::uint32_t job) { return is_one ? 0 : island_of(mover_of(job)); };
  std::vector<std::uint8_t> fails(safe_.size(), 1);
  std::vector<std::uint32_t> open;
  for (int round = 0;; ++round) {
    open.clear();
    for (std::uint32_t i = 0; i < near_.size(); ++i) {
      const std::uint32_t island = island_of_job(near_[i].limit.job);
      if (fails[island] != 0 && safe_[island].step > 0) open.push_back(i);
    }
    limits_.clear();
    limit_near(open, round < most_rounds ? 0.5 : 0, parallel);
    const SafeStep first =
        first_in(limits_.empty() ? SafeStep{} : SafeStep{limits_[0].time, limits_[0].pair}, first_of_all);
    if (first.stopped) safe_[0].stopped = true;
    if (!first.limit || first.stopped) return;
    if (first_of_all) limits_.assign(1, {0, first.step, *first.limit});
    std::ranges::fill(fails, std::uint8_t{0});
    for (const StepLimit& limit : limits_) {
      const std::uint32_t island = island_of_job(limit.job);
      if (std::exchange(fails[island], std::uint8_t{1}) != 0) continue;
      safe_[island] = {(round == 0 ? 1 - 0x1p-19 : limit.time) * safe_[island].step, limit.pair};
    }
  }
}

/// What the pair leaves of the step in this search; nothing when that is all, and for pairs that touch at the
/// start.
std::optional<double> ImpactPass::limit_of(std::uint32_t job, ElementPairKind kind, const OpenPair& pair,
                                           Worker& worker) {
  const KeptDistance kept{impact_of_job(job).min_separation, step_->keep};
  if (search_ == Search::free) {
    const double part = free_part(pair.motion, kept, rounding_of_job(job), growth_of_rounding(job));
    return part < longest_step(job) ? std::optional(0.0) : std::nullopt;
  }
  const double latest = latest_of(job).load(std::memory_order_relaxed);
  const SafeTime found = safe_time(pair.motion, kept, latest, options_.impact.exact);
  worker.stats.exact_fallbacks += found.used_exact ? 1 : 0;
  if (found.touches || !(found.least_distance > rounding_of_job(job) + latest * growth_of_rounding(job)))
    add_near(job, kind, pair, found.touches, worker);
  return found.time;
}

void ImpactPass::limit_step(std::uint32_t job, ElementPairKind kind, const OpenPair& pair, Worker& worker) {
  const std::optional<double> time = limit_of(job, kind, pair, worker);
  if (!time) return;
  const std::optional<ElementNames> names =
      names_of(kind, pair.candidate, pair.vertices, objects_[jobs_[job].a], objects_[jobs_[job].b]);
  if (!names) return;
  const StepLimit limit{
      job, *time, {objects_[jobs_[job].a].id, objects_[jobs_[job].b].id, names->kind, names->a, names->b}};
  if (worker.limits.empty() || worker.limits.back().job != job) {
    worker.limits.push_back(limit);
  } else if (limits_before(limit, worker.limits.back())) {
    worker.limits.back() = limit;
  } else {
    return;
  }
  shorten_search(job, *time);
}

/// The order of limits: by job, then by time.
bool ImpactPass::limits_before(const StepLimit& p, const StepLimit& q) {
  const auto key = [](const StepLimit& limit) {
    return std::tie(limit.job, limit.time, limit.pair.kind, limit.pair.element_a, limit.pair.element_b);
  };
  return key(p) < key(q);
}

/// Lists the first limit of each job.
void ImpactPass::list_limits() {
  limits_.clear();
  for (const Worker& worker : workers_)
    limits_.insert(limits_.end(), worker.limits.begin(), worker.limits.end());
  std::sort(limits_.begin(), limits_.end(), limits_before);
  const auto is_same_job = [](const StepLimit& p, const StepLimit& q) { return p.job == q.job; };
  limits_.erase(std::unique(limits_.begin(), limits_.end(), is_same_job), limits_.end());
}

/// The most by which two elements of the job come nearer within the step.
double ImpactPass::largest_approach(std::uint32_t job) const {
  const VertexWays &a = *objects_[jobs_[job].a].ways, &b = *objects_[jobs_[job].b].ways;
  if (search_ == Search::free) return (a.longest + b.longest) * (1 + 0x1p-40);
  const Vec3d way = a.mean - b.mean;
  return (scaled_norm(way) + a.farthest_from_mean + b.farthest_from_mean) * (1 + 0x1p-40) +
         rounding_of_ways * (a.longest + b.longest);
}

double ImpactPass::rounding_of_job(std::uint32_t job) const {
  return safe_step_rounding * std::max(objects_[jobs_[job].a].ways->largest_coordinate,
                                       objects_[jobs_[job].b].ways->largest_coordinate);
}
double ImpactPass::growth_of_rounding(std::uint32_t job) const {
  return safe_step_rounding *
         std::max(objects_[jobs_[job].a].ways->longest, objects_[jobs_[job].b].ways->longest);
}
double ImpactPass::growth_of_distance(std::uint32_t job) const {
  if (search_ == Search::free) return 2 * growth_of_rounding(job) / (1 - step_->keep) * (1 + 0x1p-40);
  return search_ == Search::safe_step ? growth_of_rounding(job) : 0;
}

double ImpactPass::searched_distance(std::uint32_t job) const {
  const double separation = impact_of_job(job).min_separation;
  switch (search_) {
    case Search::safe_step:
      return separation + rounding_of_job(job);
    case Search::free:
      return separation + 2 * rounding_of_job(job) / (1 - step_->keep) * (1 + 0x1p-40);
    default:
      return separation;
  }
}

/// Elements that come nearer by `approach` are no longer at the separation plus a share `keep` of their
/// distance beyond it only if that distance was at most approach / (1 - keep). At the start they are then
/// that near, and at this time within keep / (1 - keep) of the approach.
double ImpactPass::share_of_approach() const {
  if (search_ == Search::safe_step) return kept_share(*step_);
  return search_ == Search::free ? (1 + 0x1p-40) / (1 - step_->keep) : 0;
}

double ImpactPass::kept_distance(std::uint32_t job, float latest, const RelativeMotionBlock& block,
                                 std::size_t count) const {
  const double of_approach = share_of_approach() * latest;
  if (of_approach == 0) return 0;
  const double kept = of_approach * largest_approach(job) * (1 + 0x1p-40);
  if (search_ != Search::safe_step) return kept;
  double farthest = 0;
  for (const auto& m : std::span(block.rows[RelativeMotionBlock::m]).first(count))
    farthest = std::max(farthest, norm(Vec3d{m[0], m[1], m[2]}));
  return std::min(kept, step_->keep * farthest * (1 + 0x1p-20) + std::numeric_limits<float>::min());
}

}  // namespace supple
