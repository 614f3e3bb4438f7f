// The main function of the targets where they are not linked with libFuzzer: it runs kept inputs, or random
// ones at the speed of a release build.
//
// usage: TARGET FILE-OR-FOLDER...          runs the inputs
//        TARGET --random SECONDS [SEED]    runs random inputs and prints how many

#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t most_random_bytes = 1024;

Bytes current;  // for `keep_input`

/// Keeps the input of a failed check, as libFuzzer does. The process is about to end anyway, so this handler
/// may call functions that are not safe in handlers.
void keep_input(int signal) {
  std::signal(signal, SIG_DFL);
  const fs::path path = "crash-" + std::to_string(std::random_device()());
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(current.data()), static_cast<std::streamsize>(current.size()));
  std::fprintf(stderr, "input: %s\n", path.c_str());
}

void run_input() {
  // A copy of exactly this size, so that sanitizers detect reads beyond its end.
  const Bytes exact(current.begin(), current.end());
  LLVMFuzzerTestOneInput(exact.data(), exact.size());
}

std::uint64_t run_file(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    std::fprintf(stderr, "%s: cannot be read\n", path.c_str());
    std::exit(2);
  }
  current.assign(std::istreambuf_iterator<char>(file), {});
  run_input();
  return 1;
}

std::uint64_t run_all(const fs::path& path) {
  if (!fs::is_directory(path)) return run_file(path);
  std::uint64_t count = 0;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(path)) {
    if (entry.is_regular_file()) count += run_file(entry.path());
  }
  return count;
}

std::uint64_t run_random(double seconds, std::uint64_t seed) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point end =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  std::mt19937_64 engine(seed);
  std::uint64_t count = 0;
  for (; count % 64 != 0 || Clock::now() < end; ++count) {
    current.resize(engine() % most_random_bytes);
    for (std::uint8_t& byte : current) byte = static_cast<std::uint8_t>(engine() >> 56);
    run_input();
  }
  return count;
}

}  // namespace

int main(int count, char** arguments) {
  std::signal(SIGABRT, keep_input);
  std::signal(SIGSEGV, keep_input);
  if (count < 2) {
    std::fprintf(stderr, "usage: %s FILE-OR-FOLDER... | --random SECONDS [SEED]\n", arguments[0]);
    return 2;
  }
  std::uint64_t executions = 0;
  if (std::string(arguments[1]) == "--random" && count > 2) {
    executions = run_random(std::atof(arguments[2]),
                            count > 3 ? std::strtoull(arguments[3], nullptr, 10) : std::random_device()());
  } else {
    for (int i = 1; i < count; ++i) executions += run_all(arguments[i]);
  }
  std::printf("%llu executions\n", static_cast<unsigned long long>(executions));
  return 0;
}
