#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "geometry/integer_points.hpp"
#include "geometry/vector.hpp"
#include "scene/scene_implementation.hpp"

namespace supple {
namespace {

/// The bits of an object's coordinates, and whose coordinates are the finest and the largest.
class ObjectBits {
 public:
  /// O(n). Reads the finite vertices of triangles, edges and points, and the margin if proximity needs it.
  ObjectBits(const SceneObject& object, bool has_proximity) : object_(&object) {
    for (std::uint32_t t = 0; t < object.octree().triangles().size(); ++t) {
      for (const std::uint32_t v : object.octree().user_triangle(t)) {
        const Vec3d p = object.placement().position(v);
        if (is_finite(p)) add(p, v);
      }
    }
    if (has_proximity) add({object.options.margin, 0, 0}, margin);
  }

  const BitExtent& extent() const { return extent_; }
  std::string finest() const { return name(finest_); }
  std::string largest() const { return name(largest_); }

 private:
  static constexpr std::uint32_t margin = 0xffffffff;

  /// The smallest number counts among equals, so that the names do not depend on the octree.
  void add(const Vec3d& p, std::uint32_t number) {
    BitExtent extent;
    for (int axis = 0; axis < 3; ++axis) extent.include(p[axis]);
    if (std::pair(extent.bottom, number) < std::pair(extent_.bottom, finest_)) finest_ = number;
    if (std::pair(-extent.top, number) < std::pair(-extent_.top, largest_)) largest_ = number;
    extent_.bottom = std::min(extent_.bottom, extent.bottom);
    extent_.top = std::max(extent_.top, extent.top);
  }
  std::string name(std::uint32_t number) const {
    return (number == margin ? "the margin" : "vertex " + std::to_string(number)) + " of " +
           object_->options.name;
  }

  const SceneObject* object_;
  BitExtent extent_;
  std::uint32_t finest_ = margin, largest_ = margin;
};

void check_exact_bits(const ObjectBits& a, const ObjectBits& b, std::uint32_t most) {
  const bool is_finest_of_a = a.extent().bottom <= b.extent().bottom;
  const bool is_largest_of_a = a.extent().top >= b.extent().top;
  const int bottom = std::min(a.extent().bottom, b.extent().bottom);
  const int top = std::max(a.extent().top, b.extent().top);
  if (top - bottom <= static_cast<int>(most)) return;
  fail("detect: " + (is_largest_of_a ? a : b).largest() + " and " + (is_finest_of_a ? a : b).finest() +
       " have coordinates of " + std::to_string(top - bottom) + " bits together, but max_exact_bits is " +
       std::to_string(most) + "; raise it, or set coordinates below 2^" +
       std::to_string(top - static_cast<int>(most) + 52) + " to 0");
}

}  // namespace

void Scene::Implementation::check_exact_bits(const Jobs& jobs) const {
  const bool is_exact = question_.has_intersections() || question_.has_proximity();
  if (options.max_exact_bits == most_exact_bits || !is_exact) return;
  std::vector<std::optional<ObjectBits>> bits(slots_.size());
  for (const ContactJob& job : jobs.jobs) {
    for (const std::uint32_t index : {job.a, job.b}) {
      if (!bits[index]) bits[index].emplace(*slots_[index].object, question_.has_proximity());
    }
    supple::check_exact_bits(*bits[job.a], *bits[job.b], options.max_exact_bits);
  }
}

}  // namespace supple
