// Makes the system fail under a program that is started with LD_PRELOAD. Environment variables choose the
// fault; N counts from 1 and from the start of `main`:
//
//   FAULT_KILL_AT_WRITE=N    the N-th write kills the program before it writes anything
//   FAULT_TEAR_AT_WRITE=N    the same after half of the bytes
//   FAULT_DISK_BYTES=N       regular files grow by N bytes in all, then the disk is full (ENOSPC)
//   FAULT_ERROR_AT_WRITE=N   from the N-th write to a regular file on, writes fail (EIO)
//   FAULT_ALLOCATION=N       the N-th allocation fails
//   FAULT_ALLOCATIONS_FROM=N the N-th allocation and all later ones fail
//   FAULT_HDF5=1             allocations of HDF5 count and fail, too
//   FAULT_HDF5_CRASH=N       a crash within HDF5, or its exit, exits with status N
//   FAULT_CLOCK=MODE         clocks go forward by hours, backward by hours, both in turns (jump), or stop
//   FAULT_COUNTS=FILE        at exit, writes the numbers of writes and of allocations to this file
//
// A seccomp filter turns writes into signals, so that those of the C library are seen, too.

#include <dlfcn.h>
#include <execinfo.h>
#include <fcntl.h>
#include <link.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <iterator>

// The allocator of glibc under its own names.
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
}

namespace {

constexpr long never = -1;

struct Faults {
  long kill_at = never, tear_at = never, disk_bytes = never, error_at = never;
  long allocation = never, allocations_from = never;
  char clock = 0;
};

Faults faults;
std::atomic<bool> is_active = false;
std::atomic<long> writes = 0, file_writes = 0, allocations = 0, clock_calls = 0;
std::atomic<long> bytes_left = 0;

long number_of(const char* variable) {
  const char* const text = std::getenv(variable);
  return text != nullptr ? std::atol(text) : never;
}

/// The code of HDF5.
struct Code {
  std::uintptr_t begin = 0, end = 0;
  bool contains(const void* place) const {
    const auto address = reinterpret_cast<std::uintptr_t>(place);
    return address >= begin && address < end;
  }
};
Code hdf5;
bool hdf5_is_spared = true;

int find_hdf5(dl_phdr_info* library, std::size_t, void*) {
  if (std::strstr(library->dlpi_name, "libhdf5") == nullptr) return 0;
  for (int i = 0; i < library->dlpi_phnum; ++i) {
    const auto& part = library->dlpi_phdr[i];
    if (part.p_type != PT_LOAD || (part.p_flags & PF_X) == 0) continue;
    hdf5.begin = library->dlpi_addr + part.p_vaddr;
    hdf5.end = hdf5.begin + part.p_memsz;
    return 1;
  }
  return 0;
}

bool is_refused(const void* caller) {
  if (!is_active.load(std::memory_order_relaxed)) return false;
  if (hdf5_is_spared && hdf5.contains(caller)) return false;
  const long n = ++allocations;
  return n == faults.allocation || (faults.allocations_from != never && n >= faults.allocations_from);
}

// Writes. The filter lets a call pass whose sixth argument, which writes do not use, is this number.
constexpr std::uint32_t own_call = 0x5a17f00d;

long write_now(long number, const long* arguments) {
  const long written = syscall(number, arguments[0], arguments[1], arguments[2], arguments[3], 0L, own_call);
  return written < 0 ? -errno : written;
}

/// The bytes of a call to write, pwrite64 or writev.
long size_of(long number, const long* arguments) {
  if (number != SYS_writev) return arguments[2];
  long size = 0;
  const auto* const parts = reinterpret_cast<const iovec*>(arguments[1]);
  for (long i = 0; i < arguments[2]; ++i) size += static_cast<long>(parts[i].iov_len);
  return size;
}

/// Writes at most this many bytes of the call.
long write_part(long number, const long* arguments, long most) {
  if (number != SYS_writev) {
    const long part[] = {arguments[0], arguments[1], std::min(arguments[2], most), arguments[3]};
    return write_now(number, part);
  }
  const auto* const parts = reinterpret_cast<const iovec*>(arguments[1]);
  long i = 0;
  while (i + 1 < arguments[2] && parts[i].iov_len == 0) ++i;
  const long part[] = {arguments[0], reinterpret_cast<long>(parts[i].iov_base),
                       std::min(static_cast<long>(parts[i].iov_len), most), 0};
  return write_now(SYS_write, part);
}

/// By how many bytes the call makes the file longer.
long growth_of(long number, const long* arguments, const struct stat& file) {
  const int descriptor = static_cast<int>(arguments[0]);
  const bool appends = (fcntl(descriptor, F_GETFL) & O_APPEND) != 0;
  const long place = number == SYS_pwrite64 ? arguments[3]
                     : appends              ? file.st_size
                                            : lseek(descriptor, 0, SEEK_CUR);
  return std::max(0L, place + size_of(number, arguments) - file.st_size);
}

long write_with_faults(long number, const long* arguments) {
  const long n = ++writes;
  if (n == faults.tear_at) write_part(number, arguments, size_of(number, arguments) / 2);
  if (n == faults.kill_at || n == faults.tear_at) kill(getpid(), SIGKILL);
  struct stat file {};
  if (fstat(static_cast<int>(arguments[0]), &file) != 0 || !S_ISREG(file.st_mode))
    return write_now(number, arguments);
  if (faults.error_at != never && ++file_writes >= faults.error_at) return -EIO;
  if (faults.disk_bytes == never) return write_now(number, arguments);
  const long growth = growth_of(number, arguments, file);
  const long missing = growth - bytes_left;
  if (missing <= 0) {
    bytes_left -= growth;
    return write_now(number, arguments);
  }
  bytes_left -= std::min(growth, bytes_left.load());
  const long fitting = size_of(number, arguments) - missing;
  return fitting > 0 ? write_part(number, arguments, fitting) : -ENOSPC;
}

void on_write(int, siginfo_t* info, void* context) {
  const int error = errno;
  auto& machine = static_cast<ucontext_t*>(context)->uc_mcontext;
#if defined(__x86_64__)
  const long arguments[] = {machine.gregs[REG_RDI], machine.gregs[REG_RSI], machine.gregs[REG_RDX],
                            machine.gregs[REG_R10]};
  machine.gregs[REG_RAX] = write_with_faults(info->si_syscall, arguments);
#elif defined(__aarch64__)
  long arguments[4];
  for (int i = 0; i < 4; ++i) arguments[i] = static_cast<long>(machine.regs[i]);
  machine.regs[0] = static_cast<std::uint64_t>(write_with_faults(info->si_syscall, arguments));
#else
#error "add the registers of this machine"
#endif
  errno = error;
}

void watch_writes() {
  struct sigaction action {};
  action.sa_sigaction = on_write;
  action.sa_flags = SA_SIGINFO | SA_NODEFER;
  sigaction(SIGSYS, &action, nullptr);
  constexpr auto argument = static_cast<std::uint32_t>(offsetof(seccomp_data, args[5]));
  constexpr auto number = static_cast<std::uint32_t>(offsetof(seccomp_data, nr));
  sock_filter program[] = {
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, argument),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, own_call, 4, 0),
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, number),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_write, 3, 0),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_pwrite64, 2, 0),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_writev, 1, 0),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_TRAP),
  };
  const sock_fprog filter{std::size(program), program};
  if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 || prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &filter) != 0)
    _exit(77);
}

