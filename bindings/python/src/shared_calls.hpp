#pragma once

#include <nanobind/nanobind.h>

#include "arrays.hpp"
#include "calls.hpp"
#include "records.hpp"
#include "scene.hpp"
#include "supple/difference_descriptions.hpp"
#include "supple/verify.hpp"

namespace supple::python {

inline nb::dict report_of(const VerifyReport& report) {
  nb::dict dict;
  dict["stopped"] = report.stopped;
  dict["triangle_pairs_checked"] = report.triangle_pairs_checked;
  dict["intersecting_pairs"] = report.intersecting_pairs;
  dict["element_pairs_checked"] = report.element_pairs_checked;
  dict["touching_element_pairs"] = report.touching_element_pairs;
  dict["proximity_pairs_checked"] = report.proximity_pairs_checked;
  dict["near_pairs"] = report.near_pairs;
  dict["vertex_triangle_pairs_checked"] = report.vertex_triangle_pairs_checked;
  dict["inside_vertices"] = report.inside_vertices;
  dict["differences"] = to_table(std::vector(report.differences));
  dict["continuous_differences"] = to_table(std::vector(report.continuous_differences));
  dict["proximity_differences"] = to_table(std::vector(report.proximity_differences));
  dict["penetration_differences"] = to_table(std::vector(report.penetration_differences));
  return dict;
}

/// Binds the calls that a scene and a distributed scene share. `core.scene()` is one of them. A collective
/// call cannot be repeated on one rank.
template <class Core>
void bind_shared_calls(nb::class_<Core>& scene, bool can_repeat) {
  using Alone = CallGuard::Alone;
  const auto setter = [&](const char* name, auto set) { scene.def(name, set); };
  setter("remove", [](Core& core, ObjectId id) {
    const Alone alone(core.guard());
    core.scene().remove(id);
    core.forget_shared(id);
  });
  setter("set_positions", [](Core& core, ObjectId id, const Array& positions) {
    const Alone alone(core.guard());
    core.scene().set_positions(id, positions_of(positions));
    core.forget_shared(id);
  });
  setter("set_motion", [](Core& core, ObjectId id, const Array& from, const Array& to) {
    const Alone alone(core.guard());
    core.scene().set_motion(id, positions_of(from), positions_of(to));
    core.forget_shared(id);
  });
  setter("set_static", [](Core& core, ObjectId id, bool value) {
    const Alone alone(core.guard());
    core.scene().set_options(id, {.is_static = value});
  });
  setter("set_group", [](Core& core, ObjectId id, std::uint32_t group, std::uint32_t mask) {
    const Alone alone(core.guard());
    core.scene().set_options(id, {.group = group, .mask = mask});
  });
  setter("set_margin", [](Core& core, ObjectId id, double margin) {
    const Alone alone(core.guard());
    core.scene().set_options(id, {.margin = margin});
  });
  setter("set_min_separation", [](Core& core, ObjectId id, double separation) {
    const Alone alone(core.guard());
    core.scene().set_options(id, {.min_separation = separation});
  });
  setter("set_self_collision", [](Core& core, ObjectId id, bool enabled) {
    const Alone alone(core.guard());
    core.scene().set_options(id, {.self_collision = enabled});
  });
  setter("set_vertex_groups",
         [](Core& core, ObjectId id, const List<std::uint32_t>& groups, const List<std::uint32_t>& masks) {
           const Alone alone(core.guard());
           core.scene().set_vertex_groups(id, span_of(groups), span_of(masks));
         });
  scene.def(
      "set_pair_filter",
      [](Core& core, nb::object function) {
        HeldFunction filter = held(std::move(function));
        const Alone alone(core.guard());
        core.scene().set_pair_filter(filter_of(filter));
        core.filter().swap(filter);
      },
      nb::arg().none());
  scene.def(
      "earliest_impact",
      [can_repeat](Core& core, Stop* stop) {
        const Alone alone(core.guard());
        const auto call = [&](std::stop_token token) {
          return core.scene().earliest_impact({.stop = std::move(token)});
        };
        return to_table(run_or_fail(stop, "earliest_impact", call, can_repeat));
      },
      nb::arg().none());
  scene.def(
      "max_step",
      [can_repeat](Core& core, double seconds, Stop* stop) {
        const Alone alone(core.guard());
        const auto call = [&](std::stop_token token) {
          return core.scene().max_step({std::move(token), seconds});
        };
        return tuple_of(run_stoppable(stop, call, can_repeat));
      },
      nb::arg(), nb::arg().none());
  scene.def(
      "collision_free_step",
      [can_repeat](Core& core, double keep, double seconds, Stop* stop) {
        const Alone alone(core.guard());
        const auto call = [&](std::stop_token token) {
          return core.scene().collision_free_step({keep}, {std::move(token), seconds});
        };
        return tuple_of(run_stoppable(stop, call, can_repeat));
      },
      nb::arg(), nb::arg(), nb::arg().none());
}

}  // namespace supple::python
