#pragma once

#include <filesystem>
#include <initializer_list>
#include <span>
#include <string>

namespace supple::cli {

/// A file that an option names for output; an empty name is no file, and `-` is standard output.
struct OutputName {
  const char* option;
  std::string name;
};

/// Throws `Error` when an output is one of the inputs, or the output of two options.
void check_output_names(std::initializer_list<OutputName> outputs,
                        std::span<const std::filesystem::path> inputs);

}  // namespace supple::cli
