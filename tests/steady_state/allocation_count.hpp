#pragma once

#include <cstdint>

namespace supple {

/// Calls of any operator new in this program so far.
std::uint64_t allocation_count();

}  // namespace supple
