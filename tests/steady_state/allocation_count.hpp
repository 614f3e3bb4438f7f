#pragma once

#include <cstddef>
#include <cstdint>

namespace supple {

/// The number of calls of any operator new in this program so far.
std::uint64_t allocation_count();
/// The number of allocations that have not been freed.
std::int64_t live_allocation_count();
/// After this call, operator new throws `std::bad_alloc` for this many bytes or more.
void refuse_allocations_from(std::size_t bytes);
/// The n-th allocation from now on throws `std::bad_alloc`, all others succeed; n <= 0: none throws.
void refuse_allocation(std::int64_t n);
/// From now on, no allocation throws. Returns n of `refuse_allocation` minus the allocations since then.
std::int64_t allow_allocations();

}  // namespace supple