/// HDF5 calls no functions of the program, so it is at fault when it is among the callers.
void on_crash(int signal) {
  void* callers[64];
  const int count = backtrace(callers, static_cast<int>(std::size(callers)));
  if (std::any_of(callers, callers + count, [](const void* caller) { return hdf5.contains(caller); }))
    _exit(static_cast<int>(number_of("FAULT_HDF5_CRASH")));
  std::signal(signal, SIG_DFL);
  raise(signal);
}

void watch_crashes() {
  void* first_call_allocates[1];
  backtrace(first_call_allocates, 1);
  for (const int signal : {SIGSEGV, SIGABRT}) std::signal(signal, on_crash);
}

void read_faults() {
  faults.kill_at = number_of("FAULT_KILL_AT_WRITE");
  faults.tear_at = number_of("FAULT_TEAR_AT_WRITE");
  faults.disk_bytes = number_of("FAULT_DISK_BYTES");
  faults.error_at = number_of("FAULT_ERROR_AT_WRITE");
  faults.allocation = number_of("FAULT_ALLOCATION");
  faults.allocations_from = number_of("FAULT_ALLOCATIONS_FROM");
  const char* const clock = std::getenv("FAULT_CLOCK");
  faults.clock = clock != nullptr ? clock[0] : '\0';
  dl_iterate_phdr(find_hdf5, nullptr);
  hdf5_is_spared = number_of("FAULT_HDF5") == never;
  bytes_left = std::max(0L, faults.disk_bytes);
}

