#include "reports/result_json.hpp"

#include <algorithm>
#include <array>
#include <string>
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
  json.key(name);
  json.begin_array();
  for (const ContactGroup& group : result.groups) {
    if ((group.a == group.b) != self) continue;
    json.begin_object();
    json.member("a", group.a.index);
    if (!self) json.member("b", group.b.index);
    json.key("pairs");
    json.begin_array();
    for (const Contact& contact : result.contacts_of(group))
      json.pair(contact.triangle_a, contact.triangle_b);
    json.end_array();
    json.end_object();
  }
  json.end_array();
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
  json.key(kind_word(kind_a, kind_b).c_str());
  json.begin_array();
  for (const Row& row : of_kind.rows) {
    json.begin_array();
    write_ids(row.element_a, kind_a);
    write_ids(row.element_b, kind_b);
    json.value(row.*number);
    json.end_array();
  }
  json.end_array();
}

/// Writes the rows, counted from 0, of contacts that are only within tolerance.
void write_uncertain_rows(JsonWriter& json, std::span<const RowsOfKind<ContinuousContact>> all) {
  json.key("within_tolerance");
  json.begin_object();
  for (const auto& [kinds, rows] : all) {
    json.key(kind_word(kinds[0], kinds[1]).c_str());
    json.begin_array();
    for (std::size_t row = 0; row < rows.size(); ++row) {
      if (rows[row].certainty != ImpactCertainty::certain) json.value(std::uint64_t{row});
    }
    json.end_array();
  }
  json.end_object();
}

void write_penetration_groups(JsonWriter& json, const DetectResult& result) {
  json.key("penetration");
  json.begin_array();
  for (const PenetrationGroup& group : result.penetration_groups) {
    json.begin_object();
    write_objects(json, group.a, group.b);
    json.key("vertices");
    json.begin_array();
    for (const Penetration& p : result.penetrations_of(group)) {
      json.begin_array();
      json.value(p.vertex);
      json.value(p.triangle);
      json.value(p.depth);
      json.end_array();
    }
    json.end_array();
    write_ids(json, "on_surface", result.vertices_on_surface_of(group));
    json.end_object();
  }
  json.end_array();
}

void write_containment(JsonWriter& json, std::span<const ContainedPart> parts) {
  json.key("containment");
  json.begin_array();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const bool is_first =
        i == 0 || parts[i - 1].inner != parts[i].inner || parts[i - 1].outer != parts[i].outer;
    if (parts[i].is_whole && is_first) json.pair(parts[i].inner.index, parts[i].outer.index);
  }
  json.end_array();
}

void write_curves(JsonWriter& json, const DetectResult& result, bool details) {
  json.key("curves");
  json.begin_array();
  for (const IntersectionCurve& curve : result.curves) {
    json.begin_object();
    if (details) {
      write_fields(json, curve);
    } else {
      write_objects(json, curve.a, curve.b);
      json.member("kind", word_of(curve.kind));
    }
    json.member("segments", curve.contact_count);
    if (details) {
      json.key("pairs");
      json.begin_array();
      for (const std::uint32_t i : result.contacts_of(curve))
        json.pair(result.contacts[i].triangle_a, result.contacts[i].triangle_b);
      json.end_array();
      json.key("points");
      json.begin_array();
      for (const Vec3d& point : result.points_of(curve)) json.value(point);
      json.end_array();
      write_ids(json, "enclosed_a", result.enclosed_vertices_of(curve, ContactSide::a));
      write_ids(json, "enclosed_b", result.enclosed_vertices_of(curve, ContactSide::b));
    }
    json.end_object();
  }
  json.end_array();
}

}  // namespace

void write_element(JsonWriter& json, const std::array<std::uint32_t, 2>& element, FeatureKind kind) {
  if (kind == FeatureKind::edge)
    json.pair(element[0], element[1]);
  else
    json.value(element[0]);
}

void write_ids(JsonWriter& json, const char* name, std::span<const std::uint32_t> ids) {
  json.key(name);
  json.begin_array();
  for (const std::uint32_t id : ids) json.value(id);
  json.end_array();
}

