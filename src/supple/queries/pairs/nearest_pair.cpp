#include "queries/pairs/nearest_pair.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <tuple>

#include "contact/intersection/triangle_bounds.hpp"
#include "contact/intersection/triangle_intersection.hpp"
#include "core/float_rounding.hpp"
#include "geometry/aabb.hpp"
#include "geometry/vector.hpp"
#include "queries/feature_name.hpp"

namespace supple {
namespace {

/// The barycentric coordinates of a point on a feature of a triangle, by the vertices of the feature: those
/// of an edge by ascending ids. Rounded.
std::array<double, 3> weights_at(const Vec3d& point, const Feature& feature, const TrianglePoints& corners,
                                 const Triangle& vertices) {
  if (feature.kind == FeatureKind::vertex) return {1, 0, 0};
  const std::size_t first = feature.index, next = (first + 1) % 3;
  const Vec3d to_point = point - corners[first], along = corners[next] - corners[first];
  const double size = feature.kind == FeatureKind::edge
                          ? largest_magnitude(along)
                          : std::max(largest_magnitude(along), largest_magnitude(corners[2] - corners[0]));
  const auto scaled = [&](const Vec3d& v) { return Vec3d{v.x / size, v.y / size, v.z / size}; };
  const Vec3d w = scaled(to_point), u = scaled(along);
  if (feature.kind == FeatureKind::edge) {
    const double part = std::clamp(dot(w, u) / dot(u, u), 0.0, 1.0);
    const bool is_reversed = vertices[next] < vertices[first];
    return is_reversed ? std::array{part, 1 - part, 0.0} : std::array{1 - part, part, 0.0};
  }
  const Vec3d v = scaled(corners[2] - corners[0]), n = cross(u, v);
  const double whole = dot(n, n), s = dot(cross(w, v), n) / whole, t = dot(cross(u, w), n) / whole;
  if (std::isfinite(s) && std::isfinite(t)) return {1 - s - t, s, t};
  bool used_exact = false;  // almost without area
  const ElementPoints elements{{point, corners[0], corners[1], corners[2]}, 1, 3};
  return distance_within(elements, any_distance, used_exact, DistanceAccuracy::rough)->barycentric_b;
}

/// Some triangles of a block, as their numbers.
class TriangleList {
 public:
  TriangleList(std::uint32_t begin, std::uint64_t triangles) : begin_(begin) {
    for (std::uint64_t left = triangles; left != 0; left &= left - 1)
      list_[count_++] = {begin + static_cast<std::uint32_t>(std::countr_zero(left)), 0};
  }
  std::span<const TrianglePair> all() const { return std::span(list_).first(count_); }
  /// The triangles for which `is_kept(place in the list)` is true.
  template <class IsKept>
  std::uint64_t keep(const IsKept& is_kept) const {
    std::uint64_t kept = 0;
    for (std::size_t i = 0; i < count_; ++i)
      kept |= std::uint64_t{is_kept(i) ? 1u : 0u} << (list_[i].a - begin_);
    return kept;
  }

 private:
  std::uint32_t begin_;
  std::size_t count_ = 0;
  std::array<TrianglePair, leaf_block> list_;
};

}  // namespace

void NearestPairSearch::start(const QueriedObject& a, const QueriedObject& b, Search search,
                              double max_distance, const StopSignal& stop) {
  stop_ = stop;
  a_ = &a;
  b_ = &b;
  search_ = search;
  recent_.clear();
  intersects_ = false;
  best_.reset();
  bound_.clear();
  farther_.clear();
  decided_triangles_ = decided_elements_ = 0;
  stack_.clear();
  vertices_and_faces_.count = 0;
  edges_.count = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double from = a.view.translation[axis], to = b.view.translation[axis];
    offset_[axis] = from - to;
    const auto largest = [&](const Aabb& box) {
      return std::max(std::fabs(double{box.min[axis]}), std::fabs(double{box.max[axis]}));
    };
    // More than the roundings of two translated vertices and of the sums below.
    slop_[axis] = from == 0 && to == 0
                      ? 0
                      : 0x1p-49 * (std::fabs(from) + std::fabs(to) + largest(a.box) + largest(b.box));
  }
  set_limit(max_distance);
}

void NearestPairSearch::set_limit(double limit) {
  limit_ = limit;
  squared_limit_ = round_up(limit * limit * (1 + 0x1p-18) + 0x1p-120);
}

