// `supple.DistributedScene`: a module of its own, so that `supple` needs no MPI. The types of `_core` are its
// types, too.

#include "supple/distributed.hpp"

#include <mpi.h>
#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "../options.hpp"
#include "../scene.hpp"
#include "../shared_calls.hpp"
#include "supple/comparison.hpp"

namespace supple::python {
namespace {

using Alone = CallGuard::Alone;
using Together = CallGuard::Together;

/// The distributed scene of Python.
class DistributedCore {
 public:
  DistributedCore(MPI_Fint communicator, const DistributedOptions& options)
      : options_(options), scene_(MPI_Comm_f2c(communicator), options) {}

  DistributedScene& scene() { return scene_; }
  CallGuard& guard() { return guard_; }
  HeldFunction& filter() { return filter_; }
  template <class Visit>
  void for_each_held(const Visit& visit) const {
    if (filter_) visit(*filter_);
  }
  void forget_shared(ObjectId) {}
  std::unique_ptr<Result> detect(const nb::dict& keywords, Stop* stop) {
    DetectRequest request = request_of(keywords, options_.scene, "detect");
    const Alone alone(guard_);
    const auto detected = [&](std::stop_token token) {
      request.stop = std::move(token);
      return copy_of(scene_.detect(request));
    };
    return run_stoppable(stop, detected, false);  // other ranks would not repeat the call
  }

 private:
  const DistributedOptions options_;
  CallGuard guard_;
  HeldFunction filter_;
  DistributedScene scene_;
};

std::string library_version() {
  char text[MPI_MAX_LIBRARY_VERSION_STRING];
  int length = 0;
  MPI_Get_library_version(text, &length);
  return text;
}

}  // namespace
}  // namespace supple::python

NB_MODULE(_distributed, module) {
  using namespace supple;
  using namespace supple::python;
  nb::set_leak_warnings(false);
  use_comparison_methods();
  module.def("library_version", &library_version);
  module.def("end_calls", &WithoutGil::end_calls);
  module.def("forget_calls", &WithoutGil::forget_calls);

  nb::class_<DistributedCore> scene(module, "DistributedScene", nb::type_slots(slots_of<DistributedCore>));
  scene.def("__init__", [](DistributedCore* core, MPI_Fint communicator, const nb::dict& keywords,
                           std::uint8_t results, std::uint32_t cluster_triangles, double max_imbalance) {
    DistributedOptions options{.results = static_cast<ResultPlacement>(results),
                               .cluster_triangles = cluster_triangles,
                               .max_imbalance = max_imbalance};
    set_options(options.scene, keywords, "DistributedScene");
    const WithoutGil without_gil;
    new (core) DistributedCore(communicator, options);
  });
  bind_shared_calls(scene, false);
  scene.def(
      "add",
      [](DistributedCore& core, ObjectId id, const Array& positions, const Array& triangles,
         const nb::dict& keywords, const std::optional<Matrix<std::uint32_t, 2>>& edges,
         const std::optional<List<std::uint32_t>>& points) {
        const ObjectOptions options = object_options_of(keywords, {}, edges, points);
        const Alone alone(core.guard());
        const PositionsView xyz = positions_of(positions);
        const TrianglesView faces = triangles_of(triangles);
        const WithoutGil without_gil;
        core.scene().add(id, xyz, faces, options);
      },
      nb::arg(), nb::arg(), nb::arg(), nb::arg(), nb::arg().none(), nb::arg().none());
  scene.def("add_part", [](DistributedCore& core, ObjectId id, const Array& positions, const Array& triangles,
                           const List<std::uint32_t>& vertex_numbers,
                           const List<std::uint32_t>& triangle_numbers, const nb::dict& keywords) {
    const ObjectOptions options = object_options_of(keywords, {}, {}, {});
    const Alone alone(core.guard());
    const PositionsView xyz = positions_of(positions);
    const TrianglesView faces = triangles_of(triangles);
    const WithoutGil without_gil;
    core.scene().add_part(id, xyz, faces, {span_of(vertex_numbers), span_of(triangle_numbers)}, options);
  });
  scene.def("detect", &DistributedCore::detect, nb::arg(), nb::arg().none());
  scene.def(
      "verify",
      [](DistributedCore& core, Stop* stop) {
        const Alone alone(core.guard());
        const auto verified = [&](std::stop_token token) { return core.scene().verify({std::move(token)}); };
        return report_of(run_stoppable(stop, verified, false));
      },
      nb::arg().none());
  scene.def(
      "distances",
      [](DistributedCore& core, double max_distance, Stop* stop) {
        const Alone alone(core.guard());
        const auto found = [&](std::stop_token token) {
          return core.scene().distances(max_distance, {std::move(token)});
        };
        return to_table(run_stoppable(stop, found, false));
      },
      nb::arg(), nb::arg().none());
  scene.def(
      "closest",
      [](DistributedCore& core, const Matrix<double, 3>& points, std::optional<ObjectId> only,
         std::uint32_t mask, double max_distance) {
        const Alone alone(core.guard());
        std::vector<std::optional<ClosestPoint>> answers(points.shape(0));
        {
          const WithoutGil without_gil;
          core.scene().closest(rows_of<Vec3d>(points), answers, {{only, mask}, max_distance});
        }
        return to_answers(answers);
      },
      nb::arg(), nb::arg().none(), nb::arg(), nb::arg());
  scene.def("save", [](DistributedCore& core, const std::string& path) {
    const Alone alone(core.guard());
    const WithoutGil without_gil;
    core.scene().save(path);
  });
  scene.def("load", [](DistributedCore& core, const std::string& path) {
    const Alone alone(core.guard());
    const WithoutGil without_gil;
    core.scene().load(path);
  });
  scene.def("objects", [](DistributedCore& core) {
    const Together together(core.guard());
    return core.scene().objects();
  });
  scene.def("part_vertices", [](DistributedCore& core, ObjectId id) {
    const Together together(core.guard());
    const auto numbers = core.scene().part_vertices(id);
    return to_own_array<std::uint32_t>(std::vector<std::uint32_t>(numbers.begin(), numbers.end()));
  });
  scene.def("positions", [](DistributedCore& core, ObjectId id) {
    const Together together(core.guard());
    return to_own_array<double, 3>(core.scene().positions(id));
  });
  scene.def("rank", [](DistributedCore& core) { return core.scene().rank(); });
  scene.def("rank_count", [](DistributedCore& core) { return core.scene().rank_count(); });
  scene.def("stats", [](DistributedCore& core) {
    const Together together(core.guard());
    const DistributedStats& stats = core.scene().stats();
    nb::dict dict;
    dict["bytes_sent"] = stats.bytes_sent;
    dict["messages_sent"] = stats.messages_sent;
    dict["clusters"] = stats.clusters;
    dict["cluster_pairs"] = stats.cluster_pairs;
    dict["triangles"] = stats.triangles;
    dict["imbalance"] = stats.imbalance;
    dict["divided"] = stats.divided;
    return dict;
  });
}
