#include "scene/scene_object.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/float_rounding.hpp"

namespace supple {
namespace {

/// Beyond this size a translation is settled into the positions: single precision ends at 3e38, and the sums
/// of volumes and translations stay far from it.
constexpr double largest_lazy_size = 1e30;

double largest(const Vec3d& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

bool is_finite(const Vec3d& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

/// Encloses fl(p + offset) of every p in the box: the rounded sum is monotonic.
Aabb moved(const Aabb& box, const Vec3d& offset) {
  if (offset == Vec3d{} || box.empty()) return box;
  Aabb result;
  for (int axis = 0; axis < 3; ++axis) {
    result.min[axis] = round_down(double{box.min[axis]} + offset[axis]);
    result.max[axis] = round_up(double{box.max[axis]} + offset[axis]);
  }
  return result;
}

/// Encloses fl(p + offset) of every p in the ball.
BoundingSphere moved(const BoundingSphere& sphere, const Vec3d& offset) {
  if (offset == Vec3d{} || sphere.empty()) return sphere;
  BoundingSphere result;
  double squared_shift = 0;  // of the centre, by rounding it to float
  double magnitude = sphere.radius;
  for (int axis = 0; axis < 3; ++axis) {
    const double center = double{sphere.center[axis]} + offset[axis];
    result.center[axis] = static_cast<float>(center);
    const double shift = result.center[axis] - center;
    squared_shift += shift * shift;
    magnitude += std::abs(center);
  }
  result.radius =
      round_up(double{sphere.radius} + std::sqrt(squared_shift) * (1 + 0x1p-50) + magnitude * 0x1p-50);
  return result;
}

}  // namespace

SceneObject::SceneObject(const PositionsView<double>& positions, std::span<const Triangle> triangles,
                         const ObjectOptions& object_options, const SceneOptions& scene_options)
    : options(object_options),
      octree_(positions, triangles, object_options.octree, scene_options.bounding_volume,
              scene_options.sphere_fit) {}

template <class Scalar>
void SceneObject::set_positions(const PositionsView<Scalar>& positions, const Parallel& parallel) {
  has_shape_ = is_settled_ = false;
  rotation_ = RigidTransform{}.rotation;
  translation_ = {};
  note_non_finite(vertices_.assign(positions, octree_.vertex_order(), parallel));
}
template void SceneObject::set_positions(const PositionsView<float>&, const Parallel&);
template void SceneObject::set_positions(const PositionsView<double>&, const Parallel&);

void SceneObject::translate(Vec3d offset, const Parallel& parallel) {
  unsettle(parallel);
  translation_ = translation_ + offset;
  needs_bounds_ = true;
}

void SceneObject::set_transform(const RigidTransform& transform, const Parallel& parallel) {
  unsettle(parallel);
  translation_ = transform.translation;
  needs_bounds_ = true;
  if (transform.rotation == rotation_) return;
  rotation_ = transform.rotation;
  keep_shape();
  apply_rotation(parallel);
}

void SceneObject::keep_shape() {
  if (std::exchange(has_shape_, true)) return;
  std::swap(shape_, vertices_);
}

void SceneObject::apply_rotation(const Parallel& parallel) {
  const auto& r = rotation_;
  note_non_finite(vertices_.transform(shape_, parallel, [&](const Vec3d& p) {
    return Vec3d{r[0] * p.x + r[1] * p.y + r[2] * p.z, r[3] * p.x + r[4] * p.y + r[5] * p.z,
                 r[6] * p.x + r[7] * p.y + r[8] * p.z};
  }));
}

void SceneObject::unsettle(const Parallel& parallel) {
  if (!std::exchange(is_settled_, false)) return;
  apply_rotation(parallel);
}

void SceneObject::settle_if_extreme(const Parallel& parallel) {
  if (is_settled_ || translation_ == Vec3d{}) return;
  const Aabb& box = octree_.box();
  const double size = box.empty() ? 0
                                  : std::max(largest({box.min.x, box.min.y, box.min.z}),
                                             largest({box.max.x, box.max.y, box.max.z}));
  if (size <= largest_lazy_size && largest(translation_) <= largest_lazy_size) return;
  keep_shape();
  apply_rotation(parallel);
  const VertexBuffer rotated = vertices_;
  note_non_finite(vertices_.transform(rotated, parallel, [&](const Vec3d& p) { return p + translation_; }));
  is_settled_ = true;
  octree_.refit(vertices_, inert_, parallel);
}

void SceneObject::note_non_finite(bool all_finite) {
  needs_refit_ = needs_bounds_ = true;
  inert_.clear();
  non_finite_.clear();
  if (all_finite) return;
  inert_.resize(octree_.triangles().size(), 0);
  for (std::uint32_t t = 0; t < inert_.size(); ++t) {
    for (const std::uint32_t vertex : octree_.triangles()[t]) inert_[t] |= !is_finite(vertices_[vertex]);
  }
  for (std::uint32_t user = 0; user < vertices_.size(); ++user) {
    if (!is_finite(vertices_[octree_.vertex_order()[user]])) non_finite_.push_back(user);
  }
}

void SceneObject::update(const Parallel& parallel) {
  if (needs_refit_) octree_.refit(vertices_, inert_, parallel);
  settle_if_extreme(parallel);
  box_ = moved(octree_.box(), lazy_translation());
  sphere_ = moved(octree_.sphere(), lazy_translation());
  needs_refit_ = needs_bounds_ = false;
}

Vec3d SceneObject::position(std::uint32_t octree_vertex) const {
  const Vec3d translation = lazy_translation();
  const Vec3d p = vertices_[octree_vertex];
  return translation == Vec3d{} ? p : p + translation;
}

}  // namespace supple
