#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "narrow_phase/traversal.hpp"

namespace supple {

/// Two objects to be tested against each other, as indices into the objects of a pass; the same twice for an
/// object against itself. `a <= b`.
struct ContactJob {
  std::uint32_t a = 0, b = 0;
};

/// Part of a job: what lies below a pair of nodes.
struct ContactTask {
  std::uint32_t job = 0;
  NodePair root;
};

/// Splits jobs into tasks that load the workers evenly. Keeps its memory between steps.
class ContactTasks {
 public:
  /// One task a job; with several workers and few jobs, the first levels of the descent are done here to have
  /// enough of them. `view_of_job(job)` gives an `ObjectPairView`.
  template <class ViewOfJob>
  void plan(std::uint32_t job_count, std::size_t worker_count, Traversal& traversal,
            ViewOfJob&& view_of_job) {
    tasks_.clear();
    for (std::uint32_t job = 0; job < job_count; ++job) tasks_.push_back({job, {}});
    if (worker_count == 1) return;
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

  std::size_t size() const { return tasks_.size(); }
  const ContactTask& operator[](std::size_t i) const { return tasks_[i]; }

 private:
  static constexpr std::size_t tasks_per_worker = 32;
  static constexpr int most_refinements = 4;

  std::vector<ContactTask> tasks_, finer_tasks_;
  std::vector<NodePair> finer_;
};

}  // namespace supple
