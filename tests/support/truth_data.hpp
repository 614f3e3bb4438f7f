#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>

#include "supple/mesh.hpp"

// What truth.json and proximity.json mean by their texts.
namespace supple {

std::string sha256(const std::string& text);

TriangleMesh load_shared_mesh(const std::string& name);

/// Applies steps from left to right: "s:K" scales, "p:+y-z+x" permutes with signs, "t:X:Y:Z" adds.
void transform(TriangleMesh& mesh, const std::string& steps);

/// Edges sorted by their larger vertex, then by the smaller one: {larger, smaller} to number.
std::map<std::array<std::uint32_t, 2>, std::uint32_t> edge_numbers(const TriangleMesh& mesh);

}  // namespace supple
