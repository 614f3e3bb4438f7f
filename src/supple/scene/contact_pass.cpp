#include "scene/contact_pass.hpp"

#include <hwy/cache_control.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <type_traits>
#include <utility>

#include "contact/triangle_intersection.hpp"

namespace supple {

static_assert(std::is_trivially_copyable_v<Contact> && std::is_trivially_copyable_v<ContactPoint>);

namespace {

Vec3d position(const OctreeView& view, std::uint32_t vertex) {
  const auto at = [&](const auto& vertices) {
    return Vec3d{vertices[vertex][0], vertices[vertex][1], vertices[vertex][2]};
  };
  const TriangleArrays& arrays = view.arrays;
  return (arrays.doubles.data != nullptr ? at(arrays.doubles) : at(arrays.floats)) + view.translation;
}

TrianglePoints points_of(const OctreeView& view, std::uint32_t triangle) {
  const Triangle& corners = view.arrays.triangles[triangle];
  return {position(view, corners[0]), position(view, corners[1]), position(view, corners[2])};
}

template <class Visit>
void for_each_bit(std::uint64_t bits, Visit&& visit) {
  for (; bits != 0; bits &= bits - 1) visit(static_cast<std::size_t>(std::countr_zero(bits)));
}

/// The exact stage sees triangles in the order of the results, so that nothing depends on the octrees' shape.
std::span<const TrianglePair> in_order_of_results(std::span<const TrianglePair> pairs,
                                                  std::span<const std::uint32_t> triangle_ids,
                                                  std::span<TrianglePair> ordered) {
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    ordered[k] = pairs[k];
    if (triangle_ids[pairs[k].a] > triangle_ids[pairs[k].b]) std::swap(ordered[k].a, ordered[k].b);
  }
  return ordered.first(pairs.size());
}

}  // namespace

void ContactPass::run(std::span<const ContactJob> jobs, std::span<const ContactObject> objects,
                      const SceneOptions& options, const Parallel& parallel, StepStats& stats) {
  objects_ = objects;
  options_ = options;
  parallel_ = &parallel;
  workers_.resize(parallel.worker_count());
  for (std::size_t w = 0; w < workers_.size(); ++w) {
    Worker& worker = workers_[w];
    worker.number = static_cast<std::uint16_t>(w);
    worker.found.clear();
    worker.details.clear();
    worker.unfinished.clear();
    worker.points.clear();
    worker.leaves.clear();
    worker.stats = {};
  }
  Timer timer;
  plan_outcomes(jobs);
  tasks_.plan(static_cast<std::uint32_t>(jobs_.size()), workers_.size(), workers_[0].traversal,
              [&](std::uint32_t job) { return view_of_job(job); });
  task_outcomes_.resize(tasks_.tasks().size());
  tasks_.run(parallel, workers_, [&](const ContactTask& task, Worker& worker) { run_task(task, worker); });
  add_stats(workers_, timer.lap(), stats);
  gather_contacts();
  gather_colliding_vertices();
  stats.contacts = contacts_.size();
  stats.sort_and_events_seconds += timer.lap();
}

/// Splits the jobs into those to be done and those whose outcome is known. Both lists ascend.
void ContactPass::plan_outcomes(std::span<const ContactJob> jobs) {
  outcomes_.swap(last_outcomes_);
  if (!is_complete_) last_outcomes_.clear();
  is_complete_ = false;
  outcomes_.clear();
  sources_.clear();
  jobs_.clear();
  std::uint32_t last = 0;
  for (const ContactJob& job : jobs) {
    const auto precedes = [&](const ContactJob& other) {
      return other.a != job.a ? other.a < job.a : other.b < job.b;
    };
    while (last < last_outcomes_.size() && precedes(last_outcomes_[last].job)) ++last;
    const Outcome outcome{job, objects_[job.a].version, objects_[job.b].version, {}, {}};
    outcomes_.push_back(outcome);
    // The vertices of colliding leaves are not kept.
    const bool is_known = !options_.comparison.colliding_vertices && last < last_outcomes_.size() &&
                          last_outcomes_[last].job.a == job.a && last_outcomes_[last].job.b == job.b &&
                          last_outcomes_[last].version_a == outcome.version_a &&
                          last_outcomes_[last].version_b == outcome.version_b;
    sources_.push_back({is_known ? last : none, 0, 0});
    if (!is_known) jobs_.push_back(job);
  }
}

