#pragma once

#include <nanobind/nanobind.h>

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "arrays.hpp"
#include "calls.hpp"
#include "supple/supple.hpp"

namespace supple::python {

namespace nb = nanobind;

/// A function of Python that the library calls, or none. The type of who keeps it visits it (`traverse`).
using HeldFunction = std::shared_ptr<nb::object>;

/// For the garbage collector: a scene can reach itself through a function that it calls. The functions and
/// the objects between them end such cycles, so the type clears nothing. `core.for_each_held(visit)` calls
/// `visit(object)` for all that Python gave to it.
template <class Core>
int traverse(PyObject* self, visitproc visit, void* arg) noexcept {
  Py_VISIT(Py_TYPE(self));
  if (!nb::inst_ready(self)) return 0;
  int stop = 0;
  nb::inst_ptr<Core>(self)->for_each_held([&](const nb::object& held) {
    if (stop == 0) stop = visit(held.ptr(), arg);
  });
  return stop;
}
template <class Core>
inline PyType_Slot slots_of[] = {{Py_tp_traverse, reinterpret_cast<void*>(&traverse<Core>)}, {0, nullptr}};

/// What a result of Python reads. The scene has its memory until the next `detect`, which then leaves it
/// here.
struct Lists {
  std::shared_ptr<void> source;      ///< the scene or the simulation
  std::shared_ptr<const void> kept;  ///< see `Scene::keep_result`
};

/// The last result that Python may hold.
class LastLists {
 public:
  /// Call it before `detect`: when Python still holds the last result, its memory leaves the scene.
  template <class Source>
  void leave(Source& source) {
    if (const auto lists = lists_.lock(); lists && !lists->kept) lists->kept = source.keep_result();
  }
  std::shared_ptr<Lists> begin(std::shared_ptr<void> source) {
    auto lists = std::make_shared<Lists>(Lists{std::move(source), nullptr});
    lists_ = lists;
    return lists;
  }

 private:
  std::weak_ptr<Lists> lists_;
};

/// A result with the memory of its lists.
struct Result {
  DetectResult found;
  std::shared_ptr<Lists> lists;
};

struct SceneState {
  explicit SceneState(const SceneOptions& options) : scene(options) {}

  Scene scene;
  CallGuard guard;
  LastLists last;
  HeldFunction filter;
  std::map<ObjectId, nb::object> shared;  ///< arrays that the scene reads in place
};

/// The scene of Python.
class SceneCore {
 public:
  explicit SceneCore(const nb::dict& options);

  Scene& scene() { return state_->scene; }
  SceneState& state() { return *state_; }
  std::shared_ptr<SceneState> shared_state() { return state_; }
  CallGuard& guard() { return state_->guard; }
  HeldFunction& filter() { return state_->filter; }
  template <class Visit>
  void for_each_held(const Visit& visit) const {
    if (state_->filter) visit(*state_->filter);
    for (const auto& [id, array] : state_->shared) visit(array);
  }
  /// The object no longer reads an array in place.
  void forget_shared(ObjectId id) { state_->shared.erase(id); }
  std::unique_ptr<Result> detect(const nb::dict& request, Stop* stop);
  nb::object search(const nb::dict& request, nb::object only, Stop* stop);

 private:
  std::shared_ptr<SceneState> state_;
};

/// The vertices of both sides of each record, (n, 2, 3); `record` is the name of the structure.
nb::object vertices_of_records(const Scene& scene, const std::string& record, const List<std::uint8_t>& rows);
/// A request from keywords: those of `DetectRequest`. `options` are those of the scene.
DetectRequest request_of(const nb::dict& keywords, SceneOptions options, const char* where);
/// Keeps a function; none for None. Its last copy may be destroyed without the GIL.
HeldFunction held(nb::object function);
/// A filter that calls it, or none.
PairFilter filter_of(const HeldFunction& function);
/// The options of an object from keywords and arrays.
ObjectOptions object_options_of(const nb::dict& keywords,
                                const std::optional<List<std::uint32_t>>& same_vertex,
                                const std::optional<Matrix<std::uint32_t, 2>>& edges,
                                const std::optional<List<std::uint32_t>>& points);
/// The step and its limit.
nb::object tuple_of(const SafeStep& step);
/// A result whose lists are copies.
std::unique_ptr<Result> copy_of(const DetectResult& found);

void bind_scene(nb::module_& module);
void bind_results(nb::module_& module);
void bind_queries(nb::module_& module, nb::class_<SceneCore>& scene);
void bind_elements(nb::module_& module);
void bind_broad_phase(nb::module_& module);
void bind_placed_boxes(nb::module_& module);
void bind_inspection(nb::module_& module);
void bind_simulation(nb::module_& module);
void bind_files(nb::module_& module);

}  // namespace supple::python
