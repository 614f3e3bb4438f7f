#include "scene/exact_limit.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "geometry/vector.hpp"
#include "scene/scene_implementation.hpp"

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
CoordinateBits bits_of(const SceneObject& object, bool is_query) {
  CoordinateBits bits("vertex", " of " + object.options.name, "the margin");
  const std::size_t count = is_query ? object.face_count() : object.octree().triangles().size();
  for (std::uint32_t t = 0; t < count; ++t) {
    for (const std::uint32_t v : object.octree().user_triangle(t))
      bits.add(object.placement().position(v), v);
  }
  return bits;
}

}  // namespace

void Scene::Implementation::check_exact_bits(const Jobs& jobs) const {
  const bool is_exact = question_.has_intersections() || question_.has_proximity();
  if (!has_exact_limit() || !is_exact) return;
  std::vector<std::optional<CoordinateBits>> bits(slots_.size());
  for (const ContactJob& job : jobs.jobs) {
    for (const std::uint32_t index : {job.a, job.b}) {
      if (bits[index]) continue;
      const SceneObject& object = *slots_[index].object;
      bits[index] = bits_of(object, false);
      if (question_.has_proximity())
        bits[index]->add({object.options.margin, 0, 0}, CoordinateBits::no_point);
    }
    supple::check_exact_bits(*bits[job.a], *bits[job.b], options.max_exact_bits, "detect: ");
  }
}

void Scene::Implementation::check_exact_bits(std::span<const ObjectPair> pairs, const char* call) const {
  if (!has_exact_limit()) return;
  std::vector<std::optional<CoordinateBits>> bits(slots_.size());
  for (const ObjectPair& pair : pairs) {
    for (const ObjectId id : {pair.a, pair.b}) {
      if (!bits[id.index]) bits[id.index] = bits_of(*slots_[id.index].object, true);
    }
    const std::string with = std::string(call) + ": with " + slots_[pair.a.index].object->options.name +
                             " and " + slots_[pair.b.index].object->options.name + ", ";
    supple::check_exact_bits(*bits[pair.a.index], *bits[pair.b.index], options.max_exact_bits, with);
  }
}

void Scene::Implementation::check_exact_bits(const CoordinateBits& queries, const char* call) const {
  for (const QueriedObject& queried : queried_objects_) {
    const SceneObject& object = *slots_[queried.id.index].object;
    supple::check_exact_bits(queries, bits_of(object, true), options.max_exact_bits,
                             std::string(call) + ": with " + object.options.name + ", ");
  }
}

}  // namespace supple