ObjectPairView ContactPass::view_of_job(std::uint32_t job) const {
  const ContactObject& a = objects_[jobs_[job].a];
  if (jobs_[job].a == jobs_[job].b) return self_pair_of(a.view);
  return pair_of(a.view, objects_[jobs_[job].b].view);
}

void ContactPass::run_task(const ContactTask& task, Worker& worker) {
  const ObjectPairView pair = view_of_job(task.job);
  const std::span<const std::uint32_t> ids_a = objects_[jobs_[task.job].a].triangle_ids;
  const std::span<const std::uint32_t> ids_b = objects_[jobs_[task.job].b].triangle_ids;
  const auto on_leaves = [&](std::span<const LeafPair> leaf_pairs) {
    if (!options_.comparison.colliding_vertices) return;
    for (const LeafPair& leaves : leaf_pairs) worker.leaves.push_back({task.job, leaves});
  };
  const auto on_candidates = [&](std::span<const TrianglePair> candidates) {
    if (options_.contacts == ContactMode::none) return;
    Timer timer;
    const std::size_t first = worker.found.size();
    test_candidates(pair, ids_a, ids_b, candidates, worker);
    for (FoundContact& found : std::span(worker.found).subspan(first)) {
      found.triangle_a = ids_a[found.triangle_a];
      found.triangle_b = ids_b[found.triangle_b];
    }
    worker.stats.exact_seconds += timer.lap();
  };
  TaskOutcome& outcome = task_outcomes_[static_cast<std::size_t>(&task - tasks_.tasks().data())];
  outcome = {worker.number,
             {static_cast<std::uint32_t>(worker.found.size()), 0},
             {static_cast<std::uint32_t>(worker.points.size()), 0}};
  worker.traversal.find_triangle_pairs(pair, task.root, worker.stats.traversal, on_leaves, on_candidates);
  if (worker.unfinished.size() > 0) {
    Timer timer;
    add_normals(worker);
    worker.stats.exact_seconds += timer.lap();
  }
  outcome.contacts.count = static_cast<std::uint32_t>(worker.found.size()) - outcome.contacts.first;
  outcome.points.count = static_cast<std::uint32_t>(worker.points.size()) - outcome.points.first;
}

/// Floating point decides all but few candidates, a block of them at a time in vector lanes.
void ContactPass::test_candidates(const ObjectPairView& pair, std::span<const std::uint32_t> ids_a,
                                  std::span<const std::uint32_t> ids_b,
                                  std::span<const TrianglePair> candidates, Worker& worker) const {
  const PlacedTriangles triangles_a{pair.a.arrays, pair.a.translation};
  const PlacedTriangles triangles_b{pair.b.arrays, pair.b.translation};
  std::array<TrianglePair, pair_filter_capacity> ordered;
  for (std::size_t first = 0; first < candidates.size(); first += pair_filter_capacity) {
    auto part = candidates.subspan(first, std::min(pair_filter_capacity, candidates.size() - first));
    if (pair.same_object) part = in_order_of_results(part, ids_a, ordered);
    const PairVerdicts verdicts = filter_pairs(triangles_a, triangles_b, part);
    const std::uint64_t crossing = options_.contact_points ? 0 : verdicts.crossing;
    for_each_bit(crossing, [&](std::size_t k) {
      worker.found.push_back({part[k].a, part[k].b, 0, worker.number, IntersectionKind::segment, 2});
      // The end of the batch reads them.
      hwy::Prefetch(&ids_a[part[k].a]);
      hwy::Prefetch(&ids_b[part[k].b]);
    });
    const std::uint64_t asked = ~std::uint64_t{0} >> (pair_filter_capacity - part.size());
    for_each_bit(asked & ~(verdicts.apart | crossing),
                 [&](std::size_t k) { test_candidate(pair, part[k], worker); });
  }
}