const char* counts_file = nullptr;

void write_counts() {
  is_active = false;
  if (std::FILE* const file = std::fopen(counts_file, "w")) {
    std::fprintf(file, "%ld %ld\n", writes.load(), allocations.load());
    std::fclose(file);
  }
}

using Main = int (*)(int, char**, char**);
Main real_main = nullptr;

int main_with_faults(int count, char** arguments, char** environment) {
  read_faults();
  counts_file = std::getenv("FAULT_COUNTS");
  if (counts_file != nullptr) std::atexit(write_counts);
  const bool writes_fail = faults.kill_at != never || faults.tear_at != never || faults.disk_bytes != never ||
                           faults.error_at != never;
  if (number_of("FAULT_HDF5_CRASH") != never) watch_crashes();
  if (writes_fail || counts_file != nullptr) watch_writes();
  is_active = true;
  return real_main(count, arguments, environment);
}

/// The time with the fault, in seconds.
std::int64_t changed_seconds(std::int64_t seconds) {
  constexpr std::int64_t hour = 3600;
  if (!is_active) return seconds;
  const std::int64_t n = ++clock_calls;
  switch (faults.clock) {
    case 'f':
      return seconds + n * hour;
    case 'b':
      return seconds - n * hour;
    case 'j':
      return seconds + (n % 2 == 0 ? hour : -hour) * n;
    case 's':
      return 1000;
    default:
      return seconds;
  }
}

}  // namespace

extern "C" {

int __libc_start_main(Main main, int count, char** arguments, void (*init)(), void (*finish)(),
                      void (*loader)(), void* stack_end) {
  real_main = main;
  using Start = int (*)(Main, int, char**, void (*)(), void (*)(), void (*)(), void*);
  const auto start = reinterpret_cast<Start>(dlsym(RTLD_NEXT, "__libc_start_main"));
  return start(main_with_faults, count, arguments, init, finish, loader, stack_end);
}

/// HDF5 1.10 also ends the program where it gets no memory.
void exit(int status) {
  if (hdf5.contains(__builtin_return_address(0)) && number_of("FAULT_HDF5_CRASH") != never)
    _exit(static_cast<int>(number_of("FAULT_HDF5_CRASH")));
  using Exit = void (*)(int);
  reinterpret_cast<Exit>(dlsym(RTLD_NEXT, "exit"))(status);
  __builtin_unreachable();
}

void* malloc(std::size_t size) {
  if (!is_refused(__builtin_return_address(0))) return __libc_malloc(size);
  errno = ENOMEM;
  return nullptr;
}

void* calloc(std::size_t count, std::size_t size) {
  if (!is_refused(__builtin_return_address(0))) return __libc_calloc(count, size);
  errno = ENOMEM;
  return nullptr;
}

void* realloc(void* memory, std::size_t size) {
  if (!is_refused(__builtin_return_address(0))) return __libc_realloc(memory, size);
  errno = ENOMEM;
  return nullptr;
}

void* aligned_alloc(std::size_t alignment, std::size_t size) {
  if (!is_refused(__builtin_return_address(0))) return __libc_memalign(alignment, size);
  errno = ENOMEM;
  return nullptr;
}

// The C library would call malloc itself, so that the caller would be unknown.
char* strdup(const char* text) noexcept {
  const std::size_t size = std::strlen(text) + 1;
  void* const copy = is_refused(__builtin_return_address(0)) ? nullptr : __libc_malloc(size);
  return copy != nullptr ? static_cast<char*>(std::memcpy(copy, text, size)) : nullptr;
}

int posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
  if (is_refused(__builtin_return_address(0))) return ENOMEM;
  *memory = __libc_memalign(alignment, size);
  return *memory != nullptr ? 0 : ENOMEM;
}

int clock_gettime(clockid_t clock, timespec* time) noexcept {
  const long failed = syscall(SYS_clock_gettime, clock, time);
  if (failed != 0) return -1;
  time->tv_sec = changed_seconds(time->tv_sec);
  if (is_active && faults.clock == 's') time->tv_nsec = 0;
  return 0;
}

int gettimeofday(timeval* time, void*) noexcept {
  timespec now{};
  if (clock_gettime(CLOCK_REALTIME, &now) != 0) return -1;
  time->tv_sec = now.tv_sec;
  time->tv_usec = now.tv_nsec / 1000;
  return 0;
}

}  // extern "C"
