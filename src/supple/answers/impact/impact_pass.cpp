#include "answers/impact/impact_pass.hpp"

#include <algorithm>
#include <bit>
#include <functional>
#include <numeric>
#include <tuple>
#include <utility>

#include "contact/impact/first_impact.hpp"
#include "contact/impact/impact_search.hpp"
#include "contact/impact/safe_time.hpp"
#include "core/float_rounding.hpp"
#include "core/timer.hpp"
#include "geometry/vector.hpp"

namespace supple {
namespace {

constexpr std::size_t block_size = RelativeMotionBlock::capacity;
constexpr std::size_t least_to_keep_first = 16384;  // contacts, 4 MB

/// Orders the vertices of each edge, and the two edges of a self-collision, by the user's vertex ids. The
/// contact then does not depend on the shape of the octrees.
void sort_edges(const std::array<const MovingObject*, 4>& objects, std::array<std::uint32_t, 4>& vertices) {
  const auto id = [&](std::size_t i) { return objects[i]->vertex_ids[vertices[i]]; };
  for (const std::size_t i : {0u, 2u}) {
    if (id(i + 1) < id(i)) std::swap(vertices[i], vertices[i + 1]);
  }
  if (objects[0] != objects[2]) return;
  if (std::pair(id(2), id(3)) < std::pair(id(0), id(1))) {
    std::swap(vertices[0], vertices[2]);
    std::swap(vertices[1], vertices[3]);
  }
}

/// The order of contacts within a job.
auto order_of(const ContinuousContact& contact) {
  return std::tie(contact.kind, contact.element_a, contact.element_b);
}

/// The order in which a search for the earliest contact prefers contacts.
bool is_earlier(const ContinuousContact& p, std::uint32_t job_p, const ContinuousContact& q,
                std::uint32_t job_q) {
  if (p.toi != q.toi) return p.toi < q.toi;
  return job_p != job_q ? job_p < job_q : order_of(p) < order_of(q);
}

std::uint64_t place_of_element(std::uint32_t job, ElementPairKind kind, std::uint32_t first_of_element_a) {
  return ContactLimit::place(job, static_cast<std::uint32_t>(kind) << 29 | first_of_element_a >> 3);
}

/// Copies the impact to the contact, with the weights and the normal in the order of a and b.
void set_impact(ContinuousContact& contact, const Impact& impact, bool is_turned) {
  const auto& w = impact.barycentric;
  contact.certainty = impact.certainty;
  contact.touching_at_start = impact.touching_at_start;
  contact.toi = impact.toi;
  contact.start_distance = impact.start_distance;
  contact.point = impact.point;
  contact.normal = is_turned ? -1.0 * impact.normal : impact.normal;
  if (contact.kind == ElementPairKind::edge_edge) {
    contact.barycentric_a = {w[0], w[1], 0};
    contact.barycentric_b = {w[2], w[3], 0};
    return;
  }
  const auto [kind_a, kind_b] = feature_kinds(contact.kind);
  auto& of_vertex = is_turned ? contact.barycentric_b : contact.barycentric_a;
  auto& of_face = is_turned ? contact.barycentric_a : contact.barycentric_b;
  of_vertex = {1, 0, 0};
  switch (is_turned ? kind_a : kind_b) {
    case FeatureKind::vertex:
      of_face = {1, 0, 0};
      break;
    case FeatureKind::edge:
      of_face = {w[1], w[2] + w[3], 0};
      break;
    case FeatureKind::face:
      of_face = {w[1], w[2], w[3]};
      break;
  }
}

}  // namespace

bool ImpactPass::run(const PassInput& input, std::span<const MovingObject> objects,
                     const ImpactSearchOptions& options, StepStats& stats) {
  begin(input.jobs, objects, input.stop);
  const bool is_same_search = options.impact == last_options_.impact &&
                              options.kinds == last_options_.kinds &&
                              options.listing == last_options_.listing;
  options_ = last_options_ = options;
  search_ = Search::all;
  latest_[0] = end_of_search(options_.impact);
  latest_of_job_.assign(input.jobs.size(), 0);
  // Which contacts are the first of an element is known when all were found.
  const std::uint64_t most = lists_first() ? ContactLimit::unlimited : input.max_contacts;
  if (!run_open_jobs(input, is_same_search, most, stats)) return false;
  Timer timer;
  gather(input.parallel);
  end(most);
  if (lists_first()) is_truncated_ = first_contacts_.choose(records_, input.max_contacts, groups_);
  stats.contacts += contacts().size();
  stats.sort_and_events_seconds += timer.lap();
  return true;
}

std::optional<ContinuousContact> ImpactPass::find_earliest(const PassInput& input,
                                                           std::span<const MovingObject> objects,
                                                           const ImpactSearchOptions& options) {
  start(input, objects, options);
  all_jobs_.resize(jobs_.size());
  std::iota(all_jobs_.begin(), all_jobs_.end(), 0u);
  const Earliest* const best =
      search_earliest(Search::earliest, end_of_search(options_.impact), input.parallel);
  return best != nullptr && !stop_.stop_requested() ? std::optional(best->contact) : std::nullopt;
}

void ImpactPass::start(const PassInput& input, std::span<const MovingObject> objects,
                       const ImpactSearchOptions& options) {
  begin(input.jobs, objects, input.stop);
  options_ = options;
  work_ = {};
  limit_.start(ContactLimit::unlimited, 0);
  latest_of_job_.assign(jobs_.size(), 0);
}

const ImpactPass::Earliest* ImpactPass::search_earliest(Search search, float until,
                                                        const Parallel& parallel) {
  search_until(search, until, parallel);
  const Earliest* best = nullptr;
  for (const Worker& worker : workers_) {
    if (!worker.earliest) continue;
    const Earliest& found = *worker.earliest;
    if (best == nullptr || is_earlier(found.contact, found.job, best->contact, best->job)) best = &found;
  }
  return best;
}

void ImpactPass::search(Search search, std::span<const std::uint32_t> jobs, const Parallel& parallel) {
  search_ = search;
  run_tasks(jobs, parallel);
  add_stats(workers_, 0, work_);
}
void ImpactPass::search_until(Search search, float until, const Parallel& parallel) {
  latest_[0] = until;
  this->search(search, all_jobs_, parallel);
}

ImpactOptions ImpactPass::impact_of_job(std::uint32_t job) const {
  ImpactOptions impact = options_.impact;
  impact.min_separation = separation_of(impact.min_separation, objects_[jobs_[job].a].min_separation,
                                        objects_[jobs_[job].b].min_separation);
  return impact;
}

ObjectPairView ImpactPass::view_of_job(std::uint32_t job) const {
  const MovingObject& a = objects_[jobs_[job].a];
  const MovingObject& b = objects_[jobs_[job].b];
  const double distance = searched_distance(job);
  ObjectPairView pair = pair_of(a.view, b.view, distance);
  pair.growth = growth_of_distance(job);
  pair.kept_share = share_of_approach();
  pair.any_parts = search_ == Search::free;
  if (distance > 0 || pair.growth > 0 || pair.kept_share > 0) pair.a.culled = nullptr;
  pair.kinds = options_.kinds;
  pair.soonest_first = search_ != Search::all;
  if (latest_of(job) < 1 || pair.soonest_first) pair.latest = &latest_of(job);
  return pair;
}

void ImpactPass::run_task(std::size_t task, Worker& worker) {
  const std::uint32_t job = tasks_[task].job;
  const Ranges ranges = begin_task(task, worker);
  if (limit_.excludes(ContactLimit::place(job, 0))) return end_task(task, ranges, worker);
  const std::size_t first = ranges[0].first;
  worker.keep_first_at = least_to_keep_first;
  worker.traversal.find_element_pairs(view_of_job(job), tasks_[task].root, worker.stats.traversal,
                                      [&](ElementPairKind kind, std::span<const ElementPair> candidates) {
                                        Timer timer;
                                        test_candidates(job, kind, candidates, worker);
                                        if (limit_.is_set()) drop_excess(job, first, worker);
                                        keep_first(first, worker.keep_first_at, worker);
                                        worker.stats.exact_seconds += timer.lap();
                                      });
  constexpr std::size_t many = 256;
  keep_first(first, many, worker);
  end_task(task, ranges, worker);
}

void ImpactPass::test_candidates(std::uint32_t job, ElementPairKind kind,
                                 std::span<const ElementPair> candidates, Worker& worker) {
  const MovingObject& a = objects_[jobs_[job].a];
  const MovingObject& b = objects_[jobs_[job].b];
  const auto objects = objects_of(kind, a, b);
  const bool are_edges = kind == ElementPairKind::edge_edge, excludes = limit_.excludes_some();
  const double distance = searched_distance(job), growth = growth_of_distance(job);
  std::array<std::array<std::uint32_t, 4>, block_size> vertices;
  for (; !candidates.empty() && !stop_.stop_requested();
       candidates = candidates.subspan(std::min(block_size, candidates.size()))) {
    const auto part = candidates.first(std::min(block_size, candidates.size()));
    for (std::size_t k = 0; k < part.size(); ++k) vertices[k] = vertices_of(kind, part[k], a, b);
    const float latest = std::min(worker.traversal.until(), latest_of(job).load(std::memory_order_relaxed));
    fill(objects, std::span(vertices).first(part.size()), are_edges, latest, worker.block);
    const double kept = kept_distance(job, latest, worker.block, part.size());
    const float reach = round_up(distance + growth * latest + kept);
    std::uint64_t left = may_touch(worker.block, part.size(), are_edges, reach);
    std::size_t count = 0;
    for (; left != 0; left &= left - 1) {
      const auto k = static_cast<std::size_t>(std::countr_zero(left));
      if (excludes && is_excluded(job, kind, part[k], vertices[k])) continue;
      if (!may_touch_by_groups(objects, vertices[k], are_edges)) continue;
      OpenPair& pair = worker.open[count++];
      pair.candidate = part[k];
      pair.vertices = vertices[k];
      if (are_edges) sort_edges(objects, pair.vertices);
      set_motion(are_edges, objects, pair.vertices, pair.motion);
      pair.relative = relative_motion(pair.motion);
    }
    decide_open_pairs(job, kind, count, worker);
  }
}

/// A vector kernel decides most pairs that touch; the scalar search decides the others.
void ImpactPass::decide_open_pairs(std::uint32_t job, ElementPairKind kind, std::size_t count,
                                   Worker& worker) {
  if (search_ == Search::safe_step || search_ == Search::free) {
    for (std::size_t k = 0; k < count && !stop_.stop_requested(); ++k)
      limit_step(job, kind, worker.open[k], worker);
    return;
  }
  const ImpactOptions options = impact_of_job(job);
  const bool is_vectorized = options.min_separation == 0 && count > 0;
  if (is_vectorized) {
    for (std::size_t k = 0; k < count; ++k) worker.motions.set(k, worker.open[k].relative);
    search_coplanar_times(worker.motions, count, kind == ElementPairKind::edge_edge, worker.coplanar);
  }
  const auto search_of = [&](std::size_t k) -> ImpactSearch {
    if (is_vectorized && (worker.coplanar.apart >> k & 1) != 0) return {ImpactSearch::Outcome::apart};
    if (is_vectorized && (worker.coplanar.touching >> k & 1) != 0)
      return {ImpactSearch::Outcome::touching, worker.coplanar.times[k]};
    return search_impact(worker.open[k].relative, options.min_separation);
  };
  for (std::size_t k = 0; k < count && !stop_.stop_requested(); ++k) {
    const OpenPair& pair = worker.open[k];
    const ImpactSearch found = search_of(k);
    if (found.outcome == ImpactSearch::Outcome::apart) continue;
    if (search_ == Search::longest && found.time == 0 && touch_at_start(pair.motion)) {
      if (!touch_at_rest(pair.motion)) add_near(job, kind, pair, true, worker);
      continue;
    }
    bool used_exact = false;
    const auto impact = first_impact_after(found, pair.motion, pair.relative, options, used_exact);
    worker.stats.exact_fallbacks += used_exact ? 1 : 0;
    if (impact) add_contact(job, kind, pair, *impact, worker);
  }
}

/// Compares the first id of element a with the limit.
bool ImpactPass::is_excluded(std::uint32_t job, ElementPairKind kind, ElementPair candidate,
                             std::array<std::uint32_t, 4> vertices) const {
  const MovingObject& a = objects_[jobs_[job].a];
  const MovingObject& b = objects_[jobs_[job].b];
  if (kind == ElementPairKind::edge_edge) sort_edges(objects_of(kind, a, b), vertices);
  const std::optional<ElementNames> names = names_of(kind, candidate, vertices, a, b);
  return !names || limit_.excludes(place_of_element(job, names->kind, names->a[0]));
}

void ImpactPass::add_contact(std::uint32_t job, ElementPairKind kind, const OpenPair& pair,
                             const Impact& impact, Worker& worker) {
  const MovingObject& a = objects_[jobs_[job].a];
  const MovingObject& b = objects_[jobs_[job].b];
  const std::optional<ElementNames> names = names_of(kind, pair.candidate, pair.vertices, a, b);
  if (!names) return;
  ContinuousContact contact;
  contact.object_a = a.id;
  contact.object_b = b.id;
  contact.kind = names->kind;
  contact.element_a = names->a;
  contact.element_b = names->b;
  set_impact(contact, impact, names->is_turned);
  if (search_ == Search::all) {
    worker.found.push_back(contact);
  } else {
    keep_earlier(job, contact, worker);
  }
}

void ImpactPass::keep_earlier(std::uint32_t job, const ContinuousContact& contact, Worker& worker) {
  shorten_search(job, contact.toi);
  if (worker.earliest && !is_earlier(contact, job, worker.earliest->contact, worker.earliest->job)) return;
  worker.earliest = {contact, job};
}

/// A reported time may be early by the tolerance. The pair with the earliest reported time may therefore
/// touch later than another pair does.
void ImpactPass::shorten_search(std::uint32_t job, double time) {
  std::atomic<float>& bound = latest_of(job);
  const float until = latest_true_time(time);
  float latest = bound.load(std::memory_order_relaxed);
  while (until < latest && !bound.compare_exchange_weak(latest, until, std::memory_order_relaxed)) {
  }
}

bool ImpactPass::is_before(const ContinuousContact& p, const ContinuousContact& q) {
  return order_of(p) < order_of(q);
}
std::uint64_t ImpactPass::place_of(std::uint32_t job, const ContinuousContact& contact) {
  return place_of_element(job, contact.kind, contact.element_a[0]);
}

/// Keeps only those contacts of one task that may be listed, once the task has at least `least` contacts.
/// They begin at `first`. A contact that is not the first of an element in its task is not the first in the
/// scene.
void ImpactPass::keep_first(std::size_t first, std::size_t least, Worker& worker) const {
  if (search_ != Search::all || !lists_first() || worker.found.size() - first < least) return;
  worker.first_contacts.keep_first(worker.found, first);
  worker.keep_first_at = std::max(least_to_keep_first, 2 * (worker.found.size() - first));
}

void ImpactPass::gather_found(std::size_t outcome, Worker& worker, const Parallel& parallel) {
  using Key = ImpactWorker::Key;
  worker.order.sort(
      [&](const auto& visit) {
        for_each_found(outcome, [&](const ContinuousContact& contact, std::uint32_t finder, std::uint32_t i) {
          visit(Key{contact.kind, contact.element_a, contact.element_b, finder, i});
        });
      },
      [](const Key& key) {
        return SortKey{static_cast<std::uint32_t>(key.kind), key.element_a[0]};
      },
      std::less<>(), parallel, worker.sorted);
  const std::size_t first = outcomes_.ranges(outcome)[0].first;
  parallel.for_ranges(worker.sorted.size(), 1024, [&](std::size_t begin, std::size_t end, std::uint32_t) {
    for (std::size_t i = begin; i < end; ++i)
      records_[first + i] = workers_[worker.sorted[i].worker].found[worker.sorted[i].index];
  });
}

}  // namespace supple
