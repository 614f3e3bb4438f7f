#include "comparison/methods.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "comparison/volumes/volume_kernels.hpp"
#include "octree/refit_bottom_up.hpp"

namespace supple {
namespace {

std::span<const Vec3f> directions_of(BoundingVolume kind) {
  const std::span<const Vec3f> all = slab_directions;
  return kind == BoundingVolume::kdop14 ? all.first(4) : kind == BoundingVolume::kdop18 ? all.last(6) : all;
}

/// Numbers of all directions; those after the last one count for nothing, so that compilers vectorize.
using Lanes = std::array<float, 12>;

/// Sums of the coordinates have an error of at most 2^-22 of this; infinite when the slabs are unbounded.
float magnitude_of(const Aabb& box) {
  float sum = 0;
  for (int axis = 0; axis < 3; ++axis) sum += std::max(std::abs(box.min[axis]), std::abs(box.max[axis]));
  return sum < 0x1p120f ? sum : std::numeric_limits<float>::infinity();
}

class Kdops final : public NodeVolumes {
 public:
  Kdops(BoundingVolume kind, std::size_t nodes)
      : NodeVolumes(kind, nodes),
        directions_(directions_of(kind)),
        slabs_(nodes == 0 ? 0 : offset_of(object() + 1)) {}

  /// Rounded outward; infinite when coordinates are so large that sums may overflow.
  void refit(const RefittedOctree& octree, std::uint32_t begin, std::uint32_t end) override {
    constexpr float inf = std::numeric_limits<float>::infinity();
    Lanes x{}, y{}, z{};
    for (std::size_t d = 0; d < directions_.size(); ++d) {
      x[d] = directions_[d].x;
      y[d] = directions_[d].y;
      z[d] = directions_[d].z;
    }
    const auto refit_leaf = [&](std::uint32_t n, int child) {
      Lanes low, high;
      low.fill(inf);
      high.fill(-inf);
      for_each_vertex(octree, n, child, [&](std::uint32_t vertex) {
        const Vec3d p = octree.vertices[vertex];
        const auto px = static_cast<float>(p.x), py = static_cast<float>(p.y), pz = static_cast<float>(p.z);
        for (std::size_t d = 0; d < low.size(); ++d) {
          const float along = px * x[d] + py * y[d] + pz * z[d];
          low[d] = std::min(low[d], along);
          high[d] = std::max(high[d], along);
        }
      });
      const Aabb box = child_box(octree.boxes[n], child);
      // A leaf without a finite triangle has inverted slabs, which do not enlarge those of its ancestors.
      const float magnitude = box.empty() ? 0 : magnitude_of(box);
      const bool bounded = magnitude < inf;
      const float margin = magnitude * 0x1p-21f + std::numeric_limits<float>::min();
      float* to = slabs_.data() + offset_of(n) + child;
      for (std::size_t d = 0; d < directions_.size(); ++d, to += floats_per_slab) {
        to[0] = bounded ? low[d] - margin : -inf;
        to[node_width] = bounded ? high[d] + margin : inf;
      }
    };
    refit_bottom_up(octree.nodes.data(), begin, end, refit_leaf, [&](std::uint32_t n) {
      const OctreeNode& node = octree.nodes[n];
      if (node.parent != n) unite(n, node.child_count, node.parent, node.index_in_parent);
    });
  }

  void refit_object(const RefittedOctree& octree, const Aabb&) override {
    unite(0, octree.nodes[0].child_count, object(), 0);
  }

  void clear_apart(std::span<const NodePair> pairs, const NodeVolumes& b, const RelativePlacement& placement,
                   std::uint64_t* masks) const override {
    clear_slabs_apart(pairs, directions_, slabs_.data(), static_cast<const Kdops&>(b).slabs_.data(),
                      placement, masks);
  }

  std::vector<Slab> slabs(std::uint32_t node, int child, const Aabb& box, Vec3d translation) const override {
    std::vector<Slab> result;
    for (int axis = 0; axis < 3; ++axis) {
      Vec3f direction;
      direction[axis] = 1;
      result.push_back(moved_slab(direction, box.min[axis], box.max[axis], translation));
    }
    const float* low = slabs_.data() + offset_of(node) + child;
    for (const Vec3f& direction : directions_) {
      result.push_back(moved_slab(direction, low[0], low[node_width], translation));
      low += floats_per_slab;
    }
    return result;
  }

  std::size_t bytes() const override { return slabs_.capacity() * sizeof(float); }

 private:
  /// Writes the union of the slabs of the first `count` children of a node as a child of another node.
  void unite(std::uint32_t node, int count, std::uint32_t parent, int child) {
    const float* low = slabs_.data() + offset_of(node);
    float* to = slabs_.data() + offset_of(parent) + child;
    for (std::size_t d = 0; d < directions_.size(); ++d, low += floats_per_slab, to += floats_per_slab) {
      to[0] = *std::min_element(low, low + count);
      to[node_width] = *std::max_element(low + node_width, low + node_width + count);
    }
  }

  std::size_t offset_of(std::uint32_t node) const { return node * directions_.size() * floats_per_slab; }

  std::span<const Vec3f> directions_;
  std::vector<float> slabs_;  // see `floats_per_slab`
};

}  // namespace

std::unique_ptr<NodeVolumes> make_kdops(BoundingVolume kind, std::size_t nodes) {
  return std::make_unique<Kdops>(kind, nodes);
}

}  // namespace supple
