#include "world/exact_limit.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "geometry/vector.hpp"
#include "world/world.hpp"

namespace supple {

void CoordinateBits::add(const Vec3d& p, std::uint32_t number) {
  if (!is_finite(p)) return;
  BitExtent extent;
  for (int axis = 0; axis < 3; ++axis) extent.include(p[axis]);
  if (std::pair(extent.bottom, number) < std::pair(extent_.bottom, finest_)) finest_ = number;
  if (std::pair(-extent.top, number) < std::pair(-extent_.top, largest_)) largest_ = number;
  extent_.bottom = std::min(extent_.bottom, extent.bottom);
  extent_.top = std::max(extent_.top, extent.top);
}

void check_exact_bits(const CoordinateBits& a, const CoordinateBits& b, std::uint32_t most,
                      const std::string& call) {
  const bool is_finest_of_a = a.extent().bottom <= b.extent().bottom;
  const bool is_largest_of_a = a.extent().top >= b.extent().top;
  const int bottom = std::min(a.extent().bottom, b.extent().bottom);
  const int top = std::max(a.extent().top, b.extent().top);
  if (top - bottom <= static_cast<int>(most)) return;
  fail(call + (is_largest_of_a ? a : b).largest() + " and " + (is_finest_of_a ? a : b).finest() +
       " have coordinates of " + std::to_string(top - bottom) + " bits together, but max_exact_bits is " +
       std::to_string(most) + "; raise it, or set coordinates below 2^" +
       std::to_string(top - static_cast<int>(most) + 52) + " to 0");
}

namespace {

/// O(n). Reads the finite vertices of triangles, and for `detect` those of edges and points.
CoordinateBits bits_of(const WorldObject& object, bool is_query) {
  CoordinateBits bits("vertex", " of " + object.options.name, "the margin");
  const std::size_t count = is_query ? object.face_count() : object.octree().triangles().size();
  for (std::uint32_t t = 0; t < count; ++t) {
    for (const std::uint32_t v : object.octree().user_triangle(t))
      bits.add(object.placement().position(v), v);
  }
  return bits;
}

/// The bits of objects, each computed once.
class BitsOfObjects {
 public:
  BitsOfObjects(const World& world, bool is_query, bool with_margins)
      : world_(world), bits_(world.slot_count()), is_query_(is_query), with_margins_(with_margins) {}

  const CoordinateBits& of(std::uint32_t slot) {
    std::optional<CoordinateBits>& bits = bits_[slot];
    if (bits) return *bits;
    bits = bits_of(world_[slot], is_query_);
    if (with_margins_) bits->add({world_[slot].options.margin, 0, 0}, CoordinateBits::no_point);
    return *bits;
  }

 private:
  const World& world_;
  std::vector<std::optional<CoordinateBits>> bits_;
  bool is_query_, with_margins_;
};

}  // namespace

bool has_exact_limit(const World& world) {
  return world.options.max_exact_bits < most_exact_bits;
}

void check_exact_bits_of_jobs(const World& world, std::span<const ContactJob> jobs, bool with_margins) {
  if (!has_exact_limit(world)) return;
  BitsOfObjects bits(world, false, with_margins);
  for (const ContactJob& job : jobs)
    check_exact_bits(bits.of(job.a), bits.of(job.b), world.options.max_exact_bits, "detect: ");
}

void check_exact_bits_of_pairs(const World& world, std::span<const ObjectPair> pairs, const char* call) {
  if (!has_exact_limit(world)) return;
  BitsOfObjects bits(world, true, false);
  for (const ObjectPair& pair : pairs) {
    const std::string with = std::string(call) + ": with " + world[pair.a.index].options.name + " and " +
                             world[pair.b.index].options.name + ", ";
    check_exact_bits(bits.of(pair.a.index), bits.of(pair.b.index), world.options.max_exact_bits, with);
  }
}

void check_exact_bits_of_queries(const World& world, const CoordinateBits& queries, std::uint32_t slot,
                                 const char* call) {
  const WorldObject& object = world[slot];
  check_exact_bits(queries, bits_of(object, true), world.options.max_exact_bits,
                   std::string(call) + ": with " + object.options.name + ", ");
}

}  // namespace supple