void ContactPass::add_normals(Worker& worker) {
  std::array<Vec3d, IntersectingPairs::capacity> normals;
  separating_normals(worker.unfinished, normals.data());
  ContactDetails* const first = worker.details.data() + worker.details.size() - worker.unfinished.size();
  for (std::size_t i = 0; i < worker.unfinished.size(); ++i) first[i].normal = normals[i];
  worker.unfinished.clear();
}

void ContactPass::test_candidate(const ObjectPairView& pair, TrianglePair candidate, Worker& worker) const {
  const TrianglePoints a = points_of(pair.a, candidate.a), b = points_of(pair.b, candidate.b);
  const TriangleIntersection shared = intersect_triangles_without_normal(a, b);
  worker.stats.exact_fallbacks += shared.used_exact_fallback ? 1 : 0;
  if (!shared.intersects) return;
  worker.found.push_back({candidate.a, candidate.b, static_cast<std::uint32_t>(worker.details.size()),
                          worker.number, shared.kind, shared.point_count});
  if (options_.contact_points) {
    if (worker.unfinished.size() == IntersectingPairs::capacity) add_normals(worker);
    worker.unfinished.add(a, b);
    worker.details.push_back({{}, static_cast<std::uint32_t>(worker.points.size())});
    const auto points = shared.extreme_points();
    worker.points.insert(worker.points.end(), points.begin(), points.end());
  }
}

/// Jobs are in order already: each gets its place, and is sorted within. What is known moves within the
/// buffers, the rest is written around it.
void ContactPass::gather_contacts() {
  place_outcomes();
  move_known(contacts_, &Outcome::contacts);
  move_known(points_, &Outcome::points);
  parallel_->for_ranges(outcomes_.size(), 8, [&](std::size_t begin, std::size_t end, std::uint32_t w) {
    for (std::size_t i = begin; i < end; ++i) {
      if (sources_[i].known == none) {
        gather_found(sources_[i], outcomes_[i], workers_[w]);
      } else {
        renumber_points(last_outcomes_[sources_[i].known], outcomes_[i]);
      }
    }
  });
  list_groups();
  is_complete_ = true;
}

void ContactPass::place_outcomes() {
  const std::span<const ContactTask> tasks = tasks_.tasks();
  std::uint32_t job = 0, task = 0;
  Range contacts, points;
  for (std::size_t i = 0; i < outcomes_.size(); ++i) {
    Outcome& outcome = outcomes_[i];
    Source& source = sources_[i];
    if (source.known != none) {
      outcome.contacts.count = last_outcomes_[source.known].contacts.count;
      outcome.points.count = last_outcomes_[source.known].points.count;
    } else {
      source.first_task = task;
      for (; task < tasks.size() && tasks[task].job == job; ++task) {
        outcome.contacts.count += task_outcomes_[task].contacts.count;
        outcome.points.count += task_outcomes_[task].points.count;
      }
      source.task_count = task - source.first_task;
      ++job;
    }
    contacts = outcome.contacts = {contacts.end(), outcome.contacts.count};
    points = outcome.points = {points.end(), outcome.points.count};
  }
}

/// Known outcomes are in the order that they had, so that none which moves down comes to lie on one which is
/// yet to move up, nor the other way round.
template <class Item>
void ContactPass::move_known(std::vector<Item>& items, Range Outcome::*range) {
  const std::size_t total = outcomes_.empty() ? 0 : (outcomes_.back().*range).end();
  if (items.size() < total) items.resize(total);
  const auto move = [&](std::size_t i, bool down) {
    if (sources_[i].known == none) return;
    const Range from = last_outcomes_[sources_[i].known].*range, to = outcomes_[i].*range;
    if (to.first == from.first || (to.first < from.first) != down) return;
    std::memmove(items.data() + to.first, items.data() + from.first, to.count * sizeof(Item));
  };
  for (std::size_t i = 0; i < outcomes_.size(); ++i) move(i, true);
  for (std::size_t i = outcomes_.size(); i-- > 0;) move(i, false);
  items.resize(total);
}

void ContactPass::renumber_points(const Outcome& known, const Outcome& outcome) {
  const std::uint32_t change = outcome.points.first - known.points.first;
  if (change == 0) return;
  const auto first = contacts_.begin() + outcome.contacts.first;
  std::for_each(first, first + outcome.contacts.count,
                [&](Contact& contact) { contact.first_point += change; });
}

