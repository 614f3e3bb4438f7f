#include "reports/result_json.hpp"

#include <algorithm>
#include <optional>
#include <ranges>
#include <vector>

namespace supple::cli {
namespace {

using Kinds = std::array<FeatureKind, 2>;
using enum FeatureKind;

void write_objects(JsonWriter& json, ObjectId a, ObjectId b) {
  json.member("a", a.index);
  json.member("b", b.index);
}

/// Writes the groups of different objects, or the groups of objects with themselves.
void write_triangle_pairs(JsonWriter& json, const char* name, const DetectResult& result, bool self) {
  const auto is_wanted = [&](const ContactGroup& group) { return (group.a == group.b) == self; };
  json.objects(name, result.groups | std::views::filter(is_wanted), [&](const ContactGroup& group) {
    json.member("a", group.a.index);
    if (!self) json.member("b", group.b.index);
    json.list("pairs", result.contacts_of(group),
              [&](const Contact& contact) { json.pair(contact.triangle_a, contact.triangle_b); });
  });
}

/// The consecutive rows of a group whose elements have these kinds.
template <class Row>
struct RowsOfKind {
  Kinds kinds;
  std::span<const Row> rows;
};

/// Splits a group by kinds, whose order in the group is that of `order`. A kind without rows is left out
/// unless `is_usual(kinds)`.
template <class Row, class IsUsual>
std::vector<RowsOfKind<Row>> by_kinds(std::span<const Row> group, std::span<const Kinds> order,
                                      IsUsual is_usual) {
  std::vector<RowsOfKind<Row>> all;
  for (const Kinds& kinds : order) {
    const auto end = std::find_if(group.begin(), group.end(), [&](const Row& row) {
      return Kinds{kind_of_element(row, 'a'), kind_of_element(row, 'b')} != kinds;
    });
    const auto count = static_cast<std::size_t>(end - group.begin());
    if (count > 0 || is_usual(kinds)) all.push_back({kinds, group.first(count)});
    group = group.subspan(count);
  }
  return all;
}

/// Writes rows of the ids of both elements and the number of each contact.
template <class Row>
void write_rows(JsonWriter& json, const RowsOfKind<Row>& of_kind, double Row::*number) {
  const auto [kind_a, kind_b] = of_kind.kinds;
  const auto write_ids = [&](const std::array<std::uint32_t, 2>& element, FeatureKind kind) {
    json.value(element[0]);
    if (kind == edge) json.value(element[1]);
  };
  json.list(kind_word(kind_a, kind_b).c_str(), of_kind.rows, [&](const Row& row) {
    json.begin_array();
    write_ids(row.element_a, kind_a);
    write_ids(row.element_b, kind_b);
    json.value(row.*number);
    json.end_array();
  });
}

/// Writes the rows, counted from 0, of contacts that are only within tolerance.
void write_uncertain_rows(JsonWriter& json, std::span<const RowsOfKind<ContinuousContact>> all) {
  json.object("within_tolerance", [&] {
    for (const RowsOfKind<ContinuousContact>& of_kind : all) {
      std::uint64_t row = 0;
      json.list(kind_word(of_kind.kinds[0], of_kind.kinds[1]).c_str(), of_kind.rows,
                [&](const auto& contact) {
                  if (contact.certainty != ImpactCertainty::certain) json.value(row);
                  ++row;
                });
    }
  });
}

void write_penetration_groups(JsonWriter& json, const DetectResult& result) {
  json.objects("penetration", result.penetration_groups, [&](const PenetrationGroup& group) {
    write_objects(json, group.a, group.b);
    json.list("vertices", result.penetrations_of(group),
              [&](const Penetration& p) { json.row(p.vertex, p.triangle, p.depth); });
    json.list("on_surface", result.vertices_on_surface_of(group));
  });
}

void write_containment(JsonWriter& json, std::span<const ContainedPart> parts) {
  const ContainedPart* before = nullptr;
  json.list("containment", parts, [&](const ContainedPart& part) {
    const bool is_first = !before || before->inner != part.inner || before->outer != part.outer;
    if (part.is_whole && is_first) json.pair(part.inner.index, part.outer.index);
    before = &part;
  });
}

void write_curves(JsonWriter& json, const DetectResult& result, bool details) {
  json.objects("curves", result.curves, [&](const IntersectionCurve& curve) {
    if (details) {
      write_fields(json, curve);
    } else {
      write_objects(json, curve.a, curve.b);
      json.member("kind", word_of(curve.kind));
    }
    json.member("segments", curve.contact_count);
    if (!details) return;
    json.list("pairs", result.contacts_of(curve), [&](std::uint32_t i) {
      json.pair(result.contacts[i].triangle_a, result.contacts[i].triangle_b);
    });
    json.list("points", result.points_of(curve));
    json.list("enclosed_a", result.enclosed_vertices_of(curve, ContactSide::a));
    json.list("enclosed_b", result.enclosed_vertices_of(curve, ContactSide::b));
  });
}

}  // namespace

void write_element(JsonWriter& json, const std::array<std::uint32_t, 2>& element, FeatureKind kind) {
  if (kind == FeatureKind::edge)
    json.pair(element[0], element[1]);
  else
    json.value(element[0]);
}

void write_members(JsonWriter& json, const RecordInfo& record, const std::byte* row, bool only_exact) {
  for (const FieldInfo& field : record.fields) {
    if ((only_exact && field.role.is_rounded) || is_of_range(field.role)) continue;
    json.key(short_key(field.name));
    const bool is_list = (field.scalar == ScalarType::float64 && field.count > 1) ||
                         (field.role.names == Names::element &&
                          record.kind_of_element(row, field.role.side) == FeatureKind::edge);
    if (is_list) json.begin_array();
    for_each_value(record, field, row, [&]<class Value>(const Value& value) {
      if constexpr (!std::is_same_v<Value, std::nullptr_t>) json.value(value);
    });
    if (is_list) json.end_array();
  }
}

void write_intersections(JsonWriter& json, const DetectResult& result, const DetailedContacts& content) {
  write_triangle_pairs(json, "triangle_pairs", result, false);
  write_triangle_pairs(json, "self", result, true);
  if (!content.details) return;
  json.objects("contacts", result.contacts, [&](const Contact& contact) {
    write_fields(json, contact, !content.points);
    if (content.points) write_records(json, "points", result.points_of(contact));
  });
}

void write_continuous_groups(JsonWriter& json, const DetectResult& result, bool with_certainty) {
  constexpr Kinds order[] = {{vertex, face}, {face, vertex}, {edge, edge},
                             {vertex, edge}, {edge, vertex}, {vertex, vertex}};
  json.objects("continuous", result.continuous_groups, [&](const ContactGroup& group) {
    // In a group of an object with itself, the vertex is always the element of a.
    const auto all = by_kinds(result.continuous_contacts_of(group), order, [&](const Kinds& kinds) {
      return kinds == Kinds{edge, edge} || kinds == Kinds{vertex, face} ||
             (kinds == Kinds{face, vertex} && group.a != group.b);
    });
    write_objects(json, group.a, group.b);
    for (const auto& of_kind : all) write_rows(json, of_kind, &ContinuousContact::toi);
    if (with_certainty) write_uncertain_rows(json, all);
  });
  const auto first = std::ranges::min_element(result.continuous_contacts, {}, &ContinuousContact::toi);
  const bool is_any = first != result.continuous_contacts.end();
  json.member("earliest", is_any ? std::optional(first->toi) : std::nullopt);
}

void write_proximity_groups(JsonWriter& json, const DetectResult& result, ProximityListing listing) {
  constexpr Kinds order[] = {{vertex, vertex}, {vertex, edge}, {vertex, face}, {edge, vertex},
                             {edge, edge},     {edge, face},   {face, vertex}, {face, edge}};
  json.objects("proximity", result.proximity_groups, [&](const ContactGroup& group) {
    write_objects(json, group.a, group.b);
    const auto is_usual = [&](const Kinds& kinds) {
      if (kinds == Kinds{edge, face} || kinds == Kinds{face, edge}) return false;
      return listing == ProximityListing::features || kinds == Kinds{edge, edge} || kinds[0] == face ||
             kinds[1] == face;
    };
    for (const auto& of_kind : by_kinds(result.proximity_pairs_of(group), order, is_usual))
      write_rows(json, of_kind, &ProximityPair::distance);
  });
}

void write_penetration(JsonWriter& json, const DetectResult& result, bool details) {
  write_penetration_groups(json, result);
  write_containment(json, result.contained_parts);
  write_records(json, "contained_parts", result.contained_parts);
  write_curves(json, result, details);
  if (details) write_records(json, "penetrations", result.penetrations);
}

void write_other_answers(JsonWriter& json, const DetectResult& result, ContactKinds requested) {
  for (const ContactKindInfo& of : other_kinds()) {
    if (!contains(requested, of.kind)) continue;
    const ListInfo& list = list_infos()[place_of_answer(of.kind)];
    const ListRows rows = rows_of(result)[place_of_answer(of.kind)];
    json.objects(list.name, std::views::iota(std::size_t{0}, rows.count), [&](std::size_t i) {
      write_members(json, list.record, rows.data + i * list.record.bytes, false);
    });
  }
}

void write_manifolds(JsonWriter& json, const DetectResult& result) {
  json.objects("manifolds", result.manifolds, [&](const Manifold& manifold) {
    write_fields(json, manifold);
    write_records(json, "points", result.points_of(manifold));
  });
  write_records(json, "ended_manifolds", result.ended_manifolds);
}

void write_colliding_vertices(JsonWriter& json, const DetectResult& result) {
  json.objects("colliding_vertices", result.colliding_vertex_groups, [&](const CollidingVertices& group) {
    write_objects(json, group.a, group.b);
    const auto vertices =
        result.colliding_vertices.subspan(group.first_vertex, group.count_a + group.count_b);
    json.list("vertices_a", vertices.first(group.count_a));
    json.list("vertices_b", vertices.last(group.count_b));
  });
}

void write_distance(JsonWriter& json, const ProximityPair& pair) {
  json.begin_array();
  json.value(pair.object_a.index);
  json.value(pair.object_b.index);
  json.value(pair.distance);
  json.value(kind_word(pair.kind_a, pair.kind_b));
  write_element(json, pair.element_a, pair.kind_a);
  write_element(json, pair.element_b, pair.kind_b);
  json.value(pair.point_a);
  json.value(pair.point_b);
  json.end_array();
}

}  // namespace supple::cli
