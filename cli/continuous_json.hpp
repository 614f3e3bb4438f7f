#pragma once

#include "json_writer.hpp"
#include "supple/result.hpp"

namespace supple::cli {

// What docs/json.md describes of a step with continuous contacts.

/// `continuous` and `earliest`. `with_certainty` lists what is within tolerance only.
void write_continuous_groups(JsonWriter& json, const DetectResult& result, bool with_certainty);
/// The contacts, each with where it is.
void write_continuous_contacts(JsonWriter& json, const char* name, const DetectResult& result);
void write_continuous_verify(JsonWriter& json, const char* name, const VerifyReport& report);

}  // namespace supple::cli
