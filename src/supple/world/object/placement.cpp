#include "world/object/placement.hpp"

#include <algorithm>
#include <utility>

#include "geometry/exact_predicates.hpp"
#include "geometry/vector.hpp"

namespace supple {
namespace {

/// A larger translation is baked into the positions. Sums of volumes and translations thus stay far from
/// 3e38, the end of single precision.
constexpr double largest_lazy_size = 1e30;

}  // namespace

void Placement::set_positions(const PositionsView& positions, const Parallel& parallel) {
  end_.reserve(positions.size(), positions.is_double());
  place_afresh();
  end_.assign(positions, parallel);
}

void Placement::share_positions(const PositionsView& positions, const Parallel& parallel) {
  if (!end_.borrow(positions)) return set_positions(positions, parallel);
  place_afresh();
}

void Placement::set_motion(const PositionsView& from, const PositionsView& to, const Parallel& parallel) {
  if (!start_) start_ = std::make_unique<VertexBuffer>();
  start_->reserve(from.size(), from.is_double());
  set_positions(to, parallel);
  start_->assign(from, parallel);
  has_motion_ = true;
}

/// New positions discard all earlier transforms.
void Placement::place_afresh() {
  has_motion_ = has_shape_ = is_baked_ = is_mirrored_ = false;
  rotation_ = RigidTransform{}.rotation;
  translation_ = {};
  ++shape_version_;
  change_all();
}

void Placement::change_all() {
  ++version_;
  forget_moved();
}

void Placement::set_vertices(std::span<const std::uint32_t> vertices, const PositionsView& positions,
                             const Parallel& parallel) {
  restore(parallel);
  // A longer list takes more time than all vertices, and it would grow as long as nothing reads it.
  const bool is_listed = moved_.size() + vertices.size() <= end_.size() / 8;
  if (is_listed) moved_.insert(moved_.end(), vertices.begin(), vertices.end());
  if (!has_shape_) {
    end_.set(vertices, positions, parallel);
  } else {
    shape_->set(vertices, positions, parallel);
    end_.transform(*shape_, vertices, [&](const Vec3d& p) { return rotated(p); });
  }
  ++version_;
  if (!is_listed) forget_moved();
  if (vertices.size() > end_.size() / 8) ++shape_version_;
}

void Placement::append(const PositionsView& positions, const PositionsView& start, const Parallel& parallel) {
  std::vector<Vec3d> transformed;
  for (std::size_t i = 0; has_shape_ && i < positions.size(); ++i)
    transformed.push_back(rotated(positions[i]));
  for (VertexBuffer* const buffer : {&end_, start_.get(), shape_.get()}) {
    if (buffer != nullptr) buffer->reserve_more(positions.size());
  }
  if (is_baked_) restore(parallel);
  if (has_shape_) shape_->append(positions);
  end_.append(has_shape_ ? PositionsView(transformed) : positions);
  if (has_motion_) start_->append(start);
  ++shape_version_;
  change_all();
}

void Placement::translate(Vec3d offset, const Parallel& parallel) {
  restore(parallel);
  translation_ = translation_ + offset;
}

void Placement::set_transform(const RigidTransform& transform, const Parallel& parallel) {
  if (transform.rotation != rotation_) reserve_transformed();
  restore(parallel);
  translation_ = transform.translation;
  if (transform.rotation == rotation_) return;
  rotation_ = transform.rotation;
  is_mirrored_ = sign_of(transform) < 0;
  keep_shape();
  apply({}, parallel);
}

int Placement::sign_of(const RigidTransform& transform) {
  const auto& r = transform.rotation;
  bool used_exact = false;
  return orient3d({}, {r[0], r[1], r[2]}, {r[3], r[4], r[5]}, {r[6], r[7], r[8]}, used_exact);
}

/// The object comes to rest at the end of its path, and its translation is no longer baked.
void Placement::restore(const Parallel& parallel) {
  if (std::exchange(has_motion_, false)) change_all();
  if (is_baked_) apply({}, parallel);
  is_baked_ = false;
}

void Placement::keep_shape() {
  if (!std::exchange(has_shape_, true)) std::swap(*shape_, end_);
}

/// Takes memory for `keep_shape` and `apply`.
void Placement::reserve_transformed() {
  if (!shape_) shape_ = std::make_unique<VertexBuffer>();
  (has_shape_ ? end_ : *shape_).reserve(end_.size(), true);
}

Vec3d Placement::rotated(const Vec3d& p) const {
  const auto& r = rotation_;
  return {r[0] * p.x + r[1] * p.y + r[2] * p.z, r[3] * p.x + r[4] * p.y + r[5] * p.z,
          r[6] * p.x + r[7] * p.y + r[8] * p.z};
}

void Placement::apply(const Vec3d& translation, const Parallel& parallel) {
  const bool translates = translation != Vec3d{};
  end_.transform(*shape_, parallel,
                 [&](const Vec3d& p) { return translates ? rotated(p) + translation : rotated(p); });
  change_all();
}

bool Placement::needs_baking(const Aabb& box) const {
  if (translation() == Vec3d{}) return false;
  const double size = box.empty() ? 0
                                  : std::max(largest_magnitude({box.min.x, box.min.y, box.min.z}),
                                             largest_magnitude({box.max.x, box.max.y, box.max.z}));
  return size > largest_lazy_size || largest_magnitude(translation_) > largest_lazy_size;
}

void Placement::bake(const Parallel& parallel) {
  reserve_transformed();
  keep_shape();
  apply(translation_, parallel);
  is_baked_ = true;
}

Vec3d Placement::placed(const Vec3d& p) const {
  const Vec3d offset = translation();
  return offset == Vec3d{} ? p : p + offset;
}

}  // namespace supple
