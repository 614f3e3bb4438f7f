#include "layout.hpp"

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
          "toi", [](auto& row) -> auto& { return row.toi; }),
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
const std::vector<ColumnOf<StepStats>>& columns_of() {
  using Row = StepStats;
  static const std::vector<ColumnOf<Row>> columns{
      column<Row>(
          "refit_seconds", [](auto& row) -> auto& { return row.refit_seconds; }),
      column<Row>(
          "broad_phase_seconds", [](auto& row) -> auto& { return row.broad_phase_seconds; }),
      column<Row>(
          "rebuild_seconds", [](auto& row) -> auto& { return row.rebuild_seconds; }),
      column<Row>(
          "traversal_seconds", [](auto& row) -> auto& { return row.traversal_seconds; }),
      column<Row>(
          "exact_seconds", [](auto& row) -> auto& { return row.exact_seconds; }),
      column<Row>(
          "sort_and_events_seconds", [](auto& row) -> auto& { return row.sort_and_events_seconds; }),
      column<Row>(
          "total_seconds", [](auto& row) -> auto& { return row.total_seconds; }),
      column<Row>(
          "broad_phase_method", [](auto& row) -> auto& { return row.broad_phase_method; }),
      column<Row>(
          "objects_refitted", [](auto& row) -> auto& { return row.objects_refitted; }),
      column<Row>(
          "triangles_refitted", [](auto& row) -> auto& { return row.triangles_refitted; }),
      column<Row>(
          "subtrees_rebuilt", [](auto& row) -> auto& { return row.subtrees_rebuilt; }),
      column<Row>(
          "triangles_rebuilt", [](auto& row) -> auto& { return row.triangles_rebuilt; }),
      column<Row>(
          "object_pairs_tested", [](auto& row) -> auto& { return row.object_pairs_tested; }),
      column<Row>(
          "object_pairs", [](auto& row) -> auto& { return row.object_pairs; }),
      column<Row>(
          "node_pairs_visited", [](auto& row) -> auto& { return row.node_pairs_visited; }),
      column<Row>(
          "boxes_tested", [](auto& row) -> auto& { return row.boxes_tested; }),
      column<Row>(
          "candidate_pairs", [](auto& row) -> auto& { return row.candidate_pairs; }),
      column<Row>(
          "vertex_face_candidates", [](auto& row) -> auto& { return row.vertex_face_candidates; }),
      column<Row>(
          "edge_edge_candidates", [](auto& row) -> auto& { return row.edge_edge_candidates; }),
      column<Row>(
          "exact_fallbacks", [](auto& row) -> auto& { return row.exact_fallbacks; }),
      column<Row>(
          "contacts", [](auto& row) -> auto& { return row.contacts; }),
  };
  return columns;
}

}  // namespace supple
