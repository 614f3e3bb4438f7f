#include "scene/proximity_pass.hpp"

#include <algorithm>
#include <bit>
#include <tuple>
#include <utility>

#include "core/float_rounding.hpp"
#include "core/timer.hpp"
#include "scene/proximity_pair.hpp"

namespace supple {
namespace {

constexpr std::size_t block_size = RelativeMotionBlock::capacity;

PairElement element_of(const MovingObject& object, std::span<const std::uint32_t> vertices,
                       std::uint32_t triangle) {
  std::array<std::uint32_t, 3> ids{};
  std::array<Vec3d, 3> points{};
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    ids[i] = object.vertex_ids[vertices[i]];
    points[i] = placed((*object.end)[vertices[i]], object);
  }
  return PairElement(std::span(ids).first(vertices.size()), points, triangle);
}

}  // namespace

bool ProximityPass::run(std::span<const ContactJob> jobs, std::span<const MovingObject> objects,
                        std::span<const std::uint64_t> versions, const ProximitySearch& search,
                        std::uint64_t max_pairs, const StopSignal& stop, const Parallel& parallel,
                        StepStats& stats) {
  Timer timer;
  jobs_ = jobs;
  objects_ = objects;
  stop_ = stop;
  outcomes_.plan(jobs, versions, search == search_);
  search_ = search;
  workers_.resize(parallel.worker_count());
  for (Worker& worker : workers_) {
    worker.traversal.set_stop(stop);
    worker.found.clear();
    worker.stats = {};
  }
  tasks_.plan(outcomes_.open_jobs(), workers_.size(), workers_[0].traversal,
              [&](std::uint32_t job) { return view_of_job(job); });
  outcomes_.expect_tasks(tasks_.tasks().size());
  tasks_.run(parallel, workers_, stop, [&](std::size_t task, std::uint32_t w) { run_task(task, w); });
  add_stats(workers_, timer.lap(), stats);
  if (stop.stop_requested()) return false;
  sort_found(parallel);
  outcomes_.place(tasks_.tasks());
  outcomes_.move_known<0>(pairs_);
  for (std::size_t open = 0; open < outcomes_.open_jobs().size(); ++open) {
    ProximityPair* to = pairs_.data() + outcomes_.ranges(outcomes_.open_jobs()[open])[0].first;
    for (const Key& key : keys_[open]) *to++ = workers_[key.worker].found[key.index];
  }
  outcomes_.complete();
  is_truncated_ = pairs_.size() > max_pairs;
  if (is_truncated_) {
    outcomes_.truncate(max_pairs);
    pairs_.resize(static_cast<std::size_t>(max_pairs));
  }
  outcomes_.list_groups(groups_, [&](std::uint32_t object) { return objects_[object].id; });
  stats.proximity_pairs += pairs_.size();
  stats.sort_and_events_seconds += timer.lap();
  return true;
}

ObjectPairView ProximityPass::view_of_job(std::uint32_t job) const {
  const MovingObject& a = objects_[jobs_[job].a];
  const MovingObject& b = objects_[jobs_[job].b];
  const double reach = reach_of_margins(a.margin, b.margin);
  ObjectPairView pair = &a == &b ? moving_self_pair_of(a.view, reach) : moving_pair_of(a.view, b.view, reach);
  pair.kinds = search_.kinds;
  return pair;
}

void ProximityPass::run_task(std::size_t task, std::uint32_t w) {
  const auto [job, root] = tasks_.tasks()[task];
  Worker& worker = workers_[w];
  const std::size_t first = worker.found.size();
  worker.traversal.find_element_pairs(view_of_job(job), root, worker.stats.traversal,
                                      [&](ElementPairKind kind, std::span<const ElementPair> candidates) {
                                        Timer timer;
                                        test_candidates(job, kind, candidates, worker);
                                        worker.stats.exact_seconds += timer.lap();
                                      });
  const auto count = static_cast<std::uint32_t>(worker.found.size() - first);
  outcomes_.of_task(task) = {w, {{{static_cast<std::uint32_t>(first), count}}}};
}

