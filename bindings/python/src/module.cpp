#include <nanobind/nanobind.h>

#include "options.hpp"
#include "scene.hpp"
#include "supple/broad_phase.hpp"
#include "supple/simulation.hpp"
#include "supple/simulation_descriptions.hpp"
#include "supple/version.hpp"

namespace supple::python {

void fail_value(const char* where, const char* key, nb::handle value, const std::string& wanted) {
  throw Error(std::string(where) + ": " + key + " is " + nb::cast<std::string>(nb::repr(value)) +
              "; it must be " + wanted);
}

}  // namespace supple::python

NB_MODULE(_core, module) {
  using namespace supple::python;
  namespace nb = nanobind;
  // Objects and scenes refer to each other, and tracebacks keep them until the interpreter ends.
  nb::set_leak_warnings(false);
  module.attr("version") = SUPPLE_VERSION;
  const nb::exception<supple::Error> error(module, "Error", PyExc_ValueError);
  nb::exception<supple::MotionError>(module, "MotionError", error);
  module.def("options", [](const std::string& structure) {
    nb::list list;
    bool is_known = false;
    const auto offer = [&]<class Struct>(const Struct*) {
      if (structure != supple::Description<Struct>::name) return;
      list = list_options<Struct>();
      is_known = true;
    };
    const auto* const none = static_cast<const void*>(nullptr);
    offer(static_cast<const supple::SceneOptions*>(none));
    offer(static_cast<const supple::ObjectOptions*>(none));
    offer(static_cast<const supple::ImpactOptions*>(none));
    offer(static_cast<const supple::StepOptions*>(none));
    offer(static_cast<const supple::BroadPhaseOptions*>(none));
    offer(static_cast<const supple::SimulationOptions*>(none));
    offer(static_cast<const supple::MassSpringOptions*>(none));
    offer(static_cast<const supple::MassSpringMotion*>(none));
    offer(static_cast<const supple::RigidMotion*>(none));
    offer(static_cast<const supple::ContactResponse*>(none));
    if (!is_known)
      throw supple::Error(
          "options: there are no options '" + structure +
          "'; there are SceneOptions, ObjectOptions, ImpactOptions, StepOptions, SimulationOptions, "
          "MassSpringOptions, MassSpringMotion, RigidMotion and ContactResponse");
    return list;
  });
  module.def("end_calls", &WithoutGil::end_calls);
  module.def("forget_calls", &WithoutGil::forget_calls);
  bind_results(module);
  bind_scene(module);
  bind_elements(module);
  bind_broad_phase(module);
  bind_inspection(module);
  bind_files(module);
  bind_simulation(module);
}
