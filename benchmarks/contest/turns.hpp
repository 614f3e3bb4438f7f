#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "contest/contestant.hpp"
#include "contest/output.hpp"
#include "supple/error.hpp"

namespace supple::benchmarks {

struct Choice {
  std::string cell;
  double seconds = 3;       ///< rounds start within this time, but there are at least three
  std::size_t rounds = 60;  ///< maximum
  int cpu = 0;              ///< the first CPU to pin threads to
  bool only_supple = false;
  std::string spoiled{};  ///< drops one pair of this contestant, to test the check
};

/// Contestants found different pairs.
struct Disagreement : Error {
  using Error::Error;
};

/// Pins the calling thread, and threads it starts, to `count` processors from `first` on.
void pin_to(int first, int count);
/// Throws `Disagreement` with the cell, both contestants and their results.
void check_equal(const std::string& cell, const Record& a, const Record& b);
std::string text_of(const PairDigest& pairs);
/// The value that the given part of all values does not exceed; 0.5 for the median.
double quantile(std::vector<double> values, double part);

/// Runs frames in turn. The contestant that starts changes from round to round.
template <class Workload, class AnyContestant>
class Turns {
 public:
  void add(std::string name, unsigned threads, std::unique_ptr<AnyContestant> contestant,
           const Workload& workload) {
    contestant->prepare(workload);
    contestants_.push_back(std::move(contestant));
    Record record;
    record.name = std::move(name);
    record.threads = threads;
    records_.push_back(std::move(record));
  }

  /// `advance` makes the next frame; `check` receives the contestants that ran in the round.
  template <class Advance, class Check>
  void run(const Choice& choice, const Workload& workload, Advance advance, Check check) {
    const double start = wall_milliseconds(), budget = 1e3 * choice.seconds;
    const std::size_t count = contestants_.size();
    std::vector<double> spent(count, 0);
    // A contestant that exceeds its share of the time runs only the first few frames.
    const auto has_share = [&](std::size_t i) {
      return records_[i].cpu.size() < fewest || spent[i] < budget / static_cast<double>(count);
    };
    for (std::size_t round = 0; round < warm_up + choice.rounds; ++round) {
      const bool is_measured = round >= warm_up;
      const bool is_late = wall_milliseconds() - start > 3 * budget;  // making the frames takes time too
      std::vector<std::size_t> running;
      for (std::size_t turn = 0; turn < count; ++turn) {
        const std::size_t i = (turn + round) % count;
        if (has_share(i) && !(is_late && records_[i].cpu.size() >= fewest)) running.push_back(i);
      }
      if (running.empty()) break;
      advance();
      for (const std::size_t i : running) spent[i] += time_frame(i, choice, workload, is_measured);
      check(running, contestants_, records_);
    }
  }
  std::vector<Record>& records() { return records_; }

 private:
  static constexpr std::size_t warm_up = 2, fewest = 3;

  double time_frame(std::size_t i, const Choice& choice, const Workload& workload, bool is_measured) {
    const double wall = wall_milliseconds(), cpu = cpu_milliseconds();
    contestants_[i]->frame(workload);
    const double cpu_spent = cpu_milliseconds() - cpu, wall_spent = wall_milliseconds() - wall;
    Record& record = records_[i];
    record.pairs = contestants_[i]->pairs();
    if (record.name == choice.spoiled) --record.pairs.count;
    if (is_measured) {
      if (record.cpu.empty()) record.first_pairs = record.pairs;
      record.cpu.push_back(cpu_spent);
      record.wall.push_back(wall_spent);
      add_stages(record, contestants_[i]->stages());
    }
    return wall_spent;
  }

  std::vector<std::unique_ptr<AnyContestant>> contestants_;
  std::vector<Record> records_;
};

/// Checks that all contestants of a round found the same pairs.
inline auto same_pairs(const std::string& cell) {
  return [cell](const std::vector<std::size_t>& ran, const auto&, const std::vector<Record>& records) {
    for (const std::size_t i : ran) check_equal(cell, records[ran.front()], records[i]);
  };
}

}  // namespace supple::benchmarks
