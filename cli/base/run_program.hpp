#pragma once

#include <functional>

namespace supple::cli {

/// Calls the body of `main` and returns its exit status. Sets the standard streams, the signals and HDF5 as
/// the programs need them, and reports an exception as one line on standard error.
int run_program(const std::function<int()>& run);

}  // namespace supple::cli
