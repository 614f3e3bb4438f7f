#include "continuous_json.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "supple/result_descriptions.hpp"

namespace supple::cli {
namespace {

using Contacts = std::span<const ContinuousContact>;
using Kind = ElementPairKind;
using Element = std::array<std::uint32_t, 2>;

/// The contacts of one kind are consecutive.
Contacts of_kind(Contacts group, Kind kind) {
  const auto is_before = [&](const ContinuousContact& c) { return c.kind < kind; };
  const auto is_not_after = [&](const ContinuousContact& c) { return c.kind <= kind; };
  const auto first = std::partition_point(group.begin(), group.end(), is_before);
  return {first, std::partition_point(first, group.end(), is_not_after)};
}

/// The kinds of triangles, and those of lines and points that the group has. In a group of an object with
/// itself, the vertex is always the element of a.
std::vector<Kind> kinds_of(const ContactGroup& group, Contacts contacts) {
  std::vector<Kind> kinds{Kind::vertex_face, Kind::face_vertex, Kind::edge_edge};
  if (group.a == group.b) std::erase(kinds, Kind::face_vertex);
  for (const Kind kind : {Kind::vertex_edge, Kind::edge_vertex, Kind::vertex_vertex}) {
    if (!of_kind(contacts, kind).empty()) kinds.push_back(kind);
  }
  return kinds;
}

/// Writes one id for a vertex or a face, and two ids for an edge.
void write_ids(JsonWriter& json, const Element& element, FeatureKind kind) {
  json.value(std::uint64_t{element[0]});
  if (kind == FeatureKind::edge) json.value(std::uint64_t{element[1]});
}

/// Writes one row per contact: the ids of both elements and the time.
void write_rows(JsonWriter& json, Contacts contacts) {
  json.begin_array();
  for (const ContinuousContact& contact : contacts) {
    const auto [kind_a, kind_b] = feature_kinds(contact.kind);
    json.begin_array();
    write_ids(json, contact.element_a, kind_a);
    write_ids(json, contact.element_b, kind_b);
    json.value(contact.toi);
    json.end_array();
  }
  json.end_array();
}

/// Writes the rows, counted from 0, of contacts that are only within tolerance.
void write_uncertain_rows(JsonWriter& json, Contacts contacts) {
  json.begin_array();
  for (std::size_t row = 0; row < contacts.size(); ++row) {
    if (contacts[row].certainty != ImpactCertainty::certain) json.value(std::uint64_t{row});
  }
  json.end_array();
}

void write_earliest(JsonWriter& json, Contacts contacts) {
  const auto first = std::min_element(contacts.begin(), contacts.end(),
                                      [](const auto& x, const auto& y) { return x.toi < y.toi; });
  json.key("earliest");
  if (first == contacts.end())
    json.null();
  else
    json.value(first->toi);
}

void write_element(JsonWriter& json, const Element& element, FeatureKind kind) {
  if (kind == FeatureKind::edge)
    json.pair(element[0], element[1]);
  else
    json.value(std::uint64_t{element[0]});
}

void write_elements(JsonWriter& json, const Element& a, const Element& b, Kind kind) {
  json.member("kind", word_of(kind));
  json.key("elements");
  json.begin_array();
  const auto [kind_a, kind_b] = feature_kinds(kind);
  write_element(json, a, kind_a);
  write_element(json, b, kind_b);
  json.end_array();
}

/// Writes one weight per vertex of the element.
void write_weights(JsonWriter& json, const char* name, const std::array<double, 3>& weights,
                   FeatureKind kind) {
  json.key(name);
  json.begin_array();
  for (std::size_t i = 0; i <= static_cast<std::size_t>(kind); ++i) json.value(weights[i]);
  json.end_array();
}

void write_objects(JsonWriter& json, ObjectId a, ObjectId b) {
  json.member("a", std::uint64_t{a.index});
  json.member("b", std::uint64_t{b.index});
}

}  // namespace

void write_continuous_groups(JsonWriter& json, const DetectResult& result, bool with_certainty) {
  json.key("continuous");
  json.begin_array();
  for (const ContactGroup& group : result.continuous_groups) {
    const Contacts contacts = result.continuous_contacts_of(group);
    const std::vector<Kind> kinds = kinds_of(group, contacts);
    json.begin_object();
    write_objects(json, group.a, group.b);
    for (const Kind kind : kinds) {
      json.key(word_of(kind));
      write_rows(json, of_kind(contacts, kind));
    }
    if (with_certainty) {
      json.key("within_tolerance");
      json.begin_object();
      for (const Kind kind : kinds) {
        json.key(word_of(kind));
        write_uncertain_rows(json, of_kind(contacts, kind));
      }
      json.end_object();
    }
    json.end_object();
  }
  json.end_array();
  write_earliest(json, result.continuous_contacts);
}

void write_continuous_contacts(JsonWriter& json, const char* name, const DetectResult& result) {
  json.key(name);
  json.begin_array();
  for (const ContinuousContact& contact : result.continuous_contacts) {
    const auto [kind_a, kind_b] = feature_kinds(contact.kind);
    json.begin_object();
    write_objects(json, contact.object_a, contact.object_b);
    write_elements(json, contact.element_a, contact.element_b, contact.kind);
    json.member("toi", contact.toi);
    json.member("touching_at_start", contact.touching_at_start);
    json.member("start_distance", contact.start_distance);
    json.member("certain", contact.certainty == ImpactCertainty::certain);
    write_weights(json, "barycentric_a", contact.barycentric_a, kind_a);
    write_weights(json, "barycentric_b", contact.barycentric_b, kind_b);
    json.member("point", contact.point);
    json.member("normal", contact.normal);
    json.end_object();
  }
  json.end_array();
}

void write_continuous_verify(JsonWriter& json, const char* name, const VerifyReport& report) {
  json.key(name);
  json.begin_object();
  json.member("element_pairs_checked", report.element_pairs_checked);
  json.member("touching_element_pairs", report.touching_element_pairs);
  json.key("differences");
  json.begin_array();
  for (const ContinuousDifference& difference : report.continuous_differences) {
    json.begin_object();
    write_objects(json, difference.object_a, difference.object_b);
    write_elements(json, difference.element_a, difference.element_b, difference.kind);
    json.member("fault", word_of(difference.fault));
    json.end_object();
  }
  json.end_array();
  json.end_object();
}

}  // namespace supple::cli
