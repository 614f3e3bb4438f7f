#include "answers/intersection/intersection_pass.hpp"

#include <hwy/cache_control.h>

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include "contact/intersection/neighbour_test.hpp"
#include "contact/intersection/triangle_intersection.hpp"
#include "octree/comparison_methods.hpp"

namespace supple {

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

std::uint32_t smallest_common_vertex(const Triangle& p, const Triangle& q) {
  std::uint32_t smallest = ~std::uint32_t{0};
  for (const std::uint32_t v : p) {
    if (std::find(q.begin(), q.end(), v) != q.end()) smallest = std::min(smallest, v);
  }
  return smallest;
}

/// Orders each pair as in the result, so that the exact stage does not depend on the shape of the octrees.
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

bool IntersectionPass::run(const PassInput& input, std::span<const IntersectedObject> objects,
                           const IntersectionSearch& search, StepStats& stats) {
  begin(input.jobs, objects, input.stop);
  // Colliding vertices are not reused from the previous step.
  const bool is_same_search = std::exchange(search_, search) == search && !search.colliding_vertices;
  if (!run_open_jobs(input, is_same_search, input.max_contacts, stats)) return false;
  Timer timer;
  gather(input.parallel);
  end(input.max_contacts);
  if (is_truncated() && search_.contact_points)
    points_.resize(records_.empty() ? 0 : records_.back().first_point + records_.back().point_count);
  gather_colliding_vertices();
  stats.contacts += records_.size();
  stats.sort_and_events_seconds += timer.lap();
  return true;
}

ObjectPairView IntersectionPass::view_of_job(std::uint32_t job) const {
  const auto [a, b] = jobs_[job];
  return pair_of(objects_[a].view, objects_[b].view);
}

void IntersectionPass::run_task(std::size_t task, Worker& worker) {
  const std::uint32_t job = tasks_[task].job;
  const Ranges ranges = begin_task(task, worker);
  if (limit_.excludes(ContactLimit::place(job, 0))) return end_task(task, ranges, worker);
  const TaskInput input = input_of_job(job);
  const auto on_leaves = [&](std::span<const LeafPair> leaf_pairs) {
    if (!search_.colliding_vertices) return;
    for (const LeafPair& leaves : leaf_pairs) worker.leaves.push_back({job, leaves});
  };
  const auto test = [&](std::span<const TrianglePair> candidates) {
    test_candidates(input, candidates, worker);
    if (!limit_.is_set()) return;
    add_crossing(input, worker.crossing_count, worker);
    if (drop_excess(job, ranges[of_contacts].first, worker))
      drop_points(ranges[of_contacts].first, ranges[of_points].first, worker);
  };
  const auto on_candidates = [&](std::span<const TrianglePair> candidates) {
    if (!search_.contacts) return;
    Timer timer;
    test(candidates);
    worker.stats.exact_seconds += timer.lap();
  };
  worker.traversal.find_triangle_pairs(input.pair, tasks_[task].root, worker.stats.traversal, on_leaves,
                                       on_candidates);
  Timer timer;
  if (search_.contacts && input.pair.same_object && input.object_a.neighbours != nullptr)
    for_neighbours(input, task, worker, test);
  add_crossing(input, worker.crossing_count, worker);
  add_normals(worker);
  worker.stats.exact_seconds += timer.lap();
  end_task(task, ranges, worker);
}

IntersectionPass::TaskInput IntersectionPass::input_of_job(std::uint32_t job) const {
  const auto [a, b] = jobs_[job];
  const ObjectPairView pair = view_of_job(job);
  return {job,
          pair,
          {pair.a.arrays, pair.a.translation},
          {pair.b.arrays, pair.b.translation},
          objects_[a].octree->triangle_ids(),
          objects_[b].octree->triangle_ids(),
          objects_[a],
          objects_[b]};
}

/// Calls `test` with lists of pairs of triangles that share a vertex and may meet elsewhere. The tasks of a
/// job share the vertices.
template <class Test>
void IntersectionPass::for_neighbours(const TaskInput& input, std::size_t task, Worker& worker,
                                      const Test& test) const {
  constexpr std::size_t most_waiting = 4096;
  std::size_t first_task = task, last_task = task + 1;
  while (first_task > 0 && tasks_[first_task - 1].job == input.job) --first_task;
  while (last_task < tasks_.size() && tasks_[last_task].job == input.job) ++last_task;
  const ObjectOctree& octree = *input.object_a.octree;
  const std::size_t count = octree.vertex_count(), parts = last_task - first_task, part = task - first_task;
  worker.neighbours.clear();
  const auto pass_on = [&] {
    test(worker.neighbours);
    worker.neighbours.clear();
  };
  for (std::size_t v = count * part / parts; v < count * (part + 1) / parts && !stop_.stop_requested(); ++v) {
    const std::span<const std::uint32_t> around =
        input.object_a.neighbours->around(static_cast<std::uint32_t>(v));
    for (std::size_t i = 0; i < around.size(); ++i) {
      for (std::size_t k = i + 1; k < around.size(); ++k) {
        const TrianglePair pair{octree.octree_triangle(around[i]), octree.octree_triangle(around[k])};
        const Triangle &p = octree.triangles()[pair.a], &q = octree.triangles()[pair.b];
        if (smallest_common_vertex(p, q) != v) continue;
        if (meet_elsewhere(p, points_of(input.pair.a, pair.a), q, points_of(input.pair.a, pair.b)))
          worker.neighbours.push_back(pair);
      }
      if (worker.neighbours.size() >= most_waiting) pass_on();
    }
  }
  pass_on();
}

/// A vector kernel decides a block of candidates at a time. The exact test decides the few that remain.
void IntersectionPass::test_candidates(const TaskInput& input, std::span<const TrianglePair> candidates,
                                       Worker& worker) const {
  const bool has_groups = !input.object_a.groups.empty() || !input.object_b.groups.empty();
  std::array<TrianglePair, pair_filter_capacity> ordered, wanted;
  for (std::size_t first = 0; first < candidates.size(); first += pair_filter_capacity) {
    if (stop_.stop_requested()) return;
    auto part = candidates.subspan(first, std::min(pair_filter_capacity, candidates.size() - first));
    if (input.pair.same_object) part = in_order_of_results(part, input.ids_a, ordered);
    if (limit_.excludes_some() || has_groups) {
      const auto end = std::copy_if(part.begin(), part.end(), wanted.begin(), [&](const TrianglePair& p) {
        return !limit_.excludes(ContactLimit::place(input.job, input.ids_a[p.a])) &&
               may_touch_by_groups(input.object_a.groups, input.pair.a.arrays.triangles[p.a],
                                   input.object_b.groups, input.pair.b.arrays.triangles[p.b]);
      });
      part = {wanted.begin(), end};
      if (part.empty()) continue;
    }
    const PairVerdicts verdicts = filter_pairs(input.triangles_a, input.triangles_b, part);
    for_each_bit(verdicts.crossing, [&](std::size_t k) {
      worker.crossing[worker.crossing_count++] = part[k];
      // `add_crossing` reads these ids.
      hwy::Prefetch(&input.ids_a[part[k].a]);
      hwy::Prefetch(&input.ids_b[part[k].b]);
    });
    if (worker.crossing_count >= CrossingSegments::capacity)
      add_crossing(input, CrossingSegments::capacity, worker);
    const std::uint64_t asked = ~std::uint64_t{0} >> (pair_filter_capacity - part.size());
    for_each_bit(asked & ~(verdicts.apart | verdicts.crossing),
                 [&](std::size_t k) { test_candidate(input, part[k], worker); });
  }
}

/// Adds the first `count` pairs that wait in `crossing` to the contacts.
void IntersectionPass::add_crossing(const TaskInput& input, std::size_t count, Worker& worker) const {
  const std::span<const TrianglePair> pairs = std::span(worker.crossing).first(count);
  if (search_.contact_points) worker.segments.find(input.triangles_a, input.triangles_b, pairs);
  for (std::size_t k = 0; k < count; ++k) {
    const auto [a, b] = pairs[k];
    if (search_.contact_points && !worker.segments.is_known(k)) {
      test_candidate(input, pairs[k], worker);
      continue;
    }
    worker.found.push_back({input.ids_a[a], input.ids_b[b], static_cast<std::uint32_t>(worker.details.size()),
                            static_cast<std::uint16_t>(worker.number), IntersectionKind::segment, 2});
    if (!search_.contact_points) continue;
    worker.details.push_back({worker.segments.normal(k), static_cast<std::uint32_t>(worker.points.size())});
    worker.points.push_back(worker.segments.end(0, k));
    worker.points.push_back(worker.segments.end(1, k));
  }
  std::copy(worker.crossing.begin() + static_cast<std::ptrdiff_t>(count),
            worker.crossing.begin() + static_cast<std::ptrdiff_t>(worker.crossing_count),
            worker.crossing.begin());
  worker.crossing_count -= count;
}

void IntersectionPass::test_candidate(const TaskInput& input, TrianglePair candidate, Worker& worker) const {
  const TrianglePoints a = points_of(input.pair.a, candidate.a), b = points_of(input.pair.b, candidate.b);
  const TriangleIntersection shared = intersect_triangles_without_normal(a, b);
  worker.stats.exact_fallbacks += shared.used_exact_fallback ? 1 : 0;
  if (!shared.intersects) return;
  worker.found.push_back({input.ids_a[candidate.a], input.ids_b[candidate.b],
                          static_cast<std::uint32_t>(worker.details.size()),
                          static_cast<std::uint16_t>(worker.number), shared.kind, shared.point_count});
  if (!search_.contact_points) return;
  if (worker.unfinished.size() == IntersectingPairs::capacity) add_normals(worker);
  worker.unfinished_details[worker.unfinished.size()] = static_cast<std::uint32_t>(worker.details.size());
  worker.unfinished.add(a, b);
  worker.details.push_back({{}, static_cast<std::uint32_t>(worker.points.size())});
  const auto points = shared.extreme_points();
  worker.points.insert(worker.points.end(), points.begin(), points.end());
}

void IntersectionPass::add_normals(Worker& worker) {
  if (worker.unfinished.size() == 0) return;
  std::array<Vec3d, IntersectingPairs::capacity> normals;
  separating_normals(worker.unfinished, normals.data());
  for (std::size_t i = 0; i < worker.unfinished.size(); ++i)
    worker.details[worker.unfinished_details[i]].normal = normals[i];
  worker.unfinished.clear();
}

/// Drops the points of contacts that one task has dropped. Its contacts begin at `first`, their points at
/// `first_point`.
void IntersectionPass::drop_points(std::size_t first, std::size_t first_point, Worker& worker) const {
  if (!search_.contact_points) return;
  add_normals(worker);
  // Each contact of the worker has one item in `details`. In the order of these, items only move down.
  const std::span kept = std::span(worker.found).subspan(first);
  std::sort(kept.begin(), kept.end(),
            [](const FoundContact& p, const FoundContact& q) { return p.details < q.details; });
  auto next = static_cast<std::uint32_t>(first), point = static_cast<std::uint32_t>(first_point);
  for (FoundContact& found : kept) {
    IntersectionWorker::Details details = worker.details[found.details];
    const auto points = worker.points.begin() + static_cast<std::ptrdiff_t>(details.first_point);
    std::copy_n(points, found.point_count, worker.points.begin() + static_cast<std::ptrdiff_t>(point));
    details.first_point = std::exchange(point, point + found.point_count);
    worker.details[next] = details;
    found.details = next++;
  }
  worker.details.resize(next);
  worker.points.resize(point);
}

/// Known contacts name their points at new places.
void IntersectionPass::move_known() {
  outcomes_.move_known<of_contacts>(records_);
  outcomes_.move_known<of_points>(points_);
  for (std::size_t i = 0; i < outcomes_.size(); ++i) {
    if (!outcomes_.is_known(i)) continue;
    const auto [contacts, points] = outcomes_.ranges(i);
    const std::uint32_t change = points.first - outcomes_.last_ranges(i)[of_points].first;
    if (change == 0) continue;
    for (Contact& contact : std::span(records_).subspan(contacts.first, contacts.count))
      contact.first_point += change;
  }
}

void IntersectionPass::gather_found(std::size_t outcome, Worker& worker, const Parallel& parallel) {
  worker.order.sort(
      [&](const auto& visit) {
        for_each_found(outcome,
                       [&](const FoundContact& found, std::uint32_t, std::uint32_t) { visit(found); });
      },
      [](const FoundContact& found) {
        return SortKey{0, found.triangle_a};
      },
      [](const FoundContact& p, const FoundContact& q) { return is_before(p, q); }, parallel, worker.sorted);
  const ContactJob job = jobs_[outcomes_.job(outcome)];
  const ObjectId a = objects_[job.a].id, b = objects_[job.b].id;
  const std::uint32_t first = outcomes_.ranges(outcome)[of_contacts].first;
  std::uint32_t point = outcomes_.ranges(outcome)[of_points].first;
  for (std::size_t i = 0; i < worker.sorted.size(); ++i) {
    const FoundContact& found = worker.sorted[i];
    records_[first + i] = {a,     b, found.triangle_a, found.triangle_b, found.kind, found.point_count,
                           point, {}};
    if (search_.contact_points) point += found.point_count;
  }
  if (!search_.contact_points) return;
  parallel.for_ranges(worker.sorted.size(), 1024, [&](std::size_t begin, std::size_t end, std::uint32_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const FoundContact& found = worker.sorted[i];
      Contact& contact = records_[first + i];
      const Worker& finder = workers_[found.worker];
      const IntersectionWorker::Details& details = finder.details[found.details];
      contact.normal = details.normal;
      const ContactPoint* const from = &finder.points[details.first_point];
      ContactPoint* const to = &points_[contact.first_point];
      to[0] = from[0];
      if (found.point_count > 1) to[1] = from[1];  // most have two: no loop, which would be a call
      for (std::uint8_t p = 2; p < found.point_count; ++p) to[p] = from[p];
    }
  });
}

void IntersectionPass::gather_colliding_vertices() {
  colliding_.groups.clear();
  colliding_.vertices.clear();
  if (!search_.colliding_vertices) return;
  colliding_.leaves.clear();
  for (const Worker& worker : workers_)
    colliding_.leaves.insert(colliding_.leaves.end(), worker.leaves.begin(), worker.leaves.end());
  comparison_methods({}).list_colliding_vertices(jobs_, objects_, colliding_);
}

}  // namespace supple
