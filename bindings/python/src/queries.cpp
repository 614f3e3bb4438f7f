#include <nanobind/stl/optional.h>

#include "arrays.hpp"
#include "records.hpp"
#include "scene.hpp"
#include "supple/verify.hpp"

namespace supple::python {
namespace {

using Together = CallGuard::Together;
using Points = Matrix<double, 3>;
using Rays = Matrix<double, 6>;
using SphereRows = Matrix<double, 4>;

QueryFilter filter_with(const std::optional<ObjectId>& object, std::uint32_t mask) {
  return {object, mask};
}

/// Runs a query that fills one answer for each question.
template <class Answer, class Query>
std::vector<Answer> run_query(SceneCore& core, const char* name, std::size_t count, Stop* stop,
                              const Query& query) {
  const Together together(core.guard());
  return run_or_fail(stop, name, [&](std::stop_token token) {
    std::vector<Answer> answers(count);
    query(std::span(answers), CallLimits{std::move(token)});
    return answers;
  });
}

/// Runs a query that returns its answer.
template <class Query>
auto run_query(SceneCore& core, const char* name, Stop* stop, const Query& query) {
  const Together together(core.guard());
  return run_or_fail(stop, name, [&](std::stop_token token) { return query(CallLimits{std::move(token)}); });
}

/// The answers of a table with the member `found`.
template <class Row>
std::vector<std::optional<Row>> answers_of(const List<std::uint8_t>& bytes) {
  if (bytes.size() % sizeof(Found<Row>) != 0) throw Error("the table is not an answer of this query");
  const auto* const rows = reinterpret_cast<const Found<Row>*>(bytes.data());
  std::vector<std::optional<Row>> answers(bytes.size() / sizeof(Found<Row>));
  for (std::size_t i = 0; i < answers.size(); ++i) {
    if (rows[i].found) answers[i] = rows[i].row;
  }
  return answers;
}
template <class Row>
std::span<const Row> records_of(const List<std::uint8_t>& bytes) {
  if (bytes.size() % sizeof(Row) != 0) throw Error("the table is not an answer of this query");
  return {reinterpret_cast<const Row*>(bytes.data()), bytes.size() / sizeof(Row)};
}

nb::list wrong_answers(const std::vector<WrongAnswer>& answers) {
  nb::list list;
  for (const WrongAnswer& each : answers) list.append(nb::make_tuple(each.query, each.found, each.expected));
  return list;
}

template <class Check>
nb::list verify_query(SceneCore& core, const Check& check) {
  const Together together(core.guard());
  return wrong_answers([&] {
    const WithoutGil without_gil;
    return check(static_cast<const Scene&>(core.scene()));
  }());
}

}  // namespace

void bind_queries(nb::module_&, nb::class_<SceneCore>& scene) {
  const auto object = [] { return nb::arg().none(); };
  scene.def(
      "closest",
      [](SceneCore& core, const Points& points, std::optional<ObjectId> only, std::uint32_t mask,
         double max_distance, bool is_signed, Stop* stop) {
        return to_answers(run_query<std::optional<ClosestPoint>>(
            core, "closest", points.shape(0), stop, [&](auto answers, const CallLimits& limits) {
              core.scene().closest(rows_of<Vec3d>(points), answers,
                                   {filter_with(only, mask), max_distance, is_signed, limits});
            }));
      },
      nb::arg(), object(), nb::arg(), nb::arg(), nb::arg(), object());
  scene.def(
      "cast",
      [](SceneCore& core, const Rays& rays, std::optional<ObjectId> only, std::uint32_t mask, bool count_hits,
         Stop* stop) {
        return to_answers(run_query<std::optional<RayHit>>(
            core, "cast", rays.shape(0), stop, [&](auto answers, const CallLimits& limits) {
              core.scene().cast(rows_of<Ray>(rays), answers, {filter_with(only, mask), count_hits, limits});
            }));
      },
      nb::arg(), object(), nb::arg(), nb::arg(), object());
  scene.def(
      "cast_all",
      [](SceneCore& core, const Rays& rays, std::optional<ObjectId> only, std::uint32_t mask, Stop* stop) {
        return to_table(run_query(core, "cast_all", stop, [&](const CallLimits& limits) {
          return core.scene().cast_all(rows_of<Ray>(rays), filter_with(only, mask), limits);
        }));
      },
      nb::arg(), object(), nb::arg(), object());
  scene.def(
      "overlaps_boxes",
      [](SceneCore& core, const Rays& boxes, std::optional<ObjectId> only, std::uint32_t mask, Stop* stop) {
        return to_table(run_query(core, "overlaps_boxes", stop, [&](const CallLimits& limits) {
          return core.scene().overlaps(rows_of<QueryBox>(boxes), filter_with(only, mask), limits);
        }));
      },
      nb::arg(), object(), nb::arg(), object());
  scene.def(
      "overlaps_spheres",
      [](SceneCore& core, const SphereRows& spheres, std::optional<ObjectId> only, std::uint32_t mask,
         Stop* stop) {
        return to_table(run_query(core, "overlaps_spheres", stop, [&](const CallLimits& limits) {
          return core.scene().overlaps(rows_of<QuerySphere>(spheres), filter_with(only, mask), limits);
        }));
      },
      nb::arg(), object(), nb::arg(), object());
  scene.def(
      "inside",
      [](SceneCore& core, const Points& points, std::optional<ObjectId> only, std::uint32_t mask,
         Stop* stop) {
        const auto answers = run_query<Containment>(
            core, "inside", points.shape(0), stop, [&](auto results, const CallLimits& limits) {
              core.scene().inside(rows_of<Vec3d>(points), results, filter_with(only, mask), limits);
            });
        std::vector<std::uint8_t> numbers(answers.size());
        for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<std::uint8_t>(answers[i]);
        return to_table(std::move(numbers));
      },
      nb::arg(), object(), nb::arg(), object());
  scene.def(
      "distance",
      [](SceneCore& core, ObjectId a, ObjectId b, Stop* stop) {
        return to_table(run_query(core, "distance", stop, [&](const CallLimits& limits) {
          return core.scene().distance(a, b, limits);
        }));
      },
      nb::arg(), nb::arg(), object());
  scene.def(
      "distances",
      [](SceneCore& core, double max_distance, Stop* stop) {
        return to_table(run_query(core, "distances", stop, [&](const CallLimits& limits) {
          return core.scene().distances(max_distance, limits);
        }));
      },
      nb::arg(), object());
  scene.def(
      "any_contact",
      [](SceneCore& core, ObjectId a, ObjectId b, Stop* stop) {
        return run_query(core, "any_contact", stop,
                         [&](const CallLimits& limits) { return core.scene().any_contact(a, b, limits); });
      },
      nb::arg(), nb::arg(), object());

  scene.def(
      "verify_closest",
      [](SceneCore& core, const Points& points, const List<std::uint8_t>& answers,
         std::optional<ObjectId> only, std::uint32_t mask, double max_distance, bool is_signed) {
        const auto found = answers_of<ClosestPoint>(answers);
        return verify_query(core, [&](const Scene& s) {
          return verify_closest(s, rows_of<Vec3d>(points), found,
                                {filter_with(only, mask), max_distance, is_signed, {}});
        });
      },
      nb::arg(), nb::arg(), object(), nb::arg(), nb::arg(), nb::arg());
  scene.def(
      "verify_cast",
      [](SceneCore& core, const Rays& rays, const List<std::uint8_t>& answers, std::optional<ObjectId> only,
         std::uint32_t mask, bool count_hits) {
        const auto found = answers_of<RayHit>(answers);
        return verify_query(core, [&](const Scene& s) {
          return verify_cast(s, rows_of<Ray>(rays), found, {filter_with(only, mask), count_hits, {}});
        });
      },
      nb::arg(), nb::arg(), object(), nb::arg(), nb::arg());
  scene.def(
      "verify_cast_all",
      [](SceneCore& core, const Rays& rays, const List<std::uint8_t>& hits, std::optional<ObjectId> only,
         std::uint32_t mask) {
        return verify_query(core, [&](const Scene& s) {
          return verify_cast_all(s, rows_of<Ray>(rays), records_of<ListedRayHit>(hits),
                                 filter_with(only, mask));
        });
      },
      nb::arg(), nb::arg(), object(), nb::arg());
  scene.def(
      "verify_overlaps_boxes",
      [](SceneCore& core, const Rays& boxes, const List<std::uint8_t>& found, std::optional<ObjectId> only,
         std::uint32_t mask) {
        return verify_query(core, [&](const Scene& s) {
          return verify_overlaps(s, rows_of<QueryBox>(boxes), records_of<Overlap>(found),
                                 filter_with(only, mask));
        });
      },
      nb::arg(), nb::arg(), object(), nb::arg());
  scene.def(
      "verify_overlaps_spheres",
      [](SceneCore& core, const SphereRows& spheres, const List<std::uint8_t>& found,
         std::optional<ObjectId> only, std::uint32_t mask) {
        return verify_query(core, [&](const Scene& s) {
          return verify_overlaps(s, rows_of<QuerySphere>(spheres), records_of<Overlap>(found),
                                 filter_with(only, mask));
        });
      },
      nb::arg(), nb::arg(), object(), nb::arg());
  scene.def(
      "verify_inside",
      [](SceneCore& core, const Points& points, const List<std::uint8_t>& answers,
         std::optional<ObjectId> only, std::uint32_t mask) {
        std::vector<Containment> found(answers.size());
        for (std::size_t i = 0; i < found.size(); ++i) found[i] = static_cast<Containment>(answers.data()[i]);
        return verify_query(core, [&](const Scene& s) {
          return verify_inside(s, rows_of<Vec3d>(points), found, filter_with(only, mask));
        });
      },
      nb::arg(), nb::arg(), object(), nb::arg());
  scene.def("verify_distance", [](SceneCore& core, ObjectId a, ObjectId b, const List<std::uint8_t>& found) {
    const auto pairs = records_of<ProximityPair>(found);
    return verify_query(core, [&](const Scene& s) {
      return verify_distance(s, a, b, pairs.empty() ? std::nullopt : std::optional(pairs.front()));
    });
  });
  scene.def("verify_distances", [](SceneCore& core, double max_distance, const List<std::uint8_t>& found) {
    return verify_query(core, [&](const Scene& s) {
      return verify_distances(s, max_distance, records_of<ProximityPair>(found));
    });
  });
  scene.def("verify_any_contact", [](SceneCore& core, ObjectId a, ObjectId b, bool found) {
    return verify_query(core, [&](const Scene& s) { return verify_any_contact(s, a, b, found); });
  });
}

}  // namespace supple::python
