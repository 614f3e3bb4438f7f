#include <nanobind/stl/optional.h>
#include <nanobind/stl/unique_ptr.h>

#include "arrays.hpp"
#include "meshes.hpp"
#include "options.hpp"
#include "records.hpp"
#include "scene.hpp"
#include "supple/mesh_file.hpp"
#include "supple/models.hpp"
#include "supple/recording.hpp"

namespace supple::python {
namespace {

nb::object positions_array(std::vector<Vec3d> positions) {
  return to_own_array<double, 3>(std::move(positions));
}
nb::object triangles_array(std::vector<Triangle> triangles) {
  return to_own_array<std::uint32_t, 3>(std::move(triangles));
}

MeshData make_mesh(const std::string& name, const Array& positions, const Array& triangles,
                   const std::optional<Matrix<std::uint32_t, 2>>& edges,
                   const std::optional<List<std::uint32_t>>& points) {
  const PositionsView xyz = positions_of(positions);
  const TrianglesView faces = triangles_of(triangles);
  TriangleMesh mesh;
  mesh.name = name;
  for (std::size_t i = 0; i < xyz.size(); ++i) mesh.positions.push_back(xyz[i]);
  for (std::size_t t = 0; t < faces.size(); ++t) {
    Triangle triangle{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int64_t id = faces[t][k];
      if (id < 0 || id >= static_cast<std::int64_t>(xyz.size()))
        throw Error(name + ": triangle " + std::to_string(t) + " has vertex " + std::to_string(id) +
                    "; there are " + std::to_string(xyz.size()) + " vertices");
      triangle[k] = static_cast<std::uint32_t>(id);
    }
    mesh.triangles.push_back(triangle);
  }
  for (std::size_t i = 0; edges && i < edges->shape(0); ++i)
    mesh.edges.push_back({edges->data()[2 * i], edges->data()[2 * i + 1]});
  if (points) mesh.points.assign(points->data(), points->data() + points->size());
  check_mesh(mesh);
  return {std::move(mesh)};
}

nb::dict frame_of(RecordedFrame&& frame) {
  nb::dict tables;
  for_each_list(
      [&](const auto& list, auto member) { tables[list.name] = to_table(std::move(member(frame))); });
  nb::dict dict;
  dict["time"] = frame.time;
  dict["tables"] = tables;
  dict["stats"] = dict_of(frame.stats);
  return dict;
}

/// Records the steps of a scene or simulation whose objects stay the same.
class RecorderCore {
 public:
  RecorderCore(const std::string& path, const nb::list& objects, double time_step) {
    RecordingHeader header;
    header.time_step = time_step;
    for (const nb::handle each : objects) {
      const auto& mesh = nb::cast<const MeshData&>(each[1]).mesh;
      RecordedObject object{nb::cast<ObjectId>(each[0]), {}, mesh.positions, mesh.triangles};
      set_options(object.options, nb::cast<nb::dict>(each[2]), "record");
      header.objects.push_back(std::move(object));
    }
    recorder_.emplace(path, header);
  }

  void add(double time, const nb::list& positions, const Result& result) {
    std::vector<std::span<const Vec3d>> spans;
    std::vector<Matrix<double, 3>> arrays;  // keeps them
    for (const nb::handle each : positions) {
      arrays.push_back(nb::cast<Matrix<double, 3>>(each));
      spans.push_back(rows_of<Vec3d>(arrays.back()));
    }
    open().add(time, spans, result.found);
  }
  void flush() { open().flush(); }
  void close() {
    if (!recorder_) return;
    recorder_->close();
    recorder_.reset();
  }

 private:
  Recorder& open() {
    if (!recorder_) throw Error("the recorder is closed");
    return *recorder_;
  }
  std::optional<Recorder> recorder_;
};

}  // namespace

void bind_files(nb::module_& module) {
  nb::class_<MeshData>(module, "Mesh")
      .def(
          "__init__",
          [](MeshData* self, const std::string& name, const Array& positions, const Array& triangles,
             const std::optional<Matrix<std::uint32_t, 2>>& edges,
             const std::optional<List<std::uint32_t>>& points) {
            new (self) MeshData(make_mesh(name, positions, triangles, edges, points));
          },
          nb::arg(), nb::arg(), nb::arg(), nb::arg().none(), nb::arg().none())
      .def("name", [](const MeshData& m) { return m.mesh.name; })
      .def("positions", [](const MeshData& m) { return positions_array(m.mesh.positions); })
      .def("triangles", [](const MeshData& m) { return triangles_array(m.mesh.triangles); })
      .def("edges",
           [](const MeshData& m) { return to_own_array<std::uint32_t, 2>(std::vector(m.mesh.edges)); })
      .def("points",
           [](const MeshData& m) { return to_own_array<std::uint32_t>(std::vector(m.mesh.points)); })
      .def("polygons", [](const MeshData& m) { return dict_of(m.mesh.polygons); });
  module.def("load_mesh", [](const std::string& path) {
    const WithoutGil without_gil;
    return MeshData{load_mesh(path)};
  });
  module.def("save_mesh", [](const MeshData& mesh, const std::string& path) { save_mesh(mesh.mesh, path); });
  module.def("model_names", [] {
    nb::list names;
    for (const std::string_view name : model_names()) names.append(std::string(name));
    return names;
  });
  module.def("make_model", [](const std::string& name) { return MeshData{make_model(name)}; });
  module.def("make_icosphere", [](std::uint32_t frequency) { return MeshData{make_icosphere(frequency)}; });
  module.def("make_torus", [](std::uint32_t rings, std::uint32_t sides, double major, double minor) {
    return MeshData{make_torus(rings, sides, major, minor)};
  });
  module.def("make_box", [](double x, double y, double z, std::uint32_t resolution) {
    return MeshData{make_box({x, y, z}, resolution)};
  });
  module.def("make_cloth", [](std::uint32_t columns, std::uint32_t rows, double width, double depth) {
    return MeshData{make_cloth(columns, rows, width, depth)};
  });

  nb::class_<Recording>(module, "Recording")
      .def("__init__", [](Recording* self, const std::string& path) { new (self) Recording(path); })
      .def("frame_count", &Recording::frame_count)
      .def("time_step", [](const Recording& r) { return r.header().time_step; })
      .def("scene_file", [](const Recording& r) { return r.header().scene_file; })
      .def("objects",
           [](const Recording& r) {
             nb::list list;
             for (const RecordedObject& each : r.header().objects)
               list.append(nb::make_tuple(each.id, each.options.name, positions_array(each.rest_positions),
                                          triangles_array(each.triangles)));
             return list;
           })
      .def("frame", [](const Recording& r, std::uint64_t number) { return frame_of(r.frame(number)); })
      .def("summary", [](const Recording& r, std::uint64_t number) { return frame_of(r.summary(number)); })
      .def("positions", [](const Recording& r, std::uint64_t frame, std::size_t object) {
        return positions_array(r.positions(frame, object));
      });
  module.def(
      "find_first_difference", [](const Recording& a, const Recording& b, double tolerance) -> nb::object {
        const auto difference = find_first_difference(a, b, tolerance);
        if (!difference) return nb::none();
        return nb::make_tuple(difference->frame ? nb::cast(*difference->frame) : nb::object(nb::none()),
                              difference->what);
      });
  nb::class_<RecorderCore>(module, "Recorder")
      .def(nb::init<std::string, nb::list, double>())
      .def("add", &RecorderCore::add)
      .def("flush", &RecorderCore::flush)
      .def("close", &RecorderCore::close);
}

}  // namespace supple::python
