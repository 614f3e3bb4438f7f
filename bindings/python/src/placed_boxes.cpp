#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include <nanobind/stl/optional.h>

#include "arrays.hpp"
#include "records.hpp"
#include "scene.hpp"
#include "supple/broad_phase.hpp"

namespace supple::python {
namespace {

using Transform = nb::ndarray<const double, nb::shape<4, 4>, nb::c_contig, nb::device::cpu>;
using Point = nb::ndarray<const double, nb::shape<3>, nb::c_contig, nb::device::cpu>;

/// Boxes of meshes that stay, and where transforms place them: along the axes, and turned with the mesh.
class PlacedBoxes {
 public:
  /// Returns false, and adds nothing, when the transform places the box at no finite position.
  bool add(const Point& center, const Point& half, const Transform& transform) {
    boxes_.push_back({.mesh_center = vector_of(center), .mesh_half = vector_of(half)});
    const bool is_placed = place(boxes_.size() - 1, transform);
    if (!is_placed) boxes_.pop_back();
    return is_placed;
  }
  /// Moves a box; the same.
  bool place(std::size_t i, const Transform& transform) {
    const Vec3d center = boxes_.at(i).mesh_center, half = boxes_[i].mesh_half;
    Box placed{.mesh_center = center, .mesh_half = half};
    placed.has_points = std::isfinite(norm(center)) && std::isfinite(norm(half));
    Vec3d low, high;
    for (int axis = 0; axis < 3 && placed.has_points; ++axis) {
      const double* const row = transform.data() + 4 * axis;
      double middle = row[3], extent = 0, size = std::fabs(row[3]);
      for (int k = 0; k < 3; ++k) {
        placed.edges[static_cast<std::size_t>(k)][axis] = row[k] * half[k];
        middle += row[k] * center[k];
        extent += std::fabs(row[k]) * half[k];
        size += std::fabs(row[k]) * (std::fabs(center[k]) + half[k]);
      }
      placed.rounding += rounding_of_sums * size;
      placed.center[axis] = middle;
      low[axis] = middle - extent - rounding_of_sums * size;
      high[axis] = middle + extent + rounding_of_sums * size;
      if (!std::isfinite(low[axis]) || !std::isfinite(high[axis])) return false;
    }
    if (placed.has_points) placed.along_axes = enclosing_box(low, high);
    boxes_[i] = placed;
    return true;
  }

  /// The lowest and the highest corners along the axes, (n, 2, 3); of boxes without points at infinity.
  nb::object corners() const {
    std::vector<Aabb> all;
    for (const Box& box : boxes_) all.push_back(box.has_points ? box.along_axes : at_infinity);
    return to_own_array<float, 2, 3>(std::move(all));
  }
  /// Whether box i encloses box k of `other`, along the axes.
  bool encloses(std::size_t i, const PlacedBoxes& other, std::size_t k) const {
    const Aabb &outer = boxes_.at(i).along_axes, &inner = other.boxes_.at(k).along_axes;
    for (int axis = 0; axis < 3; ++axis) {
      if (outer.min[axis] > inner.min[axis] || inner.max[axis] > outer.max[axis]) return false;
    }
    return true;
  }

  /// The pairs with boxes of `other` that are not apart, (k, 2): of all pairs, or of those given.
  nb::object near(const PlacedBoxes& other, const std::optional<Matrix<std::uint32_t, 2>>& given) const {
    std::vector<IndexPair> pairs;
    const auto add = [&](std::size_t i, std::size_t k) {
      const Box &a = boxes_.at(i), &b = other.boxes_.at(k);
      if (gap_along_axes(a, b) == 0 && !(gap_along_edges(a, b) > 0))
        pairs.push_back({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(k)});
    };
    if (given) {
      for (std::size_t i = 0; i < given->shape(0); ++i) add(given->data()[2 * i], given->data()[2 * i + 1]);
    } else {
      for (std::size_t i = 0; i < boxes_.size(); ++i) {
        for (std::size_t k = 0; k < other.boxes_.size(); ++k) add(i, k);
      }
    }
    return to_own_array<std::uint32_t, 2>(std::move(pairs));
  }
  /// Lower bounds of the distances to the boxes of `other`, (n, m) as one list; NaN without points.
  nb::object bounds(const PlacedBoxes& other) const {
    std::vector<double> all;
    for (const Box& a : boxes_) {
      for (const Box& b : other.boxes_) {
        const bool has_points = a.has_points && b.has_points;
        all.push_back(has_points ? std::max(gap_along_axes(a, b), gap_along_edges(a, b))
                                 : std::numeric_limits<double>::quiet_NaN());
      }
    }
    return to_own_array<double>(std::move(all));
  }

 private:
  /// More than the sums of a transform lose, by the sizes of their terms.
  static constexpr double rounding_of_sums = 1e-12;
  static constexpr double shortest = 1e-150;  // edge whose square is precise
  static constexpr float infinity = std::numeric_limits<float>::infinity();
  static constexpr Aabb at_infinity{{infinity, infinity, infinity}, {infinity, infinity, infinity}};

  struct Box {
    Vec3d mesh_center, mesh_half;  // of the mesh, before its transform
    Aabb along_axes{};
    Vec3d center{};
    std::array<Vec3d, 3> edges{};  // halves
    double rounding = 0;           // of center and edges
    bool has_points = false;
  };

  static Vec3d vector_of(const Point& point) { return {point(0), point(1), point(2)}; }

  static double gap_along_axes(const Box& a, const Box& b) {
    Vec3d gap;
    for (int axis = 0; axis < 3; ++axis) {
      gap[axis] = std::max({0.0, double{a.along_axes.min[axis]} - double{b.along_axes.max[axis]},
                            double{b.along_axes.min[axis]} - double{a.along_axes.max[axis]}});
    }
    return norm(gap) * (1 - 1e-9);
  }
  /// The largest gap of their projections to an edge. Negative when all projections overlap.
  static double gap_along_edges(const Box& a, const Box& b) {
    const Vec3d between = b.center - a.center;
    double largest = -std::numeric_limits<double>::infinity();
    for (const auto& edges : {a.edges, b.edges}) {
      for (const Vec3d& edge : edges) {
        double gap = std::fabs(dot(between, edge));
        for (const Box* const box : {&a, &b}) {
          for (const Vec3d& other : box->edges) gap -= std::fabs(dot(other, edge));
        }
        const double length = norm(edge);
        if (length > shortest && std::isfinite(gap)) largest = std::max(largest, gap / length);
      }
    }
    return largest - 1e-9 * std::fabs(largest) - a.rounding - b.rounding;
  }

  std::vector<Box> boxes_;
};

}  // namespace

void bind_placed_boxes(nb::module_& module) {
  nb::class_<PlacedBoxes>(module, "PlacedBoxes")
      .def(nb::init<>())
      .def("add", &PlacedBoxes::add)
      .def("place", &PlacedBoxes::place)
      .def("corners", &PlacedBoxes::corners)
      .def("encloses", &PlacedBoxes::encloses)
      .def("near", &PlacedBoxes::near, nb::arg(), nb::arg().none())
      .def("bounds", &PlacedBoxes::bounds);
}

}  // namespace supple::python
