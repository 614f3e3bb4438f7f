#pragma once

#include <functional>
#include <memory>

#include "base/interruption.hpp"
#include "moving/moving_objects.hpp"

namespace supple::cli {

struct DetectionOptions;
struct Input;

/// The processes of a run. This class is the only one; `MpiRanks` is one of several. All ranks make the calls
/// that are not const in the same order. Rank 0 writes what users read.
class Ranks {
 public:
  Ranks() = default;
  virtual ~Ranks() = default;
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  virtual int rank() const { return 0; }
  virtual int size() const { return 1; }
  /// Does the work on each rank. When it throws on one of them, the call throws on all of them.
  virtual void together(const std::function<void()>& work) { work(); }
  /// Does the work on the other ranks, then on rank 0, which finds it done.
  void others_first(const std::function<void()>& work) {
    together([&] {
      if (rank() != 0) work();
    });
    together([&] {
      if (rank() == 0) work();
    });
  }
  /// The largest of the numbers of all ranks.
  virtual int largest(int number) { return number; }
  /// Throws `Error` when several ranks cannot do what the options or the input want.
  virtual void check(const DetectionOptions&, const Input&) {}
  /// Ranks other than 0 lose the meshes of the input. `records` says that a recording needs those of objects
  /// that the rank moves.
  virtual std::unique_ptr<MovingObjects> move(Input& input, [[maybe_unused]] bool records) {
    return std::make_unique<MovingObjects>(input);
  }
};

/// The options of this rank: only rank 0 writes reports and decides the exit status.
template <class Options>
Options options_of_rank(Options options, const Ranks& ranks) {
  if (ranks.rank() == 0) return options;
  options.quiet = true;
  options.fail_on_contact = false;
  options.json.clear();
  options.csv.clear();
  return options;
}

/// All ranks then know the signal that one of them has received.
inline void share_signal(Interruption& interruption, Ranks& ranks) {
  if (const int signal = ranks.largest(interruption.signal()); signal != 0) interruption.set_signal(signal);
}

/// Whether a signal or the time limit has ended the run on any rank.
inline bool is_ended(const Interruption& interruption, Ranks& ranks) {
  return ranks.largest(interruption.is_requested() ? 1 : 0) != 0;
}

}  // namespace supple::cli
