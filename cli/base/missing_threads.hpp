#pragma once

#include <cstdint>

namespace supple::cli {

/// Warns on standard error when fewer than `threads` threads work, because the system refuses to create them.
void warn_of_missing_threads(std::uint32_t threads);
/// The same when it is known how many there are.
void warn_of_missing_threads(std::uint32_t wanted, std::uint32_t available);

}  // namespace supple::cli
