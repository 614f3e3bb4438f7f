#include "world/object/fine_boxes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace supple {

bool FineBoxes::are_needed(const OctreeView& view) {
  if (view.arrays.doubles.data == nullptr || view.box.empty()) return false;
  constexpr double most = 0x1p12;  // the rounding is then below a thousandth of the size
  double size = 0, farthest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = view.box.min[axis], high = view.box.max[axis];
    size = std::max(size, high - low);
    farthest = std::max({farthest, std::fabs(low), std::fabs(high)});
  }
  return !(farthest <= most * size) || !std::isfinite(farthest);
}

void FineBoxes::update(const OctreeView& view, const VertexBuffer& positions, std::uint64_t version) {
  if (version_ == version) return;
  version_ = 0;  // until all is computed
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const Vec3d largest{infinity, infinity, infinity};
  boxes_.assign(node_width * view.nodes.size(), {largest, -largest});
  const auto include = [](QueryBox& box, const Vec3d& low, const Vec3d& high) {
    for (int axis = 0; axis < 3; ++axis) {
      box.min[axis] = std::min(box.min[axis], low[axis]);
      box.max[axis] = std::max(box.max[axis], high[axis]);
    }
  };
  // Children have larger numbers than their parents.
  for (std::size_t number = view.nodes.size(); number-- > 0;) {
    const OctreeNode& node = view.nodes[number];
    for (int child = 0; child < node.child_count; ++child) {
      QueryBox& box = boxes_[node_width * number + static_cast<std::size_t>(child)];
      if (node.is_inner(child)) {
        const std::size_t first = node_width * std::size_t{node.child_node(child)};
        for (std::size_t i = first; i < first + node_width; ++i) include(box, boxes_[i].min, boxes_[i].max);
        continue;
      }
      for (std::uint32_t t = node.first_triangle[child]; t < node.first_triangle[child + 1]; ++t) {
        if (view.arrays.inert != nullptr && view.arrays.inert[t] != 0) continue;
        for (const std::uint32_t vertex : view.arrays.triangles[t]) {
          const Vec3d p = positions[vertex];
          include(box, p, p);
        }
      }
    }
  }
  version_ = version;
}

}  // namespace supple
