#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
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

/// The contacts that the jobs of a step found, as ranges of the lists of the result. `lists` is the number of
/// lists, for example contacts and points. Only jobs that found something have an outcome. When neither
/// object of a job has moved, the job reuses the contacts of the previous step; they only move within the
/// lists. Keeps its memory between steps.
template <std::size_t lists>
class JobOutcomes {
 public:
  using Ranges = std::array<Range, lists>;

  /// Starts a step with these jobs, ascending, and workers. `versions` are those of the objects' positions.
  /// The outcome of a job is known when both versions are those of the previous step and that step made the
  /// same search.
  void plan(std::span<const ContactJob> jobs, std::span<const std::uint64_t> versions, bool is_same_search,
            std::size_t worker_count) {
    // Nothing is known until this step is complete, also when memory runs out on the way.
    const std::size_t reusable = std::exchange(reusable_, 0);
    last_jobs_.resize(is_same_search ? reusable : 0);
    outcomes_.swap(last_outcomes_);
    outcomes_.clear();
    open_jobs_.clear();
    std::size_t last = 0;
    std::uint32_t known = 0;
    for (std::uint32_t job = 0; job < jobs.size(); ++job) {
      const auto [a, b] = jobs[job];
      while (last < last_jobs_.size() && last_jobs_[last] < jobs[job]) ++last;
      const bool was_tested = last < last_jobs_.size() && last_jobs_[last] == jobs[job];
      if (!was_tested || !is_unmoved(a, versions) || !is_unmoved(b, versions)) {
        open_jobs_.push_back(job);
        continue;
      }
      while (known < last_outcomes_.size() && last_outcomes_[known].job < last) ++known;
      if (known == last_outcomes_.size() || last_outcomes_[known].job != last) continue;
      Outcome& outcome = outcomes_.emplace_back(Outcome{job, known, 0, 0, last_outcomes_[known].ranges});
      for (Range& range : outcome.ranges) range.first = 0;
    }
    last_jobs_.assign(jobs.begin(), jobs.end());
    last_versions_.assign(versions.begin(), versions.end());
    expect_tasks(worker_count);
  }
  /// Indices of the jobs whose outcome is not known, ascending.
  std::span<const std::uint32_t> open_jobs() const { return open_jobs_; }

  /// The ranges that a task of a job wrote in its worker's lists.
  struct TaskOutcome {
    std::uint32_t job = 0, task = 0, worker = 0;
    Ranges ranges;
  };
  /// Forgets what tasks added.
  void expect_tasks(std::size_t worker_count) {
    of_workers_.resize(worker_count);
    for (std::vector<TaskOutcome>& added : of_workers_) added.clear();
  }
  /// Each worker may add at the same time.
  void add(const TaskOutcome& found) {
    const auto has_some = [](const Range& range) { return range.count != 0; };
    if (std::ranges::any_of(found.ranges, has_some)) of_workers_[found.worker].push_back(found);
  }
  /// Takes back what the worker added last, if a task of this job did: another one continues its ranges.
  std::optional<Ranges> take(std::uint32_t job, std::uint32_t worker) {
    std::vector<TaskOutcome>& added = of_workers_[worker];
    if (added.empty() || added.back().job != job) return std::nullopt;
    const Ranges ranges = added.back().ranges;
    added.pop_back();
    return ranges;
  }

  /// Assigns all ranges of the lists, in the order of the jobs. Only then all outcomes are there.
  void place() {
    tasks_.clear();
    for (const std::vector<TaskOutcome>& added : of_workers_)
      tasks_.insert(tasks_.end(), added.begin(), added.end());
    std::ranges::sort(tasks_, {}, [](const TaskOutcome& found) { return std::pair(found.job, found.task); });
    for (std::uint32_t task = 0; task < tasks_.size();) {
      Outcome& outcome = outcomes_.emplace_back(Outcome{tasks_[task].job, none, task, 0, {}});
      for (; task < tasks_.size() && tasks_[task].job == outcome.job; ++task, ++outcome.task_count) {
        for (std::size_t list = 0; list < lists; ++list)
          outcome.ranges[list].count += tasks_[task].ranges[list].count;
      }
    }
    std::ranges::sort(outcomes_, {}, &Outcome::job);
    Ranges last{};
    for (Outcome& outcome : outcomes_) {
      for (std::size_t list = 0; list < lists; ++list) outcome.ranges[list].first = last[list].end();
      last = outcome.ranges;
    }
  }

  /// The outcomes, ascending by the index of their job.
  std::size_t size() const { return outcomes_.size(); }
  std::uint32_t job(std::size_t i) const { return outcomes_[i].job; }
  bool is_known(std::size_t i) const { return outcomes_[i].known != none; }
  const Ranges& ranges(std::size_t i) const { return outcomes_[i].ranges; }
  /// The ranges of a known outcome in the lists of the previous step.
  const Ranges& last_ranges(std::size_t i) const { return last_outcomes_[outcomes_[i].known].ranges; }
  std::span<const TaskOutcome> tasks_of(std::size_t i) const {
    return std::span(tasks_).subspan(outcomes_[i].first_task, outcomes_[i].task_count);
  }

  /// Moves the items of known outcomes to their new ranges and resizes the list. Known ones keep their order.
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
  void complete() { reusable_ = last_jobs_.size(); }
  /// Keeps the first `most` contacts. The next step does not reuse the job that is cut, nor any after it.
  void truncate(std::uint64_t most) {
    std::size_t cut = 0;
    while (outcomes_[cut].ranges[0].end() <= most) ++cut;
    outcomes_.resize(cut + 1);
    reusable_ = outcomes_[cut].job;
    Range& contacts = outcomes_[cut].ranges[0];
    contacts.count = static_cast<std::uint32_t>(most - contacts.first);
  }

  /// Lists the jobs that have contacts.
  template <class IdOf>
  void list_groups(std::vector<ContactGroup>& groups, const IdOf& id_of) const {
    groups.clear();
    for (const Outcome& outcome : outcomes_) {
      const Range contacts = outcome.ranges[0];
      const auto [a, b] = last_jobs_[outcome.job];
      if (contacts.count != 0) groups.push_back({id_of(a), id_of(b), contacts.first, contacts.count});
    }
  }

 private:
  static constexpr std::uint32_t none = ~std::uint32_t{0};
  struct Outcome {
    std::uint32_t job = 0;       // its index
    std::uint32_t known = none;  // index into `last_outcomes_`
    std::uint32_t first_task = 0, task_count = 0;
    Ranges ranges;
  };

  bool is_unmoved(std::uint32_t slot, std::span<const std::uint64_t> versions) const {
    return slot < last_versions_.size() && last_versions_[slot] == versions[slot];
  }

  std::vector<Outcome> outcomes_, last_outcomes_;
  std::vector<ContactJob> last_jobs_;         // of this step, for the next one
  std::vector<std::uint64_t> last_versions_;  // by slot
  std::vector<std::uint32_t> open_jobs_;
  std::vector<std::vector<TaskOutcome>> of_workers_;
  std::vector<TaskOutcome> tasks_;
  std::size_t reusable_ = 0;  // how many of the first jobs the next step may reuse
};

}  // namespace supple