void write_members(JsonWriter& json, const RecordInfo& record, const std::byte* row, bool only_exact) {
  for (const FieldInfo& field : record.fields) {
    const Role& role = field.role;
    if ((only_exact && role.is_rounded) || is_of_range(role)) continue;
    json.key(short_key(field.name));
    const auto number = [&](std::size_t i) { return number_of(field, row, i); };
    if (field.kind == FieldInfo::Kind::object) {
      json.value(number(0));
    } else if (field.kind == FieldInfo::Kind::feature) {
      json.value(name_of(Feature{static_cast<FeatureKind>(number(0)), static_cast<std::uint8_t>(number(1))}));
    } else if (role.names == Names::element) {
      write_element(json, {static_cast<std::uint32_t>(number(0)), static_cast<std::uint32_t>(number(1))},
                    record.kind_of_element(row, role.side));
    } else if (field.scalar == ScalarType::float64 && field.count > 1) {
      const std::size_t count = role.names == Names::weights  // one for each vertex of the element
                                    ? 1 + static_cast<std::size_t>(record.kind_of_element(row, role.side))
                                    : field.count;
      json.begin_array();
      for (std::size_t i = 0; i < count; ++i) json.value(real_number(field, row, i));
      json.end_array();
    } else if (field.scalar == ScalarType::float64) {
      json.value(real_number(field, row, 0));
    } else if (field.scalar == ScalarType::boolean) {
      json.value(number(0) != 0);
    } else if (!field.words.empty()) {
      json.value(field.words[number(0)]);
    } else {
      json.value(number(0));
    }
  }
}

void write_intersections(JsonWriter& json, const DetectResult& result, const DetailedContacts& content) {
  write_triangle_pairs(json, "triangle_pairs", result, false);
  write_triangle_pairs(json, "self", result, true);
  if (!content.details) return;
  json.key("contacts");
  json.begin_array();
  for (const Contact& contact : result.contacts) {
    json.begin_object();
    write_fields(json, contact, !content.points);
    if (content.points) write_records(json, "points", result.points_of(contact));
    json.end_object();
  }
  json.end_array();
}

void write_continuous_groups(JsonWriter& json, const DetectResult& result, bool with_certainty) {
  constexpr Kinds order[] = {{vertex, face}, {face, vertex}, {edge, edge},
                             {vertex, edge}, {edge, vertex}, {vertex, vertex}};
  json.key("continuous");
  json.begin_array();
  for (const ContactGroup& group : result.continuous_groups) {
    // In a group of an object with itself, the vertex is always the element of a.
    const auto all = by_kinds(result.continuous_contacts_of(group), order, [&](const Kinds& kinds) {
      return kinds == Kinds{edge, edge} || kinds == Kinds{vertex, face} ||
             (kinds == Kinds{face, vertex} && group.a != group.b);
    });
    json.begin_object();
    write_objects(json, group.a, group.b);
    for (const auto& of_kind : all) write_rows(json, of_kind, &ContinuousContact::toi);
    if (with_certainty) write_uncertain_rows(json, all);
    json.end_object();
  }
  json.end_array();
  const auto first = std::ranges::min_element(result.continuous_contacts, {}, &ContinuousContact::toi);
  json.key("earliest");
  if (first == result.continuous_contacts.end())
    json.null();
  else
    json.value(first->toi);
}

void write_proximity_groups(JsonWriter& json, const DetectResult& result, ProximityListing listing) {
  constexpr Kinds order[] = {{vertex, vertex}, {vertex, edge}, {vertex, face}, {edge, vertex},
                             {edge, edge},     {edge, face},   {face, vertex}, {face, edge}};
  json.key("proximity");
  json.begin_array();
  for (const ContactGroup& group : result.proximity_groups) {
    json.begin_object();
    write_objects(json, group.a, group.b);
    const auto is_usual = [&](const Kinds& kinds) {
      if (kinds == Kinds{edge, face} || kinds == Kinds{face, edge}) return false;
      return listing == ProximityListing::features || kinds == Kinds{edge, edge} || kinds[0] == face ||
             kinds[1] == face;
    };
    for (const auto& of_kind : by_kinds(result.proximity_pairs_of(group), order, is_usual))
      write_rows(json, of_kind, &ProximityPair::distance);
    json.end_object();
  }
  json.end_array();
}

void write_penetration(JsonWriter& json, const DetectResult& result, bool details) {
  write_penetration_groups(json, result);
  write_containment(json, result.contained_parts);
  write_records(json, "contained_parts", result.contained_parts);
  write_curves(json, result, details);
  if (details) write_records(json, "penetrations", result.penetrations);
}

void write_manifolds(JsonWriter& json, const DetectResult& result) {
  json.key("manifolds");
  json.begin_array();
  for (const Manifold& manifold : result.manifolds) {
    json.begin_object();
    write_fields(json, manifold);
    write_records(json, "points", result.points_of(manifold));
    json.end_object();
  }
  json.end_array();
  write_records(json, "ended_manifolds", result.ended_manifolds);
}

void write_colliding_vertices(JsonWriter& json, const DetectResult& result) {
  json.key("colliding_vertices");
  json.begin_array();
  for (const CollidingVertices& group : result.colliding_vertex_groups) {
    json.begin_object();
    write_objects(json, group.a, group.b);
    write_ids(json, "vertices_a", result.colliding_vertices.subspan(group.first_vertex, group.count_a));
    write_ids(json, "vertices_b",
              result.colliding_vertices.subspan(group.first_vertex + group.count_a, group.count_b));
    json.end_object();
  }
  json.end_array();
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
