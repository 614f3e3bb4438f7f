#pragma once

#include <string>

#include "inputs.hpp"

namespace supple::cli {

/// Told by the extension: .h5 or .hdf5.
bool is_recording(const std::string& name);

/// The objects of a recording with their options, in its order, where its first frame has them. Throws
/// `Error` when it cannot be read or has no frame.
Input read_recording(const std::string& name);

}  // namespace supple::cli
