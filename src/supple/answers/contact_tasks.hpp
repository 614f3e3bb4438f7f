#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/parallel.hpp"
#include "core/stop_signal.hpp"
#include "core/timer.hpp"
#include "narrow_phase/traversal.hpp"
#include "supple/result.hpp"
#include "world/world.hpp"

namespace supple {

/// Part of a job: a pair of nodes and everything below it.
struct ContactTask {
  std::uint32_t job = 0;
  NodePair root;
};

/// The work of one worker in a step.
struct TaskStats {
  TraversalStats traversal;
  std::uint64_t exact_fallbacks = 0;
  double busy_seconds = 0;
  double exact_seconds = 0;  ///< part of `busy_seconds`
};

/// Splits jobs into tasks that load the workers evenly. Keeps its memory between steps. Many jobs are one
/// task each, which takes no memory.
class ContactTasks {
 public:
  /// Makes one task for each job; the jobs stay where they are. With several workers and few jobs, it splits
  /// tasks by descending the first levels of the octrees. `view_of_job(job)` returns an `ObjectPairView`.
  template <class ViewOfJob>
  void plan(std::span<const std::uint32_t> jobs, std::size_t worker_count, Traversal& traversal,
            ViewOfJob&& view_of_job) {
    jobs_ = jobs;
    tasks_.clear();
    splits_ = worker_count > 1 && jobs.size() < tasks_per_worker * worker_count;
    if (!splits_) return;
    for (const std::uint32_t job : jobs) tasks_.push_back({job, {}});
    for (int round = 0; round < most_refinements && tasks_.size() < tasks_per_worker * worker_count;
         ++round) {
      finer_tasks_.clear();
      for (const ContactTask& task : tasks_) {
        finer_.clear();
        traversal.refine(view_of_job(task.job), task.root, finer_);
        for (const NodePair& root : finer_) finer_tasks_.push_back({task.job, root});
      }
      tasks_.swap(finer_tasks_);
    }
  }

  std::size_t size() const { return splits_ ? tasks_.size() : jobs_.size(); }
  /// Ascending by job.
  ContactTask operator[](std::size_t task) const {
    return splits_ ? tasks_[task] : ContactTask{jobs_[task], {}};
  }

  /// Calls `run_task(index of the task, index of the worker)` for all tasks, on all workers, until a stop is
  /// requested. Each worker has a member `TaskStats stats`.
  template <class Worker, class RunTask>
  void run(const Parallel& parallel, std::vector<Worker>& workers, const StopSignal& stop,
           RunTask&& run_task) const {
    parallel.for_ranges(size(), 1, [&](std::size_t begin, std::size_t end, std::uint32_t w) {
      Timer busy;
      for (std::size_t i = begin; i < end && !stop.stop_requested(); ++i) run_task(i, w);
      workers[w].stats.busy_seconds += busy.lap();
    });
  }

 private:
  static constexpr std::size_t tasks_per_worker = 32;
  static constexpr int most_refinements = 4;

  std::span<const std::uint32_t> jobs_;
  bool splits_ = false;
  std::vector<ContactTask> tasks_, finer_tasks_;  // where it splits
  std::vector<NodePair> finer_;
};

/// Adds the work of all workers to `stats`. `wall_seconds` is the time of traversal and exact stage together;
/// the workers' own clocks say how it splits.
template <class Worker>
void add_stats(const std::vector<Worker>& workers, double wall_seconds, StepStats& stats) {
  double busy = 0, exact = 0;
  for (const Worker& worker : workers) {
    const TaskStats& done = worker.stats;
    busy += done.busy_seconds;
    exact += done.exact_seconds;
    stats.node_pairs_visited += done.traversal.node_pairs_visited;
    stats.boxes_tested += done.traversal.volumes_tested;
    stats.candidate_pairs += done.traversal.candidate_pairs;
    stats.vertex_face_candidates += done.traversal.vertex_face_candidates;
    stats.edge_edge_candidates += done.traversal.edge_edge_candidates;
    stats.exact_fallbacks += done.exact_fallbacks;
  }
  const double exact_seconds = wall_seconds * (busy > 0 ? std::min(1.0, exact / busy) : 0);
  stats.exact_seconds += exact_seconds;
  stats.traversal_seconds += wall_seconds - exact_seconds;
}

}  // namespace supple
