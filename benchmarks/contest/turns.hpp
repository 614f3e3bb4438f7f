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
  double seconds = 3;       ///< that rounds begin in, at least three of them
  std::size_t rounds = 60;  ///< at most
  int cpu = 0;              ///< to which one thread is pinned
  bool only_supple = false;
  std::string spoiled{};  ///< contestant of whose pairs one is lost, to see that it is noticed
};

/// Wrong pairs, not wrong use.
struct Disagreement : Error {
  using Error::Error;
};

/// Keeps the calling thread, and those that it starts, on `count` processors from `first` on.
void pin_to(int first, int count);
/// Throws `Disagreement` that names the cell, both contestants and what they found.
void check_equal(const std::string& cell, const Record& a, const Record& b);
std::string text_of(const PairDigest& pairs);

/// Frames in turn: the first contestant first, in the next round the second, and so on round.
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

  /// `advance` makes the next frame; `check` sees each round's contestants that ran.
  template <class Advance, class Check>
  void run(const Choice& choice, const Workload& workload, Advance advance, Check check) {
    const double start = wall_milliseconds(), budget = 1e3 * choice.seconds;
    const std::size_t count = contestants_.size();
    std::vector<double> spent(count, 0);
    // Who takes more than its share of the time has only the first few frames.
    const auto has_share = [&](std::size_t i) {
      return records_[i].cpu.size() < fewest || spent[i] < budget / static_cast<double>(count);
    };
    for (std::size_t round = 0; round < warm_up + choice.rounds; ++round) {
      const bool is_measured = round >= warm_up;
      const bool is_late = wall_milliseconds() - start > 3 * budget;  // the frames take time to make, too
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

/// All that ran in a round found the same.
inline auto same_pairs(const std::string& cell) {
  return [cell](const std::vector<std::size_t>& ran, const auto&, const std::vector<Record>& records) {
    for (const std::size_t i : ran) check_equal(cell, records[ran.front()], records[i]);
  };
}

}  // namespace supple::benchmarks
