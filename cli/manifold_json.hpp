#pragma once

#include "json_writer.hpp"
#include "supple/result.hpp"

namespace supple::cli {

/// `manifolds` with their points, and `ended_manifolds`.
void write_manifolds(JsonWriter& json, const DetectResult& result);

}  // namespace supple::cli
