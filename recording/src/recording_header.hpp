#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include "hdf5/read.hpp"
#include "supple/recording.hpp"

namespace supple {

/// Returns the version of a recording. Throws `Error` when the file is none, or when this program does not
/// read its version.
std::uint32_t check_format(const InputFile& file);

/// `file_of` returns the file that has an object.
RecordingHeader read_header(const InputFile& file, std::uint32_t version,
                            const std::function<const InputFile&(std::size_t)>& file_of);

}  // namespace supple
