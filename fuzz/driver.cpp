// The main function of the targets where they are not linked with libFuzzer: it runs kept inputs, or random
// ones at the speed of a release build.
//
// usage: TARGET FILE-OR-FOLDER...          runs the inputs
//        TARGET --random AMOUNT SEED [FILE-OR-FOLDER...]
//                                          runs random inputs, and these inputs with changes; prints how
//                                          many. AMOUNT is a number of inputs, or of seconds with an s: 60s.
//                                          Seed 0 is another one each time.

#include <algorithm>
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
#include <utility>
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

Bytes read_file(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    std::fprintf(stderr, "%s: cannot be read\n", path.c_str());
    std::exit(2);
  }
  return Bytes(std::istreambuf_iterator<char>(file), {});
}

/// The inputs of files and folders, in the order of their names.
std::vector<Bytes> read_all(char** paths, int count) {
  std::vector<Bytes> inputs;
  for (const fs::path& path : std::vector<fs::path>(paths, paths + count)) {
    std::vector<fs::path> files;
    if (fs::is_directory(path)) {
      for (const fs::directory_entry& entry : fs::recursive_directory_iterator(path)) {
        if (entry.is_regular_file()) files.push_back(entry.path());
      }
      std::sort(files.begin(), files.end());
    } else {
      files.push_back(path);
    }
    for (const fs::path& file : files) inputs.push_back(read_file(file));
  }
  return inputs;
}

class RandomInputs {
 public:
  RandomInputs(std::uint64_t seed, std::vector<Bytes> kept) : engine_(seed), kept_(std::move(kept)) {}

  Bytes next() {
    if (kept_.empty() || below(4) == 0) {
      Bytes bytes(below(most_random_bytes));
      for (std::uint8_t& byte : bytes) byte = random_byte();
      return bytes;
    }
    Bytes bytes = kept_[below(kept_.size())];
    for (std::size_t edits = 1 + below(4); edits > 0; --edits) change(bytes);
    return bytes;
  }

 private:
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(engine_() % count); }
  std::uint8_t random_byte() { return static_cast<std::uint8_t>(engine_() >> 56); }

  void change(Bytes& bytes) {
    const auto place = static_cast<std::ptrdiff_t>(below(bytes.size() + 1));
    const auto length = static_cast<std::ptrdiff_t>(
        std::min<std::size_t>(1 + below(16), bytes.size() - static_cast<std::size_t>(place)));
    switch (below(5)) {
      case 0:
        if (length > 0) bytes[static_cast<std::size_t>(place)] = random_byte();
        break;
      case 1:
        if (length > 0) bytes[static_cast<std::size_t>(place)] ^= static_cast<std::uint8_t>(1u << below(8));
        break;
      case 2:
        bytes.erase(bytes.begin() + place, bytes.begin() + place + length);
        break;
      case 3:
        bytes.insert(bytes.begin() + place, random_byte());
        break;
      default: {  // a part of another input
        const Bytes& other = kept_[below(kept_.size())];
        const std::size_t first = below(other.size() + 1);
        const std::size_t count = std::min(1 + below(32), other.size() - first);
        const auto from = other.begin() + static_cast<std::ptrdiff_t>(first);
        bytes.insert(bytes.begin() + place, from, from + static_cast<std::ptrdiff_t>(count));
      }
    }
  }

  std::mt19937_64 engine_;
  std::vector<Bytes> kept_;
};

std::uint64_t run_random(const std::string& amount, RandomInputs inputs) {
  using Clock = std::chrono::steady_clock;
  const double number = std::atof(amount.c_str());
  const bool is_time = amount.ends_with('s');
  const Clock::time_point end = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                                   std::chrono::duration<double>(is_time ? number : 0));
  std::uint64_t count = 0;
  while (is_time ? count % 16 != 0 || Clock::now() < end : static_cast<double>(count) < number) {
    current = inputs.next();
    run_input();
    ++count;
  }
  return count;
}

}  // namespace

int main(int count, char** arguments) {
  std::signal(SIGABRT, keep_input);
  std::signal(SIGSEGV, keep_input);
  const bool is_random = count > 3 && std::string(arguments[1]) == "--random";
  if (count < 2 || (!is_random && arguments[1][0] == '-')) {
    std::fprintf(stderr, "usage: %s FILE-OR-FOLDER... | --random AMOUNT SEED [FILE-OR-FOLDER...]\n",
                 arguments[0]);
    return 2;
  }
  std::uint64_t executions = 0;
  if (is_random) {
    const std::uint64_t seed = std::strtoull(arguments[3], nullptr, 10);
    executions = run_random(arguments[2],
                            {seed != 0 ? seed : std::random_device()(), read_all(arguments + 4, count - 4)});
  } else {
    for (Bytes& input : read_all(arguments + 1, count - 1)) {
      current = std::move(input);
      run_input();
      ++executions;
    }
  }
  std::printf("%llu executions\n", static_cast<unsigned long long>(executions));
  return 0;
}