Aabb NearestPairSearch::seen(const Aabb& box, double direction) const {
  constexpr float most = std::numeric_limits<float>::max();
  Aabb bounds;
  for (int axis = 0; axis < 3; ++axis) {
    const double offset = direction * offset_[axis];
    // Always a step outwards, which is faster than `round_down` and `round_up`.
    const float low = std::min(static_cast<float>(box.min[axis] + offset - slop_[axis]), most),
                high = std::max(static_cast<float>(box.max[axis] + offset + slop_[axis]), -most);
    bounds.min[axis] = low - outward_step(low);
    bounds.max[axis] = high + outward_step(high);
  }
  return bounds;
}

bool NearestPairSearch::any_contact(const QueriedObject& a, const QueriedObject& b, const StopSignal& stop) {
  start(a, b, Search::any_contact, 0, stop);
  descend();
  return intersects_;
}

std::optional<ProximityPair> NearestPairSearch::nearest(const QueriedObject& a, const QueriedObject& b,
                                                        double max_distance,
                                                        std::optional<TrianglePair> guess,
                                                        const StopSignal& stop) {
  start(a, b, Search::nearest, max_distance, stop);
  if (a.box.empty() || b.box.empty()) return {};
  if (guess)
    decide(*guess);
  else
    guess_by_projection();
  consider_all();
  descend();
  if (!intersects_) consider_all();
  return intersects_ ? contact_pair() : best_;
}

/// Projects a point from one surface to the other and back, until the distance no longer decreases.
void NearestPairSearch::guess_by_projection() {
  Vec3d point;
  for (int axis = 0; axis < 3; ++axis)
    point[axis] = (double{a_->box.min[axis]} + double{a_->box.max[axis]}) / 2;
  if (!is_finite(point)) point = a_->corners(0)[0];
  if (!is_finite(point)) return;
  constexpr int most = 6;
  TrianglePair triangles;
  double last = any_distance;
  for (int i = 0; i < most; ++i) {
    const QueriedObject& onto = i % 2 == 0 ? *b_ : *a_;
    queries_.start(stop_);
    const auto nearest = queries_.nearest(std::span(&onto, 1), point, any_distance);
    if (!nearest) return;
    (i % 2 == 0 ? triangles.b : triangles.a) = nearest->triangle;
    const ElementDistance closest = *distance_within(nearest->elements(), any_distance, used_exact_);
    if (i > 1 && !(closest.distance < last)) break;
    if (i > 0) last = closest.distance;
    point = closest.point_b;
    if (!is_finite(point)) return;
  }
  decide(triangles);
}

void NearestPairSearch::descend() {
  const auto children = [](const QueriedObject& object, std::uint32_t node) {
    return int{object.view.nodes[node].child_count};
  };
  if (a_->view.nodes.empty() || b_->view.nodes.empty()) return;
  expand(0, 0, children(*a_, 0), 0, 0, children(*b_, 0));
  while (!stack_.empty() && !is_done()) {
    const Entry entry = stack_.back();
    stack_.pop_back();
    if (!(entry.square <= squared_limit_) || are_apart(entry)) continue;
    const OctreeNode &node_a = a_->view.nodes[entry.node_a], &node_b = b_->view.nodes[entry.node_b];
    const bool is_inner_a = node_a.is_inner(entry.child_a), is_inner_b = node_b.is_inner(entry.child_b);
    if (!is_inner_a && !is_inner_b) {
      test_leaves(entry);
      continue;
    }
    const std::uint32_t next_a = is_inner_a ? node_a.child_node(entry.child_a) : entry.node_a,
                        next_b = is_inner_b ? node_b.child_node(entry.child_b) : entry.node_b;
    expand(next_a, is_inner_a ? 0 : entry.child_a, is_inner_a ? children(*a_, next_a) : entry.child_a + 1,
           next_b, is_inner_b ? 0 : entry.child_b, is_inner_b ? children(*b_, next_b) : entry.child_b + 1);
  }
}

/// Whether the bound excludes an entry, unless it is the one that did not when the entry was pushed.
bool NearestPairSearch::are_apart(const Entry& entry) const {
  if (!bound_.is_set() || entry.version == bound_.version()) return false;
  const QueryBox box_a = a_->child_box(entry.node_a, entry.child_a),
                 box_b = b_->child_box(entry.node_b, entry.child_b);
  return bound_.are_apart(box_a, bound_.depth(NearestBound::a, box_a), box_b,
                          bound_.depth(NearestBound::b, box_b));
}

