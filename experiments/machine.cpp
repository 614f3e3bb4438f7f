#include "machine.hpp"

#include <fmt/core.h>

#include <fstream>
#include <thread>

#include "supple/version.hpp"

namespace supple::experiments {
namespace {

std::string processor() {
  std::ifstream stream("/proc/cpuinfo");
  for (std::string line; std::getline(stream, line);) {
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  }
  return "unknown";
}

std::string compiler() {
#if defined(__clang__)
  return "clang " __clang_version__;
#elif defined(__GNUC__)
  return "g++ " __VERSION__;
#else
  return "unknown";
#endif
}

}  // namespace

std::vector<std::pair<std::string, std::string>> describe_machine() {
#ifdef NDEBUG
  const char* const build = "optimised";
#else
  const char* const build = "with assertions: times mean little";
#endif
  return {{"processor", fmt::format("{}, {} cores", processor(), std::thread::hardware_concurrency())},
          {"compiler", fmt::format("{}, {}", compiler(), build)},
          {"program", "supple " SUPPLE_VERSION}};
}

}  // namespace supple::experiments
