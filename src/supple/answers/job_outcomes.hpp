#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "answers/contact_tasks.hpp"
#include "supple/result.hpp"

namespace supple {

/// A range of a list.
struct Range {
  std::uint32_t first = 0, count = 0;

  std::uint32_t end() const { return first + count; }
};

/// The contacts that each job of a step found, as ranges of the lists of the result. `lists` is the number of
/// lists, for example contacts and points. When neither object of a job has moved, the job reuses the
/// contacts of the previous step; they only move within the lists. Keeps its memory between steps.
template <std::size_t lists>
class JobOutcomes {
 public:
  using Ranges = std::array<Range, lists>;

  /// Starts a step. `versions` are those of the objects' positions. The outcome of a job is known when both
  /// versions are those of the previous step and that step made the same search.
  void plan(std::span<const ContactJob> jobs, std::span<const std::uint64_t> versions, bool is_same_search) {
    // Nothing is known until this step is complete, also when memory runs out on the way.
    const std::size_t known = std::exchange(reusable_, 0);
    outcomes_.swap(last_outcomes_);
    // The two lists take turns; both grow at once.
    outcomes_.reserve(last_outcomes_.capacity());
    last_outcomes_.resize(is_same_search ? known : 0);
    outcomes_.clear();
    open_jobs_.clear();
    std::uint32_t last = 0;
    for (const ContactJob& job : jobs) {
      while (last < last_outcomes_.size() && last_outcomes_[last].job < job) ++last;
      Outcome outcome{job, {}, none, 0, 0};
      const bool was_tested = last < last_outcomes_.size() && last_outcomes_[last].job == job;
      if (was_tested && is_unmoved(job.a, versions) && is_unmoved(job.b, versions)) {
        outcome.known = last;
        for (std::size_t list = 0; list < lists; ++list)
          outcome.ranges[list].count = last_outcomes_[last].ranges[list].count;
      } else {
        open_jobs_.push_back(static_cast<std::uint32_t>(outcomes_.size()));
      }
      outcomes_.push_back(outcome);
    }
    last_versions_.assign(versions.begin(), versions.end());
  }
  /// Indices of the jobs whose outcome is not known, ascending.
  std::span<const std::uint32_t> open_jobs() const { return open_jobs_; }

  std::size_t size() const { return outcomes_.size(); }
  ContactJob job(std::size_t i) const { return outcomes_[i].job; }
  bool is_known(std::size_t i) const { return outcomes_[i].known != none; }
  const Ranges& ranges(std::size_t i) const { return outcomes_[i].ranges; }
  /// The ranges of a known job in the lists of the previous step.
  const Ranges& last_ranges(std::size_t i) const { return last_outcomes_[outcomes_[i].known].ranges; }

  /// The ranges that a task wrote in its worker's lists.
  struct TaskOutcome {
    std::uint32_t worker = 0;
    Ranges ranges;
  };
  void expect_tasks(std::size_t count) { task_outcomes_.resize(count); }
  TaskOutcome& of_task(std::size_t task) { return task_outcomes_[task]; }
  /// The ranges of a task, which then has none: another task of its job and its worker continues them.
  Ranges take(std::size_t task) { return std::exchange(task_outcomes_[task].ranges, Ranges{}); }
  std::span<const TaskOutcome> tasks_of(std::size_t i) const {
    return std::span(task_outcomes_).subspan(outcomes_[i].first_task, outcomes_[i].task_count);
  }

  /// Assigns each job its ranges of the lists, in the order of the jobs.
  void place(std::span<const ContactTask> tasks) {
    std::uint32_t task = 0;
    Ranges last{};
    for (std::uint32_t i = 0; i < outcomes_.size(); ++i) {
      Outcome& outcome = outcomes_[i];
      outcome.first_task = task;
      for (; task < tasks.size() && tasks[task].job == i; ++task) {
        for (std::size_t list = 0; list < lists; ++list)
          outcome.ranges[list].count += task_outcomes_[task].ranges[list].count;
      }
      outcome.task_count = task - outcome.first_task;
      for (std::size_t list = 0; list < lists; ++list) outcome.ranges[list].first = last[list].end();
      last = outcome.ranges;
    }
  }

  /// Moves the items of known jobs to their new ranges and resizes the list. Known jobs keep their order.
  /// Moving first those that go down, from the front, and then those that go up, from the back, overwrites
  /// nothing that is still needed.
  template <std::size_t list, class Item>
  void move_known(std::vector<Item>& items) const {
    static_assert(std::is_trivially_copyable_v<Item>);
    const std::size_t total = outcomes_.empty() ? 0 : outcomes_.back().ranges[list].end();
    if (items.size() < total) items.resize(total);
    const auto move = [&](std::size_t i, bool down) {
      if (!is_known(i)) return;
      const Range from = last_ranges(i)[list], to = ranges(i)[list];
      if (to.first == from.first || (to.first < from.first) != down) return;
      std::memmove(static_cast<void*>(items.data() + to.first), items.data() + from.first,
                   to.count * sizeof(Item));
    };
    for (std::size_t i = 0; i < outcomes_.size(); ++i) move(i, true);
    for (std::size_t i = outcomes_.size(); i-- > 0;) move(i, false);
    items.resize(total);
  }

  /// The lists are complete; the next step may reuse them.
  void complete() { reusable_ = outcomes_.size(); }
  /// Keeps the first `most` contacts. The next step does not reuse the job that is cut, nor any after it.
  void truncate(std::uint64_t most) {
    for (reusable_ = 0; outcomes_[reusable_].ranges[0].end() <= most;) ++reusable_;
    outcomes_.resize(reusable_ + 1);
    Range& contacts = outcomes_.back().ranges[0];
    contacts.count = static_cast<std::uint32_t>(most - contacts.first);
  }
  std::uint64_t contact_count() const { return outcomes_.empty() ? 0 : outcomes_.back().ranges[0].end(); }

  /// Lists the jobs that have contacts.
  template <class IdOf>
  void list_groups(std::vector<ContactGroup>& groups, const IdOf& id_of) const {
    groups.clear();
    for (const Outcome& outcome : outcomes_) {
      const Range contacts = outcome.ranges[0];
      if (contacts.count != 0)
        groups.push_back({id_of(outcome.job.a), id_of(outcome.job.b), contacts.first, contacts.count});
    }
  }

 private:
  static constexpr std::uint32_t none = ~std::uint32_t{0};
  struct Outcome {
    ContactJob job;
    Ranges ranges;
    std::uint32_t known = none;  // index into `last_outcomes_`
    std::uint32_t first_task = 0, task_count = 0;
  };

  bool is_unmoved(std::uint32_t slot, std::span<const std::uint64_t> versions) const {
    return slot < last_versions_.size() && last_versions_[slot] == versions[slot];
  }

  std::vector<Outcome> outcomes_, last_outcomes_;  // by job
  std::vector<std::uint64_t> last_versions_;       // by slot
  std::vector<std::uint32_t> open_jobs_;
  std::vector<TaskOutcome> task_outcomes_;
  std::size_t reusable_ = 0;  // how many outcomes the next step may reuse
};

}  // namespace supple
