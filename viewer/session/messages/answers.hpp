#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "messages/json_text.hpp"
#include "scene_view.hpp"
#include "sources/center.hpp"
#include "sources/source.hpp"

namespace supple::viewer {

/// The name of a node as in the paper, `A(h, k)`, or `S(h, k)` for a sphere; `?` for a number that does not
/// fit into 64 bits.
std::string node_name(bool is_sphere, std::optional<std::uint64_t> number, std::uint32_t level);

/// These functions write the members of the answers to `explain`, `measure`, `node_pairs` and `read` into an
/// open JSON object. All ids must exist. `ObjectTriangle` is an object and one of its triangles.
using ObjectTriangle = std::array<std::uint32_t, 2>;
void answer_explain(const SceneView& show, const Source& source, const Center& center, ObjectTriangle a,
                    ObjectTriangle b, JsonText& json);
/// The nearest points of two objects; null for one object, and when one has no finite triangle.
void answer_measure(const SceneView& show, const Source& source, const Center& center, std::uint32_t a,
                    std::uint32_t b, JsonText& json);
void answer_node_pairs(const Source& source, std::uint32_t a, std::uint32_t b, JsonText& json);
void answer_read_vertex(const Source& source, std::uint32_t object, std::uint32_t vertex, JsonText& json);
void answer_read_triangle(const SceneView& show, const Source& source, std::uint32_t object,
                          std::uint32_t triangle, JsonText& json);
void answer_read_object(const SceneView& show, const Source& source, std::uint32_t object, JsonText& json);

}  // namespace supple::viewer
