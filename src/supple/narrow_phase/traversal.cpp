#include "narrow_phase/traversal.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "core/float_rounding.hpp"
#include "geometry/aabb.hpp"
#include "octree/comparison_methods.hpp"

namespace supple {
namespace {

/// Bounds of the ways of the vertices of a child.
Aabb way_of(const OctreeView& view, std::uint32_t node, int child) {
  const Aabb at_rest{{0, 0, 0}, {0, 0, 0}};
  const Aabb way = view.ways != nullptr ? child_box(view.ways[node], child) : at_rest;
  return way.empty() ? at_rest : way;
}

/// A bound of the length of two vertices' largest approach; with `any_parts` of the sum of their ways.
double largest_approach(const Aabb& way_a, const Aabb& way_b, bool any_parts) {
  double square = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto longest = [&](const Aabb& way) {
      return std::max(std::fabs(double{way.min[axis]}), std::fabs(double{way.max[axis]}));
    };
    const double most = any_parts ? longest(way_a) + longest(way_b)
                                  : std::max(std::fabs(double{way_a.max[axis]} - way_b.min[axis]),
                                             std::fabs(double{way_a.min[axis]} - way_b.max[axis]));
    square += most * most;
  }
  return std::sqrt(square) * (1 + 0x1p-40);
}

/// The boxes of two children: that of a at the start and at the end, and that of b.
std::array<Aabb, 4> boxes_in_motion(const ObjectPairView& pair, const ChildPair& children) {
  const auto& [a, b, i, j] = children;
  return {child_box(pair.a.moving.start[a], i), child_box(pair.a.moving.end[a], i),
          child_box(pair.b.moving.start[b], j), child_box(pair.b.moving.end[b], j)};
}

/// Distances from a to b along an axis, above and below; negative where they overlap.
std::array<double, 2> gaps(const Aabb& a, const Aabb& b, int axis, double offset_of_b) {
  return {b.min[axis] + offset_of_b - a.max[axis], a.min[axis] - offset_of_b - b.max[axis]};
}

/// The middle one of the sizes along the axes.
double middle_size(const Aabb& box) {
  const double x = double{box.max.x} - box.min.x, y = double{box.max.y} - box.min.y,
               z = double{box.max.z} - box.min.z;
  return std::max(std::min(x, y), std::min(std::max(x, y), z));
}

/// A time before which two children stay farther apart along an axis than the separation; later than 1 when
/// in the whole step. The gaps between their boxes and the separation are linear in time. Gaps take a few
/// roundings of 2^-53 of the coordinates' magnitudes, for which 2^-50 of their sum has room.
///
/// With `any_parts`, the boxes at the start count. The separation is s + W / (1 - keep), where W is the sum
/// of both ways. Elements at a larger distance keep enough of it. The others keep at most s + keep W / (1 -
/// keep), which is W less than the separation. So the gap must be that, plus what both move towards each
/// other along the axis.
double first_time_near(const ObjectPairView& pair, const ChildPair& children) {
  constexpr double never = 2;
  const auto [a0, a1, b0, b1] = boxes_in_motion(pair, children);
  if (a0.empty() || b0.empty()) return never;
  const auto size_of = [](const Aabb& a, const Aabb& b, int axis) {
    return std::fabs(double{a.min[axis]}) + std::fabs(double{a.max[axis]}) + std::fabs(double{b.min[axis]}) +
           std::fabs(double{b.max[axis]});
  };
  double time = 0, approach = -1;
  Aabb way_a, way_b;
  for (int axis = 0; axis < 3; ++axis) {
    const double offset = pair.placement.offset[axis];
    const std::array<double, 2> starts = gaps(a0, b0, axis, offset);
    const std::size_t side = starts[0] > starts[1] ? 0 : 1;
    if (!(starts[side] > pair.separation)) continue;
    if (approach < 0 && pair.kept_share > 0) {
      way_a = way_of(pair.a, children.node_a, children.child_a);
      way_b = way_of(pair.b, children.node_b, children.child_b);
      approach = largest_approach(way_a, way_b, pair.any_parts);
    }
    double wanted = (pair.growth + pair.kept_share * approach) * (1 + 0x1p-20);
    if (pair.any_parts) {
      const double towards = side == 0
                                 ? std::max(way_a.max[axis], 0.0f) + std::max(-double{way_b.min[axis]}, 0.0)
                                 : std::max(-double{way_a.min[axis]}, 0.0) + std::max(way_b.max[axis], 0.0f);
      wanted -= (1 - 0x1p-20) * std::max(approach * (1 - 0x1p-20) - towards, 0.0);
    }
    const double gap_at_end = pair.any_parts ? starts[side] : gaps(a1, b1, axis, offset)[side];
    const double size_at_end = size_of(a1, b1, axis);
    const double least =
        pair.separation + 0x1p-50 * (size_of(a0, b0, axis) + size_at_end + std::fabs(offset));
    const double at_start = starts[side] - least, at_end = gap_at_end - least - wanted;
    if (!(at_start > 0)) continue;
    if (at_end > 0) return never;
    // A bound at the end of the range of float may be farther out.
    if (size_at_end < std::numeric_limits<float>::max())
      time = std::max(time, at_start / (at_start - at_end) * (1 - 0x1p-40));
  }
  return time;
}

/// Bits of children that may come near, by the separation of their nodes, which is enough for all children.
std::uint64_t mask_of_nodes(const ObjectPairView& pair, const NodePair& nodes) {
  std::uint64_t near = ~std::uint64_t{0};
  PartOfStep part = pair.part_of_step();
  if (pair.kept_share > 0) {
    if (nodes.a == 0 || nodes.b == 0) return near;
    const OctreeNode &a = pair.a.nodes[nodes.a], &b = pair.b.nodes[nodes.b];
    part = pair.part_until({a.parent, b.parent, a.index_in_parent, b.index_in_parent}, part.latest);
  }
  moving_overlap_masks({&nodes, 1}, pair.a.moving, pair.b.moving, part, &near);
  return near;
}

std::uint8_t child_bit(int child) {
  return static_cast<std::uint8_t>(1u << child);
}

std::uint64_t count_of_tests(const ObjectPairView& pair, const NodePair& nodes) {
  return std::uint64_t{bit_count(nodes.children_a & pair.a.nodes[nodes.a].child_mask())} *
         bit_count(nodes.children_b & pair.b.nodes[nodes.b].child_mask());
}

/// Returns the number of tests.
std::uint64_t test_children(const ObjectPairView& pair, std::span<const NodePair> node_pairs,
                            std::uint64_t* masks) {
  std::uint64_t tests = 0;
  if (!pair.is_moving() && pair.a.descent == Descent::one_side_first) {
    const ComparisonMethods& methods = comparison_methods({});
    for (std::size_t k = 0; k < node_pairs.size(); ++k)
      masks[k] = methods.mask_one_side_first(pair, node_pairs[k], tests);
    return tests;
  }
  for (const NodePair& nodes : node_pairs) tests += count_of_tests(pair, nodes);
  if (pair.is_moving() && pair.kept_share > 0) {
    for (std::size_t k = 0; k < node_pairs.size(); ++k) masks[k] = mask_of_nodes(pair, node_pairs[k]);
  } else if (pair.is_moving()) {
    moving_overlap_masks(node_pairs, pair.a.moving, pair.b.moving, pair.part_of_step(), masks);
  } else {
    const NodeVolumes* const volumes = pair.a.volumes;
    if (volumes != nullptr && volumes->replace_boxes()) {
      std::fill_n(masks, node_pairs.size(), ~std::uint64_t{0});
    } else {
      overlap_masks(node_pairs, pair.a.boxes, pair.b.boxes, pair.placement, masks);
    }
    if (volumes != nullptr) volumes->clear_apart(node_pairs, *pair.b.volumes, pair.placement, masks);
  }
  return tests;
}

/// Bit i to the bits of byte i.
std::uint64_t spread_to_bytes(std::uint32_t bits) {
  const std::uint64_t copies = bits * 0x0101010101010101u;
  const std::uint64_t ones = copies & 0x8040201008040201u;  // one bit of each byte
  return ((ones + 0x7f7f7f7f7f7f7f7fu) >> 7 & 0x0101010101010101u) * 0xffu;
}

/// Calls `visit(i, j)` for each pair of children that is in the mask; for a node with itself only pairs with
/// i <= j. This is one loop over all pairs, because the end of a loop for each i is hard to predict.
template <class Visit>
void for_each_child_pair(const ObjectPairView& pair, NodePair node_pair, std::uint64_t mask, Visit&& visit) {
  const OctreeNode& node_a = pair.a.nodes[node_pair.a];
  const OctreeNode& node_b = pair.b.nodes[node_pair.b];
  mask &= spread_to_bytes(node_pair.children_a & node_a.child_mask());
  mask &= (node_pair.children_b & node_b.child_mask()) * 0x0101010101010101u;
  if (pair.same_object && node_pair.a == node_pair.b) {
    constexpr std::uint64_t upper_half = 0x80c0e0f0f8fcfeffu;
    mask &= upper_half;
    const std::uint32_t culled = pair.a.culled != nullptr ? pair.a.culled[node_pair.a] : 0;
    for (std::uint32_t rest = culled; rest != 0; rest &= rest - 1) {
      mask &= ~(std::uint64_t{1} << 9 * std::countr_zero(rest));
    }
  }
  for (; mask != 0; mask &= mask - 1) {
    const int place = std::countr_zero(mask);
    visit(place >> 3, place & 7);
  }
}

std::uint32_t leaf_number(std::uint32_t node, int child) {
  return node * node_width + static_cast<std::uint32_t>(child);
}

LeafPair leaf_pair(const ObjectPairView& pair, const ChildPair& leaves) {
  const auto& [a, b, i, j] = leaves;
  const OctreeNode &node_a = pair.a.nodes[a], &node_b = pair.b.nodes[b];
  return {node_a.first_triangle[i], node_a.first_triangle[i + 1],
          node_b.first_triangle[j], node_b.first_triangle[j + 1],
          leaf_number(a, i),        leaf_number(b, j)};
}

/// Largest absolute coordinate of the box; 0 when it is empty.
double greatest_coordinate(const Aabb& box) {
  if (box.empty()) return 0;
  double greatest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    greatest = std::max({greatest, std::abs(double{box.min[axis]}), std::abs(double{box.max[axis]})});
  }
  return greatest;
}

