#include <nanobind/stl/vector.h>

#include <limits>

#include "arrays.hpp"
#include "options.hpp"
#include "records.hpp"
#include "scene.hpp"

// Distances and first impacts of raw elements, for many pairs in one call.

namespace supple::python {
namespace {

/// The points of many elements, `points` for each: an (n, points, 3) array.
template <std::size_t points>
using Elements = nb::ndarray<const double, nb::shape<-1, points, 3>, nb::c_contig, nb::device::cpu>;

template <std::size_t points>
std::array<Vec3d, points> element(const Elements<points>& elements, std::size_t i) {
  std::array<Vec3d, points> element;
  std::memcpy(static_cast<void*>(element.data()), elements.data() + i * points * 3, sizeof element);
  return element;
}

/// Calls `decide(i)` for each of `count` pairs without the GIL; Ctrl-C ends it.
template <class Row, class Decide>
nb::object decide_all(std::size_t count, const Decide& decide) {
  return to_answers(run_stoppable(nullptr, [&](const std::stop_token& token) {
    std::vector<std::optional<Row>> rows(count);
    for (std::size_t i = 0; i < count && !token.stop_requested(); ++i) rows[i] = decide(i);
    return rows;
  }));
}

void check_counts(std::size_t a, std::size_t b) {
  if (a != b)
    throw Error("the first list has " + std::to_string(a) + " elements and the second one " +
                std::to_string(b) + "; they must have the same number");
}

template <std::size_t points_a, std::size_t points_b, class Distance>
void bind_distance(nb::module_& module, const char* name, const Distance& distance) {
  module.def(name, [distance](const Elements<points_a>& a, const Elements<points_b>& b, double max_distance) {
    check_counts(a.shape(0), b.shape(0));
    return decide_all<ElementDistance>(a.shape(0), [&](std::size_t i) {
      return distance(element<points_a>(a, i), element<points_b>(b, i), max_distance);
    });
  });
}

template <class Motion, std::size_t points>
void bind_impact(nb::module_& module, const char* name) {
  module.def(name, [](const Elements<points>& start, const Elements<points>& end, const nb::dict& keywords) {
    check_counts(start.shape(0), end.shape(0));
    ImpactOptions options;
    set_options(options, keywords, "first_impact");
    return decide_all<Impact>(start.shape(0), [&](std::size_t i) {
      return first_impact(Motion{element<points>(start, i), element<points>(end, i)}, options);
    });
  });
}

}  // namespace

void bind_elements(nb::module_& module) {
  module.def("triangles_intersect", [](const Elements<3>& a, const Elements<3>& b) {
    check_counts(a.shape(0), b.shape(0));
    return to_table(run_stoppable(nullptr, [&](const std::stop_token& token) {
      std::vector<std::uint8_t> answers(a.shape(0));
      for (std::size_t i = 0; i < answers.size() && !token.stop_requested(); ++i)
        answers[i] = triangles_intersect(element<3>(a, i), element<3>(b, i)) ? 1 : 0;
      return answers;
    }));
  });
  module.def("intersect_triangles", [](const Elements<3>& a, const Elements<3>& b) {
    check_counts(a.shape(0), b.shape(0));
    return to_table(run_stoppable(nullptr, [&](const std::stop_token& token) {
      std::vector<TriangleIntersection> rows(a.shape(0));
      for (std::size_t i = 0; i < rows.size() && !token.stop_requested(); ++i)
        rows[i] = intersect_triangles(element<3>(a, i), element<3>(b, i));
      return rows;
    }));
  });
  module.def("contact_times_by_algebra",
             [](const std::string& kind, const nb::ndarray<const double, nb::ndim<3>, nb::c_contig>& start,
                const nb::ndarray<const double, nb::ndim<3>, nb::c_contig>& end, double separation) {
               check_counts(start.shape(0), end.shape(0));
               const std::size_t size = start.shape(1) * 3;
               std::vector<double> times(2 * start.shape(0), std::numeric_limits<double>::quiet_NaN());
               const auto decide = [&]<class Motion>(Motion motion, std::size_t i) {
                 std::memcpy(static_cast<void*>(&motion.start), start.data() + i * size, sizeof motion.start);
                 std::memcpy(static_cast<void*>(&motion.end), end.data() + i * size, sizeof motion.end);
                 if (const auto bracket = first_contact_by_algebra(motion, separation)) {
                   times[2 * i] = bracket->low;
                   times[2 * i + 1] = bracket->high;
                 }
               };
               const WithoutGil without_gil;
               for (std::size_t i = 0; i < start.shape(0); ++i) {
                 if (kind == "vertex_face")
                   decide(VertexFaceMotion{}, i);
                 else if (kind == "edge_edge")
                   decide(EdgeEdgeMotion{}, i);
                 else if (kind == "point_point")
                   decide(PointPointMotion{}, i);
                 else
                   decide(PointEdgeMotion{}, i);
               }
               return times;
             });
  bind_distance<1, 1>(module, "point_point_distance", [](const auto& a, const auto& b, double most) {
    return point_point_distance(a[0], b[0], most);
  });
  bind_distance<1, 2>(module, "point_edge_distance", [](const auto& a, const auto& b, double most) {
    return point_edge_distance(a[0], b, most);
  });
  bind_distance<1, 3>(module, "point_triangle_distance", [](const auto& a, const auto& b, double most) {
    return point_triangle_distance(a[0], b, most);
  });
  bind_distance<2, 2>(module, "edge_edge_distance", [](const auto& a, const auto& b, double most) {
    return edge_edge_distance(a, b, most);
  });
  bind_impact<VertexFaceMotion, 4>(module, "vertex_face_impact");
  bind_impact<EdgeEdgeMotion, 4>(module, "edge_edge_impact");
  bind_impact<PointPointMotion, 2>(module, "point_point_impact");
  bind_impact<PointEdgeMotion, 3>(module, "point_edge_impact");
}

}  // namespace supple::python
