#pragma once

#include <string>

#include "inputs.hpp"

namespace supple::cli {

/// Told by the extension: .h5 or .hdf5.
bool is_recording(const std::string& name);

/// The objects of a recording with their options, in its order. Throws `Error` when it cannot be read.
Input read_recording(const std::string& name);

/// Where a recorded object is in a frame.
std::vector<Vec3d> recorded_positions(const Input& input, std::size_t object, std::uint64_t frame);

/// How often a recording is detected on: for each frame, or from each frame to the next. Throws `Error` when
/// it has too few frames.
std::uint64_t count_recorded_steps(const Input& input, ContactMode contacts);

}  // namespace supple::cli
