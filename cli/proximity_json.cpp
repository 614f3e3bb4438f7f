#include "proximity_json.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <utility>

#include "supple/result_descriptions.hpp"
#include "text.hpp"

namespace supple::cli {
namespace {

using Kinds = std::pair<FeatureKind, FeatureKind>;

Kinds kinds_of(const ProximityPair& pair) {
  return {pair.kind_a, pair.kind_b};
}

/// Whether the list of the kind is written also when it is empty. The others occur with lines and points.
constexpr bool is_usual(const Kinds& kinds, ProximityListing listing) {
  const bool are_edges = kinds == Kinds{FeatureKind::edge, FeatureKind::edge};
  const bool has_face = kinds.first == FeatureKind::face || kinds.second == FeatureKind::face;
  return listing == ProximityListing::features || are_edges || has_face;
}

void write_ids(JsonWriter& json, const std::array<std::uint32_t, 2>& element, FeatureKind kind) {
  json.value(std::uint64_t{element[0]});
  if (kind == FeatureKind::edge) json.value(std::uint64_t{element[1]});
}

void write_element(JsonWriter& json, const std::array<std::uint32_t, 2>& element, FeatureKind kind) {
  if (kind == FeatureKind::edge)
    json.pair(element[0], element[1]);
  else
    json.value(std::uint64_t{element[0]});
}

template <class Pair>
void write_names(JsonWriter& json, const Pair& pair) {
  json.member("a", std::uint64_t{pair.object_a.index});
  json.member("b", std::uint64_t{pair.object_b.index});
  json.member("kind", kind_word(pair.kind_a, pair.kind_b));
  json.key("elements");
  json.begin_array();
  write_element(json, pair.element_a, pair.kind_a);
  write_element(json, pair.element_b, pair.kind_b);
  json.end_array();
}

void write_weights(JsonWriter& json, const char* name, const std::array<double, 3>& weights,
                   FeatureKind kind) {
  json.key(name);
  json.begin_array();
  for (std::size_t i = 0; i <= static_cast<std::size_t>(kind); ++i) json.value(weights[i]);
  json.end_array();
}

}  // namespace

void write_proximity_groups(JsonWriter& json, const DetectResult& result, ProximityListing listing) {
  json.key("proximity");
  json.begin_array();
  for (const ContactGroup& group : result.proximity_groups) {
    json.begin_object();
    json.member("a", std::uint64_t{group.a.index});
    json.member("b", std::uint64_t{group.b.index});
    auto pairs = result.proximity_pairs_of(group);
    using enum FeatureKind;
    for (const Kinds& kinds : {Kinds{vertex, vertex}, Kinds{vertex, edge}, Kinds{vertex, face},
                               Kinds{edge, vertex}, Kinds{edge, edge}, Kinds{face, vertex}}) {
      // The pairs of one kind are consecutive, and the kinds are in this order.
      const auto has_kind = [&] { return !pairs.empty() && kinds_of(pairs.front()) == kinds; };
      if (!is_usual(kinds, listing) && !has_kind()) continue;
      json.key(kind_word(kinds.first, kinds.second).c_str());
      json.begin_array();
      for (; has_kind(); pairs = pairs.subspan(1)) {
        const ProximityPair& pair = pairs.front();
        json.begin_array();
        write_ids(json, pair.element_a, pair.kind_a);
        write_ids(json, pair.element_b, pair.kind_b);
        json.value(pair.distance);
        json.end_array();
      }
      json.end_array();
    }
    json.end_object();
  }
  json.end_array();
}

void write_proximity_pairs(JsonWriter& json, const DetectResult& result) {
  json.key("proximity_pairs");
  json.begin_array();
  for (const ProximityPair& pair : result.proximity_pairs) {
    json.begin_object();
    write_names(json, pair);
    json.member("on_a", name_of(pair.on_a));
    json.member("on_b", name_of(pair.on_b));
    json.member("distance", pair.distance);
    write_weights(json, "barycentric_a", pair.barycentric_a, pair.kind_a);
    write_weights(json, "barycentric_b", pair.barycentric_b, pair.kind_b);
    json.member("point_a", pair.point_a);
    json.member("point_b", pair.point_b);
    json.member("normal", pair.normal);
    json.end_object();
  }
  json.end_array();
}

void write_distance(JsonWriter& json, const ProximityPair& pair) {
  json.begin_array();
  json.value(std::uint64_t{pair.object_a.index});
  json.value(std::uint64_t{pair.object_b.index});
  json.value(pair.distance);
  json.value(kind_word(pair.kind_a, pair.kind_b));
  write_element(json, pair.element_a, pair.kind_a);
  write_element(json, pair.element_b, pair.kind_b);
  json.value(pair.point_a);
  json.value(pair.point_b);
  json.end_array();
}

void write_proximity_verify(JsonWriter& json, const VerifyReport& report) {
  json.key("proximity_verify");
  json.begin_object();
  json.member("element_pairs_checked", report.proximity_pairs_checked);
  json.member("near_pairs", report.near_pairs);
  json.key("differences");
  json.begin_array();
  for (const ProximityDifference& difference : report.proximity_differences) {
    json.begin_object();
    write_names(json, difference);
    json.member("fault", word_of(difference.fault));
    json.end_object();
  }
  json.end_array();
  json.end_object();
}

}  // namespace supple::cli