/// The volumes are those of the untranslated positions. Seen from a, b's move by the difference of the
/// translations, or a's the other way. The slop covers the sums fl(position + translation) that the exact
/// tests see (2^-53 of their size, in both objects), and where there is a difference, rounding it and the
/// moved coordinates to float (2^-24 of their size each). Below an ulp it still works: rounding is monotonic,
/// so a gap of at most the slop closes.
RelativePlacement place(const OctreeView& a, const OctreeView& b) {
  if (a.translation == Vec3d{} && b.translation == Vec3d{}) return {};
  const Vec3d offset = b.translation - a.translation;
  const auto largest = [](Vec3d v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); };
  const double size_a = greatest_coordinate(a.box), size_b = greatest_coordinate(b.box);
  const double world = std::max(size_a + largest(a.translation), size_b + largest(b.translation));
  const double moved = offset == Vec3d{} ? 0 : std::max(size_a, size_b) + largest(offset);
  return {{static_cast<float>(offset.x), static_cast<float>(offset.y), static_cast<float>(offset.z)},
          round_up(0x1p-21 * moved + 0x1p-50 * world)};
}

}  // namespace

OctreeView view_of(const ObjectOctree& octree, const VertexBuffer& vertices,
                   std::span<const std::uint8_t> inert, Vec3d translation) {
  OctreeView view;
  view.nodes = octree.nodes();
  view.cell_numbers = octree.cell_numbers();
  view.boxes = octree.boxes();
  view.volumes = octree.volumes();
  view.leaf_vertices = octree.leaf_vertices();
  view.arrays = arrays_of(octree.triangles(), vertices, inert);
  view.box = octree.box();
  view.translation = translation;
  return view;
}

