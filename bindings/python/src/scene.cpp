#include "scene.hpp"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <utility>

#include "arrays.hpp"
#include "options.hpp"
#include "records.hpp"
#include "shared_calls.hpp"
#include "supple/verify.hpp"

namespace supple::python {
namespace {

using Alone = CallGuard::Alone;
using Reading = CallGuard::Reading;
using Together = CallGuard::Together;

/// The vertices of both sides of each record, (n, 2, 3): an element with fewer vertices repeats its first
/// one.
template <class Row>
nb::object vertices_of(const Scene& scene, const List<std::uint8_t>& bytes) {
  if (bytes.size() % sizeof(Row) != 0) throw Error("vertices: the array does not have records of this kind");
  std::vector<std::array<std::uint32_t, 6>> vertices(bytes.size() / sizeof(Row));
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    Row row;
    std::memcpy(&row, bytes.data() + i * sizeof(Row), sizeof(Row));
    for (const ContactSide side : {ContactSide::a, ContactSide::b}) {
      const ElementVertices found = scene.vertices_of(row, side);
      for (std::size_t k = 0; k < 3; ++k)
        vertices[i][(side == ContactSide::b ? 3 : 0) + k] = found[k < found.size() ? k : 0];
    }
  }
  return to_own_array<std::uint32_t, 2, 3>(std::move(vertices));
}

/// Calls `visit(Row{})` for each record of a list with a triangle or an element on each side.
void for_each_pair_record(const auto& visit) {
  for_each_list([&]<class Row>(const ResultList<Row>&, auto) {
    if constexpr (
        requires(Row row) { row.triangle_a; } || requires(Row row) { row.element_a; })
      visit(Row{});
  });
  visit(LimitingPair{});
}

nb::object positions_of_object(const Scene& scene, ObjectId id) {
  std::vector<Vec3d> positions(scene.vertex_count(id));
  for (std::uint32_t v = 0; v < positions.size(); ++v) positions[v] = scene.position(id, v);
  return to_own_array<double, 3>(std::move(positions));
}

nb::object triangles_of_object(const Scene& scene, ObjectId id) {
  std::vector<Triangle> triangles(scene.triangle_count(id));
  for (std::uint32_t t = 0; t < triangles.size(); ++t)
    triangles[t] = scene.triangle(id, t).value_or(Triangle{});
  return to_own_array<std::uint32_t, 3>(std::move(triangles));
}

}  // namespace

nb::object vertices_of_records(const Scene& scene, const std::string& record,
                               const List<std::uint8_t>& rows) {
  nb::object vertices;
  for_each_pair_record([&]<class Row>(const Row&) {
    if (record == Description<Row>::name) vertices = vertices_of<Row>(scene, rows);
  });
  if (vertices.is_valid()) return vertices;
  throw Error("vertices: a " + record + " has no two elements");
}

SceneCore::SceneCore(const nb::dict& keywords) {
  SceneOptions options;
  set_options(options, keywords, "Scene");
  state_ = std::make_shared<SceneState>(options);
}

std::unique_ptr<Result> SceneCore::detect(const nb::dict& keywords, Stop* stop) {
  DetectRequest request = request_of(keywords, scene().options(), "detect");
  const Alone alone(guard());
  auto result = std::make_unique<Result>();
  result->found = run_stoppable(stop, [&](std::stop_token token) {
    request.stop = std::move(token);
    state_->last.leave(scene());
    return scene().detect(request);
  });
  result->lists = state_->last.begin(state_);
  return result;
}

/// Its lists are copied, so they need no scene.
nb::object SceneCore::search(const nb::dict& keywords, nb::object only, Stop* stop) {
  DetectRequest request = request_of(keywords, scene().options(), "search");
  const PairFilter filter = filter_of(held(std::move(only)));
  const Alone alone(guard());
  const DetectResult found = run_stoppable(stop, [&](std::stop_token token) {
    request.stop = std::move(token);
    return scene().search(request, filter);
  });
  nb::dict tables;
  const auto copy = [&]<class Row>(const char* name, std::span<const Row> rows) {
    tables[name] = to_table(std::vector<Row>(rows.begin(), rows.end()));
  };
  for_each_list([&](const auto& list, auto member) { copy(list.name, member(found)); });
  tables["stopped"] = found.stopped;
  tables["truncated"] = found.truncated;
  return tables;
}

