#pragma once

#include <cstddef>
#include <cstdint>

namespace supple {

/// Calls of any operator new in this program so far.
std::uint64_t allocation_count();
/// From now on any operator new throws `std::bad_alloc` for so many bytes and more.
void refuse_allocations_from(std::size_t bytes);

}  // namespace supple
