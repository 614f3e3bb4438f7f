#include "supple/broad_phase.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <nanobind/stl/optional.h>

#include "arrays.hpp"
#include "options.hpp"
#include "records.hpp"
#include "scene.hpp"

namespace supple::python {
namespace {

using Boxes = nb::ndarray<const float, nb::shape<-1, 2, 3>, nb::c_contig, nb::device::cpu>;
using Spheres = nb::ndarray<const float, nb::shape<-1, 4>, nb::c_contig, nb::device::cpu>;
static_assert(sizeof(Aabb) == 6 * sizeof(float) && sizeof(BoundingSphere) == 4 * sizeof(float));

/// The broad phase alone.
struct BroadPhaseCore {
  BroadPhase broad_phase;
  CallGuard guard;
};

/// The pairs of volumes, (k, 2).
template <class Volume>
nb::object find_pairs(BroadPhaseCore& core, std::span<const Volume> volumes,
                      const std::optional<List<std::uint8_t>>& kinds,
                      const std::optional<List<std::uint32_t>>& dirty) {
  const CallGuard::Alone alone(core.guard);
  std::vector<IndexPair> pairs;
  {
    const WithoutGil without_gil;
    BroadPhase& search = core.broad_phase;
    const auto found = kinds && dirty ? search.find_object_pairs(volumes, span_of(*kinds), span_of(*dirty))
                       : kinds        ? search.find_object_pairs(volumes, span_of(*kinds))
                       : dirty        ? search.find_object_pairs(volumes, span_of(*dirty))
                                      : search.find_object_pairs(volumes);
    pairs.assign(found.begin(), found.end());
  }
  return to_own_array<std::uint32_t, 2>(std::move(pairs));
}

using MutableBoxes = nb::ndarray<float, nb::shape<-1, 2, 3>, nb::c_contig, nb::device::cpu>;
using Transforms = nb::ndarray<const double, nb::shape<-1, 4, 4>, nb::c_contig, nb::device::cpu>;

/// Writes the boxes of `moved`, rounded outward: that of each center with its half edges, after its
/// transform. What is not finite has a box at infinity. Returns the first one that has no finite box.
std::optional<std::uint32_t> place_boxes(const Transforms& transforms, const Matrix<double, 3>& centers,
                                         const Matrix<double, 3>& halves, const List<std::uint32_t>& moved,
                                         const MutableBoxes& boxes) {
  const std::span<Aabb> placed(reinterpret_cast<Aabb*>(boxes.data()), boxes.shape(0));
  for (const std::uint32_t i : span_of(moved)) {
    const Vec3d center = rows_of<Vec3d>(centers)[i], half = rows_of<Vec3d>(halves)[i];
    double reach = 0;
    bool has_box = true, is_placed = true;
    for (int axis = 0; axis < 3; ++axis) {
      reach = std::max(reach, std::fabs(center[axis]) + half[axis]);
      has_box = has_box && std::isfinite(std::fabs(center[axis]) + half[axis]);
    }
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Vec3d low{infinity, infinity, infinity}, high = low;
    for (int axis = 0; axis < 3 && has_box; ++axis) {
      const double* const row = transforms.data() + 16 * std::size_t{i} + 4 * axis;
      double middle = row[3], extent = 0, size = 0;
      for (int k = 0; k < 3; ++k) {
        middle += row[k] * center[k];
        extent += std::fabs(row[k]) * half[k];
        size += std::fabs(row[k]);
      }
      // Rounded corners must not hide a pair.
      extent += 1e-12 * (size * reach + std::fabs(row[3]));
      low[axis] = middle - extent;
      high[axis] = middle + extent;
      is_placed = is_placed && std::isfinite(low[axis]) && std::isfinite(high[axis]);
    }
    if (!is_placed) return i;
    placed[i] = enclosing_box(low, high, 0);
  }
  return std::nullopt;
}

/// The pairs of boxes of two lists that overlap, (k, 2), by comparing all.
nb::object overlapping_boxes(const Boxes& a, const Boxes& b) {
  const std::span all_a(reinterpret_cast<const Aabb*>(a.data()), a.shape(0)),
      all_b(reinterpret_cast<const Aabb*>(b.data()), b.shape(0));
  std::vector<IndexPair> pairs;
  for (std::uint32_t i = 0; i < all_a.size(); ++i) {
    for (std::uint32_t k = 0; k < all_b.size(); ++k) {
      const auto meet = [&](int axis) {
        return all_a[i].min[axis] <= all_b[k].max[axis] && all_b[k].min[axis] <= all_a[i].max[axis];
      };
      if (meet(0) && meet(1) && meet(2)) pairs.push_back({i, k});
    }
  }
  return to_own_array<std::uint32_t, 2>(std::move(pairs));
}

}  // namespace

void bind_broad_phase(nb::module_& module) {
  nb::class_<BroadPhaseCore>(module, "BroadPhase")
      .def("__init__",
           [](BroadPhaseCore* self, nb::dict keywords) {
             BroadPhaseOptions options;
             if (keywords.contains("kind_pairs")) {
               for (const nb::handle pair : nb::borrow<nb::iterable>(keywords["kind_pairs"]))
                 options.kind_pairs.push_back(
                     {nb::cast<std::uint8_t>(pair[0]), nb::cast<std::uint8_t>(pair[1])});
               nb::del(keywords["kind_pairs"]);
             }
             set_options(options, keywords, "BroadPhase");
             new (self) BroadPhaseCore{BroadPhase(options), {}};
           })
      .def(
          "of_boxes",
          [](BroadPhaseCore& core, const Boxes& boxes, const std::optional<List<std::uint8_t>>& kinds,
             const std::optional<List<std::uint32_t>>& dirty) {
            return find_pairs(core, std::span(reinterpret_cast<const Aabb*>(boxes.data()), boxes.shape(0)),
                              kinds, dirty);
          },
          nb::arg(), nb::arg().none(), nb::arg().none())
      .def(
          "of_spheres",
          [](BroadPhaseCore& core, const Spheres& spheres, const std::optional<List<std::uint8_t>>& kinds,
             const std::optional<List<std::uint32_t>>& dirty) {
            return find_pairs(
                core, std::span(reinterpret_cast<const BoundingSphere*>(spheres.data()), spheres.shape(0)),
                kinds, dirty);
          },
          nb::arg(), nb::arg().none(), nb::arg().none())
      .def("stats", [](const BroadPhaseCore& core) { return dict_of(core.broad_phase.stats()); });
  module.def("place_boxes", &place_boxes);
  module.def("overlapping_boxes", &overlapping_boxes);
  module.def("enclosing_boxes",
             [](const Matrix<double, 3>& lowest, const Matrix<double, 3>& highest, double radius) {
               if (lowest.shape(0) != highest.shape(0))
                 throw Error("enclosing_boxes: both lists must have the same length");
               std::vector<Aabb> boxes(lowest.shape(0));
               for (std::size_t i = 0; i < boxes.size(); ++i)
                 boxes[i] = enclosing_box(rows_of<Vec3d>(lowest)[i], rows_of<Vec3d>(highest)[i], radius);
               return to_own_array<float, 2, 3>(std::move(boxes));
             });
}

}  // namespace supple::python
