#pragma once

namespace supple::cli {

/// What a launcher such as mpirun or srun has said in the environment.
struct LaunchedProcess {
  int rank = 0, size = 1;
};

/// One process without a launcher of MPI.
LaunchedProcess launched_process();

/// Replaces this process by the program `supple-mpi`, which is beside this program or in PATH. Throws `Error`
/// when it is in neither.
[[noreturn]] void run_as_rank(const LaunchedProcess& process, char** arguments);

}  // namespace supple::cli
