#include "results.hpp"
#include "table1/table1_runs.hpp"

namespace supple::experiments {
bool run_table1(const Table1Options& options, const Request& request, bool resume,
                const cli::Interruption& interruption) {
  const auto run = [&](RunClock clock, double seconds, const char* name) {
    std::vector<Motion> motions;
    for (const Table1Scene& scene : options.scenes) {
      Motion& motion = motions.emplace_back(Motion{scene, {}, {}, seconds});
      for (const BoundingVolume volume : options.method.volumes)
        motion.variants.push_back({options.method, volume});
    }
    return run_all(motions,
                   {.folder = request.folder,
                    .name = name,
                    .resume = resume,
                    .clock = clock,
                    .runs = options.runs,
                    .seed = options.seed,
                    .exact = clock == RunClock::simulated,
                    .threads = options.threads},
                   interruption, request.show_progress);
  };
  if (options.simulated_seconds > 0 && !run(RunClock::simulated, options.simulated_seconds, "table1_runs"))
    return false;
  return !options.program_clock || run(RunClock::program, *options.program_clock, "table1_program_runs");
}

}  // namespace supple::experiments
