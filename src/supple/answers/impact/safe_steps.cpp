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
// of their pairs with themselves and with objects that do not move. Two islands are joined while a pair
// between them has a free part below one of their parts; the joined island has the least of both parts and of
// the times of its pairs. Parts only decrease, so that every pair remains safe: within an island by its time,
// between islands by its free part. Pairs of objects that no search looks at have such distant boxes around
// their ways that they keep their distances at any parts.

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <numeric>
#include <tuple>
#include <utility>

#include "answers/impact/impact_pass.hpp"
#include "contact/impact/first_impact.hpp"
#include "contact/impact/impact_search.hpp"
#include "contact/impact/safe_time.hpp"
#include "core/float_rounding.hpp"
#include "core/sort_once.hpp"
#include "geometry/vector.hpp"

namespace supple {
namespace {

/// The part of a safe step that a time may be early, with some slack.
constexpr double relative_tolerance = 0x1p-17;

float end_of_search_for(double time) {
  return std::min(1.0f, round_up(time * (1 + relative_tolerance) + toi_tolerance));
}

/// Where an island moves by this part, as users compute it. Ways that overflow take another formula.
Vec3d rounded_position(const Vec3d& start, const Vec3d& end, double part) {
  const Vec3d position = start + part * (end - start);
  return is_finite(position) ? position : mix(start, end, part);
}

}  // namespace

SafeStep ImpactPass::find_safe_step(std::span<const ContactJob> jobs, std::span<const MovingObject> objects,
                                    const ImpactSearchOptions& options, const StepOptions& step,
                                    const FirstOfAll& first_of_all, const Parallel& parallel) {
  start_steps(jobs, objects, options, step);
  ends_early_ = true;
  island_.assign(objects.size(), 0);
  safe_.assign(std::max<std::size_t>(objects.size(), 1), {});
  // What touches bounds the step, and a short step needs little more than the separation.
  search(Search::touching, all_jobs_, 1, parallel);
  const Earliest* const earliest = earliest_of_workers();
  const SafeStep touching = first_of_all(
      earliest != nullptr ? SafeStep{earliest->contact.toi, pair_of_contact(earliest->contact)} : SafeStep{});
  if (touching.step == 0) return touching;
  search(Search::safe_step, all_jobs_, touching.limit ? end_of_search_for(touching.step) : 1, parallel);
  list_limits();
  for (const StepLimit& limit : limits_) shorten(0, limit);
  safe_[0] = first_of_all(safe_[0]);
  const std::vector<std::uint32_t> open = near_jobs();
  for (double factor = 1 - 0x1p-19; safe_[0].step > 0; factor = 0.5) {
    search(Search::rounded, open, std::min(1.0f, round_up(safe_[0].step)), parallel);
    list_limits();
    const SafeStep failing =
        first_of_all(limits_.empty() ? SafeStep{} : SafeStep{limits_[0].time, limits_[0].pair});
    if (!failing.limit) break;
    safe_[0] = {factor * safe_[0].step, failing.limit};
  }
  return safe_[0];
}

std::vector<ObjectStep> ImpactPass::find_safe_steps(std::span<const ContactJob> jobs,
                                                    std::span<const MovingObject> objects,
                                                    const ImpactSearchOptions& options,
                                                    const StepOptions& step, const Parallel& parallel) {
  start_steps(jobs, objects, options, step);
  ends_early_ = false;
  island_.resize(objects.size());
  std::iota(island_.begin(), island_.end(), 0u);
  safe_.assign(objects.size(), {});
  std::vector<std::uint32_t> jobs_of_two;
  std::copy_if(all_jobs_.begin(), all_jobs_.end(), std::back_inserter(jobs_of_two),
               [&](std::uint32_t job) { return is_between_islands(job); });
  search(Search::free, jobs_of_two, 1, parallel);
  list_limits();
  free_parts_.assign(jobs.size(), 1);
  for (const StepLimit& limit : limits_) free_parts_[limit.job] = limit.time;
  search(Search::safe_step, all_jobs_, 1, parallel);
  list_limits();
  join_islands();
  prove_rounded_positions(parallel);
  std::vector<ObjectStep> steps;
  for (std::uint32_t object = 0; object < objects.size(); ++object)
    steps.push_back({objects[object].id, objects[island_of(object)].id, safe_[island_of(object)]});
  return steps;
}

void ImpactPass::start_steps(std::span<const ContactJob> jobs, std::span<const MovingObject> objects,
                             const ImpactSearchOptions& options, const StepOptions& step) {
  begin(jobs, objects, {});
  options_ = options;
  step_ = step;
  options_.impact.max_time = 1;
  limit_.start(ContactLimit::unlimited, 0);
  all_jobs_.clear();
  for (std::uint32_t job = 0; job < jobs.size(); ++job) {
    if (moves(jobs[job].a) || moves(jobs[job].b)) all_jobs_.push_back(job);
  }
}

/// Joins the islands of objects that are not free of each other.
void ImpactPass::join_islands() {
  for (bool has_joined = true; has_joined;) {
    safe_.assign(objects_.size(), {});
    for (const StepLimit& limit : limits_) {
      if (!is_between_islands(limit.job)) shorten(island_of(mover_of(limit.job)), limit);
    }
    has_joined = false;
    for (const std::uint32_t job : all_jobs_) {
      if (!is_between_islands(job)) continue;
      const std::uint32_t p = island_of(jobs_[job].a), q = island_of(jobs_[job].b);
      if (std::max(safe_[p].step, safe_[q].step) <= free_parts_[job]) continue;
      const auto [first, last] = std::minmax({p, q});
      safe_[first].step = std::min(safe_[p].step, safe_[q].step);
      island_[last] = first;
      has_joined = true;
    }
  }
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
/// Whether both objects of the job move, in different islands.
bool ImpactPass::is_between_islands(std::uint32_t job) const {
  const auto& [a, b] = jobs_[job];
  return moves(a) && moves(b) && island_of(a) != island_of(b);
}

/// Limits are listed in canonical order, so that the first of several at the same time counts.
void ImpactPass::shorten(std::uint32_t island, const StepLimit& limit) {
  if (limit.time < safe_[island].step) safe_[island] = {limit.time, limit.pair};
}

/// The jobs of elements that are so near that rounding could make them touch.
std::vector<std::uint32_t> ImpactPass::near_jobs() const {
  std::vector<std::uint32_t> near;
  for (const Worker& worker : workers_)
    near.insert(near.end(), worker.near_jobs.begin(), worker.near_jobs.end());
  sort_once(near);
  return near;
}

/// Shortens the parts of islands until the positions that they round to are reached without contact.
void ImpactPass::prove_rounded_positions(const Parallel& parallel) {
  std::vector<std::uint32_t> open = near_jobs();
  std::erase_if(open, [&](std::uint32_t job) { return is_between_islands(job); });
  const auto safe_of = [&](std::uint32_t job) -> SafeStep& { return safe_[island_of(mover_of(job))]; };
  std::vector<std::uint8_t> is_shorter(safe_.size(), 0), fails(safe_.size(), 1);
  for (;;) {
    std::erase_if(open, [&](std::uint32_t job) {
      return fails[island_of(mover_of(job))] == 0 || safe_of(job).step == 0;
    });
    if (open.empty()) return;
    double latest = 0;
    for (const std::uint32_t job : open) latest = std::max(latest, safe_of(job).step);
    search(Search::rounded, open, std::min(1.0f, round_up(latest)), parallel);
    list_limits();
    std::fill(fails.begin(), fails.end(), std::uint8_t{0});
    for (const StepLimit& limit : limits_) {
      const std::uint32_t island = island_of(mover_of(limit.job));
      if (std::exchange(fails[island], std::uint8_t{1}) != 0) continue;
      const double factor = std::exchange(is_shorter[island], std::uint8_t{1}) != 0 ? 0.5 : 1 - 0x1p-19;
      safe_[island] = {factor * safe_[island].step, limit.pair};
    }
  }
}

/// What the pair leaves of the step in this search; nothing when that is all.
std::optional<double> ImpactPass::limit_of(std::uint32_t job, const OpenPair& pair, Worker& worker) {
  const KeptDistance kept{impact_of_job(job).min_separation, step_.keep};
  if (search_ == Search::free) {
    const double part = free_part(pair.motion, kept, rounding_of_job(job));
    return part < 1 ? std::optional(part) : std::nullopt;
  }
  if (search_ == Search::rounded) {
    ElementMotion motion = pair.motion;
    const double part = safe_[island_of(mover_of(job))].step;
    for (std::size_t i = 0; i < 4; ++i)
      motion.end[i] = rounded_position(motion.start[i], motion.end[i], part);
    const RelativeMotion relative = relative_motion(motion);
    ImpactOptions options;
    options.exact = may_be_exact(pair, 0);
    bool used_exact = false;
    const auto impact = first_impact_after(search_impact(relative, 0), motion, relative, options, used_exact);
    if (!impact || (impact->touching_at_start && touch_at_rest(pair.motion))) return {};
    return 0;
  }
  const double latest = has_exact_limit() ? 1 : latest_.load(std::memory_order_relaxed);
  const SafeTime found = safe_time(pair.motion, kept, latest, may_be_exact(pair, kept.separation));
  worker.stats.exact_fallbacks += found.used_exact ? 1 : 0;
  const bool is_near = !(found.least_distance > rounding_of_job(job));
  if (is_near && (worker.near_jobs.empty() || worker.near_jobs.back() != job))
    worker.near_jobs.push_back(job);
  return found.time;
}

void ImpactPass::limit_step(std::uint32_t job, ElementPairKind kind, const OpenPair& pair, Worker& worker) {
  const std::optional<double> time = limit_of(job, pair, worker);
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
  if (ends_early_ && search_ == Search::safe_step) search_until(*time * (1 + relative_tolerance));
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

double ImpactPass::searched_distance(std::uint32_t job) const {
  const double separation = impact_of_job(job).min_separation;
  switch (search_) {
    case Search::safe_step:
    case Search::rounded:
      return separation + rounding_of_job(job);
    case Search::free:
      return separation + 2 * rounding_of_job(job) / (1 - step_.keep) * (1 + 0x1p-40);
    default:
      return separation;
  }
}

/// Elements that come nearer by `approach` are no longer at the separation plus a share `keep` of their
/// distance beyond it only if that distance was at most approach / (1 - keep). At the start they are then
/// that near, and at this time within keep / (1 - keep) of the approach.
double ImpactPass::share_of_approach() const {
  if (search_ == Search::safe_step) return kept_share(step_);
  return search_ == Search::free ? (1 + 0x1p-40) / (1 - step_.keep) : 0;
}

double ImpactPass::kept_distance(std::uint32_t job) const {
  const double share = share_of_approach();
  return share > 0 ? share * largest_approach(job) * (1 + 0x1p-40) : 0;
}

}  // namespace supple
