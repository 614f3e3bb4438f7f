#include <nanobind/nanobind.h>

#include "options.hpp"
#include "scene.hpp"
#include "supple/broad_phase.hpp"
#include "supple/comparison.hpp"
#include "supple/simulation.hpp"
#include "supple/simulation_descriptions.hpp"
#include "supple/use_manifolds.hpp"
#include "supple/version.hpp"

NB_MODULE(_core, module) {
  using namespace supple::python;
  namespace nb = nanobind;
  // Objects and scenes refer to each other, and tracebacks keep them until the interpreter ends.
  nb::set_leak_warnings(false);
  supple::use_comparison_methods();
  supple::use_manifolds();
  module.attr("version") = SUPPLE_VERSION;
  const nb::exception<supple::Error> error(module, "Error", PyExc_ValueError);
  nb::exception<supple::MotionError>(module, "MotionError", error);
  module.def("options", [](const std::string& structure) {
    nb::list list;
    std::string known;
    const auto offer = [&]<class... Structs>(const Structs&...) {
      const auto offer_one = [&]<class Struct>(const Struct&) {
        const char* const name = supple::Description<Struct>::name;
        known += (known.empty() ? "" : ", ") + std::string(name);
        if (structure != name) return false;
        list = list_options<Struct>();
        return true;
      };
      return (offer_one(Structs{}) || ...);
    };
    if (!offer(supple::SceneOptions{}, supple::ObjectOptions{}, supple::ImpactOptions{},
               supple::StepOptions{}, supple::BroadPhaseOptions{}, supple::SimulationOptions{},
               supple::MassSpringOptions{}, supple::MassSpringMotion{}, supple::RigidMotion{},
               supple::ContactResponse{}))
      throw supple::Error("options: there are no options '" + structure + "'; there are those of " + known);
    return list;
  });
  module.def("method_of_2007", [](const nb::dict& keywords) {
    supple::SceneOptions scene;
    set_options(scene, keywords, "method_of_2007");
    const supple::ObjectOptions object{.octree = supple::octree_of_2007()};
    return nb::make_tuple(dict_of_options(supple::with_method_of_2007(scene)),
                          dict_of_options(object.octree));
  });
  module.def("end_calls", &WithoutGil::end_calls);
  module.def("forget_calls", &WithoutGil::forget_calls);
  bind_results(module);
  bind_scene(module);
  bind_elements(module);
  bind_broad_phase(module);
  bind_placed_boxes(module);
  bind_inspection(module);
  bind_files(module);
  bind_simulation(module);
}
