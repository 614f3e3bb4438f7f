#include "supple/broad_phase.hpp"

#include <cstddef>
#include <cstdint>
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
