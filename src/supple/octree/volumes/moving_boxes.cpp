#include "octree/volumes/moving_boxes.hpp"
#include "octree/object_octree.hpp"

#include "geometry/aabb.hpp"
#include "geometry/vector.hpp"
#include "octree/refit_bottom_up.hpp"
#include "octree/volumes/box_kernels.hpp"

namespace supple {
namespace {

constexpr std::size_t grain = 8192;

Aabb root_box(const std::vector<ChildBoxes>& nodes) {
  return nodes.empty() ? Aabb{} : enclosing_box(nodes[0]);
}

}  // namespace

bool MovingBoxes::refit(const ObjectOctree& octree, const SurfaceElements& elements,
                        const VertexBuffer& start, const VertexBuffer& end, const Parallel& parallel) {
  at_rest_ = &start == &end;
  inert_.clear();
  const bool some_inert = mark_inert(start, end, parallel);
  const std::uint8_t* const inert = some_inert ? inert_.data() : nullptr;
  refit(start_, octree, elements, start, inert, parallel);
  if (!at_rest_) refit(end_, octree, elements, end, inert, parallel);
  return !some_inert;
}

void MovingBoxes::refit(Moment& moment, const ObjectOctree& octree, const SurfaceElements& elements,
                        const VertexBuffer& positions, const std::uint8_t* inert,
                        const Parallel& parallel) const {
  moment.corners = {positions.floats().data, positions.floats().data, positions.floats().stride};
  if (positions.is_double()) {
    moment.rounded.resize(8 * positions.size());
    const float* const lower = moment.rounded.data();  // null when there are no vertices
    moment.corners = {lower, lower == nullptr ? lower : lower + 4, 8};
    parallel.for_ranges(positions.size(), grain, [&](std::size_t begin, std::size_t end, std::uint32_t) {
      round_corners(positions.doubles().data, moment.rounded.data(), static_cast<std::uint32_t>(begin),
                    static_cast<std::uint32_t>(end));
    });
  }
  moment.nodes.resize(octree.nodes().size());
  octree.for_nodes_bottom_up(parallel, 512, [&](std::uint32_t begin, std::uint32_t end) {
    refit_moving_boxes(octree.nodes().data(), moment.nodes.data(), moment.corners, elements.faces().data(),
                       inert, begin, end);
  });
}

/// Returns whether a vertex is not finite at either end; then `inert_` marks these vertices.
bool MovingBoxes::mark_inert(const VertexBuffer& start, const VertexBuffer& end, const Parallel& parallel) {
  const auto all_finite = [&](const VertexBuffer& positions) {
    return parallel.all_of_ranges(positions.size(), grain, [&](std::size_t first, std::size_t last) {
      const auto finite = [&](const auto& vertices) {
        auto sum = vertices[first][0] * 0;  // NaN as soon as one coordinate is not finite
        for (std::size_t v = first; v < last; ++v) {
          sum += vertices[v][0] * 0 + vertices[v][1] * 0 + vertices[v][2] * 0;
        }
        return sum == 0;
      };
      return positions.is_double() ? finite(positions.doubles()) : finite(positions.floats());
    });
  };
  if (all_finite(start) && (at_rest_ || all_finite(end))) return false;
  inert_.resize(start.size());
  for (std::uint32_t v = 0; v < inert_.size(); ++v) inert_[v] = !is_finite(start[v]) || !is_finite(end[v]);
  return true;
}

MovingView MovingBoxes::view(const SurfaceElements& elements) const {
  return {start_.nodes.data(),
          last().nodes.data(),
          start_.corners,
          last().corners,
          inert_.empty() ? nullptr : inert_.data(),
          elements.faces().data(),
          elements.edges().data(),
          elements.first_vertex(),
          elements.first_edge()};
}

Aabb MovingBoxes::start_box() const {
  return root_box(start_.nodes);
}

Aabb MovingBoxes::end_box() const {
  return root_box(last().nodes);
}

Aabb MovingBoxes::swept_box() const {
  Aabb box = start_box();
  extend(box, end_box());
  return box;
}

std::size_t MovingBoxes::bytes() const {
  std::size_t bytes = inert_.capacity();
  for (const Moment* const moment : {&start_, &end_})
    bytes += moment->rounded.capacity() * sizeof(float) + moment->nodes.capacity() * sizeof(ChildBoxes);
  return bytes;
}

}  // namespace supple
