#pragma once

#include <functional>
#include <string>

namespace supple::cli {

/// Calls the body of `main` and returns its exit status. Sets the standard streams, the signals and HDF5 as
/// the programs need them, and reports an exception as one line on standard error.
int run_program(const std::function<int()>& run);
/// Replaces this process by another program, with these arguments: by that beside this program, else by that
/// in PATH. Returns when it is in neither.
void become_program(std::string name, char** arguments);

}  // namespace supple::cli
