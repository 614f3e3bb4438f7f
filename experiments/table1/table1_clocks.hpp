#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "fit.hpp"
#include "table.hpp"
#include "table1/table1_runs.hpp"

namespace supple::experiments {

using Member = std::uint64_t RunCounts::*;
using Quantity = std::function<double(const RunCounts&)>;

Quantity number_of(Member member);

/// The runs of a scene with boxes and with spheres.
struct Both {
  const Runs* boxes;
  const Runs* spheres;
};

/// The scenes in their first size that ran with boxes and with spheres.
std::vector<Both> with_both(const std::vector<Runs>& all);

/// The collisions with spheres for each collision with boxes, over all runs, and its jackknife error: runs
/// are independent, and the same seed gives both volumes the same motion.
Estimate sphere_ratio(const std::vector<Both>& scenes, const Quantity& quantity);
Estimate sphere_ratio(const std::vector<Both>& scenes, Member member);

/// A clock: its column, the runs that it counts, and the collisions of a run in ten minutes of it; in
/// simulated time, those of the whole run.
struct ByClock {
  const char* name;
  const char* heading;
  const std::vector<Runs>* runs;
  Quantity (*quantity)(Member member);
};

/// In simulated time, by the clock of the detection, and by that of the program: from the runs by steps, the
/// last from its own runs where there are some.
std::array<ByClock, 3> by_clocks(const std::vector<Runs>& steps, const std::vector<Runs>& program);

/// Collisions in ten minutes by each clock, and those of the paper.
Table rates_table(const std::vector<Runs>& steps, const std::vector<Runs>& program);
/// The ratio of spheres to boxes by each clock, and that of the paper, for each scene that ran with both.
Table clocks_table(const std::vector<Runs>& steps, const std::vector<Runs>& program);

}  // namespace supple::experiments
