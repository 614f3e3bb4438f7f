#pragma once

#include <concepts>

#include "base/interruption.hpp"
#include "moving/ranks.hpp"
#include "options/options.hpp"

namespace supple::cli {

/// The options of this rank: only rank 0 writes reports and decides the exit status.
template <std::derived_from<DetectionOptions> Options>
Options options_of_rank(Options options, const Ranks& ranks) {
  if (ranks.rank() == 0) return options;
  options.quiet = true;
  options.fail_on_contact = false;
  options.json.clear();
  options.csv.clear();
  return options;
}

/// Whether a signal or the time limit has ended the run on any rank. All ranks then know the signal.
inline bool is_ended(Interruption& interruption, Ranks& ranks) {
  if (const int signal = ranks.largest(interruption.signal()); signal != 0) interruption.set_signal(signal);
  return ranks.largest(interruption.is_requested() ? 1 : 0) != 0;
}

}  // namespace supple::cli