OctreeView moving_view_of(const ObjectOctree& octree, const SurfaceElements& elements,
                          const MovingBoxes& boxes, Vec3d translation) {
  OctreeView view;
  view.nodes = octree.nodes();
  view.cell_numbers = octree.cell_numbers();
  view.box = boxes.swept_box();
  view.translation = translation;
  view.moving = boxes.view(elements);
  return view;
}

/// With `at_start`, coordinates of two elements come nearer by at most the approach until then. So elements
/// whose boxes at the start are farther apart than it plus the separation stay apart.
PartOfStep ObjectPairView::part_until(const ChildPair& children, float until) const {
  PartOfStep part{separation, until, placement.offset, kinds, -1};
  const auto has_ways = [](const OctreeView& view) {
    return view.ways != nullptr || view.moving.start == view.moving.end;
  };
  if (!has_ways(a) || !has_ways(b)) {
    part.separation = growth > 0 ? round_up(separation + growth * until) : separation;
    return part;
  }
  const double approach = until * largest_approach(way_of(a, children.node_a, children.child_a),
                                                   way_of(b, children.node_b, children.child_b), any_parts);
  double grown = separation + until * growth + (kept_share > 0 ? kept_share * approach : 0);
  const double size = std::min(middle_size(child_box(a.moving.start[children.node_a], children.child_a)),
                               middle_size(child_box(b.moving.start[children.node_b], children.child_b)));
  constexpr double little = 1.0 / 32;
  part.size = static_cast<float>(size);
  part.at_start = approach <= little * size;
  if (part.at_start) {
    grown += approach;
    part.latest = 1;
  }
  // Beyond the range of float, boxes do not say how far elements are apart.
  constexpr double most = std::numeric_limits<float>::max() / 4;
  grown *= 1 + 0x1p-20;
  part.separation = grown <= most ? round_up(grown) : std::numeric_limits<float>::infinity();
  return part;
}

