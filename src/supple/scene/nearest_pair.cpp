#include "scene/nearest_pair.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <tuple>

#include "contact/triangle_intersection.hpp"
#include "core/float_rounding.hpp"
#include "geometry/aabb.hpp"
#include "geometry/vector.hpp"
#include "scene/feature_name.hpp"

namespace supple {
namespace {

PairName name_of(const ProximityPair& pair) {
  return {pair.kind_a, pair.kind_b, pair.element_a, pair.element_b};
}

/// Whether the boxes of some points are farther apart than `distance`.
bool boxes_apart(std::span<const Vec3d> a, std::span<const Vec3d> b, double distance) {
  double square = 0;
  for (int axis = 0; axis < 3; ++axis) {
    double low_a = a[0][axis], high_a = low_a, low_b = b[0][axis], high_b = low_b;
    for (const Vec3d& p : a) {
      low_a = std::min(low_a, p[axis]);
      high_a = std::max(high_a, p[axis]);
    }
    for (const Vec3d& p : b) {
      low_b = std::min(low_b, p[axis]);
      high_b = std::max(high_b, p[axis]);
    }
    const double gap = std::max({low_a - high_b, low_b - high_a, 0.0});
    if (gap > distance * (1 + 0x1p-50)) return true;
    square += gap * gap;
  }
  return square > distance * distance * (1 + 0x1p-48) + 0x1p-1040;
}

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

}  // namespace

void NearestPairSearch::start(const QueriedObject& a, const QueriedObject& b, Search search,
                              double max_distance) {
  a_ = &a;
  b_ = &b;
  search_ = search;
  recent_.clear();
  queries_.start();
  intersects_ = false;
  best_.reset();
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

PointBounds NearestPairSearch::seen(const Aabb& box, double direction) const {
  constexpr float most = std::numeric_limits<float>::max();
  PointBounds bounds;
  for (int axis = 0; axis < 3; ++axis) {
    const double offset = direction * offset_[axis];
    // Always a step outwards, which is faster than `round_down` and `round_up`.
    const float low = std::min(static_cast<float>(box.min[axis] + offset - slop_[axis]), most),
                high = std::max(static_cast<float>(box.max[axis] + offset + slop_[axis]), -most);
    bounds.low[axis] = low - outward_step(low);
    bounds.high[axis] = high + outward_step(high);
  }
  return bounds;
}

bool NearestPairSearch::any_contact(const QueriedObject& a, const QueriedObject& b) {
  start(a, b, Search::any_contact, 0);
  descend();
  return intersects_;
}

std::optional<ProximityPair> NearestPairSearch::nearest(const QueriedObject& a, const QueriedObject& b,
                                                        double max_distance,
                                                        std::optional<TrianglePair> guess) {
  start(a, b, Search::nearest, max_distance);
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
  if (!is_finite(point)) return;
  constexpr int most = 6;
  TrianglePair triangles;
  double last = any_distance;
  for (int i = 0; i < most; ++i) {
    const QueriedObject& onto = i % 2 == 0 ? *b_ : *a_;
    queries_.start();
    const auto closest = queries_.closest(std::span(&onto, 1), point, any_distance);
    if (!closest) return;
    (i % 2 == 0 ? triangles.b : triangles.a) = queries_.last_nearest_triangle();
    if (i > 1 && !(closest->distance < last)) break;
    if (i > 0) last = closest->distance;
    point = closest->point;
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
    if (!(entry.square <= squared_limit_)) continue;
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

/// Pushes the pairs of children within the limit, the nearest last.
void NearestPairSearch::expand(std::uint32_t node_a, int first_a, int end_a, std::uint32_t node_b,
                               int first_b, int end_b) {
  const std::size_t first = stack_.size();
  const ChildBoxes &boxes_a = a_->view.boxes[node_a], &boxes_b = b_->view.boxes[node_b];
  for (int i = first_a; i < end_a; ++i) {
    const Aabb box = child_box(boxes_a, i);
    if (box.empty()) continue;
    std::array<float, node_width> squares;
    squared_distances(seen_by_b(box), boxes_b, squares);
    for (int k = first_b; k < end_b; ++k) {
      const float square = squares[static_cast<std::size_t>(k)];
      if (square <= squared_limit_ && !child_box(boxes_b, k).empty())
        stack_.push_back({square, node_a, node_b, i, k});
    }
  }
  std::sort(stack_.begin() + static_cast<std::ptrdiff_t>(first), stack_.end(),
            [](const Entry& p, const Entry& q) {
              return std::tie(q.square, q.child_a, q.child_b) < std::tie(p.square, p.child_a, p.child_b);
            });
}

void NearestPairSearch::test_leaves(const Entry& leaves) {
  const OctreeNode &node_a = a_->view.nodes[leaves.node_a], &node_b = b_->view.nodes[leaves.node_b];
  const std::uint32_t leaf_a = node_width * leaves.node_a + static_cast<std::uint32_t>(leaves.child_a),
                      leaf_b = node_width * leaves.node_b + static_cast<std::uint32_t>(leaves.child_b);
  const std::uint32_t end_a = node_a.first_triangle[leaves.child_a + 1],
                      end_b = node_b.first_triangle[leaves.child_b + 1];
  const PointBounds box_a = seen_by_b(child_box(a_->view.boxes[leaves.node_a], leaves.child_a)),
                    box_b = seen_by_a(child_box(b_->view.boxes[leaves.node_b], leaves.child_b));
  for (std::uint32_t begin_a = node_a.first_triangle[leaves.child_a]; begin_a < end_a;
       begin_a += leaf_block) {
    // A copy, because the next call may overwrite it.
    const LeafBoxes boxes_a =
        recent_.boxes_of(0, a_->leaves(), leaf_a, begin_a, std::min(begin_a + leaf_block, end_a));
    const std::uint64_t near_a = near_triangles(box_b, boxes_a, squared_limit_);
    if (near_a == 0) continue;
    for (std::uint32_t begin_b = node_b.first_triangle[leaves.child_b]; begin_b < end_b;
         begin_b += leaf_block) {
      const LeafBoxes& boxes_b =
          recent_.boxes_of(1, b_->leaves(), leaf_b, begin_b, std::min(begin_b + leaf_block, end_b));
      const std::uint64_t near_b = near_triangles(box_a, boxes_b, squared_limit_);
      if (near_b != 0) test_blocks(boxes_a, near_a, begin_a, boxes_b, near_b, begin_b);
      if (is_done()) return;
    }
  }
}

void NearestPairSearch::test_blocks(const LeafBoxes& boxes_a, std::uint64_t near_a, std::uint32_t begin_a,
                                    const LeafBoxes& boxes_b, std::uint64_t near_b, std::uint32_t begin_b) {
  // Two triangles are not nearer than their projections to the direction between the nearest features so far.
  // Laterally, their boxes are a good bound; together few pairs are left.
  Projections along_a, along_b;
  const bool has_direction = best_ && !intersects_ && best_->distance > 0;
  if (has_direction) {
    along_a = project(*a_, begin_a, near_a, 1);
    along_b = project(*b_, begin_b, near_b, -1);
  }
  for (std::uint64_t left_a = near_a; left_a != 0; left_a &= left_a - 1) {
    const auto i = static_cast<std::uint32_t>(std::countr_zero(left_a));
    const PointBounds box_a = seen_by_b({{boxes_a.min_x[i], boxes_a.min_y[i], boxes_a.min_z[i]},
                                         {boxes_a.max_x[i], boxes_a.max_y[i], boxes_a.max_z[i]}});
    for (std::uint64_t left_b = near_triangles(box_a, boxes_b, squared_limit_) & near_b; left_b != 0;
         left_b &= left_b - 1) {
      const auto k = static_cast<std::uint32_t>(std::countr_zero(left_b));
      if (has_direction && along_a.least[i] + along_b.least[k] > limit_) continue;
      decide({begin_a + i, begin_b + k});
      if (is_done()) return;
    }
  }
}

/// For each triangle a lower bound of its coordinates along `sign` times the direction from b to a, from the
/// middle between the nearest features so far.
NearestPairSearch::Projections NearestPairSearch::project(const QueriedObject& object, std::uint32_t begin,
                                                          std::uint64_t triangles, double sign) const {
  const Vec3d middle = 0.5 * (best_->point_a + best_->point_b);
  Projections result;
  for (std::uint64_t left = triangles; left != 0; left &= left - 1) {
    const auto i = static_cast<std::uint32_t>(std::countr_zero(left));
    double least = any_distance, size = 0;
    for (const Vec3d& corner : object.corners(begin + i)) {
      const Vec3d from_middle = corner - middle;
      least = std::min(least, sign * dot(from_middle, best_->normal));
      size = std::max(size, largest_magnitude(from_middle));
    }
    // More than the roundings of the difference, the product and the direction.
    result.least[i] = least - 0x1p-48 * size;
  }
  return result;
}

void NearestPairSearch::decide(TrianglePair triangles) {
  const TrianglePoints a = a_->corners(triangles.a), b = b_->corners(triangles.b);
  const auto ids_of = [&](TrianglePair pair) {
    return std::pair(a_->triangle_ids[pair.a], b_->triangle_ids[pair.b]);
  };
  if (!boxes_apart(a, b, 0)) {
    if (intersects_ && search_ == Search::nearest && ids_of(triangles_) < ids_of(triangles)) return;
    if (triangles_intersect(a, b)) {
      intersects_ = true;
      triangles_ = triangles;
      set_limit(0);
      return;
    }
  }
  if (!intersects_ && search_ == Search::nearest) decide_elements(triangles, a, b);
}

/// Considers the vertices and faces and the edges of two triangles that do not intersect.
void NearestPairSearch::decide_elements(TrianglePair triangles, const TrianglePoints& a,
                                        const TrianglePoints& b) {
  const Triangle &vertices_a = a_->triangles[triangles.a], &vertices_b = b_->triangles[triangles.b];
  const auto vertex = [](const Triangle& vertices, const TrianglePoints& corners, std::size_t i) {
    return PairElement(std::span(&vertices[i], 1), {corners[i]}, 0);
  };
  const auto edge = [](const Triangle& vertices, const TrianglePoints& corners, std::size_t i) {
    const std::size_t k = (i + 1) % 3;
    return PairElement(std::array{vertices[i], vertices[k]}, {corners[i], corners[k]}, 0);
  };
  const auto face = [](const QueriedObject& object, std::uint32_t triangle, const TrianglePoints& corners) {
    return PairElement(object.triangles[triangle], corners, object.triangle_ids[triangle]);
  };
  // Most pairs of elements are farther apart than the limit along the direction between the nearest ones.
  std::array<double, 3> along_a{}, along_b{};
  const Vec3d middle = best_ ? 0.5 * (best_->point_a + best_->point_b) : Vec3d{};
  const Vec3d normal = best_ ? best_->normal : Vec3d{};
  double size = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    along_a[i] = dot(a[i] - middle, normal);
    along_b[i] = dot(b[i] - middle, normal);
    size = std::max({size, largest_magnitude(a[i] - middle), largest_magnitude(b[i] - middle)});
  }
  const double slack = 0x1p-47 * size;
  const auto are_apart = [&](double least_a, double most_b) { return least_a - most_b - slack > limit_; };
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t next = (i + 1) % 3;
    const std::array edge_a{a[i], a[next]};
    if (!are_apart(along_a[i], std::max({along_b[0], along_b[1], along_b[2]})) &&
        !boxes_apart(std::span(&a[i], 1), b, limit_))
      add({vertex(vertices_a, a, i), face(*b_, triangles.b, b), PairOrder::given, triangles});
    if (!are_apart(std::min({along_a[0], along_a[1], along_a[2]}), along_b[i]) &&
        !boxes_apart(std::span(&b[i], 1), a, limit_))
      add({vertex(vertices_b, b, i), face(*a_, triangles.a, a), PairOrder::swapped, triangles});
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t after = (k + 1) % 3;
      if (!are_apart(std::min(along_a[i], along_a[next]), std::max(along_b[k], along_b[after])) &&
          !boxes_apart(edge_a, std::array{b[k], b[after]}, limit_))
        add({edge(vertices_a, a, i), edge(vertices_b, b, k), PairOrder::given, triangles});
    }
  }
}

void NearestPairSearch::add(const ElementCandidate& candidate) {
  Candidates& list = candidate.first.count == 1 ? vertices_and_faces_ : edges_;
  const ElementPoints elements = points_of(candidate.first, candidate.second);
  for (std::size_t i = 0; i < 4; ++i) list.block.set(i, list.count, elements.points[i]);
  list.candidates[list.count++] = candidate;
  if (list.count == PointsBlock::capacity) consider(list);
}

void NearestPairSearch::consider_all() {
  consider(vertices_and_faces_);
  consider(edges_);
}

/// Considers those that the kernel does not exclude.
void NearestPairSearch::consider(Candidates& list) {
  const bool are_edges = &list == &edges_;
  std::array<FeatureCode, PointsBlock::capacity> codes;
  classify(list.block, list.count, are_edges, limit_, codes.data());
  for (std::size_t i = 0; i < list.count; ++i) {
    if (codes[i] == FeatureCode::apart) continue;
    const ElementCandidate& candidate = list.candidates[i];
    // Most of the others have the nearest features again, which several triangles share.
    const bool is_known =
        codes[i] != FeatureCode::unknown && best_ &&
        name_of_pair(candidate.first, candidate.second, features_of_code(codes[i], are_edges),
                     candidate.order, ProximityListing::features) == name_of(*best_);
    if (!is_known) consider(candidate);
  }
  list.count = 0;
}

void NearestPairSearch::consider(const ElementCandidate& candidate) {
  const auto& [first, second, order, triangles] = candidate;
  const auto pair = proximity_pair_within(first, second, {a_->id, b_->id}, order, ProximityListing::features,
                                          limit_, used_exact_);
  if (!pair) return;
  const ElementPoints elements = points_of(first, second);
  if (best_) {
    const bool is_same = name_of(*pair) == name_of(*best_);
    const int side = is_same ? 0 : compare_distances(elements, best_elements_, used_exact_);
    if (side > 0 || (side == 0 && name_of(*best_) <= name_of(*pair))) return;
  }
  best_ = pair;
  best_elements_ = elements;
  triangles_ = triangles;
  set_limit(std::min(limit_, pair->distance * (1 + 0x1p-36) + 0x1p-1060));
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
