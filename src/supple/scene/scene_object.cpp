#include "scene/scene_object.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "core/float_rounding.hpp"
#include "geometry/aabb.hpp"
#include "geometry/sphere.hpp"
#include "geometry/vector.hpp"

namespace supple {
namespace {

/// Beyond this size a translation is settled into the positions: single precision ends at 3e38, and the sums
/// of volumes and translations stay far from it.
constexpr double largest_lazy_size = 1e30;

/// Refits in a row of which the octree's quality is measured once it was found degraded.
constexpr std::uint32_t refits_watched = 16;
/// Of building an octree anew, in queries of it as built: what is the same however small the degraded part,
/// and sorting all of it.
constexpr double price_of_relinking = 10, price_of_building = 50;
/// Of what queries of the degraded parts cost, that a new tree must save: leaves that are patches of the
/// surface stay good for longer than those that are parts of space. And where the surface is smooth, more of
/// them cannot touch themselves.
constexpr double least_saving = 0.5, least_saving_of_smooth = 0.75;
constexpr double most_patience = 1024;

double largest(const Vec3d& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

/// The ball around a box.
BoundingSphere sphere_around(const Aabb& box) {
  if (box.empty()) return {};
  BoundingSphere sphere;
  double squared_radius = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = box.min[axis], high = box.max[axis];
    sphere.center[axis] = static_cast<float>((low + high) / 2);
    const double reach = std::max(high - sphere.center[axis], sphere.center[axis] - low);
    squared_radius += reach * reach;
  }
  sphere.radius = round_up(std::sqrt(squared_radius) * (1 + 0x1p-50));
  return sphere;
}

/// Vertices, edges and faces of two leaves are all tested in continuous contacts, most of them in vain:
/// leaves half as large are faster. A regular octree is what it is asked to be.
ObjectOctreeOptions octree_options(const ObjectOptions& options, const SceneOptions& scene_options) {
  ObjectOctreeOptions octree = options.octree;
  if (scene_options.contacts == ContactMode::continuous && !octree.regular && octree.arity == 8) {
    octree.leaf_size = octree.leaf_size / 2 + octree.leaf_size % 2;
  }
  return octree;
}

/// A byte a triangle: whether a vertex of it is not finite.
void mark_inert(const ObjectOctree& octree, const VertexBuffer& vertices, std::vector<std::uint8_t>& inert) {
  inert.assign(octree.triangles().size(), 0);
  for (std::uint32_t t = 0; t < inert.size(); ++t) {
    for (const std::uint32_t vertex : octree.triangles()[t]) inert[t] |= !is_finite(vertices[vertex]);
  }
}

}  // namespace

SceneObject::SceneObject(const PositionsView& positions, std::span<const Triangle> triangles,
                         const ObjectOptions& object_options, const SceneOptions& scene_options)
    : options(object_options),
      octree_(positions, triangles, octree_options(object_options, scene_options),
              scene_options.bounding_volume, scene_options.comparison.sphere_fit,
              scene_options.contacts == ContactMode::continuous ? VertexNumbering::by_first_use
                                                                : VertexNumbering::given),
      is_continuous_(scene_options.contacts == ContactMode::continuous),
      // Neighbours come within a separation; and the paper's output is of all leaves whose volumes overlap.
      passes_over_unfolded_(is_continuous_ ? scene_options.impact.min_separation == 0
                                           : !scene_options.comparison.colliding_vertices),
      may_rebuild_(object_options.octree.rebuild_degraded && !scene_options.comparison.colliding_vertices &&
                   scene_options.comparison.sphere_fit == SphereFit::vertices) {
  if (is_continuous_) elements_ = SurfaceElements(octree_);
}

void SceneObject::set_positions(const PositionsView& positions, const Parallel& parallel) {
  place_afresh();
  vertices_.assign(positions, octree_.vertex_order(), parallel);
}

void SceneObject::share_positions(const PositionsView& positions, const Parallel& parallel) {
  if (is_continuous_ || !vertices_.borrow(positions)) return set_positions(positions, parallel);
  place_afresh();
}

void SceneObject::set_motion(const PositionsView& from, const PositionsView& to, const Parallel& parallel) {
  set_positions(to, parallel);
  if (!is_continuous_) return;
  has_motion_ = true;
  start_.assign(from, octree_.vertex_order(), parallel);
}

/// Positions given anew replace all that was done to those before.
void SceneObject::place_afresh() {
  has_shape_ = is_settled_ = has_motion_ = false;
  rotation_ = RigidTransform{}.rotation;
  translation_ = {};
  mark_moved();
}

void SceneObject::mark_moved() {
  needs_refit_ = needs_bounds_ = true;
  has_unfolded_ = false;
}

void SceneObject::translate(Vec3d offset, const Parallel& parallel) {
  unsettle(parallel);
  has_motion_ = false;
  translation_ = translation_ + offset;
  needs_bounds_ = true;
}

void SceneObject::set_transform(const RigidTransform& transform, const Parallel& parallel) {
  unsettle(parallel);
  has_motion_ = false;
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
  vertices_.transform(shape_, parallel, [&](const Vec3d& p) {
    return Vec3d{r[0] * p.x + r[1] * p.y + r[2] * p.z, r[3] * p.x + r[4] * p.y + r[5] * p.z,
                 r[6] * p.x + r[7] * p.y + r[8] * p.z};
  });
  mark_moved();
}

void SceneObject::unsettle(const Parallel& parallel) {
  if (!std::exchange(is_settled_, false)) return;
  apply_rotation(parallel);
}

bool SceneObject::is_extreme() const {
  const Aabb& box = octree_.box();
  const double size = box.empty() ? 0
                                  : std::max(largest({box.min.x, box.min.y, box.min.z}),
                                             largest({box.max.x, box.max.y, box.max.z}));
  return size > largest_lazy_size || largest(translation_) > largest_lazy_size;
}

void SceneObject::settle(const Parallel& parallel) {
  keep_shape();
  apply_rotation(parallel);
  const VertexBuffer rotated = vertices_;
  vertices_.transform(rotated, parallel, [&](const Vec3d& p) { return p + translation_; });
  mark_moved();
  is_settled_ = true;
}

void SceneObject::find_non_finite() {
  mark_inert(octree_, vertices_, inert_);
  for (std::uint32_t user = 0; user < vertices_.size(); ++user) {
    if (!is_finite(non_finite_position(octree_.octree_vertex(user)))) non_finite_.push_back(user);
  }
}

void SceneObject::update(const Parallel& parallel) {
  if (is_continuous_) {
    update_moving(parallel);
  } else {
    if (needs_refit_) refit_octree(parallel);
    if (!is_settled_ && translation_ != Vec3d{} && is_extreme()) {
      settle(parallel);
      refit_octree(parallel);
    }
    box_ = moved(octree_.box(), lazy_translation());
    sphere_ = moved(octree_.sphere(), lazy_translation());
  }
  if (options.self_collision && needs_refit_ && passes_over_unfolded_) update_unfolded(parallel);
  if (needs_refit_) measure_quality();
  needs_refit_ = needs_bounds_ = false;
}

void SceneObject::refit_octree(const Parallel& parallel) {
  inert_.clear();
  non_finite_.clear();
  if (octree_.refit(vertices_, {}, parallel)) return;
  find_non_finite();
  octree_.refit(vertices_, inert_, parallel);
}

void SceneObject::update_moving(const Parallel& parallel) {
  if (!is_settled_ && translation_ != Vec3d{}) settle(parallel);
  inert_.clear();
  non_finite_.clear();
  if (!moving_boxes_.refit(octree_, elements_, start(), end(), parallel)) find_non_finite();
  box_ = moving_boxes_.swept_box();
  sphere_ = sphere_around(box_);
}

/// Where too few lanes are unfolded, as in crumpled cloth, looking for them costs more than it saves: it is
/// then left for some steps.
void SceneObject::update_unfolded(const Parallel& parallel) {
  constexpr std::uint32_t rest_steps = 15, least_share = 8;
  if (steps_without_unfolded_ > 0) {
    --steps_without_unfolded_;
    return;
  }
  if (unfolded_.masks().empty()) unfolded_ = SelfCollisionCulling(octree_);
  unfolded_.refit(octree_, start(), end(), parallel);
  has_unfolded_ = true;
  std::size_t lanes = 0, unfolded = 0;
  for (std::size_t node = 0; node < octree_.nodes().size(); ++node) {
    lanes += octree_.nodes()[node].lane_count;
    unfolded += static_cast<std::size_t>(std::popcount(unfolded_.masks()[node]));
  }
  const bool pays = unfolded * least_share >= lanes;
  was_unfolded_ = was_unfolded_ || pays;
  if (!pays) steps_without_unfolded_ = rest_steps;
}

TreeBoxes SceneObject::tree_boxes() const {
  const AabbLanes* const moving = moving_boxes_.view(octree_, elements_).end;
  return {octree_.nodes(), moving != nullptr ? moving : octree_.boxes(), leaf_limit()};
}

std::uint32_t SceneObject::leaf_limit() const {
  return is_continuous_ ? moving_leaf_size : 0;
}

void SceneObject::set_rest_quality(const Parallel& parallel) {
  refit_octree(parallel);
  quality_.set_references(tree_boxes());
}

/// A tree degrades over many steps, mostly: it is looked at now and then, not in time with a motion that
/// repeats, and all the time when it has lately been found degraded.
void SceneObject::measure_quality() {
  if (!may_rebuild_ || --refits_until_measured_ > 0) return;
  quality_.measure(tree_boxes());
  if (is_degraded()) refits_to_watch_ = refits_watched;
  refits_until_measured_ = 1;
  if (refits_to_watch_ > 0) {
    --refits_to_watch_;
  } else {
    random_ = random_ * 1664525 + 1013904223;
    refits_until_measured_ += random_ >> 28;
  }
}

bool SceneObject::count_queries(double queries) {
  waste_ += queries * quality_.saving();
  return waste_ >= patience_ * (price_of_relinking + price_of_building * quality_.share());
}

std::uint64_t SceneObject::degraded_triangles() const {
  std::uint64_t count = 0;
  for (const std::uint32_t node : quality_.degraded()) count += octree_.nodes()[node].size();
  return count;
}

void SceneObject::rebuild(const Parallel& parallel) {
  waste_ = 0;
  ObjectOctree octree = octree_;
  const OctreeRebuild changes = octree.rebuild(quality_.degraded(), vertices_);
  const bool renumbers = !changes.new_vertices.empty();
  VertexBuffer vertices = renumbers ? vertices_.renumbered(changes.new_vertices) : VertexBuffer{};
  const VertexBuffer& present = renumbers ? vertices : vertices_;
  if (!octree.refit(present, {}, parallel)) {
    std::vector<std::uint8_t> inert;
    mark_inert(octree, present, inert);
    octree.refit(present, inert, parallel);
  }
  TreeQuality quality = quality_;
  quality.update_references({octree.nodes(), octree.boxes(), leaf_limit()}, changes.old_nodes);
  const double least = was_unfolded_ ? least_saving_of_smooth : least_saving;
  if (!(quality_.cost() - quality.cost() >= least * quality_.degraded_cost())) {
    quality_.set_references(tree_boxes());
    patience_ = std::min(2 * patience_, most_patience);
    return;
  }
  patience_ = std::max(patience_ / 2, 1.0);
  subtrees_rebuilt_ += quality_.degraded().size();
  triangles_rebuilt_ += degraded_triangles();
  VertexBuffer start = renumbers && has_motion_ ? start_.renumbered(changes.new_vertices) : VertexBuffer{};
  VertexBuffer shape = renumbers && has_shape_ ? shape_.renumbered(changes.new_vertices) : VertexBuffer{};
  SurfaceElements elements = is_continuous_ ? SurfaceElements(octree) : SurfaceElements{};
  // Nothing here takes memory. What the update needs it may lack: then the next one makes good what is
  // missing.
  mark_moved();
  quality_ = std::move(quality);
  octree_ = std::move(octree);
  if (renumbers) {
    vertices_ = std::move(vertices);
    start_ = std::move(start);
    shape_ = std::move(shape);
  }
  elements_ = std::move(elements);
  unfolded_ = {};
  refits_until_measured_ = 2;  // not by this update
  refits_to_watch_ = refits_watched;
  update(parallel);
}

OctreeView SceneObject::view() const {
  OctreeView view = view_of(octree_, vertices_, inert_, lazy_translation());
  if (has_unfolded_) view.unfolded = unfolded_.masks().data();
  return view;
}

OctreeView SceneObject::moving_view() const {
  OctreeView view = moving_view_of(octree_, elements_, moving_boxes_);
  if (has_unfolded_) view.unfolded = unfolded_.masks().data();
  return view;
}

std::string SceneObject::validate() const {
  if (!is_continuous_) return octree_.validate(vertices_, inert_);
  const std::string wrong = elements_.validate(octree_);
  return wrong.empty() ? moving_boxes_.validate(octree_, elements_, start(), end()) : wrong;
}

OctreeStatistics SceneObject::octree_statistics() const {
  OctreeStatistics statistics = octree_.statistics();
  statistics.bytes += moving_boxes_.bytes() + elements_.bytes() + unfolded_.bytes() + quality_.bytes();
  TreeQuality quality = quality_;
  quality.measure(tree_boxes());
  statistics.cost = quality.cost();
  statistics.degradation = quality.degradation();
  statistics.subtrees_rebuilt = subtrees_rebuilt_;
  statistics.triangles_rebuilt = triangles_rebuilt_;
  if (statistics.triangles != 0) {
    statistics.bytes_per_triangle =
        static_cast<double>(statistics.bytes) / static_cast<double>(statistics.triangles);
  }
  return statistics;
}

Vec3d SceneObject::non_finite_position(std::uint32_t octree_vertex) const {
  const Vec3d end = position(octree_vertex);
  return is_finite(end) ? start()[octree_vertex] : end;
}

Vec3d SceneObject::position(std::uint32_t octree_vertex) const {
  const Vec3d translation = lazy_translation();
  const Vec3d p = vertices_[octree_vertex];
  return translation == Vec3d{} ? p : p + translation;
}

}  // namespace supple