/// Pushes the pairs of children within the limit, the nearest last.
void NearestPairSearch::expand(std::uint32_t node_a, int first_a, int end_a, std::uint32_t node_b,
                               int first_b, int end_b) {
  const std::size_t first = stack_.size();
  const ChildBoxes &boxes_a = a_->view.boxes[node_a], &boxes_b = b_->view.boxes[node_b];
  const bool needs_placed = bound_.is_set() || a_->fine_boxes != nullptr || b_->fine_boxes != nullptr;
  std::array<QueryBox, node_width> placed_b;
  std::array<double, node_width> depths_b{};
  for (int k = first_b; needs_placed && k < end_b; ++k) {
    const auto place = static_cast<std::size_t>(k);
    placed_b[place] = b_->child_box(node_b, k);
    if (bound_.is_set()) depths_b[place] = bound_.depth(NearestBound::b, placed_b[place]);
  }
  for (int i = first_a; i < end_a; ++i) {
    const Aabb box = child_box(boxes_a, i);
    if (box.empty()) continue;
    const QueryBox placed = needs_placed ? a_->child_box(node_a, i) : QueryBox{};
    const double depth_a = bound_.is_set() ? bound_.depth(NearestBound::a, placed) : 0;
    std::array<float, node_width> squares;
    squared_distances_of(box, placed, node_b, first_b, end_b, placed_b, squares);
    for (int k = first_b; k < end_b; ++k) {
      const auto place = static_cast<std::size_t>(k);
      if (!(squares[place] <= squared_limit_) || child_box(boxes_b, k).empty()) continue;
      if (bound_.is_set() && bound_.are_apart(placed, depth_a, placed_b[place], depths_b[place])) continue;
      const double depth = depth_a + depths_b[place];
      stack_.push_back({squares[place], depth == depth ? static_cast<float>(depth) : 0, node_a, node_b, i, k,
                        bound_.is_set() ? bound_.version() : 0});
    }
  }
  std::sort(stack_.begin() + static_cast<std::ptrdiff_t>(first), stack_.end(),
            [](const Entry& p, const Entry& q) {
              return std::tie(q.square, q.depth, q.child_a, q.child_b) <
                     std::tie(p.square, p.depth, p.child_a, p.child_b);
            });
}

/// The squared distances of a box of a and the children of a node of b, as `squared_distances` bounds them.
void NearestPairSearch::squared_distances_of(const Aabb& box, const QueryBox& placed, std::uint32_t node_b,
                                             int first, int end, std::span<const QueryBox> placed_b,
                                             std::array<float, node_width>& squares) const {
  if (a_->fine_boxes == nullptr && b_->fine_boxes == nullptr)
    return squared_distances(seen_by_b(box), b_->view.boxes[node_b], squares);
  for (auto k = static_cast<std::size_t>(first); k < static_cast<std::size_t>(end); ++k)
    squares[k] = static_cast<float>(squared_gap(placed, placed_b[k]));
}

