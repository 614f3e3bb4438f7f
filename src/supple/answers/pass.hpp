#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "answers/contact_limit.hpp"
#include "answers/contact_tasks.hpp"
#include "answers/job_outcomes.hpp"
#include "core/bucket_sort.hpp"
#include "core/parallel.hpp"
#include "core/stop_signal.hpp"
#include "core/timer.hpp"
#include "narrow_phase/traversal.hpp"
#include "supple/result.hpp"

namespace supple {

/// What all passes of a step read, besides their objects.
struct PassInput {
  std::span<const ContactJob> jobs;         ///< ascending; they contain indices of the objects
  std::span<const std::uint64_t> versions;  ///< of the objects' positions and margins
  std::uint64_t max_contacts = ContactLimit::unlimited;
  StopSignal stop{};
  const Parallel& parallel;
};

/// What a worker of any pass has. Passes add to it; `start` prepares for a search.
template <class Found>
struct PassWorker {
  std::uint32_t number = 0;
  Traversal traversal;
  std::vector<Found> found;  ///< by all tasks of the worker
  TaskStats stats;
  BucketSort order;

  void start() {}
  std::size_t capacity() const { return found.capacity(); }
  /// The sizes of the lists in which the ranges of a task are.
  std::array<std::uint32_t, 1> sizes() const { return {static_cast<std::uint32_t>(found.size())}; }
};

/// What the answers of the narrow phase do alike. For all jobs of a step whose outcome is not known, it plans
/// tasks, runs them on all workers, and lists the records of all jobs in canonical order. It keeps its memory
/// between steps.
///
/// `Kind` derives from it, is its friend, and has the test and the record:
///   `ObjectPairView view_of_job(job)`     what the traversal reads
///   `run_task(task, worker)`              tests candidates and adds to `worker.found`
///   `answers`, `list_of_records`          the kind of contacts, and the list of a `DetectResult`
///   `search_of(question, earlier)`        what `run` searches; passes before this one found `earlier`
/// and, if it calls `drop_excess` and `gather`:
///   `static is_before(found, found)`      the order of the records of a job
///   `place_of(job, found)`                a place for `ContactLimit`; does not descend in that order
///   `move_known()`                        moves known records and what belongs to them
///   `gather_found(outcome, worker, parallel)` writes the records of a job in order
template <class Kind, class ObjectType, class WorkerType, class RecordType>
class Pass {
 public:
  using Object = ObjectType;
  using Worker = WorkerType;
  using Record = RecordType;

  std::span<const ContactGroup> groups() const { return groups_; }
  /// The search found more records than the caller wants.
  bool is_truncated() const { return is_truncated_; }
  /// For how much of what it finds a worker has memory.
  std::size_t largest_buffer() const {
    std::size_t largest = 0;
    for (const Worker& worker : workers_) largest = std::max(largest, worker.capacity());
    return largest;
  }

  /// Adds the lists to a result; passes add theirs.
  void list(DetectResult& found) const {
    found.truncated = found.truncated || is_truncated_;
    found.*info_of(Kind::answers).groups = groups_;
    found.*Kind::list_of_records = records_;
  }
  /// Calls `visit(list)` for each list of the result; passes add theirs.
  template <class Visit>
  void visit_lists(const Visit& visit) {
    visit(groups_);
    visit(records_);
  }

 protected:
  static constexpr std::size_t list_count = std::tuple_size_v<decltype(std::declval<Worker>().sizes())>;
  using Outcomes = JobOutcomes<list_count>;
  using Ranges = typename Outcomes::Ranges;

  void begin(std::span<const ContactJob> jobs, std::span<const Object> objects, const StopSignal& stop) {
    jobs_ = jobs;
    objects_ = objects;
    stop_ = stop;
  }

  /// Plans and runs the tasks of these jobs.
  void run_tasks(std::span<const std::uint32_t> jobs, const Parallel& parallel) {
    workers_.resize(parallel.worker_count());
    for (std::uint32_t w = 0; w < workers_.size(); ++w) {
      Worker& worker = workers_[w];
      worker.number = w;
      worker.traversal.set_stop(stop_);
      worker.found.clear();
      worker.stats = {};
      worker.start();
    }
    tasks_.plan(jobs, workers_.size(), workers_[0].traversal,
                [&](std::uint32_t job) { return kind().view_of_job(job); });
    outcomes_.expect_tasks(workers_.size());
    tasks_.run(parallel, workers_, stop_,
               [&](std::size_t task, std::uint32_t w) { kind().run_task(task, workers_[w]); });
  }

