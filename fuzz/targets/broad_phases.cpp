// All broad phases against a double loop, over several steps of boxes or spheres with kinds and dirty lists.

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <memory>
#include <vector>

#include "geometry/aabb.hpp"
#include "geometry/sphere.hpp"
#include "supple/broad_phase.hpp"
#include "support/byte_reader.hpp"
#include "support/check.hpp"

namespace {

using namespace supple;
using fuzz::check;

constexpr std::array all_methods{BroadPhaseMethod::automatic, BroadPhaseMethod::octree,
                                 BroadPhaseMethod::grid,      BroadPhaseMethod::sweep,
                                 BroadPhaseMethod::brute,     BroadPhaseMethod::sweep3};
constexpr std::size_t most_volumes = 100;
constexpr int most_steps = 12;

float number(fuzz::ByteReader& bytes) {
  const std::uint8_t kind = bytes.byte();
  if (kind < 100) return static_cast<float>(kind % 10);
  if (kind < 230) return static_cast<float>(bytes.byte()) / 16;
  return std::bit_cast<float>(static_cast<std::uint32_t>(bytes.bits(4)));
}
Vec3f point(fuzz::ByteReader& bytes) {
  const float x = number(bytes), y = number(bytes);
  return {x, y, number(bytes)};
}

void change(fuzz::ByteReader& bytes, Aabb& box) {
  box.min = point(bytes);
  box.max = bytes.below(16) == 0 ? point(bytes) : box.min + Vec3f{1, 1, 1} * (number(bytes) / 4);
}
void change(fuzz::ByteReader& bytes, BoundingSphere& sphere) {
  sphere.center = point(bytes);
  sphere.radius = number(bytes) / 4;
}

bool are_wanted(const std::vector<KindPair>& wanted, std::uint8_t a, std::uint8_t b) {
  return wanted.empty() || std::any_of(wanted.begin(), wanted.end(), [&](const KindPair& pair) {
           return (pair.a == a && pair.b == b) || (pair.a == b && pair.b == a);
         });
}

template <class Volume>
std::vector<IndexPair> double_loop(const std::vector<Volume>& volumes, const std::vector<std::uint8_t>& kinds,
                                   const std::vector<KindPair>& wanted) {
  std::vector<IndexPair> pairs;
  for (std::uint32_t a = 0; a < volumes.size(); ++a) {
    for (std::uint32_t b = a + 1; b < volumes.size(); ++b) {
      if (!volumes[a].empty() && !volumes[b].empty() && overlap(volumes[a], volumes[b]) &&
          are_wanted(wanted, kinds[a], kinds[b]))
        pairs.push_back({a, b});
    }
  }
  return pairs;
}

template <class Volume>
std::span<const IndexPair> find(BroadPhase& method, const std::vector<Volume>& volumes,
                                const std::vector<std::uint8_t>* kinds,
                                const std::vector<std::uint32_t>* dirty) {
  const std::span<const Volume> all(volumes);
  if (kinds == nullptr)
    return dirty != nullptr ? method.find_object_pairs(all, *dirty) : method.find_object_pairs(all);
  return dirty != nullptr ? method.find_object_pairs(all, *kinds, *dirty)
                          : method.find_object_pairs(all, *kinds);
}

template <class Volume>
void live(fuzz::ByteReader& bytes) {
  BroadPhaseOptions options;
  options.threads = 1;
  for (std::uint32_t i = bytes.below(4); i > 0; --i)
    options.kind_pairs.push_back(
        {static_cast<std::uint8_t>(bytes.below(4)), static_cast<std::uint8_t>(bytes.below(4))});
  std::vector<BroadPhase> methods;
  for (const BroadPhaseMethod method : all_methods) {
    options.method = method;
    methods.emplace_back(options);
  }

  std::vector<Volume> volumes;
  std::vector<std::uint8_t> kinds;
  for (int step = 0; step < most_steps && !bytes.at_end(); ++step) {
    volumes.resize(std::min(most_volumes, bytes.flag() ? volumes.size() + bytes.below(40)
                                                       : volumes.size() * bytes.below(256) / 256));
    kinds.resize(volumes.size());
    std::vector<std::uint32_t> dirty;
    for (std::uint32_t left = bytes.below(30); left > 0 && !volumes.empty(); --left) {
      const std::uint32_t i = bytes.byte() % static_cast<std::uint32_t>(volumes.size());
      change(bytes, volumes[i]);
      kinds[i] = static_cast<std::uint8_t>(bytes.below(4));
      dirty.push_back(i);
    }
    const bool with_list = step > 0 && bytes.flag();
    const std::vector<IndexPair> expected = double_loop(volumes, kinds, options.kind_pairs);
    for (BroadPhase& method : methods) {
      const auto found =
          find(method, volumes, options.kind_pairs.empty() ? nullptr : &kinds, with_list ? &dirty : nullptr);
      // Rounding may add pairs of spheres, but no method may lose one.
      check(std::includes(found.begin(), found.end(), expected.begin(), expected.end()), "a pair is missed");
      check(std::is_same_v<Volume, BoundingSphere> || found.size() == expected.size(), "a pair is too much");
      const std::string error = method.validate();
      check(error.empty(), error);
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::ByteReader bytes(data, size);
  bytes.flag() ? live<Aabb>(bytes) : live<BoundingSphere>(bytes);
  return 0;
}
