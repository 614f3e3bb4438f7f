#pragma once

#include <cstdint>

/// All golden hashes in one.
struct Results {
  std::uint64_t hash;
  std::uint64_t expected;
};

/// Computes every golden hash and prints those that differ.
Results compute_golden_hashes();