void ProximityPass::test_candidates(std::uint32_t job, ElementPairKind kind,
                                    std::span<const ElementPair> candidates, Worker& worker) {
  const MovingObject& a = objects_[jobs_[job].a];
  const MovingObject& b = objects_[jobs_[job].b];
  const auto objects = objects_of(kind, a, b);
  const bool are_edges = kind == ElementPairKind::edge_edge;
  const float reach = round_up(reach_of_margins(a.margin, b.margin));
  std::array<std::array<std::uint32_t, 4>, block_size> vertices;
  for (; !candidates.empty() && !stop_.stop_requested();
       candidates = candidates.subspan(std::min(block_size, candidates.size()))) {
    const auto part = candidates.first(std::min(block_size, candidates.size()));
    for (std::size_t k = 0; k < part.size(); ++k) vertices[k] = vertices_of(kind, part[k], a, b);
    fill(objects, std::span(vertices).first(part.size()), are_edges, 1, worker.block);
    for (std::uint64_t left = may_touch(worker.block, part.size(), are_edges, reach); left != 0;
         left &= left - 1) {
      const auto k = static_cast<std::size_t>(std::countr_zero(left));
      if (may_touch_by_groups(objects, vertices[k], are_edges))
        add_pair(job, kind, part[k], vertices[k], worker);
    }
  }
}

void ProximityPass::add_pair(std::uint32_t job, ElementPairKind kind, ElementPair candidate,
                             std::array<std::uint32_t, 4> vertices, Worker& worker) {
  const MovingObject& a = objects_[jobs_[job].a];
  const MovingObject& b = objects_[jobs_[job].b];
  const bool are_edges = kind == ElementPairKind::edge_edge, is_self = &a == &b;
  const auto objects = objects_of(kind, a, b);
  const std::size_t count = are_edges ? 2 : 1;
  // A vertex stands before a face here.
  const std::uint32_t triangle = kind == ElementPairKind::vertex_face   ? b.triangle_ids[candidate.b]
                                 : kind == ElementPairKind::face_vertex ? a.triangle_ids[candidate.a]
                                                                        : 0;
  std::size_t count_b = 4 - count;
  if (!are_edges && triangle >= objects[3]->face_count) count_b = vertices[1] == vertices[2] ? 1 : 2;
  PairElement first = element_of(*objects[0], std::span(vertices).first(count), 0);
  PairElement second = element_of(*objects[3], std::span(vertices).subspan(count, count_b), triangle);
  if (is_self && are_edges && second.edge_order() < first.edge_order()) std::swap(first, second);
  bool used_exact = false;
  const auto order = is_self                                ? PairOrder::by_names
                     : kind == ElementPairKind::face_vertex ? PairOrder::swapped
                                                            : PairOrder::given;
  const auto pair = proximity_pair_within(first, second, {a.id, b.id}, order, search_.listing,
                                          reach_of_margins(a.margin, b.margin), used_exact);
  worker.stats.exact_fallbacks += used_exact ? 1 : 0;
  if (pair) worker.found.push_back(*pair);
}

/// Orders the pairs of each open job, each once, and tells their number to the outcomes.
void ProximityPass::sort_found(const Parallel& parallel) {
  first_tasks_.clear();
  for (std::uint32_t task = 0; task < tasks_.tasks().size(); ++task) {
    if (task == 0 || tasks_.tasks()[task].job != tasks_.tasks()[task - 1].job) first_tasks_.push_back(task);
  }
  const std::size_t jobs = first_tasks_.size();
  first_tasks_.push_back(static_cast<std::uint32_t>(tasks_.tasks().size()));
  if (keys_.size() < outcomes_.open_jobs().size()) keys_.resize(outcomes_.open_jobs().size());
  for (std::vector<Key>& keys : keys_) keys.clear();
  parallel.for_ranges(jobs, 1, [&](std::size_t begin, std::size_t end, std::uint32_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto& open = outcomes_.open_jobs();
      const auto place = std::lower_bound(open.begin(), open.end(), tasks_.tasks()[first_tasks_[i]].job);
      sort_job(first_tasks_[i], first_tasks_[i + 1], keys_[static_cast<std::size_t>(place - open.begin())]);
    }
  });
}

void ProximityPass::sort_job(std::size_t first_task, std::size_t end_task, std::vector<Key>& keys) {
  for (std::size_t task = first_task; task < end_task; ++task) {
    auto& [w, ranges] = outcomes_.of_task(task);
    for (std::uint32_t i = ranges[0].first; i < ranges[0].end(); ++i) {
      const ProximityPair& pair = workers_[w].found[i];
      keys.push_back({pair.kind_a, pair.kind_b, pair.element_a, pair.element_b, w, i});
    }
    ranges[0].count = 0;
  }
  std::sort(keys.begin(), keys.end());
  const auto same = [](const Key& p, const Key& q) { return p.is_same_pair(q); };
  keys.erase(std::unique(keys.begin(), keys.end(), same), keys.end());
  outcomes_.of_task(first_task).ranges[0].count = static_cast<std::uint32_t>(keys.size());
}

}  // namespace supple
