#include "world/object/fine_boxes.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "narrow_phase/query_kernels.hpp"
#include "octree/refit_bottom_up.hpp"

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
  boxes_.assign(node_width * view.nodes.size(), no_box());
  refit_bottom_up(
      view.nodes.data(), 0, static_cast<std::uint32_t>(view.nodes.size()),
      [&](std::uint32_t n, int child) {
        const OctreeNode& node = view.nodes[n];
        QueryBox& box = boxes_[node_width * std::size_t{n} + static_cast<std::size_t>(child)];
        for (std::uint32_t t = node.first_triangle[child]; t < node.first_triangle[child + 1]; ++t) {
          if (view.arrays.inert != nullptr && view.arrays.inert[t] != 0) continue;
          for (const std::uint32_t vertex : view.arrays.triangles[t]) {
            const Vec3d p = positions[vertex];
            extend(box, p, p);
          }
        }
      },
      [&](std::uint32_t n) {
        const OctreeNode& node = view.nodes[n];
        if (node.parent == n) return;
        QueryBox& box = boxes_[node_width * std::size_t{node.parent} + node.index_in_parent];
        for (const QueryBox& child : std::span(boxes_).subspan(node_width * std::size_t{n}, node_width))
          extend(box, child.min, child.max);
      });
  version_ = version;
}

}  // namespace supple
