#pragma once

#include "json_writer.hpp"
#include "supple/result.hpp"

namespace supple::cli {

// The JSON of a step with penetration, as docs/json.md describes.

/// `penetration`, `containment`, `contained_parts` and `curves`. With `details`, curves also have their
/// contacts, points and numbers, and `penetrations` has every row with its point and normal.
void write_penetration(JsonWriter& json, const DetectResult& result, bool details);
void write_penetration_verify(JsonWriter& json, const VerifyReport& report);

}  // namespace supple::cli
