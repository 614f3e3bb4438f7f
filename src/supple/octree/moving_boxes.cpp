#include "octree/moving_boxes.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "geometry/aabb.hpp"
#include "geometry/vector.hpp"
#include "octree/box_kernels.hpp"

namespace supple {
namespace {

/// Vector loads reach past the last element of a leaf by less than this.
constexpr std::size_t padding = 16;
constexpr std::size_t grain = 8192;

std::size_t stride_of(std::size_t count) {
  return count + padding;
}

/// Boxes in the padding are inverted, so that vector loads find no overlap there.
BoxArrays sized(std::vector<float>& boxes, std::size_t count) {
  constexpr float inf = std::numeric_limits<float>::infinity();
  const std::size_t stride = stride_of(count);
  if (boxes.size() != 6 * stride) {
    boxes.assign(3 * stride, inf);
    boxes.resize(6 * stride, -inf);
  }
  return {boxes.data(), stride};
}

MovingBoxArrays arrays_of(const std::vector<float>& start, const std::vector<float>& end) {
  return {start.data(), end.data(), start.size() / 6};
}

void invert(std::vector<float>& boxes, std::size_t element) {
  constexpr float inf = std::numeric_limits<float>::infinity();
  const std::size_t stride = boxes.size() / 6;
  for (std::size_t side = 0; side < 6; ++side) boxes[side * stride + element] = side < 3 ? inf : -inf;
}

Aabb root_box(const std::vector<ChildBoxes>& nodes) {
  return nodes.empty() ? Aabb{} : enclosing_box(nodes[0]);
}

}  // namespace

bool MovingBoxes::refit(const ObjectOctree& octree, const SurfaceElements& elements,
                        const VertexBuffer& start, const VertexBuffer& end, const Parallel& parallel) {
  at_rest_ = &start == &end;
  const bool some_inert = mark_inert(start, end, parallel);
  for (Moment* const moment : {&start_, &end_}) {
    if (moment == &end_ && at_rest_) continue;
    set_boxes(*moment, moment == &start_ ? start : end, elements, elements.faces(), parallel);
    if (some_inert) invert_inert(*moment, elements, elements.faces());
    refit_nodes(*moment, octree, elements, !some_inert, parallel);
  }
  return !some_inert;
}

void MovingBoxes::set_boxes(Moment& moment, const VertexBuffer& positions, const SurfaceElements& elements,
                            std::span<const Triangle> faces, const Parallel& parallel) {
  const std::uint32_t vertex_count = elements.vertex_count();
  VertexCorners corners{positions.floats().data, positions.floats().data, positions.floats().stride};
  if (positions.is_double() && vertex_count > 0) {
    moment.corners.resize(8 * std::size_t{vertex_count});
    corners = {moment.corners.data(), moment.corners.data() + 4, 8};
  }
  const auto ranges = [&](std::size_t count, const auto& body) {
    parallel.for_ranges(count, grain, [&](std::size_t begin, std::size_t end, std::uint32_t) {
      body(static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end));
    });
  };
  const BoxArrays vertices = sized(moment.vertices, vertex_count);
  ranges(vertex_count, [&](std::uint32_t begin, std::uint32_t end) {
    if (positions.is_double()) round_corners(positions.doubles().data, moment.corners.data(), begin, end);
    set_vertex_boxes(corners, vertices, begin, end);
  });
  const BoxArrays edges = sized(moment.edges, elements.edge_count());
  ranges(elements.edge_count(), [&](std::uint32_t begin, std::uint32_t end) {
    set_edge_boxes(corners, elements.edges().data(), edges, begin, end);
  });
  const BoxArrays face_boxes = sized(moment.faces, faces.size());
  ranges(faces.size(), [&](std::uint32_t begin, std::uint32_t end) {
    set_face_boxes(corners, faces.data(), face_boxes, begin, end);
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

void MovingBoxes::invert_inert(Moment& moment, const SurfaceElements& elements,
                               std::span<const Triangle> faces) const {
  for (std::size_t v = 0; v < elements.vertex_count(); ++v) {
    if (inert_[v] != 0) invert(moment.vertices, v);
  }
  const auto edges = elements.edges();
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (inert_[edges[e][0]] != 0 || inert_[edges[e][1]] != 0) invert(moment.edges, e);
  }
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const Triangle& face = faces[f];
    if (inert_[face[0]] != 0 || inert_[face[1]] != 0 || inert_[face[2]] != 0) invert(moment.faces, f);
  }
}

void MovingBoxes::refit_nodes(Moment& moment, const ObjectOctree& octree, const SurfaceElements& elements,
                              bool faces_enclose, const Parallel& parallel) const {
  moment.nodes.resize(octree.nodes().size());
  const auto arrays = [](std::vector<float>& boxes) { return BoxArrays{boxes.data(), boxes.size() / 6}; };
  const LeafElements leaf_elements{arrays(moment.vertices), arrays(moment.edges),  arrays(moment.faces),
                                   elements.first_vertex(), elements.first_edge(), faces_enclose};
  octree.for_nodes_bottom_up(parallel, 512, [&](std::uint32_t begin, std::uint32_t end) {
    refit_element_boxes(octree.nodes().data(), moment.nodes.data(), leaf_elements, begin, end);
  });
}

MovingView MovingBoxes::view(const SurfaceElements& elements) const {
  return {start_.nodes.data(),
          last().nodes.data(),
          arrays_of(start_.vertices, last().vertices),
          arrays_of(start_.edges, last().edges),
          arrays_of(start_.faces, last().faces),
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

std::size_t MovingBoxes::Moment::bytes() const {
  return (corners.capacity() + vertices.capacity() + edges.capacity() + faces.capacity()) * sizeof(float) +
         nodes.capacity() * sizeof(ChildBoxes);
}

std::size_t MovingBoxes::bytes() const {
  return start_.bytes() + end_.bytes() + inert_.capacity();
}

namespace {

/// Checks the boxes at one end of the step.
class MomentValidation {
 public:
  MomentValidation(const VertexBuffer& positions, std::span<const std::uint8_t> inert)
      : positions_(positions), inert_(inert) {}

  /// Adds the box of element `i` to `bounds`; the empty string or what is wrong.
  std::string check(const float* boxes, std::size_t stride, std::size_t i,
                    std::span<const std::uint32_t> corners, Aabb& bounds) const {
    const auto at = [&](std::size_t side) { return boxes[side * stride + i]; };
    const Aabb box{{at(0), at(1), at(2)}, {at(3), at(4), at(5)}};
    for (const std::uint32_t vertex : corners) {
      if (inert_[vertex] != 0) return box == Aabb{} ? "" : "an inert element has a box";
    }
    Aabb exact;
    for (const std::uint32_t vertex : corners) extend(exact, positions_[vertex]);
    constexpr float greatest = std::numeric_limits<float>::max();
    for (int axis = 0; axis < 3; ++axis) {
      exact.min[axis] = std::max(exact.min[axis], -greatest);
      exact.max[axis] = std::min(exact.max[axis], greatest);
    }
    if (box != exact) return "a box is not the element's";
    extend(bounds, box);
    return "";
  }

 private:
  const VertexBuffer& positions_;
  std::span<const std::uint8_t> inert_;
};

/// Checks the boxes of the elements and of all children, from the last node up.
std::string check_moment(const ObjectOctree& octree, const SurfaceElements& elements, const MovingView& view,
                         bool at_end, const MomentValidation& validation) {
  const auto nodes = octree.nodes();
  std::vector<Aabb> node_boxes(nodes.size());
  const ChildBoxes* const children = at_end ? view.end : view.start;
  const auto check = [&](const MovingBoxArrays& boxes, std::size_t i, std::span<const std::uint32_t> corners,
                         Aabb& bounds) {
    return validation.check(at_end ? boxes.end : boxes.start, boxes.stride, i, corners, bounds);
  };
  for (std::size_t n = nodes.size(); n-- > 0;) {
    for (int child = 0; child < node_width; ++child) {
      Aabb bounds;
      if (child < nodes[n].child_count && nodes[n].is_inner(child)) {
        bounds = node_boxes[nodes[n].child_node(child)];
      } else if (child < nodes[n].child_count) {
        const std::uint32_t first = nodes[n].first_triangle[child], last = nodes[n].first_triangle[child + 1];
        const ElementRange vertices = elements.vertices_of(first, last);
        for (std::uint32_t v = vertices.begin; v < vertices.end; ++v) {
          if (std::string wrong = check(view.vertices, v, {&v, 1}, bounds); !wrong.empty()) return wrong;
        }
        const ElementRange edges = elements.edges_of(first, last);
        for (std::uint32_t e = edges.begin; e < edges.end; ++e) {
          if (std::string wrong = check(view.edges, e, elements.edges()[e], bounds); !wrong.empty())
            return wrong;
        }
        for (std::uint32_t f = first; f < last; ++f) {
          if (std::string wrong = check(view.faces, f, elements.faces()[f], bounds); !wrong.empty()) {
            return wrong;
          }
        }
      }
      if (child_box(children[n], child) != bounds) return "the box of a child is not that of its elements";
      extend(node_boxes[n], bounds);
    }
  }
  return "";
}

}  // namespace

std::string MovingBoxes::validate(const ObjectOctree& octree, const SurfaceElements& elements,
                                  const VertexBuffer& start, const VertexBuffer& end) const {
  std::vector<std::uint8_t> inert(start.size());
  for (std::uint32_t v = 0; v < inert.size(); ++v) inert[v] = !is_finite(start[v]) || !is_finite(end[v]);
  const MovingView shown = view(elements);
  std::string wrong = check_moment(octree, elements, shown, false, {start, inert});
  if (wrong.empty()) wrong = check_moment(octree, elements, shown, true, {end, inert});
  return wrong;
}

}  // namespace supple
