// The program of one rank. `supple` becomes this program when a launcher of MPI starts it.

#include <fmt/core.h>
#include <mpi.h>

#include <cstdio>
#include <exception>

#include "base/run_program.hpp"
#include "base/text.hpp"
#include "commands/commands.hpp"
#include "mpi_ranks.hpp"

namespace supple::cli {
namespace {

/// Runs the command on all ranks. Only rank 0 has an exit status other than 0.
int run_command(int argument_count, char** arguments, MpiRanks& ranks) {
  CommandLine line;
  const auto parse = [&] { line = parse_command_line(argument_count, arguments); };
  // Rank 0 prints help and usage errors.
  ranks.together([&] {
    if (ranks.rank() == 0) parse();
  });
  const bool has_command = ranks.rank() != 0 || line.command != CommandLine::Command::exit;
  if (ranks.largest(has_command ? 0 : 1) != 0) return line.exit_status;
  ranks.together([&] {
    if (ranks.rank() != 0) parse();
    if (line.command != CommandLine::Command::detect && line.command != CommandLine::Command::simulate)
      fail("only detect and simulate run on several ranks; start one process, without the launcher");
  });
  const int status = line.command == CommandLine::Command::detect ? run_detect(line.detect, ranks)
                                                                  : run_simulate(line.simulate, ranks);
  return ranks.rank() == 0 ? status : exit_done;
}

/// Returns when all ranks do. An exception that the others do not know of ends the job.
int run_on_ranks(int argument_count, char** arguments) {
  const int wanted = launched_process().size;
  int provided = 0;
  MPI_Init_thread(&argument_count, &arguments, MPI_THREAD_FUNNELED, &provided);
  MpiRanks ranks;
  int status = exit_done;
  std::exception_ptr thrown;
  try {
    if (ranks.size() != wanted)
      fail(
          "the launcher started {} processes, but MPI has {}; use the launcher of the MPI "
          "that this program was built with",
          wanted, ranks.size());
    status = run_command(argument_count, arguments, ranks);
  } catch (const EndedByAll&) {
  } catch (const std::exception& error) {
    thrown = std::current_exception();
    if (!ranks.has_ended()) {
      fmt::print(stderr, "supple: rank {}: {}\n", ranks.rank(), one_line(error.what()));
      std::fflush(nullptr);
      MPI_Abort(MPI_COMM_WORLD, exit_unusable);
    }
  }
  std::fflush(nullptr);
  MPI_Finalize();
  if (thrown) std::rethrow_exception(thrown);
  return status;
}

}  // namespace
}  // namespace supple::cli

int main(int argument_count, char** arguments) {
  return supple::cli::run_program([&] { return supple::cli::run_on_ranks(argument_count, arguments); });
}
