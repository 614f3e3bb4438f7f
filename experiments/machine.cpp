#include "machine.hpp"

#include <fmt/chrono.h>
#include <fmt/core.h>

#include <ctime>
#include <fstream>
#include <thread>

#include "supple/utf8.hpp"
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

std::string command() {
  std::ifstream stream("/proc/self/cmdline");
  std::string text;
  std::getline(stream, text, '\0');  // the program
  text = "supple experiment";
  for (std::string word; std::getline(stream, word, '\0');) text += ' ' + word;
  return one_line(text);
}

}  // namespace

std::vector<std::pair<std::string, std::string>> describe_machine() {
#ifdef NDEBUG
  const char* const build = "optimised";
#else
  const char* const build = "with assertions: times mean little";
#endif
  return {{"date", fmt::format("{:%Y-%m-%d}", fmt::gmtime(std::time(nullptr)))},
          {"commit", commit()},
          {"processor", fmt::format("{}, {} cores", processor(), std::thread::hardware_concurrency())},
          {"compiler", fmt::format("{}, {}", compiler(), build)},
          {"program", "supple " SUPPLE_VERSION},
          {"command", command()}};
}

std::string csv_head() {
  std::string head;
  for (const auto& [name, value] : describe_machine()) head += fmt::format("# {}: {}\n", name, value);
  return head;
}

}  // namespace supple::experiments