/// Those of one task are used where they are.
std::span<const FoundContact> ContactPass::found_of(const Source& source, Worker& worker) const {
  const auto tasks = std::span(task_outcomes_).subspan(source.first_task, source.task_count);
  const auto found = [&](const TaskOutcome& task) {
    return std::span(workers_[task.worker].found).subspan(task.contacts.first, task.contacts.count);
  };
  if (tasks.size() == 1) return found(tasks.front());
  worker.of_job.clear();
  for (const TaskOutcome& task : tasks) {
    const auto part = found(task);
    worker.of_job.insert(worker.of_job.end(), part.begin(), part.end());
  }
  return worker.of_job;
}

void ContactPass::gather_found(const Source& source, const Outcome& outcome, Worker& worker) {
  const ObjectId a = objects_[outcome.job.a].id, b = objects_[outcome.job.b].id;
  Contact* contact = contacts_.data() + outcome.contacts.first;
  std::uint32_t point = outcome.points.first;
  for (const FoundContact& found : worker.order.sort(found_of(source, worker))) {
    *contact = {a, b, found.triangle_a, found.triangle_b, found.kind, found.point_count, point, {}};
    if (options_.contact_points) {
      const Worker& finder = workers_[found.worker];
      const ContactDetails& details = finder.details[found.details];
      contact->normal = details.normal;
      std::copy_n(finder.points.begin() + details.first_point, found.point_count, points_.begin() + point);
      point += found.point_count;
    }
    ++contact;
  }
}

void ContactPass::list_groups() {
  groups_.clear();
  for (const Outcome& outcome : outcomes_) {
    if (outcome.contacts.count == 0) continue;
    groups_.push_back({objects_[outcome.job.a].id, objects_[outcome.job.b].id, outcome.contacts.first,
                       outcome.contacts.count});
  }
}

void ContactPass::gather_colliding_vertices() {
  vertex_groups_.clear();
  vertices_.clear();
  if (!options_.comparison.colliding_vertices) return;
  leaves_.clear();
  for (const Worker& worker : workers_)
    leaves_.insert(leaves_.end(), worker.leaves.begin(), worker.leaves.end());
  // The vertices of a job are a set: the order of its leaves does not matter.
  std::sort(leaves_.begin(), leaves_.end(),
            [](const CollidingLeaves& p, const CollidingLeaves& q) { return p.job < q.job; });
  for (auto first = leaves_.begin(); first != leaves_.end();) {
    const std::uint32_t job = first->job;
    const auto last =
        std::find_if(first, leaves_.end(), [&](const auto& leaves) { return leaves.job != job; });
    CollidingVertices group{objects_[jobs_[job].a].id, objects_[jobs_[job].b].id,
                            static_cast<std::uint32_t>(vertices_.size()), 0, 0};
    append_marked_vertices(jobs_[job].a, {first, last}, false);
    group.count_a = static_cast<std::uint32_t>(vertices_.size()) - group.first_vertex;
    append_marked_vertices(jobs_[job].b, {first, last}, true);
    group.count_b = static_cast<std::uint32_t>(vertices_.size()) - group.first_vertex - group.count_a;
    vertex_groups_.push_back(group);
    first = last;
  }
}

void ContactPass::append_marked_vertices(std::uint32_t object, std::span<const CollidingLeaves> leaves,
                                         bool side_b) {
  const ContactObject& owner = objects_[object];
  marked_.assign(owner.vertex_count, 0);
  for (const CollidingLeaves& pair : leaves) {
    const std::uint32_t begin = side_b ? pair.leaves.begin_b : pair.leaves.begin_a;
    const std::uint32_t end = side_b ? pair.leaves.end_b : pair.leaves.end_a;
    for (std::uint32_t t = begin; t < end; ++t) {
      for (const std::uint32_t vertex : owner.view.arrays.triangles[t]) marked_[vertex] = 1;
    }
  }
  for (std::uint32_t vertex = 0; vertex < marked_.size(); ++vertex) {
    if (marked_[vertex] != 0) vertices_.push_back(vertex);
  }
}

}  // namespace supple
