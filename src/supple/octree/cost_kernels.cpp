#include "octree/cost_kernels.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "octree/cost_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <bit>
#include <cstddef>

HWY_BEFORE_NAMESPACE();
namespace supple {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Half the surface of each lane's box, 0 where there is none, and what it costs as a leaf.
HWY_INLINE void set_lane_costs(const OctreeNode& node, const AabbLanes& boxes, double* HWY_RESTRICT areas,
                               double* HWY_RESTRICT costs) {
  const hn::CappedTag<double, node_width> d;
  const hn::Rebind<float, decltype(d)> f;
  const hn::Rebind<std::int32_t, decltype(d)> s;
  const auto extent = [&](const float* low, const float* high) HWY_ATTR {
    const auto length = hn::Sub(hn::PromoteTo(d, hn::LoadU(f, high)), hn::PromoteTo(d, hn::LoadU(f, low)));
    return hn::Max(length, hn::Zero(d));
  };
  const auto* const first = reinterpret_cast<const std::int32_t*>(node.first_triangle);
  for (std::size_t i = 0; i < node_width; i += hn::Lanes(d)) {
    const auto x = extent(boxes.min_x + i, boxes.max_x + i), y = extent(boxes.min_y + i, boxes.max_y + i),
               z = extent(boxes.min_z + i, boxes.max_z + i);
    const auto area = hn::Add(hn::Add(hn::Mul(x, y), hn::Mul(y, z)), hn::Mul(z, x));
    const auto triangles = hn::PromoteTo(d, hn::Sub(hn::LoadU(s, first + i + 1), hn::LoadU(s, first + i)));
    const auto visits = hn::Add(hn::Set(d, 1), hn::Mul(hn::Set(d, visits_a_triangle), triangles));
    hn::StoreU(area, d, areas + i);
    hn::StoreU(hn::Mul(area, visits), d, costs + i);
  }
}

/// Children come after their parents.
void AddUpCosts(const TreeBoxes& tree, NodeCost* costs) {
  for (auto n = static_cast<std::uint32_t>(tree.nodes.size()); n-- > 0;) {
    const OctreeNode& node = tree.nodes[n];
    double areas[node_width], lanes[node_width];
    set_lane_costs(node, tree.boxes[n], areas, lanes);
    std::uint32_t child = node.first_child;
    for (std::uint32_t inner = node.inner_mask; inner != 0; inner &= inner - 1, ++child) {
      const int lane = std::countr_zero(inner);
      costs[child].area = areas[lane];
      lanes[lane] = areas[lane] + costs[child].cost;
    }
    // In one order for all instruction sets.
    costs[n].cost =
        ((lanes[0] + lanes[1]) + (lanes[2] + lanes[3])) + ((lanes[4] + lanes[5]) + (lanes[6] + lanes[7]));
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace supple
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace supple {

HWY_EXPORT(AddUpCosts);

void add_up_costs(const TreeBoxes& tree, NodeCost* costs) {
  HWY_DYNAMIC_DISPATCH(AddUpCosts)(tree, costs);
}

}  // namespace supple
#endif
