#include <nanobind/stl/optional.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include <string_view>

#include "arrays.hpp"
#include "meshes.hpp"
#include "options.hpp"
#include "records.hpp"
#include "scene.hpp"
#include "simulation.hpp"
#include "supple/simulation_descriptions.hpp"

namespace supple::python {
namespace {

using Alone = CallGuard::Alone;
using Points = Matrix<double, 3>;

}  // namespace

SimulationCore::SimulationCore(const nb::dict& keywords) {
  SimulationOptions options;
  for (const auto [key, value] : keywords) {
    const auto keyword = nb::cast<std::string>(key);
    if (keyword == "border" || keyword == "bounds") {
      if (value.is_none()) continue;
      Points corners;
      if (!nb::try_cast(value, corners) || corners.shape(0) != 2)
        fail_value("Simulation", "border", value, "an array of two corners, lowest and highest");
      options.border = Border{rows_of<Vec3d>(corners)[0], rows_of<Vec3d>(corners)[1]};
    } else if (keyword == "response") {
      if (value.is_none()) continue;
      nb::dict response;
      if (!nb::try_cast(value, response)) fail_value("Simulation", "response", value, "a dict of options");
      set_options(options.response.emplace(), response, "Simulation: response");
    } else if (!set_option(options, keyword, value, "Simulation")) {
      throw nb::type_error(
          ("Simulation: there is no option '" + keyword + "'; supple.options('SimulationOptions') lists all")
              .c_str());
    }
  }
  state_ = std::make_shared<SimulationState>(options);
}

template <class Advance>
std::unique_ptr<Result> SimulationCore::run(const nb::dict& keywords, const char* where, Stop* stop,
                                            const Advance& advance) {
  DetectRequest request = request_of(keywords, simulation().options().scene, where);
  const Alone alone(guard());
  auto result = std::make_unique<Result>();
  const auto run = [&](std::stop_token token) {
    request.stop = std::move(token);
    state_->last.leave(simulation());
    return advance(simulation(), request);
  };
  // A step cannot be taken twice.
  result->found = run_stoppable(stop, run, std::string_view(where) != "step");
  result->lists = state_->last.begin(state_);
  return result;
}

namespace {

MassSpringMotion springs_of(const nb::dict& keywords,
                            const std::optional<List<std::uint32_t>>& fixed_vertices,
                            const nb::list& handles) {
  MassSpringMotion motion;
  set_options(motion, keywords, "add");
  if (fixed_vertices)
    motion.springs.fixed_vertices.assign(fixed_vertices->data(),
                                         fixed_vertices->data() + fixed_vertices->size());
  for (const nb::handle each : handles) {
    auto& handle = motion.handles.emplace_back();
    handle.vertices = nb::cast<std::vector<std::uint32_t>>(each[0]);
    set_options(handle, nb::cast<nb::dict>(each[1]), "add: handle");
  }
  return motion;
}

/// Calls `function(seconds, positions)`, which may change the (n, 3) array or return another one.
MotionFunction motion_of(const HeldFunction& function) {
  return [function](double seconds, std::span<Vec3d> positions) {
    nb::gil_scoped_acquire acquire;
    auto* const copy = new std::vector<Vec3d>(positions.begin(), positions.end());
    const nb::ndarray<nb::numpy, double, nb::shape<-1, 3>> array(copy->data(), {copy->size(), 3},
                                                                 owner_of(copy));
    const nb::object answer = (*function)(seconds, array);
    if (answer.is_none()) {
      std::copy(copy->begin(), copy->end(), positions.begin());
      return;
    }
    Array moved;
    if (!nb::try_cast(answer, moved)) throw Error("the motion must return an (n, 3) array or None");
    const PositionsView view = positions_of(moved);
    if (view.size() != positions.size())
      throw Error("the motion returned " + std::to_string(view.size()) + " positions for " +
                  std::to_string(positions.size()) + " vertices");
    for (std::size_t i = 0; i < positions.size(); ++i) positions[i] = view[i];
  };
}

nb::object copy_of(std::span<const Vec3d> positions) {
  return to_own_array<double, 3>(std::vector<Vec3d>(positions.begin(), positions.end()));
}

nb::object add_object(SimulationCore& core, const MeshData& mesh, const nb::dict& object,
                      const std::string& kind, nb::object motion,
                      const std::optional<List<std::uint32_t>>& fixed_vertices, const nb::list& handles) {
  ObjectOptions options;
  set_options(options, object, "add");
  const auto add = [&](const auto&... how) {
    const Alone alone(core.guard());
    return nb::cast(core.simulation().add(mesh.mesh, options, how...));
  };
  if (kind == "springs") return add(springs_of(nb::cast<nb::dict>(motion), fixed_vertices, handles));
  if (kind == "function") {
    const HeldFunction function = held(std::move(motion));
    const Alone alone(core.guard());
    const ObjectId added = core.simulation().add(mesh.mesh, options, motion_of(function));
    core.motions().emplace(added, function);
    return nb::cast(added);
  }
  if (kind == "rigid") {
    RigidMotion rigid;
    set_options(rigid, nb::cast<nb::dict>(motion), "add");
    return add(rigid);
  }
  const Alone alone(core.guard());
  return nb::cast(core.simulation().add(mesh.mesh, options));
}

}  // namespace

void bind_simulation(nb::module_& module) {
  nb::class_<SimulationCore> simulation(module, "Simulation", nb::type_slots(slots_of<SimulationCore>));
  simulation.def(nb::init<nb::dict>());
  simulation.def("add", &add_object, nb::arg(), nb::arg(), nb::arg(), nb::arg().none(), nb::arg().none(),
                 nb::arg());
  simulation.def("remove", [](SimulationCore& core, ObjectId id) {
    HeldFunction motion;
    const Alone alone(core.guard());
    core.simulation().remove(id);
    if (const auto found = core.motions().extract(id)) motion = std::move(found.mapped());
  });
  simulation.def(
      "detect",
      [](SimulationCore& core, const nb::dict& request, Stop* stop) {
        return core.run(request, "detect", stop,
                        [](Simulation& s, const DetectRequest& r) { return s.detect(r); });
      },
      nb::arg(), nb::arg().none());
  simulation.def(
      "step",
      [](SimulationCore& core, const nb::dict& request, Stop* stop) {
        return core.run(request, "step", stop,
                        [](Simulation& s, const DetectRequest& r) { return s.step(r); });
      },
      nb::arg(), nb::arg().none());
  simulation.def("step_count", [](SimulationCore& core) { return core.simulation().step_count(); });
  simulation.def("time", [](SimulationCore& core) { return core.simulation().time(); });
  simulation.def("motion_seconds", [](SimulationCore& core) { return core.simulation().motion_seconds(); });
  simulation.def("time_step", [](SimulationCore& core) { return core.simulation().options().time_step; });
  simulation.def(
      "name", [](SimulationCore& core, ObjectId id) { return core.simulation().scene().options(id).name; });
  simulation.def("objects", [](SimulationCore& core) { return core.simulation().scene().objects(); });
  simulation.def("positions", [](SimulationCore& core, ObjectId id) {
    const Alone alone(core.guard());
    return copy_of(core.simulation().positions(id));
  });
  simulation.def("set_positions", [](SimulationCore& core, ObjectId id, const Points& positions) {
    const Alone alone(core.guard());
    core.simulation().set_positions(id, rows_of<Vec3d>(positions));
  });
  simulation.def("vertices_of",
                 [](SimulationCore& core, const std::string& record, const List<std::uint8_t>& rows) {
                   const Alone alone(core.guard());
                   return vertices_of_records(core.simulation().scene(), record, rows);
                 });
  simulation.def("velocities", [](SimulationCore& core, ObjectId id) -> nb::object {
    const Alone alone(core.guard());
    const MassSpringBody* const body = core.simulation().body(id);
    return body == nullptr ? nb::object(nb::none()) : copy_of(body->velocities());
  });

  nb::class_<MassSpringBody> body(module, "MassSpringBody");
  body.def(
      "__init__",
      [](MassSpringBody* self, const MeshData& mesh, const nb::dict& keywords,
         const std::optional<List<std::uint32_t>>& fixed_vertices) {
        MassSpringOptions options;
        set_options(options, keywords, "MassSpringBody");
        if (fixed_vertices)
          options.fixed_vertices.assign(fixed_vertices->data(),
                                        fixed_vertices->data() + fixed_vertices->size());
        new (self) MassSpringBody(mesh.mesh, options);
      },
      nb::arg(), nb::arg(), nb::arg().none());
  body.def("step", [](MassSpringBody& b, double seconds) { b.step(seconds); });
  body.def("undo_step", &MassSpringBody::undo_step);
  body.def("positions", [](const MassSpringBody& b) { return copy_of(b.positions()); });
  body.def("velocities", [](const MassSpringBody& b) { return copy_of(b.velocities()); });
  body.def("set_positions", [](MassSpringBody& b, const Points& x) { b.set_positions(rows_of<Vec3d>(x)); });
  body.def("set_velocities", [](MassSpringBody& b, const Points& v) { b.set_velocities(rows_of<Vec3d>(v)); });
  body.def("set_external_forces",
           [](MassSpringBody& b, const Points& f) { b.set_external_forces(rows_of<Vec3d>(f)); });
  body.def("add_drift", [](MassSpringBody& b, double x, double y, double z) { b.add_drift({x, y, z}); });
  body.def("reflect", [](MassSpringBody& b, int axis) {
    if (axis < 0 || axis > 2)
      throw Error("reflect: the axis is " + std::to_string(axis) + "; it must be 0, 1 or 2");
    b.reflect(axis);
  });
  body.def("vertex_count", &MassSpringBody::vertex_count);
  body.def("stable_step", &MassSpringBody::stable_step);
  body.def("area", &MassSpringBody::area);
  body.def("volume", &MassSpringBody::volume);
  const auto vector = [](Vec3d v) { return nb::make_tuple(v.x, v.y, v.z); };
  body.def("momentum", [vector](const MassSpringBody& b) { return vector(b.momentum()); });
  body.def("angular_momentum", [vector](const MassSpringBody& b) { return vector(b.angular_momentum()); });
  body.def("center_of_mass", [vector](const MassSpringBody& b) { return vector(b.center_of_mass()); });
  body.def("mean_velocity", [vector](const MassSpringBody& b) { return vector(b.mean_velocity()); });
  body.def("energy", [](const MassSpringBody& b) {
    const MassSpringEnergy energy = b.energy();
    nb::dict dict;
    dict["kinetic"] = energy.kinetic;
    dict["elastic"] = energy.elastic;
    dict["area"] = energy.area;
    dict["volume"] = energy.volume;
    dict["gravity"] = energy.gravity;
    dict["total"] = energy.total();
    return dict;
  });
  body.def("area_error", [](const MassSpringBody& b) {
    const AreaError error = b.area_error();
    return nb::make_tuple(error.largest, error.mean);
  });
  body.def("edge_strain", [](const MassSpringBody& b) {
    const EdgeStrain strain = b.edge_strain();
    return nb::make_tuple(strain.largest, strain.mean);
  });
  body.def("bounds", [vector](const MassSpringBody& b) -> nb::object {
    const auto bounds = b.bounds();
    if (!bounds) return nb::none();
    return nb::make_tuple(vector((*bounds)[0]), vector((*bounds)[1]));
  });
  body.def("springs", [](const MassSpringBody& b) {
    std::vector<std::uint32_t> ends;
    std::vector<double> lengths;
    for (const MassSpringBody::Spring& each : b.springs()) {
      ends.push_back(each.a);
      ends.push_back(each.b);
      lengths.push_back(each.rest_length);
    }
    return nb::make_tuple(to_table(std::move(ends)), to_table(std::move(lengths)));
  });

  module.def(
      "respond",
      [](SceneCore& core, ObjectId id,
         nb::ndarray<double, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu> velocities,
         const std::optional<List<double>>& masses, double dt, const nb::dict& keywords) {
        ContactResponse options;
        set_options(options, keywords, "respond");
        const std::span<Vec3d> v(reinterpret_cast<Vec3d*>(velocities.data()), velocities.shape(0));
        const std::span<const double> m = masses ? span_of(*masses) : std::span<const double>();
        const Alone alone(core.guard());
        const WithoutGil without_gil;
        return respond(core.scene(), id, v, m, dt, options);
      },
      nb::arg(), nb::arg(), nb::arg(), nb::arg().none(), nb::arg(), nb::arg());
}

}  // namespace supple::python
