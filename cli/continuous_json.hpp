#pragma once

#include "json_writer.hpp"
#include "supple/result.hpp"

namespace supple::cli {

// The JSON of a step with continuous contacts, as docs/json.md describes.

/// `continuous` and `earliest`. `with_certainty` adds the list of contacts that are only within tolerance.
void write_continuous_groups(JsonWriter& json, const DetectResult& result, bool with_certainty);
/// The contacts with their points, normals and barycentric coordinates.
void write_continuous_contacts(JsonWriter& json, const char* name, const DetectResult& result);
void write_continuous_verify(JsonWriter& json, const char* name, const VerifyReport& report);

}  // namespace supple::cli
