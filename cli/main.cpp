#include <fmt/core.h>

#include <cstdio>
#include <exception>

#include "detect.hpp"
#include "exit_status.hpp"
#include "info.hpp"
#include "options.hpp"
#include "supple/error.hpp"
#include "text.hpp"

int main(int argument_count, char** arguments) {
  using namespace supple::cli;
  try {
    const CommandLine line = parse_command_line(argument_count, arguments);
    switch (line.command) {
      case CommandLine::Command::detect:
        return run_detect(line.detect);
      case CommandLine::Command::info:
        return run_info(line.info);
      case CommandLine::Command::exit:
        return line.exit_status;
    }
  } catch (const std::exception& error) {
    fmt::print(stderr, "supple: {}\n", one_line(error.what()));
    return exit_unusable;
  }
}
