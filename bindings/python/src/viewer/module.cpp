// `supple.attach`: a module of its own, so that `supple` loads neither a server nor a page. The types of
// `_core` are its types, too.

#include <nanobind/nanobind.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/unique_ptr.h>
#include <unistd.h>

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "../options.hpp"
#include "../scene.hpp"
#include "../simulation.hpp"
#include "program/attach_descriptions.hpp"
#include "supple/viewer.hpp"

namespace supple::python {
namespace {

using viewer::AttachOptions;
using viewer::BreakOptions;
using viewer::FieldElement;
using viewer::View;
using ObjectNames = std::array<std::string, 2>;

/// A view, and what it shows.
class ViewCore {
 public:
  template <class State, class Shown>
  ViewCore(std::shared_ptr<State> state, Shown& shown, const AttachOptions& options)
      : guard_(state->guard), owner_(std::move(state)) {
    const CallGuard::Alone alone(guard_);
    const WithoutGil without_gil;
    view_.emplace(viewer::attach(shown, options));
  }
  ~ViewCore() {
    // A process made by fork has none of the threads, so it cannot end them.
    if (getpid() != process_) {
      new std::optional<View>(std::move(view_));
      return;
    }
    const nb::gil_scoped_release release;
    view_.reset();
  }
  ViewCore(const ViewCore&) = delete;

  View& view() { return *view_; }
  void close() {
    const WithoutGil without_gil;
    view_->close();
  }
  template <class Value>
  void set_field(ObjectId object, const std::string& name, std::span<const Value> values,
                 const std::optional<std::string>& of) {
    std::optional<FieldElement> element;
    if (of && !(element = value_of_word<FieldElement>(*of)))
      throw Error("set_field: of is " + *of + "; it must be one of " + list_of_words<FieldElement>());
    const CallGuard::Together together(guard_);
    view_->set_field(object, name, values, element);
  }
  void wait(Stop* stop) {
    const CallGuard::Alone alone(guard_);
    run_stoppable(stop, [&](std::stop_token token) {
      view_->wait({std::move(token)});
      return true;
    });
  }

 private:
  const pid_t process_ = getpid();
  CallGuard& guard_;
  std::shared_ptr<void> owner_;
  std::optional<View> view_;
};

AttachOptions options_of(const nb::dict& keywords, ObjectNames objects) {
  AttachOptions options;
  set_options(options, keywords, "attach");
  options.breaks.objects = std::move(objects);
  return options;
}

}  // namespace
}  // namespace supple::python

NB_MODULE(_viewer, module) {
  using namespace supple;
  using namespace supple::python;
  nb::set_leak_warnings(false);
  module.def("end_calls", &WithoutGil::end_calls);
  module.def("forget_calls", &WithoutGil::forget_calls);
  module.def("options", [] { return list_options<AttachOptions>(); });
  nb::class_<ViewCore>(module, "View")
      .def("url", [](ViewCore& core) { return core.view().url(); })
      .def("watching_url", [](ViewCore& core) { return core.view().watching_url(); })
      .def("step_count", [](ViewCore& core) { return core.view().step_count(); })
      .def("frame_count", [](ViewCore& core) { return core.view().frame_count(); })
      .def("seconds_in_steps", [](ViewCore& core) { return core.view().seconds_in_steps(); })
      .def("is_paused", [](ViewCore& core) { return core.view().is_paused(); })
      .def("set_breaks",
           [](ViewCore& core, const nb::dict& keywords, ObjectNames objects) {
             BreakOptions breaks;
             set_options(breaks, keywords, "set_breaks");
             breaks.objects = std::move(objects);
             core.view().set_breaks(breaks);
           })
      .def(
          "set_field",
          [](ViewCore& core, ObjectId object, const std::string& name, const List<double>& values,
             const std::optional<std::string>& of) { core.set_field(object, name, span_of(values), of); },
          nb::arg(), nb::arg(), nb::arg(), nb::arg().none())
      .def(
          "set_field_vectors",
          [](ViewCore& core, ObjectId object, const std::string& name, const Matrix<double, 3>& values,
             const std::optional<std::string>& of) {
            core.set_field(object, name, rows_of<Vec3d>(values), of);
          },
          nb::arg(), nb::arg(), nb::arg(), nb::arg().none())
      .def("wait", &ViewCore::wait, nb::arg().none())
      .def("close", &ViewCore::close);
  module.def("attach_scene", [](SceneCore& core, const nb::dict& keywords, ObjectNames objects) {
    return std::make_unique<ViewCore>(core.shared_state(), core.scene(),
                                      options_of(keywords, std::move(objects)));
  });
  module.def("attach_simulation", [](SimulationCore& core, const nb::dict& keywords, ObjectNames objects) {
    return std::make_unique<ViewCore>(core.state(), core.simulation(),
                                      options_of(keywords, std::move(objects)));
  });
}
