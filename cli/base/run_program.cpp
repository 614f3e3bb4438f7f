#include "base/run_program.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <hdf5.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <new>
#include <stdexcept>
#include <system_error>

#include "base/files.hpp"
#include "base/text.hpp"
#include "supple/comparison.hpp"
#include "supple/threads.hpp"
#include "supple/use_manifolds.hpp"

namespace supple::cli {
namespace {

/// Opens /dev/null in place of standard streams that the caller has closed. Otherwise the first files that
/// the program opens would be these streams, and messages would overwrite them.
void open_closed_streams() {
  for (const int stream : {0, 1, 2}) {
    if (fcntl(stream, F_GETFD) == -1 && open("/dev/null", O_RDWR) != stream) std::abort();
  }
}

/// For the time in which the input is read, and nothing was written yet: Interruption replaces it then.
extern "C" void end_at_signal(int signal) {
  std::_Exit(exit_interrupted + signal);
}

int report_lack_of_memory() {
  // Without a buffer, so that this needs no memory.
  std::fputs("supple: the memory is used up; give fewer or smaller meshes, or fewer --threads\n", stderr);
  return exit_unusable;
}

/// Libraries end the program where memory runs out in functions that must not throw. Then there is nothing to
/// clean up: recordings are valid at any moment.
[[noreturn]] void terminate() {
  try {
    if (const std::exception_ptr thrown = std::current_exception()) std::rethrow_exception(thrown);
  } catch (const std::bad_alloc&) {
    std::_Exit(report_lack_of_memory());
  } catch (const std::exception& error) {  // a fault of the program
    std::fprintf(stderr, "supple: %s\n", error.what());
  } catch (...) {
  }
  std::abort();
}

/// The number in a variable of the environment; -1 when there is none.
int number_of(const char* variable) {
  const char* const text = std::getenv(variable);
  if (text == nullptr || *text == '\0') return -1;
  char* end = nullptr;
  const long number = std::strtol(text, &end, 10);
  return *end == '\0' && number >= 0 && number <= 1 << 30 ? static_cast<int>(number) : -1;
}

}  // namespace

int run_program(const std::function<int()>& run) {
  open_closed_streams();
  use_comparison_methods();
  use_manifolds();
  std::set_terminate(terminate);
  // A limit of the file size (ulimit -f) is then an error of writing, as a full disk is.
  std::signal(SIGXFSZ, SIG_IGN);
  for (const int signal : {SIGINT, SIGTERM}) {
    if (std::signal(signal, end_at_signal) == SIG_IGN) std::signal(signal, SIG_IGN);
  }
  // The program closes all recordings before it exits. Without this call, HDF5 would report handles that a
  // damaged recording left open to standard error.
  H5dont_atexit();
  // HDF5 1.10 exits without a message when it gets no memory to start.
  static bool hdf5_has_started = false;
  std::atexit([] {
    if (!hdf5_has_started) std::_Exit(report_lack_of_memory());
  });
  // The program reports what fails; HDF5 must not print its own messages.
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  hdf5_has_started = true;
  try {
    const int exit_status = run();
    OutputFile("-").close();
    return exit_status;
  } catch (const std::bad_alloc&) {
    return report_lack_of_memory();
  } catch (const std::length_error&) {
    return report_lack_of_memory();  // an array that no memory can hold
  } catch (const std::filesystem::filesystem_error& error) {
    fmt::print(stderr, "supple: {}: {}; check the path and who may use it\n",
               one_line(error.path1().string()), error.code().message());
    return exit_unusable;
  } catch (const std::system_error& error) {
    const bool is_thread = error.code() == std::errc::resource_unavailable_try_again;
    fmt::print(stderr, "supple: {}\n",
               is_thread ? "the system refuses to create a thread; raise its limits (ulimit -u, ulimit -v)"
                         : one_line(error.what()));
    return exit_unusable;
  } catch (const std::exception& error) {
    fmt::print(stderr, "supple: {}\n", one_line(error.what()));
    return exit_unusable;
  }
}

void become_program(std::string name, char** arguments) {
  std::error_code unknown;
  const auto beside = std::filesystem::read_symlink("/proc/self/exe", unknown).replace_filename(name);
  arguments[0] = name.data();
  execv(beside.c_str(), arguments);
  execvp(name.c_str(), arguments);
}

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
  fail(
      "was started as {} processes, but the program supple-mpi is neither beside this program nor in PATH; "
      "build it with MPI and Zoltan, or start one process, without the launcher",
      process.size);
}

void warn_of_missing_threads(std::uint32_t threads) {
  warn_of_missing_threads(threads != 0 ? threads : usable_cores(), available_threads(threads));
}

void warn_of_missing_threads(std::uint32_t wanted, std::uint32_t available) {
  if (available >= wanted) return;
  fmt::print(
      stderr,
      "supple: warning: the system has too few processes or too little memory left for {} threads, so {} "
      "work; raise its limits (ulimit -u, ulimit -v), or give --threads {}\n",
      wanted, available, available);
}

}  // namespace supple::cli