ObjectPairView pair_of(const OctreeView& a, const OctreeView& b, double separation) {
  const RelativePlacement placement = place(a, b);
  ObjectPairView pair{a, b, placement, &a == &b, round_up(separation + placement.slop), nullptr};
  // Both translations of one object are equal, but rounding may still make close positions touch.
  if (pair.same_object && (separation > 0 || !placement.is_identity())) pair.a.culled = nullptr;
  return pair;
}

bool object_volumes_apart(const ObjectPairView& pair) {
  if (pair.a.nodes.empty() || pair.b.nodes.empty()) return false;
  const NodePair objects{pair.a.volumes->object(), pair.b.volumes->object()};
  std::uint64_t mask = 1;
  pair.a.volumes->clear_apart({&objects, 1}, *pair.b.volumes, pair.placement, &mask);
  return mask == 0;
}

std::optional<NodePair> nodes_below(const ObjectPairView& pair, const ChildPair& children) {
  const OctreeNode &node_a = pair.a.nodes[children.node_a], &node_b = pair.b.nodes[children.node_b];
  const int i = children.child_a, j = children.child_b;
  const bool inner_a = node_a.is_inner(i), inner_b = node_b.is_inner(j);
  if (inner_a && inner_b) return NodePair{node_a.child_node(i), node_b.child_node(j)};
  if (inner_a) return NodePair{node_a.child_node(i), children.node_b, 0xff, child_bit(j)};
  if (inner_b) return NodePair{children.node_a, node_b.child_node(j), child_bit(i), 0xff};
  return std::nullopt;
}

void find_overlapping_children(const ObjectPairView& pair, NodePair node_pair,
                               std::vector<ChildPair>& children) {
  std::uint64_t mask = 0;
  test_children(pair, {&node_pair, 1}, &mask);
  for_each_child_pair(pair, node_pair, mask, [&](int i, int j) {
    children.push_back({node_pair.a, node_pair.b, i, j});
  });
}

