#pragma once

#include <cstdint>

namespace supple {

constexpr std::uint64_t empty_hash = 0xcbf29ce484222325u;

/// Adds a word to a hash: FNV-1a over its bytes, low bytes first.
constexpr std::uint64_t hash_of_word(std::uint64_t word, std::uint64_t hash) {
  for (int byte = 0; byte < 8; ++byte) hash = (hash ^ (word >> (8 * byte) & 0xff)) * 0x100000001b3u;
  return hash;
}

/// A hash of results that have the same bits on every machine and with every compiler, standard library,
/// build type, number of threads and instruction set.
struct GoldenHash {
  const char* part;  ///< what the results are
  std::uint64_t (*compute)(std::uint32_t threads);
  std::uint64_t value;
};

}  // namespace supple
