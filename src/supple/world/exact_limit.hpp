#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>

#include "geometry/numbers/bit_extent.hpp"
#include "supple/types.hpp"

namespace supple {

class World;
struct ContactJob;

/// The bits of numbered points, and which of them are the finest and the largest.
class CoordinateBits {
 public:
  static constexpr std::uint32_t no_point = 0xffffffff;

  /// Messages call a point `kind`, its number and `owner`, and the number that belongs to no point `other`.
  CoordinateBits(const char* kind, std::string owner, const char* other = "")
      : kind_(kind), owner_(std::move(owner)), other_(other) {}

  /// Numbers that are not finite do not count. The smallest number counts among equals, so that the names do
  /// not depend on the order of the points.
  void add(const Vec3d& p, std::uint32_t number);

  const BitExtent& extent() const { return extent_; }
  std::string finest() const { return name(finest_); }
  std::string largest() const { return name(largest_); }

 private:
  std::string name(std::uint32_t number) const {
    return (number == no_point ? other_ : kind_ + ' ' + std::to_string(number)) + owner_;
  }

  std::string kind_, owner_, other_;
  BitExtent extent_;
  std::uint32_t finest_ = no_point, largest_ = no_point;
};

/// Throws an error when both have more than `most` bits together. It begins with `call`.
void check_exact_bits(const CoordinateBits& a, const CoordinateBits& b, std::uint32_t most,
                      const std::string& call);

/// Whether `SceneOptions::max_exact_bits` limits anything.
bool has_exact_limit(const World& world);

// These throw an error when two objects, or the numbers of queries and an object, have more bits together
// than `SceneOptions::max_exact_bits`. O(n) for each object, nothing without a limit.

void check_exact_bits_of_jobs(const World& world, std::span<const ContactJob> jobs, bool with_margins);
/// The error names `call`.
void check_exact_bits_of_pairs(const World& world, std::span<const ObjectPair> pairs, const char* call);
void check_exact_bits_of_queries(const World& world, const CoordinateBits& queries, std::uint32_t slot,
                                 const char* call);

}  // namespace supple
