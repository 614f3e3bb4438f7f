// Counts the calls of MPI in a program, also those by libraries such as Zoltan, and the processor time in
// them: ranks spin while they wait. Include it in one source of the program.
#pragma once

#include <mpi.h>
#include <time.h>

#include <cstdint>

namespace supple {

/// What this rank called.
struct MpiCalls {
  std::uint64_t collectives = 0, sends = 0;
  double cpu_seconds = 0;
};
inline MpiCalls mpi_calls;

/// The processor time that this thread has used.
inline double cpu_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

template <class Call>
int counted(bool is_collective, bool is_send, const Call& call) {
  const double begin = cpu_seconds();
  const int status = call();
  mpi_calls.cpu_seconds += cpu_seconds() - begin;
  mpi_calls.collectives += is_collective ? 1 : 0;
  mpi_calls.sends += is_send ? 1 : 0;
  return status;
}

}  // namespace supple

// clang-format off
#define SUPPLE_COUNT(name, is_collective, is_send, parameters, arguments) \
  extern "C" int MPI_##name parameters { \
    return supple::counted(is_collective, is_send, [&] { return PMPI_##name arguments; }); \
  }
SUPPLE_COUNT(Allreduce, true, false, (const void* s, void* r, int n, MPI_Datatype t, MPI_Op o, MPI_Comm c), (s, r, n, t, o, c))
SUPPLE_COUNT(Reduce, true, false, (const void* s, void* r, int n, MPI_Datatype t, MPI_Op o, int root, MPI_Comm c), (s, r, n, t, o, root, c))
SUPPLE_COUNT(Scatter, true, false, (const void* s, int n, MPI_Datatype t, void* r, int m, MPI_Datatype u, int root, MPI_Comm c), (s, n, t, r, m, u, root, c))
SUPPLE_COUNT(Bcast, true, false, (void* b, int n, MPI_Datatype t, int root, MPI_Comm c), (b, n, t, root, c))
SUPPLE_COUNT(Reduce_scatter, true, false, (const void* s, void* r, const int* n, MPI_Datatype t, MPI_Op o, MPI_Comm c), (s, r, n, t, o, c))
SUPPLE_COUNT(Barrier, true, false, (MPI_Comm c), (c))
SUPPLE_COUNT(Send, false, true, (const void* b, int n, MPI_Datatype t, int to, int tag, MPI_Comm c), (b, n, t, to, tag, c))
SUPPLE_COUNT(Rsend, false, true, (const void* b, int n, MPI_Datatype t, int to, int tag, MPI_Comm c), (b, n, t, to, tag, c))
SUPPLE_COUNT(Isend, false, true, (const void* b, int n, MPI_Datatype t, int to, int tag, MPI_Comm c, MPI_Request* r), (b, n, t, to, tag, c, r))
SUPPLE_COUNT(Recv, false, false, (void* b, int n, MPI_Datatype t, int from, int tag, MPI_Comm c, MPI_Status* s), (b, n, t, from, tag, c, s))
SUPPLE_COUNT(Wait, false, false, (MPI_Request* r, MPI_Status* s), (r, s))
SUPPLE_COUNT(Waitany, false, false, (int n, MPI_Request* r, int* i, MPI_Status* s), (n, r, i, s))
SUPPLE_COUNT(Waitall, false, false, (int n, MPI_Request* r, MPI_Status* s), (n, r, s))
#undef SUPPLE_COUNT
// clang-format on
