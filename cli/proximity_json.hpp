#pragma once

#include "json_writer.hpp"
#include "supple/result.hpp"

namespace supple::cli {

// The JSON of a step with proximity, as docs/json.md describes.

/// `proximity`: the ids and the distance of every pair, by pairs of objects and by kinds.
void write_proximity_groups(JsonWriter& json, const DetectResult& result, ProximityListing listing);
/// `proximity_pairs`: the pairs with their points, normals and barycentric coordinates.
void write_proximity_pairs(JsonWriter& json, const DetectResult& result);
/// One pair of objects of `supple query distance`, as a list.
void write_distance(JsonWriter& json, const ProximityPair& pair);
void write_proximity_verify(JsonWriter& json, const VerifyReport& report);

}  // namespace supple::cli