  /// Runs all jobs whose outcome is not that of the previous step. Returns false when it was stopped; the
  /// lists are then not valid. Records after the first `wanted` may be missing.
  bool run_open_jobs(const PassInput& input, bool is_same_search, std::uint64_t wanted, StepStats& stats) {
    Timer timer;
    outcomes_.plan(jobs_, input.versions, is_same_search, input.parallel.worker_count());
    limit_.start(wanted, jobs_.size());
    for (std::size_t known = 0; known < outcomes_.size(); ++known)
      limit_.add(outcomes_.job(known), outcomes_.ranges(known)[0].count);
    run_tasks(outcomes_.open_jobs(), input.parallel);
    add_stats(workers_, timer.lap(), stats);
    return !stop_.stop_requested();
  }

  /// The ranges in which a task adds to what its worker has found. With a limit, the tasks of a job that
  /// follow each other share them, so that the list is cut where they together find too much.
  Ranges begin_task(std::size_t task, Worker& worker) {
    if (limit_.is_set()) {
      if (const auto continued = outcomes_.take(tasks_[task].job, worker.number)) return *continued;
    }
    Ranges ranges{};
    for (std::size_t list = 0; list < list_count; ++list) ranges[list].first = worker.sizes()[list];
    return ranges;
  }
  void end_task(std::size_t task, const Ranges& begun, const Worker& worker) {
    Ranges ranges = begun;
    for (std::size_t list = 0; list < list_count; ++list)
      ranges[list].count = worker.sizes()[list] - ranges[list].first;
    const std::uint32_t job = tasks_[task].job;
    outcomes_.add({job, static_cast<std::uint32_t>(task), worker.number, ranges});
    limit_.add(job, ranges[0].count - std::min(ranges[0].count, begun[0].count));
  }

  /// Drops what a task has found too much from `first` on: what follows the first `wanted()`. Returns whether
  /// there was any.
  bool drop_excess(std::uint32_t job, std::size_t first, Worker& worker) {
    if (!limit_.drops_at(worker.found.size() - first)) return false;
    const auto begin = worker.found.begin() + static_cast<std::ptrdiff_t>(first);
    const auto last = begin + static_cast<std::ptrdiff_t>(limit_.wanted() - 1);
    std::nth_element(begin, last, worker.found.end(),
                     [](const auto& p, const auto& q) { return Kind::is_before(p, q); });
    limit_.exclude_after(kind().place_of(job, *last));
    worker.found.erase(last + 1, worker.found.end());
    return true;
  }

  /// Visits what the tasks of a job have found, with the worker that has it and its index there.
  template <class Visit>
  void for_each_found(std::size_t outcome, const Visit& visit) const {
    for (const auto& [job, task, worker, ranges] : outcomes_.tasks_of(outcome)) {
      for (std::uint32_t i = ranges[0].first; i < ranges[0].end(); ++i)
        visit(workers_[worker].found[i], worker, i);
    }
  }

  /// Lists the records of all jobs. Known ones only move within the list; new ones are written between them.
  /// All workers share a job with many records.
  void gather(const Parallel& parallel) {
    constexpr std::uint32_t many = 8192;
    outcomes_.place();
    kind().move_known();
    const auto has_many = [&](std::size_t outcome) { return outcomes_.ranges(outcome)[0].count >= many; };
    parallel.for_ranges(outcomes_.size(), 8, [&](std::size_t begin, std::size_t end, std::uint32_t w) {
      for (std::size_t i = begin; i < end; ++i) {
        if (!outcomes_.is_known(i) && !has_many(i)) kind().gather_found(i, workers_[w], Parallel(1));
      }
    });
    for (std::size_t i = 0; i < outcomes_.size(); ++i) {
      if (!outcomes_.is_known(i) && has_many(i)) kind().gather_found(i, workers_[0], parallel);
    }
    outcomes_.complete();
  }

  /// Cuts the list after `most` records and lists the groups.
  void end(std::uint64_t most) {
    is_truncated_ = records_.size() > most;
    if (is_truncated_) {
      outcomes_.truncate(most);
      records_.resize(static_cast<std::size_t>(most));
    }
    outcomes_.list_groups(groups_, [&](std::uint32_t object) { return objects_[object].id; });
  }

  std::span<const ContactJob> jobs_;
  std::span<const Object> objects_;
  StopSignal stop_;
  std::vector<Worker> workers_;
  ContactTasks tasks_;
  ContactLimit limit_;
  Outcomes outcomes_;
  std::vector<ContactGroup> groups_;
  std::vector<Record> records_;
  bool is_truncated_ = false;

 private:
  Kind& kind() { return static_cast<Kind&>(*this); }
};

}  // namespace supple
