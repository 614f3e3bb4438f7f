#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace supple::cli {

/// Scripts rely on these values.
enum ExitStatus : int {
  exit_done = 0,
  exit_contact = 1,  ///< --fail-on-contact, and something touches
  exit_differ = 1,   ///< supple diff found a difference
  exit_unusable =
      2,  ///< usage or input error, reported in one line on standard error; a motion that blew up; or
          ///< --fail-on-contact, and nothing was tested
  exit_differences = 3,    ///< --verify found a difference, or an answer of a query is false
  exit_interrupted = 128,  ///< plus the number of the signal that ended a run early
};

/// Calls the body of `main` and returns its exit status. Sets the standard streams, the signals and HDF5 as
/// the programs need them, and reports an exception as one line on standard error.
int run_program(const std::function<int()>& run);
/// Replaces this process by another program, with these arguments: by that beside this program, else by that
/// in PATH. Returns when it is in neither.
void become_program(std::string name, char** arguments);

/// What a launcher such as mpirun or srun has said in the environment.
struct LaunchedProcess {
  int rank = 0, size = 1;
};

/// One process without a launcher of MPI.
LaunchedProcess launched_process();

/// Replaces this process by the program `supple-mpi`, which is beside this program or in PATH. Throws `Error`
/// when it is in neither.
[[noreturn]] void run_as_rank(const LaunchedProcess& process, char** arguments);

/// Warns on standard error when fewer than `threads` threads work, because the system refuses to create them.
void warn_of_missing_threads(std::uint32_t threads);
/// The same when it is known how many there are.
void warn_of_missing_threads(std::uint32_t wanted, std::uint32_t available);

}  // namespace supple::cli