void bind_scene(nb::module_& module) {
  nb::class_<ObjectId>(module, "ObjectId")
      .def(nb::init<std::uint32_t, std::uint32_t>(), nb::arg("index"), nb::arg("generation") = 0)
      .def_ro("index", &ObjectId::index)
      .def_ro("generation", &ObjectId::generation);
  nb::class_<Stop>(
      module, "Stop",
      "Stops calls from another thread: give it to a call as `stop`, and call `request` to end the call.")
      .def(nb::init<>())
      .def("request", [](Stop& stop) { stop.source.request_stop(); })
      .def_prop_ro("requested", [](const Stop& stop) { return stop.source.stop_requested(); });

  module.def("records_with_vertices", [] {
    nb::list names;
    for_each_pair_record([&]<class Row>(const Row&) { names.append(Description<Row>::name); });
    return names;
  });
  module.def("rotation_of_quaternion", [](double x, double y, double z, double w) {
    const auto& r = RigidTransform::from_quaternion(x, y, z, w).rotation;
    return to_own_array<double>(std::vector<double>(r.begin(), r.end()));
  });

  nb::class_<SceneCore> scene(module, "Scene", nb::type_slots(slots_of<SceneCore>));
  const auto setter = [&](const char* name, auto set) { scene.def(name, set); };
  scene.def(nb::init<nb::dict>());
  bind_shared_calls(scene, true);
  scene.def(
      "add",
      [](SceneCore& core, const Array& positions, const Array& triangles, const nb::dict& options,
         const std::optional<List<std::uint32_t>>& same_vertex,
         const std::optional<Matrix<std::uint32_t, 2>>& edges,
         const std::optional<List<std::uint32_t>>& points) {
        const ObjectOptions object = object_options_of(options, same_vertex, edges, points);
        const Alone alone(core.guard());
        const PositionsView xyz = positions_of(positions);
        const TrianglesView faces = triangles_of(triangles);
        const WithoutGil without_gil;
        return core.scene().add(xyz, faces, object);
      },
      nb::arg(), nb::arg(), nb::arg(), nb::arg().none(), nb::arg().none(), nb::arg().none());
  setter("set_vertices",
         [](SceneCore& core, ObjectId id, const List<std::uint32_t>& vertices, const Array& positions) {
           const Alone alone(core.guard());
           core.scene().set_vertices(id, span_of(vertices), positions_of(positions));
         });
  setter(
      "edit", [](SceneCore& core, ObjectId id, const List<std::uint32_t>& removed, const Array& added,
                 const Array& new_vertices, const Array& new_starts,
                 const Matrix<std::uint32_t, 2>& removed_edges, const Matrix<std::uint32_t, 2>& added_edges,
                 const List<std::uint32_t>& removed_points, const List<std::uint32_t>& added_points) {
        const auto edges_of = [](const Matrix<std::uint32_t, 2>& rows) {
          return std::span(reinterpret_cast<const std::array<std::uint32_t, 2>*>(rows.data()), rows.shape(0));
        };
        const Alone alone(core.guard());
        core.scene().edit(id, {.removed = span_of(removed),
                               .added = triangles_of(added),
                               .new_vertices = positions_of(new_vertices),
                               .new_starts = positions_of(new_starts),
                               .removed_edges = edges_of(removed_edges),
                               .added_edges = edges_of(added_edges),
                               .removed_points = span_of(removed_points),
                               .added_points = span_of(added_points)});
      });
  scene.def("compact", [](SceneCore& core, ObjectId id) {
    const Alone alone(core.guard());
    return to_own_array<std::uint32_t>(core.scene().compact(id));
  });
  scene.def("mesh_version", [](SceneCore& core, ObjectId id) {
    const Reading reading(core.guard());
    return core.scene().mesh_version(id);
  });
  setter("share_positions", [](SceneCore& core, ObjectId id, const Array& positions, nb::object array) {
    const Alone alone(core.guard());
    core.scene().share_positions(id, positions_of(positions));
    core.state().shared[id] = std::move(array);
  });
  setter("translate", [](SceneCore& core, ObjectId id, double x, double y, double z) {
    const Alone alone(core.guard());
    core.scene().translate(id, {x, y, z});
  });
  setter("set_transform", [](SceneCore& core, ObjectId id, const Matrix<double, 4>& rows) {
    if (rows.shape(0) < 3) throw Error("set_transform: the matrix must have the shape (3, 4) or (4, 4)");
    RigidTransform transform;
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t c = 0; c < 3; ++c) transform.rotation[3 * r + c] = rows.data()[4 * r + c];
      transform.translation[static_cast<int>(r)] = rows.data()[4 * r + 3];
    }
    const Alone alone(core.guard());
    core.scene().set_transform(id, transform);
  });
  scene.def("detect", &SceneCore::detect, nb::arg(), nb::arg().none());
  scene.def("search", &SceneCore::search, nb::arg(), nb::arg().none(), nb::arg().none());
  scene.def(
      "collision_free_steps",
      [](SceneCore& core, double keep, double seconds, Stop* stop) {
        const Alone alone(core.guard());
        const auto steps = run_stoppable(stop, [&](std::stop_token token) {
          return core.scene().collision_free_steps({keep}, {std::move(token), seconds});
        });
        nb::list list;
        for (const ObjectStep& each : steps)
          list.append(nb::make_tuple(each.object, each.island, each.safe.step, to_table(each.safe.limit),
                                     each.safe.stopped));
        return list;
      },
      nb::arg(), nb::arg(), nb::arg().none());
  scene.def(
      "verify",
      [](SceneCore& core, Stop* stop) {
        const Together together(core.guard());
        return report_of(run_or_fail(
            stop, "verify", [&](std::stop_token token) { return verify(core.scene(), {std::move(token)}); }));
      },
      nb::arg().none());

  scene.def("objects", [](SceneCore& core) {
    const Together together(core.guard());
    return core.scene().objects();
  });
  scene.def("contains", [](SceneCore& core, ObjectId id) {
    const Reading reading(core.guard());
    return core.scene().contains(id);
  });
  scene.def("name", [](SceneCore& core, ObjectId id) {
    const Reading reading(core.guard());
    return core.scene().options(id).name;
  });
  scene.def("vertex_count", [](SceneCore& core, ObjectId id) {
    const Reading reading(core.guard());
    return core.scene().vertex_count(id);
  });
  scene.def("triangle_count", [](SceneCore& core, ObjectId id) {
    const Reading reading(core.guard());
    return core.scene().triangle_count(id);
  });
  scene.def("positions", [](SceneCore& core, ObjectId id) {
    const Together together(core.guard());
    return positions_of_object(core.scene(), id);
  });
  scene.def("vertices_of", [](SceneCore& core, const std::string& record, const List<std::uint8_t>& rows) {
    const Together together(core.guard());
    return vertices_of_records(core.scene(), record, rows);
  });
  scene.def("triangles", [](SceneCore& core, ObjectId id) {
    const Together together(core.guard());
    return triangles_of_object(core.scene(), id);
  });
  scene.def("options", [](SceneCore& core) { return dict_of_options(core.scene().options()); });
  bind_queries(module, scene);
}

}  // namespace supple::python
