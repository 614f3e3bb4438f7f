#pragma once

#include <string>

#include "inputs/inputs.hpp"

namespace supple::cli {

/// True for the extensions .h5 and .hdf5.
bool is_recording(const std::string& name);

/// Reads the objects of a recording with their options, in the order of the recording, with the positions of
/// the first frame. Throws `Error` when it cannot be read or has no frame.
Input read_recording(const std::string& name);

}  // namespace supple::cli
