#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "center.hpp"
#include "json_text.hpp"
#include "scene_view.hpp"
#include "source.hpp"

namespace supple::viewer {

/// These functions write the members of the answers to `explain` and `read` into an open JSON object. All
/// ids must exist. `ObjectTriangle` is an object and one of its triangles.
using ObjectTriangle = std::array<std::uint32_t, 2>;
void answer_explain(const SceneView& show, const Source& source, const Center& center, ObjectTriangle a,
                    ObjectTriangle b, JsonText& json);
void answer_read_vertex(const Source& source, std::uint32_t object, std::uint32_t vertex, JsonText& json);
void answer_read_triangle(const SceneView& show, const Source& source, std::uint32_t object,
                          std::uint32_t triangle, JsonText& json);
void answer_read_object(const SceneView& show, const Source& source, std::uint32_t object, JsonText& json);

}  // namespace supple::viewer