void NearestPairSearch::test_leaves(const Entry& leaves) {
  const OctreeNode &node_a = a_->view.nodes[leaves.node_a], &node_b = b_->view.nodes[leaves.node_b];
  const std::uint32_t leaf_a = node_width * leaves.node_a + static_cast<std::uint32_t>(leaves.child_a),
                      leaf_b = node_width * leaves.node_b + static_cast<std::uint32_t>(leaves.child_b);
  const std::uint32_t end_a = node_a.first_triangle[leaves.child_a + 1],
                      end_b = node_b.first_triangle[leaves.child_b + 1];
  const Aabb box_a = seen_by_b(child_box(a_->view.boxes[leaves.node_a], leaves.child_a)),
             box_b = seen_by_a(child_box(b_->view.boxes[leaves.node_b], leaves.child_b));
  const QueryBox placed_a = a_->child_box(leaves.node_a, leaves.child_a),
                 placed_b = b_->child_box(leaves.node_b, leaves.child_b);
  for (std::uint32_t begin_a = node_a.first_triangle[leaves.child_a]; begin_a < end_a;
       begin_a += leaf_block) {
    // A copy, because the next call may overwrite it.
    const LeafBoxes boxes_a = recent_.block_of(0, a_->leaves(), leaf_a, begin_a,
                                               std::min(begin_a + leaf_block, end_a), load_leaf_boxes);
    const std::uint64_t all_near_a = near_triangles(box_b, boxes_a, squared_limit_);
    if (all_near_a == 0) continue;
    for (std::uint32_t begin_b = node_b.first_triangle[leaves.child_b]; begin_b < end_b;
         begin_b += leaf_block) {
      const LeafBoxes& boxes_b = recent_.block_of(1, b_->leaves(), leaf_b, begin_b,
                                                  std::min(begin_b + leaf_block, end_b), load_leaf_boxes);
      std::uint64_t near_a = all_near_a, near_b = near_triangles(box_a, boxes_b, squared_limit_);
      if (near_b == 0) continue;
      if (bound_.is_set()) {
        if (are_known_excluded(begin_a, near_a, begin_b, near_b)) continue;
        keep_near(begin_a, near_a, begin_b, near_b);
      }
      near_a = within_limit(*a_, begin_a, near_a, placed_b);
      near_b = within_limit(*b_, begin_b, near_b, placed_a);
      if (near_a != 0 && near_b != 0) test_blocks(boxes_a, near_a, begin_a, boxes_b, near_b, begin_b);
      if (is_done()) return;
    }
  }
}

/// Those triangles of a block that may be within the limit of a box, where the box is small with respect to
/// the limit: single precision hardly tells their distances apart.
std::uint64_t NearestPairSearch::within_limit(const QueriedObject& object, std::uint32_t begin,
                                              std::uint64_t triangles, const QueryBox& box) const {
  constexpr int many = 8;
  Vec3d middle, half;
  for (int axis = 0; axis < 3; ++axis) {
    middle[axis] = 0.5 * box.min[axis] + 0.5 * box.max[axis];
    half[axis] = std::max(box.max[axis] - middle[axis], middle[axis] - box.min[axis]);
  }
  const double radius = scaled_norm(half) * (1 + 0x1p-40);
  if (!(8 * radius < limit_) || !std::isfinite(limit_) || std::popcount(triangles) < many) return triangles;
  std::array<double, leaf_block> lower, upper;
  const TriangleList list(begin, triangles);
  bound_distances({&middle, 1}, {object.view.arrays, object.view.translation}, list.all(), lower.data(),
                  upper.data());
  return list.keep([&](std::size_t i) { return !(lower[i] * (1 - 0x1p-40) - radius > limit_); });
}

/// Keeps those triangles of two blocks that are not certainly farther apart than the nearest features from
/// all of the other block.
void NearestPairSearch::keep_near(std::uint32_t begin_a, std::uint64_t& near_a, std::uint32_t begin_b,
                                  std::uint64_t& near_b) const {
  const TriangleList list_a(begin_a, near_a), list_b(begin_b, near_b);
  std::array<double, leaf_block> depths_a, depths_b;
  const auto least_of = [&](NearestBound::Side side, const QueriedObject& object, const TriangleList& list,
                            std::array<double, leaf_block>& depths) {
    const SupportPlane& plane = bound_.plane(side);
    bound_depths(plane.origin, plane.normal, {object.view.arrays, object.view.translation}, list.all(),
                 depths.data());
    return *std::min_element(depths.begin(), depths.begin() + list.all().size());
  };
  const double least_a = least_of(NearestBound::a, *a_, list_a, depths_a),
               least_b = least_of(NearestBound::b, *b_, list_b, depths_b);
  near_a = list_a.keep([&](std::size_t i) { return !(depths_a[i] + least_b > 0); });
  near_b = list_b.keep([&](std::size_t i) { return !(least_a + depths_b[i] > 0); });
}

