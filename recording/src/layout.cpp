#include "layout.hpp"

#include "supple/result_descriptions.hpp"

namespace supple {

template <>
const std::vector<ColumnOf<ObjectPair>>& columns_of() {
  static const std::vector<ColumnOf<ObjectPair>> columns{
      column<ObjectPair>(
          "object_a", [](auto& row) -> auto& { return row.a.index; }),
      column<ObjectPair>(
          "object_b", [](auto& row) -> auto& { return row.b.index; }),
  };
  return columns;
}

template <>
const std::vector<ColumnOf<Contact>>& columns_of() {
  static const std::vector<ColumnOf<Contact>> columns{
      column<Contact>(
          "object_a", [](auto& row) -> auto& { return row.object_a.index; }),
      column<Contact>(
          "object_b", [](auto& row) -> auto& { return row.object_b.index; }),
      column<Contact>(
          "triangle_a", [](auto& row) -> auto& { return row.triangle_a; }),
      column<Contact>(
          "triangle_b", [](auto& row) -> auto& { return row.triangle_b; }),
      column<Contact>(
          "kind", [](auto& row) -> auto& { return row.kind; }),
      column<Contact>(
          "point_count", [](auto& row) -> auto& { return row.point_count; }),
      column<Contact>(
          "first_point", [](auto& row) -> auto& { return row.first_point; }),
      column<Contact>(
          "normal", [](auto& row) -> auto& { return row.normal; }),
  };
  return columns;
}

template <>
const std::vector<ColumnOf<ContactPoint>>& columns_of() {
  static const std::vector<ColumnOf<ContactPoint>> columns{
      column<ContactPoint>(
          "position", [](auto& row) -> auto& { return row.position; }),
      column<ContactPoint>(
          "feature_a", [](auto& row) -> auto& { return row.on_a.kind; }),
      column<ContactPoint>(
          "feature_index_a", [](auto& row) -> auto& { return row.on_a.index; }),
      column<ContactPoint>(
          "feature_b", [](auto& row) -> auto& { return row.on_b.kind; }),
      column<ContactPoint>(
          "feature_index_b", [](auto& row) -> auto& { return row.on_b.index; }),
  };
  return columns;
}

template <>
const std::vector<ColumnOf<ContinuousContact>>& columns_of() {
  using Row = ContinuousContact;
  static const std::vector<ColumnOf<Row>> columns{
      column<Row>(
          "object_a", [](auto& row) -> auto& { return row.object_a.index; }),
      column<Row>(
          "object_b", [](auto& row) -> auto& { return row.object_b.index; }),
      column<Row>(
          "kind", [](auto& row) -> auto& { return row.kind; }),
      column<Row>(
          "element_a", [](auto& row) -> auto& { return row.element_a; }),
      column<Row>(
          "element_b", [](auto& row) -> auto& { return row.element_b; }),
      column<Row>(
          "certainty", [](auto& row) -> auto& { return row.certainty; }),
      column<Row>(
          "touching_at_start", [](auto& row) -> auto& { return row.touching_at_start; }),
      column<Row>(
          "toi", [](auto& row) -> auto& { return row.toi; }),
      column<Row>(
          "start_distance", [](auto& row) -> auto& { return row.start_distance; }),
      column<Row>(
          "barycentric_a", [](auto& row) -> auto& { return row.barycentric_a; }),
      column<Row>(
          "barycentric_b", [](auto& row) -> auto& { return row.barycentric_b; }),
      column<Row>(
          "point", [](auto& row) -> auto& { return row.point; }),
      column<Row>(
          "normal", [](auto& row) -> auto& { return row.normal; }),
  };
  return columns;
}

template <>
const std::vector<ColumnOf<ProximityPair>>& columns_of() {
  using Row = ProximityPair;
  static const std::vector<ColumnOf<Row>> columns{
      column<Row>(
          "object_a", [](auto& row) -> auto& { return row.object_a.index; }),
      column<Row>(
          "object_b", [](auto& row) -> auto& { return row.object_b.index; }),
      column<Row>(
          "kind_a", [](auto& row) -> auto& { return row.kind_a; }),
      column<Row>(
          "kind_b", [](auto& row) -> auto& { return row.kind_b; }),
      column<Row>(
          "element_a", [](auto& row) -> auto& { return row.element_a; }),
      column<Row>(
          "element_b", [](auto& row) -> auto& { return row.element_b; }),
      column<Row>(
          "feature_a", [](auto& row) -> auto& { return row.on_a.kind; }),
      column<Row>(
          "feature_index_a", [](auto& row) -> auto& { return row.on_a.index; }),
      column<Row>(
          "feature_b", [](auto& row) -> auto& { return row.on_b.kind; }),
      column<Row>(
          "feature_index_b", [](auto& row) -> auto& { return row.on_b.index; }),
      column<Row>(
          "distance", [](auto& row) -> auto& { return row.distance; }),
      column<Row>(
          "barycentric_a", [](auto& row) -> auto& { return row.barycentric_a; }),
      column<Row>(
          "barycentric_b", [](auto& row) -> auto& { return row.barycentric_b; }),
      column<Row>(
          "point_a", [](auto& row) -> auto& { return row.point_a; }),
      column<Row>(
          "point_b", [](auto& row) -> auto& { return row.point_b; }),
      column<Row>(
          "normal", [](auto& row) -> auto& { return row.normal; }),
  };
  return columns;
}

template <>
const std::vector<ColumnOf<PenetrationGroup>>& columns_of() {
  using Row = PenetrationGroup;
  static const std::vector<ColumnOf<Row>> columns{
      column<Row>(
          "object_a", [](auto& row) -> auto& { return row.a.index; }),
      column<Row>(
          "object_b", [](auto& row) -> auto& { return row.b.index; }),
      column<Row>(
          "first_penetration", [](auto& row) -> auto& { return row.first_penetration; }),
      column<Row>(
          "penetration_count", [](auto& row) -> auto& { return row.penetration_count; }),
      column<Row>(
          "first_on_surface", [](auto& row) -> auto& { return row.first_on_surface; }),
      column<Row>(
          "on_surface_count", [](auto& row) -> auto& { return row.on_surface_count; }),
  };
  return columns;
}

template <>
const std::vector<ColumnOf<Penetration>>& columns_of() {
  using Row = Penetration;
  static const std::vector<ColumnOf<Row>> columns{
      column<Row>(
          "object_a", [](auto& row) -> auto& { return row.object_a.index; }),
      column<Row>(
          "object_b", [](auto& row) -> auto& { return row.object_b.index; }),
      column<Row>(
          "vertex", [](auto& row) -> auto& { return row.vertex; }),
      column<Row>(
          "triangle", [](auto& row) -> auto& { return row.triangle; }),
      column<Row>(
          "feature", [](auto& row) -> auto& { return row.feature.kind; }),
      column<Row>(
          "feature_index", [](auto& row) -> auto& { return row.feature.index; }),
      column<Row>(
          "depth", [](auto& row) -> auto& { return row.depth; }),
      column<Row>(
          "barycentric", [](auto& row) -> auto& { return row.barycentric; }),
      column<Row>(
          "point", [](auto& row) -> auto& { return row.point; }),
      column<Row>(
          "normal", [](auto& row) -> auto& { return row.normal; }),
  };
  return columns;
}

template <>
const std::vector<ColumnOf<ContainedPart>>& columns_of() {
  using Row = ContainedPart;
  static const std::vector<ColumnOf<Row>> columns{
      column<Row>(
          "object_a", [](auto& row) -> auto& { return row.inner.index; }),
      column<Row>(
          "object_b", [](auto& row) -> auto& { return row.outer.index; }),
      column<Row>(
          "vertex", [](auto& row) -> auto& { return row.vertex; }),
      column<Row>(
          "vertex_count", [](auto& row) -> auto& { return row.vertex_count; }),
      column<Row>(
          "is_whole", [](auto& row) -> auto& { return row.is_whole; }),
  };
  return columns;
}

template <>
const std::vector<ColumnOf<IntersectionCurve>>& columns_of() {
  using Row = IntersectionCurve;
  static const std::vector<ColumnOf<Row>> columns{
      column<Row>(
          "object_a", [](auto& row) -> auto& { return row.a.index; }),
      column<Row>(
          "object_b", [](auto& row) -> auto& { return row.b.index; }),
      column<Row>(
          "kind", [](auto& row) -> auto& { return row.kind; }),
      column<Row>(
          "first_contact", [](auto& row) -> auto& { return row.first_contact; }),
      column<Row>(
          "contact_count", [](auto& row) -> auto& { return row.contact_count; }),
      column<Row>(
          "first_point", [](auto& row) -> auto& { return row.first_point; }),
      column<Row>(
          "point_count", [](auto& row) -> auto& { return row.point_count; }),
      column<Row>(
          "first_enclosed", [](auto& row) -> auto& { return row.first_enclosed; }),
      column<Row>(
          "enclosed_count_a", [](auto& row) -> auto& { return row.enclosed_count_a; }),
      column<Row>(
          "enclosed_count_b", [](auto& row) -> auto& { return row.enclosed_count_b; }),
      column<Row>(
          "centroid", [](auto& row) -> auto& { return row.centroid; }),
      column<Row>(
          "area", [](auto& row) -> auto& { return row.area; }),
      column<Row>(
          "normal", [](auto& row) -> auto& { return row.normal; }),
      column<Row>(
          "depth", [](auto& row) -> auto& { return row.depth; }),
  };
  return columns;
}

template <>
const std::vector<ColumnOf<CurveContact>>& columns_of() {
  static const std::vector<ColumnOf<CurveContact>> columns{
      column<CurveContact>(
          "contact", [](auto& row) -> auto& { return row.contact; }),
  };
  return columns;
}

/// Points of curves.
template <>
const std::vector<ColumnOf<Vec3d>>& columns_of() {
  static const std::vector<ColumnOf<Vec3d>> columns{
      column<Vec3d>(
          "position", [](auto& row) -> auto& { return row; }),
  };
  return columns;
}

template <>
const std::vector<ColumnOf<CollidingVertices>>& columns_of() {
  static const std::vector<ColumnOf<CollidingVertices>> columns{
      column<CollidingVertices>(
          "object_a", [](auto& row) -> auto& { return row.a.index; }),
      column<CollidingVertices>(
          "object_b", [](auto& row) -> auto& { return row.b.index; }),
      column<CollidingVertices>(
          "first_vertex", [](auto& row) -> auto& { return row.first_vertex; }),
      column<CollidingVertices>(
          "count_a", [](auto& row) -> auto& { return row.count_a; }),
      column<CollidingVertices>(
          "count_b", [](auto& row) -> auto& { return row.count_b; }),
  };
  return columns;
}

/// Vertices on surfaces, enclosed by curves, or in colliding leaves.
template <>
const std::vector<ColumnOf<std::uint32_t>>& columns_of() {
  static const std::vector<ColumnOf<std::uint32_t>> columns{
      column<std::uint32_t>(
          "vertex", [](auto& row) -> auto& { return row; }),
  };
  return columns;
}

template <>
const std::vector<ColumnOf<StepStats>>& columns_of() {
  static const std::vector<ColumnOf<StepStats>> columns = [] {
    std::vector<ColumnOf<StepStats>> list;
    for_each_field<StepStats>([&](const auto& field) {
      list.push_back(column<StepStats>(
          field.key, [&](auto& row) -> auto& { return row.*field.member; }));
    });
    return list;
  }();
  return columns;
}

namespace {

struct Renamed {
  const char* now;
  const char* in_version_1;
};

std::string old_name(const std::string& name, std::uint32_t version, std::span<const Renamed> renamed) {
  if (version >= 2) return name;
  for (const Renamed& one : renamed) {
    if (name == one.now) return one.in_version_1;
  }
  return name;
}

}  // namespace

std::string attribute_in_version(const std::string& name, std::uint32_t version) {
  static constexpr Renamed renamed[] = {
      {"contacts", "contact_mode"},
      {"undecided", "exact_impacts"},
      {"region_test", "region_sphere_test"},
      {"self", "self_collision"},
      {"static", "is_static"},
      {"max_level", "octree_max_level"},
      {"leaf_size", "octree_leaf_size"},
  };
  return old_name(name, version, renamed);
}

std::string column_in_version(const std::string& name, std::uint32_t version) {
  static constexpr Renamed renamed[] = {
      {"sort_and_events_seconds", "finish_seconds"},
      {"toi", "time"},
      {"barycentric_a", "weights_a"},
      {"barycentric_b", "weights_b"},
  };
  return old_name(name, version, renamed);
}

}  // namespace supple