void Traversal::expand_batch(const ObjectPairView& pair, TraversalStats& stats) {
  const std::size_t count = std::min(node_batch, stack_.size());
  std::copy(stack_.end() - static_cast<std::ptrdiff_t>(count), stack_.end(), batch_.begin());
  stack_.resize(stack_.size() - count);
  stats.volumes_tested += test_children(pair, {batch_.data(), count}, masks_.data());
  stats.node_pairs_visited += count;
  for (std::size_t k = 0; k < count; ++k) {
    const NodePair node_pair = batch_[k];
    for_each_child_pair(pair, node_pair, masks_[k], [&](int i, int j) {
      if (const auto below = nodes_below(pair, {node_pair.a, node_pair.b, i, j})) {
        stack_.push_back(*below);
      } else {
        leaf_pairs_.push_back(leaf_pair(pair, {node_pair.a, node_pair.b, i, j}));
      }
    });
  }
}

void Traversal::wait(double time, const NodePair& nodes) {
  waiting_.push_back({time, waited_++, nodes});
  std::push_heap(waiting_.begin(), waiting_.end());
}

std::optional<Traversal::LeavesInTime> Traversal::next_leaves(const ObjectPairView& pair,
                                                              TraversalStats& stats) {
  while (!waiting_.empty() && !stop_.stop_requested()) {
    std::pop_heap(waiting_.begin(), waiting_.end());
    const auto [time, number, nodes] = waiting_.back();
    waiting_.pop_back();
    const float latest = pair.latest->load(std::memory_order_relaxed);
    if (time > latest) break;
    const OctreeNode &node_a = pair.a.nodes[nodes.a], &node_b = pair.b.nodes[nodes.b];
    const int i = std::countr_zero(nodes.children_a), j = std::countr_zero(nodes.children_b);
    if (nodes.children_a == child_bit(i) && nodes.children_b == child_bit(j) && !node_a.is_inner(i) &&
        !node_b.is_inner(j)) {
      const ChildPair leaves{nodes.a, nodes.b, i, j};
      const auto [a0, a1, b0, b1] = boxes_in_motion(pair, leaves);
      double approach = 0, size = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const std::array<double, 2> starts = gaps(a0, b0, axis, 0), ends = gaps(a1, b1, axis, 0);
        approach = std::max({approach, std::fabs(ends[0] - starts[0]), std::fabs(ends[1] - starts[1])});
        size = std::max({size, double{a0.max[axis]} - a0.min[axis], double{b0.max[axis]} - b0.min[axis]});
      }
      const double end = time + std::max(time, 0.25 * size / std::max(approach, 1e-300));
      const float until = end < 0.5 && !pair.any_parts ? std::max(round_up(end), least_part_of_step) : 1;
      if (until < latest) wait(until, nodes);
      const float part = std::max(std::min(until, latest), least_part_of_step);
      return LeavesInTime{leaf_pair(pair, leaves), pair.part_until(leaves, part), part};
    }
    stats.volumes_tested += count_of_tests(pair, nodes);
    ++stats.node_pairs_visited;
    for_each_child_pair(pair, nodes, mask_of_nodes(pair, nodes), [&](int child_a, int child_b) {
      const ChildPair children{nodes.a, nodes.b, child_a, child_b};
      const double first = first_time_near(pair, children);
      if (first > latest) return;
      const NodePair leaves{nodes.a, nodes.b, child_bit(child_a), child_bit(child_b)};
      wait(first, nodes_below(pair, children).value_or(leaves));
    });
  }
  return std::nullopt;
}

void Traversal::refine(const ObjectPairView& pair, NodePair node_pair, std::vector<NodePair>& finer) {
  if (pair.a.nodes.empty() || pair.b.nodes.empty()) return;
  std::uint64_t mask = 0;
  test_children(pair, {&node_pair, 1}, &mask);
  const OctreeNode& node_a = pair.a.nodes[node_pair.a];
  const OctreeNode& node_b = pair.b.nodes[node_pair.b];
  for_each_child_pair(pair, node_pair, mask, [&](int i, int j) {
    if (node_a.is_inner(i) && node_b.is_inner(j)) {
      finer.push_back({node_a.child_node(i), node_b.child_node(j)});
    } else {
      finer.push_back({node_pair.a, node_pair.b, child_bit(i), child_bit(j)});
    }
  });
}

}  // namespace supple