void NearestPairSearch::test_blocks(const LeafBoxes& boxes_a, std::uint64_t near_a, std::uint32_t begin_a,
                                    const LeafBoxes& boxes_b, std::uint64_t near_b, std::uint32_t begin_b) {
  for (std::uint64_t left_a = near_a; left_a != 0; left_a &= left_a - 1) {
    const auto i = static_cast<std::uint32_t>(std::countr_zero(left_a));
    // A contact of this triangle would come after the first one so far.
    if (intersects_ && a_->triangle_ids[triangles_.a] < a_->triangle_ids[begin_a + i]) continue;
    const Aabb box_a = seen_by_b(boxes_a.box(i));
    for (std::uint64_t left_b = near_triangles(box_a, boxes_b, squared_limit_) & near_b; left_b != 0;
         left_b &= left_b - 1) {
      const auto k = static_cast<std::uint32_t>(std::countr_zero(left_b));
      if (bound_.is_set()) {
        find_depths(NearestBound::a, begin_a, near_a, block_a_);
        find_depths(NearestBound::b, begin_b, near_b, block_b_);
        if (are_excluded(block_a_.all, block_b_.all)) {
          for (const NearestBound::Side side : {NearestBound::a, NearestBound::b}) {
            excluded_[side].resize((side == NearestBound::a ? *a_ : *b_).triangles.size() / 8 + 1);
            const BlockSummary& all = (side == NearestBound::a ? block_a_ : block_b_).all;
            excluded_[side][all.begin / 8] = all;
          }
          return;
        }
        if (block_a_.least[i] + block_b_.least[k] > 0 ||
            bound_.excludes(block_a_.depths[i], NearestBound::all_corners, block_b_.depths[k],
                            NearestBound::all_corners))
          continue;
      }
      decide({begin_a + i, begin_b + k});
      if (is_done()) return;
    }
  }
}

/// Whether none of the triangles of two blocks gives a better pair, also when many are at one place.
bool NearestPairSearch::are_excluded(const BlockSummary& a, const BlockSummary& b) const {
  if (a.least + b.least > 0) return true;
  return a.least >= 0 && b.least >= 0 && bound_.excludes_equal(a.level, b.level);
}

/// The same without a look at the triangles, for blocks that were excluded before.
bool NearestPairSearch::are_known_excluded(std::uint32_t begin_a, std::uint64_t near_a, std::uint32_t begin_b,
                                           std::uint64_t near_b) const {
  if (excluded_[0].size() <= begin_a / 8 || excluded_[1].size() <= begin_b / 8) return false;
  const BlockSummary &a = excluded_[0][begin_a / 8], &b = excluded_[1][begin_b / 8];
  return a.is_known(begin_a, near_a, bound_.version()) && b.is_known(begin_b, near_b, bound_.version()) &&
         are_excluded(a, b);
}

void NearestPairSearch::find_depths(NearestBound::Side side, std::uint32_t begin, std::uint64_t triangles,
                                    BlockDepths& block) {
  if (block.all.is_known(begin, triangles, bound_.version())) return;
  block.all = {begin, triangles, bound_.version(), std::numeric_limits<double>::infinity(), {}};
  TriangleLevel& least = block.all.level;
  least.name.fill(std::numeric_limits<std::uint32_t>::max());
  const QueriedObject& object = side == NearestBound::a ? *a_ : *b_;
  for (std::uint64_t left = triangles; left != 0; left &= left - 1) {
    const auto i = static_cast<std::uint32_t>(std::countr_zero(left));
    block.depths[i] = bound_.depths(side, object, begin + i);
    block.least[i] = block.depths[i].least(NearestBound::all_corners);
    const TriangleLevel& level = block.depths[i].level;
    block.all.least = std::min(block.all.least, block.least[i]);
    least.is_in_feature = least.is_in_feature && level.is_in_feature;
    least.name = std::min(least.name, level.name);
    least.least_vertex = std::min(least.least_vertex, level.least_vertex);
  }
}

/// The first point of the first contact.
ProximityPair NearestPairSearch::contact_pair() const {
  const TrianglePoints a = a_->corners(triangles_.a), b = b_->corners(triangles_.b);
  const TriangleIntersection shared = intersect_triangles(a, b);
  const ContactPoint& point = shared.points[0];
  const auto ids = [](const Feature& feature, const QueriedObject& object, std::uint32_t triangle) {
    const FeatureName name = name_of(feature, object.triangles[triangle], object.triangle_ids[triangle]);
    return std::array{name.first, name.last};
  };
  return {a_->id,
          b_->id,
          point.on_a.kind,
          point.on_b.kind,
          ids(point.on_a, *a_, triangles_.a),
          ids(point.on_b, *b_, triangles_.b),
          {point.on_a.kind, 0},
          {point.on_b.kind, 0},
          0,
          weights_at(point.position, point.on_a, a, a_->triangles[triangles_.a]),
          weights_at(point.position, point.on_b, b, b_->triangles[triangles_.b]),
          point.position,
          point.position,
          shared.normal};
}

}  // namespace supple
