// Calls of MPI that are late, or kill their rank: SUPPLE_DELAY=N makes one of N calls sleep for a while, and
// SUPPLE_KILL=RANK:CALL kills this rank at this call. The program and Zoltan call these functions.

#include <mpi.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

namespace {

int rank_of_process() {
  int rank = 0;
  PMPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank;
}

void before_call() {
  static const char* const delay = std::getenv("SUPPLE_DELAY");
  static const char* const kill = std::getenv("SUPPLE_KILL");
  static std::uint64_t calls = 0;
  ++calls;
  if (delay != nullptr) {
    const std::uint64_t number =
        calls * 0x9e3779b97f4a7c15u + static_cast<std::uint64_t>(rank_of_process()) * 77;
    if ((number >> 33) % static_cast<std::uint64_t>(std::atoi(delay)) == 0)
      usleep(static_cast<useconds_t>((number >> 40) % 5000));
  }
  int rank = 0;
  unsigned long long call = 0;
  if (kill != nullptr && std::sscanf(kill, "%d:%llu", &rank, &call) == 2 && call == calls &&
      rank == rank_of_process())
    std::raise(SIGKILL);
}

}  // namespace

extern "C" {

int MPI_Allreduce(const void* from, void* to, int count, MPI_Datatype type, MPI_Op op, MPI_Comm ranks) {
  before_call();
  return PMPI_Allreduce(from, to, count, type, op, ranks);
}
int MPI_Bcast(void* data, int count, MPI_Datatype type, int root, MPI_Comm ranks) {
  before_call();
  return PMPI_Bcast(data, count, type, root, ranks);
}
int MPI_Send(const void* data, int count, MPI_Datatype type, int to, int tag, MPI_Comm ranks) {
  before_call();
  return PMPI_Send(data, count, type, to, tag, ranks);
}
int MPI_Rsend(const void* data, int count, MPI_Datatype type, int to, int tag, MPI_Comm ranks) {
  before_call();
  return PMPI_Rsend(data, count, type, to, tag, ranks);
}
int MPI_Irecv(void* data, int count, MPI_Datatype type, int from, int tag, MPI_Comm ranks,
              MPI_Request* request) {
  before_call();
  return PMPI_Irecv(data, count, type, from, tag, ranks, request);
}

}  // extern "C"
