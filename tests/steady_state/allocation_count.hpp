#pragma once

#include <cstddef>
#include <cstdint>

namespace supple {

/// The number of calls of any operator new in this program so far.
std::uint64_t allocation_count();
/// After this call, operator new throws `std::bad_alloc` for this many bytes or more.
void refuse_allocations_from(std::size_t bytes);

}  // namespace supple
