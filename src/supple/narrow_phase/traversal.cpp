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

/// Whether two children stay farther apart along an axis than the separation of the part of the step: on the
/// same side at both ends.
///
/// With `any_parts`, the boxes at the start count. The separation is s + W / (1 - keep), where W is the sum
/// of both ways. Elements at a larger distance keep enough of it. The others keep at most s + keep W / (1 -
/// keep), which is W less than the separation. So the gap must be that, plus what both move towards each
/// other along the axis.
bool stay_apart(const ObjectPairView& pair, const PartOfStep& part, std::uint32_t node_a, int child_a,
                std::uint32_t node_b, int child_b) {
  const Aabb a0 = child_box(pair.a.moving.start[node_a], child_a),
             a1 = child_box(pair.a.moving.end[node_a], child_a),
             b0 = child_box(pair.b.moving.start[node_b], child_b),
             b1 = child_box(pair.b.moving.end[node_b], child_b);
  const Aabb way_a = way_of(pair.a, node_a, child_a), way_b = way_of(pair.b, node_b, child_b);
  const double both_ways = pair.any_parts ? largest_approach(way_a, way_b, true) : 0;
  const auto at_end = [&](float start, float end) {
    return (1 - double{part.latest}) * start + double{part.latest} * end;
  };
  const auto size_of = [](const Aabb& a, const Aabb& b, int axis) {
    return std::fabs(double{a.min[axis]}) + std::fabs(double{a.max[axis]}) + std::fabs(double{b.min[axis]}) +
           std::fabs(double{b.max[axis]});
  };
  for (int axis = 0; axis < 3; ++axis) {
    const double offset = part.offset[axis], size_at_end = size_of(a1, b1, axis);
    // A bound at the end of the range of float may be farther out.
    if (part.latest < 1 && !(size_at_end < std::numeric_limits<float>::max())) continue;
    const double size = size_of(a0, b0, axis) + part.latest * size_at_end + std::fabs(offset);
    const double least = part.separation + 0x1p-50 * size;
    const double above_start = b0.min[axis] + offset - a0.max[axis],
                 above_end = at_end(b0.min[axis], b1.min[axis]) + offset - at_end(a0.max[axis], a1.max[axis]);
    const double below_start = a0.min[axis] - b0.max[axis] - offset,
                 below_end = at_end(a0.min[axis], a1.min[axis]) - at_end(b0.max[axis], b1.max[axis]) - offset;
    if (pair.any_parts) {
      const double to_above = std::max(way_a.max[axis], 0.0f) + std::max(-double{way_b.min[axis]}, 0.0),
                   to_below = std::max(-double{way_a.min[axis]}, 0.0) + std::max(way_b.max[axis], 0.0f);
      const auto least_to = [&](double towards) {
        return least - (1 - 0x1p-20) * part.latest * std::max(both_ways * (1 - 0x1p-20) - towards, 0.0);
      };
      if (above_start > least_to(to_above) || below_start > least_to(to_below)) return true;
    } else if ((above_start > least && above_end > least) || (below_start > least && below_end > least)) {
      return true;
    }
  }
  return false;
}

/// As `moving_overlap_masks`, with a separation of each pair of children.
std::uint64_t masks_of_near_children(const ObjectPairView& pair, const NodePair& nodes) {
  const OctreeNode &a = pair.a.nodes[nodes.a], &b = pair.b.nodes[nodes.b];
  std::uint64_t near = ~std::uint64_t{0};
  if (nodes.a != 0 && nodes.b != 0) {  // the separation of both nodes is enough for all of their children
    const PartOfStep part = pair.part_of_step(a.parent, a.index_in_parent, b.parent, b.index_in_parent);
    moving_overlap_masks({&nodes, 1}, pair.a.moving, pair.b.moving, part, &near);
  }
  const std::uint32_t children_a = nodes.children_a & a.child_mask(),
                      children_b = nodes.children_b & b.child_mask();
  std::uint64_t mask = 0;
  for (; near != 0; near &= near - 1) {
    const int place = std::countr_zero(near), i = place / node_width, j = place % node_width;
    if ((children_a >> i & children_b >> j & 1) == 0) continue;
    if (child_box(pair.a.moving.start[nodes.a], i).empty() ||
        child_box(pair.b.moving.start[nodes.b], j).empty())
      continue;
    if (!stay_apart(pair, pair.part_of_step(nodes.a, i, nodes.b, j), nodes.a, i, nodes.b, j))
      mask |= std::uint64_t{1} << place;
  }
  return mask;
}

std::uint8_t child_bit(int child) {
  return static_cast<std::uint8_t>(1u << child);
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
  for (const NodePair& nodes : node_pairs) {
    tests += std::uint64_t{bit_count(nodes.children_a & pair.a.nodes[nodes.a].child_mask())} *
             bit_count(nodes.children_b & pair.b.nodes[nodes.b].child_mask());
  }
  if (pair.is_moving() && pair.kept_share > 0) {
    for (std::size_t k = 0; k < node_pairs.size(); ++k)
      masks[k] = masks_of_near_children(pair, node_pairs[k]);
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

PartOfStep ObjectPairView::part_of_step(std::uint32_t node_a, int child_a, std::uint32_t node_b,
                                        int child_b) const {
  PartOfStep part = part_of_step();
  if (kept_share == 0) return part;
  const double approach = largest_approach(way_of(a, node_a, child_a), way_of(b, node_b, child_b), any_parts);
  // Beyond the range of float, boxes do not say how far elements are apart.
  constexpr double most = std::numeric_limits<float>::max() / 4;
  const double grown = (part.separation + kept_share * part.latest * approach) * (1 + 0x1p-20);
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
    const OctreeNode& node_a = pair.a.nodes[node_pair.a];
    const OctreeNode& node_b = pair.b.nodes[node_pair.b];
    for_each_child_pair(pair, node_pair, masks_[k], [&](int i, int j) {
      if (const auto below = nodes_below(pair, {node_pair.a, node_pair.b, i, j})) {
        stack_.push_back(*below);
      } else {
        leaf_pairs_.push_back({node_a.first_triangle[i], node_a.first_triangle[i + 1],
                               node_b.first_triangle[j], node_b.first_triangle[j + 1],
                               leaf_number(node_pair.a, i), leaf_number(node_pair.b, j)});
      }
    });
  }
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
