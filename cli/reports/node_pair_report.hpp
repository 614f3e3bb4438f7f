#pragma once

#include <cstdint>

#include "base/json_writer.hpp"
#include "options/json_content.hpp"
#include "supple/scene.hpp"

namespace supple::cli {

struct Input;

/// Throws an error that names --node-pairs when an object does not exist, or is not tested against itself.
void check_node_pairs(const Input& input, ObjectNumbers objects);

/// Prints the pairs of nodes that collide in the scene's last detection, level by level.
void print_node_pairs(const Scene& scene, ObjectNumbers objects, std::uint64_t frame);
/// Writes all these pairs as the member `node_pairs`.
void write_node_pairs(JsonWriter& json, const Scene& scene, ObjectNumbers objects);

}  // namespace supple::cli
