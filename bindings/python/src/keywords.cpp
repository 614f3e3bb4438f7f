// What keywords of Python mean. Both compiled modules have it.

#include <nanobind/nanobind.h>

#include "options.hpp"
#include "records.hpp"
#include "scene.hpp"

namespace supple::python {

void fail_value(const char* where, const char* key, nb::handle value, const std::string& wanted) {
  throw Error(std::string(where) + ": " + key + " is " + nb::cast<std::string>(nb::repr(value)) +
              "; it must be " + wanted);
}

ObjectOptions object_options_of(const nb::dict& keywords,
                                const std::optional<List<std::uint32_t>>& same_vertex,
                                const std::optional<Matrix<std::uint32_t, 2>>& edges,
                                const std::optional<List<std::uint32_t>>& points) {
  ObjectOptions options;
  set_options(options, keywords, "add");
  if (same_vertex) options.same_vertex.assign(same_vertex->data(), same_vertex->data() + same_vertex->size());
  if (points) options.points.assign(points->data(), points->data() + points->size());
  for (std::size_t i = 0; edges && i < edges->shape(0); ++i)
    options.edges.push_back({edges->data()[2 * i], edges->data()[2 * i + 1]});
  return options;
}

DetectRequest request_of(const nb::dict& keywords, SceneOptions options, const char* where) {
  DetectRequest request;
  for (const auto [key, value] : keywords) {
    const auto keyword = nb::cast<std::string>(key);
    if (keyword == "max_contacts") {
      if (!value.is_none() && !nb::try_cast(value, request.max_contacts))
        fail_value(where, "max_contacts", value, "None or a whole number from 0 on");
      continue;
    }
    if (!set_option(options, keyword, value, where)) {
      throw nb::type_error(
          (std::string(where) + ": there is no option '" + keyword +
           "'; the options are contacts, those of continuous contacts (supple.options"
           "('ImpactOptions')), proximity_listing, element_kinds, continuous_listing, manifolds, "
           "curves, depths and max_contacts")
              .c_str());
    }
    if (keyword == "contacts")
      request.contacts = options.contacts;
    else if (keyword == "proximity_listing")
      request.proximity_listing = options.proximity_listing;
    else if (keyword == "element_kinds")
      request.element_kinds = options.element_kinds;
    else if (keyword == "continuous_listing")
      request.continuous_listing = options.continuous_listing;
    else if (keyword == "manifolds")
      request.manifolds = options.manifolds;
    else if (keyword == "curves")
      request.curves = options.curves;
    else if (keyword == "depths")
      request.depths = options.depths;
    else if (ImpactOptions impact; keyword == "impact" || set_option(impact, keyword, value, where))
      request.impact = options.impact;
    else
      throw nb::type_error(
          (std::string(where) + ": '" + keyword + "' is fixed when the scene is made").c_str());
  }
  return request;
}

PairFilter filter_of(nb::object function) {
  if (function.is_none()) return {};
  // The last copy may be destroyed without the GIL.
  auto* const held = new nb::object(std::move(function));
  const std::shared_ptr<nb::object> shared(held, [](nb::object* object) {
    nb::gil_scoped_acquire acquire;
    delete object;
  });
  return [shared](ObjectId a, ObjectId b) {
    const CallGuard::Callback callback;
    nb::gil_scoped_acquire acquire;
    const nb::object answer = (*shared)(a, b);
    bool accepts = false;
    if (!nb::try_cast(answer, accepts)) {
      throw nb::type_error("the pair filter must return True or False");
    }
    return accepts;
  };
}

nb::object tuple_of(const SafeStep& step) {
  return nb::make_tuple(step.step, to_table(step.limit));
}

}  // namespace supple::python
