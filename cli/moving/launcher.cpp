#include "moving/launcher.hpp"

#include <fmt/core.h>

#include <cstdlib>

#include "base/exit_status.hpp"
#include "base/run_program.hpp"
#include "supple/error.hpp"

namespace supple::cli {
namespace {

/// The number in a variable of the environment; -1 when there is none.
int number_of(const char* variable) {
  const char* const text = std::getenv(variable);
  if (text == nullptr || *text == '\0') return -1;
  char* end = nullptr;
  const long number = std::strtol(text, &end, 10);
  return *end == '\0' && number >= 0 && number <= 1 << 30 ? static_cast<int>(number) : -1;
}

}  // namespace

LaunchedProcess launched_process() {
  struct Variables {
    const char *rank, *size;
  };
  // Open MPI; MPICH, Intel MPI and Slurm with PMI; Slurm with PMIx.
  for (const auto& [rank, size] :
       {Variables{"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"}, Variables{"PMI_RANK", "PMI_SIZE"},
        Variables{"PMIX_RANK", "SLURM_STEP_NUM_TASKS"}}) {
    const LaunchedProcess process{number_of(rank), number_of(size)};
    if (process.rank >= 0 && process.size > 1) return process;
  }
  return {};
}

void run_as_rank(const LaunchedProcess& process, char** arguments) {
  become_program("supple-mpi", arguments);
  // Rank 0 reports it. The launcher ends the job at the first status that is not 0.
  if (process.rank != 0) std::_Exit(exit_done);
  throw Error(fmt::format(
      "was started as {} processes, but the program supple-mpi is neither beside this program nor in PATH; "
      "build it with MPI and Zoltan, or start one process, without the launcher",
      process.size));
}

}  // namespace supple::cli
