#pragma once

#include "base/json_writer.hpp"
#include "supple/result.hpp"

namespace supple::cli {

// The lists of a result as JSON, as docs/json.md describes. With `details`, each contact is also an object
// with its points, normal and barycentric coordinates.

struct DetailedContacts {
  bool details = false;
  bool points = true;  ///< of intersections
};

/// `triangle_pairs`, `self` and `contacts`.
void write_intersections(JsonWriter& json, const DetectResult& result, const DetailedContacts& content);
/// `continuous` and `earliest`. `with_certainty` adds the list of contacts that are only within tolerance.
void write_continuous_groups(JsonWriter& json, const DetectResult& result, bool with_certainty);
/// `proximity`: the ids and the distance of each pair, by pairs of objects and by kinds.
void write_proximity_groups(JsonWriter& json, const DetectResult& result, ProximityListing listing);
/// `penetration`, `containment`, `contained_parts`, `curves` and, with `details`, `penetrations`.
void write_penetration(JsonWriter& json, const DetectResult& result, bool details);
/// `manifolds` with their points, and `ended_manifolds`.
void write_manifolds(JsonWriter& json, const DetectResult& result);
/// `colliding_vertices`, the paper's output.
void write_colliding_vertices(JsonWriter& json, const DetectResult& result);
/// One pair of objects of `supple query distance`, as a list.
void write_distance(JsonWriter& json, const ProximityPair& pair);

}  // namespace supple::cli
