#pragma once

#include <bit>
#include <cstdint>
#include <string_view>

#include "supple/models.hpp"
#include "support/golden_hash.hpp"

namespace supple {

/// The hash of the positions and ids of a built-in model.
struct GoldenModel {
  std::string_view name;
  std::uint64_t value;
};
constexpr GoldenModel golden_models[] = {{"pawn", 0x239cfafbbb0b2a7d},
                                         {"fish", 0xc4d56cb5df82a39f},
                                         {"rabbit", 0xdf5934733addc20a},
                                         {"human", 0xea5bddb2a1be546e},
                                         {"bike", 0x3fb7469308da10ab}};

inline std::uint64_t hash_of(const TriangleMesh& mesh) {
  std::uint64_t hash = empty_hash;
  for (const Vec3d& p : mesh.positions) {
    for (int axis = 0; axis < 3; ++axis) hash = hash_of_word(std::bit_cast<std::uint64_t>(p[axis]), hash);
  }
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) hash = hash_of_word(v, hash);
  return hash;
}

inline std::uint64_t hash_of_all_models(std::uint32_t) {
  std::uint64_t hash = empty_hash;
  for (const GoldenModel& model : golden_models) hash = hash_of_word(hash_of(make_model(model.name)), hash);
  return hash;
}

constexpr std::uint64_t golden_hash_of_all_models() {
  std::uint64_t hash = empty_hash;
  for (const GoldenModel& model : golden_models) hash = hash_of_word(model.value, hash);
  return hash;
}

constexpr GoldenHash golden_model_hashes[] = {{"models", hash_of_all_models, golden_hash_of_all_models()}};

}  // namespace supple
