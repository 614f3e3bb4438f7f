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
#include <cmath>
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
#include "geometry/aabb.hpp"
#include "geometry/vector.hpp"

namespace supple {
namespace {

/// The size of an object at the start, without what is not finite.
double size_of(const MovingObject& object) {
  Aabb box;
  for (int child = 0; child < node_width && !object.view.nodes.empty(); ++child) {
    if (const Aabb part = child_box(object.view.moving.start[0], child); !part.empty()) extend(box, part);
  }
  if (box.empty()) return 0;
  double size = 0;
  for (int axis = 0; axis < 3; ++axis) size = std::max(size, double{box.max[axis]} - double{box.min[axis]});
  return size;
}

}  // namespace

SafeStep ImpactPass::find_safe_step(const PassInput& input, std::span<const MovingObject> objects,
                                    const ImpactSearchOptions& options,
                                    const std::optional<StepOptions>& step, const FirstOfAll& first_of_all) {
  start_steps(input, objects, options, step);
  SafeStep known{0, {}, true};
  // Processes would have to agree on the first part.
  for (const double until : {first_of_all ? 1 : first_part(), 1.0}) {
    const SafeStep found = find_step_until(until, first_of_all, input.parallel);
    if (found.stopped) break;
    if (found.limit || until == 1) return found;
    known.step = until;
  }
  return known;
}

/// The safe step of all objects, no longer than `until`.
SafeStep ImpactPass::find_step_until(double until, const FirstOfAll& first_of_all, const Parallel& parallel) {
  const auto first = [&](SafeStep own) {
    own.stopped = stop_.stop_requested();
    return first_of_all ? first_of_all(own) : own;
  };
  island_.assign(objects_.size(), 0);
  latest_of_job_.assign(jobs_.size(), 0);
  touching_.clear();
  near_jobs_.clear();
  // What touches bounds the step, and a short step needs little more than the separation.
  const Earliest* const earliest =
      search_earliest(step_ ? Search::touching : Search::longest, round_up(until), parallel);
  list_touching();
  limits_.clear();
  limit_touching(all_jobs_, false, 0, parallel);
  safe_.assign(1, {until, {}});
  for (const StepLimit& limit : limits_) shorten(0, limit);
  SafeStep contact = safe_[0];
  if (earliest != nullptr && earliest->contact.toi < contact.step)
    contact = {earliest->contact.toi, pair_of_contact(earliest->contact)};
  contact = first(contact);
  if (!step_ || contact.step == 0 || contact.stopped) return contact;
  search_until(Search::safe_step, contact.limit ? latest_true_time(contact.step) : round_up(until), parallel);
  list_near_jobs();
  list_limits();
  for (const StepLimit& limit : limits_) shorten(0, limit);
  safe_[0] = first(safe_[0]);
  for (int round = 0; safe_[0].step > 0 && !safe_[0].stopped; ++round) {
    latest_[0] = std::min(1.0f, round_up(safe_[0].step));
    search(Search::rounded, near_jobs_, parallel);
    list_limits();
    limit_touching(near_jobs_, true, round < most_rounds ? 0.5 : 0, parallel);
    const SafeStep failing = first(limits_.empty() ? SafeStep{} : SafeStep{limits_[0].time, limits_[0].pair});
    if (!failing.limit && !failing.stopped) break;
    safe_[0] = {(round == 0 ? 1 - 0x1p-19 : failing.step) * safe_[0].step, failing.limit, failing.stopped};
  }
  return safe_[0];
}

/// A part of the step in which nothing moves far, to be searched before the whole step: it is the safe part
/// of a call that ends later. 1 where that is not worth the time.
double ImpactPass::first_part() const {
  constexpr double least = 0x1p-100, worth = 0x1p-6;
  double part = 1;
  for (const std::uint32_t job : all_jobs_) {
    const MovingObject &a = objects_[jobs_[job].a], &b = objects_[jobs_[job].b];
    const double faces = static_cast<double>(std::max(a.triangle_ids.size(), b.triangle_ids.size()));
    const double size = std::max(size_of(a), size_of(b)) / std::sqrt(faces), approach = largest_approach(job);
    if (approach > 0 && size > 0) part = std::min(part, size / approach);
  }
  return part < worth ? std::max(part, least) : 1;
}

std::vector<ObjectStep> ImpactPass::find_safe_steps(const PassInput& input,
                                                    std::span<const MovingObject> objects,
                                                    const ImpactSearchOptions& options,
                                                    const StepOptions& step) {
  start_steps(input, objects, options, step);
  double known = 0;
  if (const double part = first_part(); part < 1) {
    const SafeStep first = find_step_until(part, {}, input.parallel);
    if (!first.stopped) known = first.step;
  }
  island_.resize(objects.size());
  std::iota(island_.begin(), island_.end(), 0u);
  safe_.assign(objects.size(), {});
  if (const std::size_t count = std::max(objects.size(), jobs_.size()); latest_.size() < count)
    latest_ = std::vector<std::atomic<float>>(count);
  all_limits_.clear();
  touching_.clear();
  near_jobs_.clear();
  std::vector<std::uint32_t> inside, between;
  for (const std::uint32_t job : all_jobs_) (is_between_islands(job) ? between : inside).push_back(job);
  search_islands(inside, input.parallel);
  for (const std::uint32_t job : between) {
    latest_of_job_[job] = job;
    latest_[job] = latest_true_time(std::max(safe_[jobs_[job].a].step, safe_[jobs_[job].b].step));
  }
  search(Search::free, between, input.parallel);
  list_limits();
  free_parts_.assign(jobs_.size(), 1);
  for (const StepLimit& limit : limits_) free_parts_[limit.job] = limit.time;
  while (join_islands()) {
    inside.clear();
    std::erase_if(between, [&](std::uint32_t job) {
      if (!is_between_islands(job)) inside.push_back(job);
      return !is_between_islands(job);
    });
    limit_islands();
    search_islands(inside, input.parallel);
  }
  prove_rounded_positions(input.parallel);
  if (stop_.stop_requested()) {
    // All that move are one island, of the first of them.
    const auto first = std::find_if(objects.begin(), objects.end(), [](const MovingObject& object) {
      return object.ways != nullptr && object.ways->longest > 0;
    });
    const auto root = static_cast<std::uint32_t>(first - objects.begin());
    for (std::uint32_t object = 0; object < objects.size(); ++object)
      island_[object] = objects[object].ways != nullptr && moves(object) ? root : object;
    safe_.assign(objects.size(), {1, {}, true});
    if (root < objects.size()) safe_[root].step = known;
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
  search_ = Search::touching;
  options_.impact.max_time = 1;
  options_.impact.skip_parting = true;
  all_jobs_.clear();
  for (std::uint32_t job = 0; job < jobs_.size(); ++job) {
    if (moves(jobs_[job].a) || moves(jobs_[job].b)) all_jobs_.push_back(job);
  }
}

/// Finds the limits of jobs within islands, up to the steps of these islands, and shortens them.
void ImpactPass::search_islands(std::span<const std::uint32_t> jobs, const Parallel& parallel) {
  for (const std::uint32_t job : jobs) {
    latest_of_job_[job] = island_of(mover_of(job));
    latest_of(job) = latest_true_time(safe_[latest_of_job_[job]].step);
  }
  search(Search::safe_step, jobs, parallel);
  list_near_jobs();
  list_touching();
  list_limits();
  limit_touching(jobs, false, 0, parallel);
  all_limits_.insert(all_limits_.end(), limits_.begin(), limits_.end());
  std::sort(all_limits_.begin(), all_limits_.end(), limits_before);
  limit_islands();
}

/// Gives islands the steps of their limits.
void ImpactPass::limit_islands() {
  safe_.assign(objects_.size(), {});
  for (const StepLimit& limit : all_limits_) {
    if (!is_between_islands(limit.job)) shorten(island_of(mover_of(limit.job)), limit);
  }
}

/// Joins islands of objects that are not free of each other. Returns whether there are any.
bool ImpactPass::join_islands() {
  bool has_joined = false;
  for (const std::uint32_t job : all_jobs_) {
    if (!is_between_islands(job)) continue;
    const std::uint32_t p = island_of(jobs_[job].a), q = island_of(jobs_[job].b);
    if (std::max(safe_[p].step, safe_[q].step) <= free_parts_[job]) continue;
    const auto [first, last] = std::minmax({p, q});
    safe_[first].step = std::min(safe_[p].step, safe_[q].step);
    island_[last] = first;
    has_joined = true;
  }
  return has_joined;
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

/// Adds the jobs of elements that are so near that rounding could make them touch, and of those that touch.
void ImpactPass::list_near_jobs() {
  for (const Worker& worker : workers_)
    near_jobs_.insert(near_jobs_.end(), worker.near_jobs.begin(), worker.near_jobs.end());
  sort_once(near_jobs_);
}

/// Shortens the parts of islands until the positions that they round to are reached without contact.
void ImpactPass::prove_rounded_positions(const Parallel& parallel) {
  std::vector<std::uint32_t> open = near_jobs_;
  std::erase_if(open, [&](std::uint32_t job) { return is_between_islands(job); });
  const auto safe_of = [&](std::uint32_t job) -> SafeStep& { return safe_[island_of(mover_of(job))]; };
  std::vector<std::uint8_t> is_shorter(safe_.size(), 0), fails(safe_.size(), 1);
  for (int round = 0;; ++round) {
    std::erase_if(open, [&](std::uint32_t job) {
      return fails[island_of(mover_of(job))] == 0 || safe_of(job).step == 0;
    });
    if (open.empty()) return;
    for (const std::uint32_t job : open) {
      latest_of_job_[job] = island_of(mover_of(job));
      latest_of(job) = std::min(1.0f, round_up(safe_of(job).step));
    }
    search(Search::rounded, open, parallel);
    list_limits();
    limit_touching(open, true, round < most_rounds ? 0.5 : 0, parallel);
    std::fill(fails.begin(), fails.end(), std::uint8_t{0});
    for (const StepLimit& limit : limits_) {
      const std::uint32_t island = island_of(mover_of(limit.job));
      if (std::exchange(fails[island], std::uint8_t{1}) != 0) continue;
      const double factor =
          std::exchange(is_shorter[island], std::uint8_t{1}) != 0 ? limit.time : 1 - 0x1p-19;
      safe_[island] = {factor * safe_[island].step, limit.pair};
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
    return part < 1 ? std::optional(part) : std::nullopt;
  }
  if (search_ == Search::rounded) {
    ElementMotion motion = pair.motion;
    const double part = safe_[island_of(mover_of(job))].step;
    for (std::size_t i = 0; i < 4; ++i)
      motion.end[i] = rounded_position(motion.start[i], motion.end[i], part);
    const RelativeMotion relative = relative_motion(motion);
    bool used_exact = false;
    const auto impact =
        first_impact_after(search_impact(relative, 0), motion, relative, impact_of_job(job), used_exact);
    return impact && !impact->touching_at_start ? std::optional(0.5) : std::nullopt;
  }
  const double latest = latest_of(job).load(std::memory_order_relaxed);
  const SafeTime found = safe_time(pair.motion, kept, latest, options_.impact.exact);
  worker.stats.exact_fallbacks += found.used_exact ? 1 : 0;
  if (found.touches) add_touching(job, kind, pair, worker);
  const bool is_near =
      found.touches || !(found.least_distance > rounding_of_job(job) + latest * growth_of_rounding(job));
  if (is_near && (worker.near_jobs.empty() || worker.near_jobs.back() != job))
    worker.near_jobs.push_back(job);
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
  if (search_ != Search::rounded) shorten_search(job, *time);
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
  return search_ == Search::safe_step || search_ == Search::rounded ? growth_of_rounding(job) : 0;
}

double ImpactPass::searched_distance(std::uint32_t job) const {
  const double separation = impact_of_job(job).min_separation;
  switch (search_) {
    case Search::safe_step:
    case Search::rounded:
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

double ImpactPass::kept_distance(std::uint32_t job) const {
  const double share = share_of_approach();
  return share > 0 ? share * largest_approach(job) * (1 + 0x1p-40) : 0;
}

}  // namespace supple
