#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <vector>

#include "messages/message.hpp"
#include "pins/pin_values.hpp"

namespace supple::viewer {

// What each section of a message contains. The reader of the page (page/src/protocol/sections_generated.ts)
// and the table of viewer/PROTOCOL.md are made from this list.

enum class ScalarOfSection : std::uint8_t { uint8, uint32, float32, float64 };
inline constexpr const char* names_of_scalars[] = {"uint8", "uint32", "float32", "float64"};

struct SectionForm {
  Tag tag;
  const char* name;
  ScalarOfSection scalar;
  std::uint32_t width;  ///< scalars of an element; 0 when something else determines it
  unsigned kinds;       ///< of messages with this section: a set of bits `1 << kind`
  bool is_of_object;    ///< one section for each object
  const char* element;  ///< what an element is
  const char* when;     ///< when it is in a message; empty: always
};

inline constexpr unsigned in_scene = 1u << static_cast<unsigned>(MessageKind::scene);
inline constexpr unsigned in_frame = 1u << static_cast<unsigned>(MessageKind::frame);
inline constexpr unsigned in_series = 1u << static_cast<unsigned>(MessageKind::series);
inline constexpr unsigned in_texts = in_scene | in_frame | 1u << static_cast<unsigned>(MessageKind::answer) |
                                     1u << static_cast<unsigned>(MessageKind::failure);

/// The names of the kinds of messages with a section.
inline std::vector<const char*> kinds_of(const SectionForm& form) {
  std::vector<const char*> kinds;
  for (std::size_t i = 0; i < std::size(names_of_message_kinds); ++i) {
    if ((form.kinds >> i & 1u) != 0) kinds.push_back(names_of_message_kinds[i]);
  }
  return kinds;
}

inline constexpr std::array section_forms = std::to_array<SectionForm>({
    {Tag::text, "text", ScalarOfSection::uint8, 1, in_texts, false, "UTF-8 of a JSON object", ""},
    {Tag::triangles, "triangles", ScalarOfSection::uint32, 3, in_scene, true, "vertices", ""},
    {Tag::edges, "edges", ScalarOfSection::uint32, 2, in_scene, true,
     "vertices of an edge of no triangle, such as a part of a rod", "with such edges"},
    {Tag::points, "points", ScalarOfSection::uint32, 1, in_scene, true,
     "vertex of a point of no triangle, such as a particle", "with such points"},
    {Tag::positions, "positions", ScalarOfSection::float32, 3, in_frame, true,
     "`center` of the scene subtracted", "that moved since the last frame that was sent"},
    {Tag::column, "column", ScalarOfSection::uint8, 0, in_frame, true,
     "a column of a list of the result, with scalars of its own; the object is its number", "with rows"},
    {Tag::candidates, "candidates", ScalarOfSection::uint32, 4, in_frame, false,
     "object a, triangle a, object b, triangle b", "when requested"},
    {Tag::scene_regions, "scene_regions", ScalarOfSection::float32, 8, in_frame, false,
     "lower corner, level, upper corner, objects (−1 for inner regions)", "when requested"},
    {Tag::octree_boxes, "octree_boxes", ScalarOfSection::float32, 8, in_frame, true,
     "lower corner, level, upper corner, triangles (−1 for inner cells)", "when requested"},
    {Tag::octree_spheres, "octree_spheres", ScalarOfSection::float32, 8, in_frame, true,
     "centre, radius, level, triangles (−1 for inner cells), 0, 0", "when requested"},
    {Tag::colliding_vertices, "colliding_vertices", ScalarOfSection::uint32, 1, in_frame, true,
     "vertices of the paper's output", "when requested"},
    {Tag::statistics, "statistics", ScalarOfSection::float64, 1, in_frame, false,
     "in the order of the names in `statistics` of the scene: a row for each step since the last frame that "
     "was "
     "sent",
     ""},
    {Tag::contact_begin, "contact_begin", ScalarOfSection::uint32, 3, in_frame, false,
     "the step, and objects that began touching", "not of a recording or the past"},
    {Tag::contact_end, "contact_end", ScalarOfSection::uint32, 3, in_frame, false,
     "the step, and objects that stopped touching", "not of a recording or the past"},
    {Tag::narrow_phase_begin, "narrow_phase_begin", ScalarOfSection::uint32, 3, in_frame, false,
     "the step, and objects whose leaves began to collide",
     "with `colliding_vertices`; not of a recording or the past"},
    {Tag::narrow_phase_end, "narrow_phase_end", ScalarOfSection::uint32, 3, in_frame, false,
     "the step, and objects whose leaves ended to collide",
     "with `colliding_vertices`; not of a recording or the past"},
    {Tag::volume_begin, "volume_begin", ScalarOfSection::uint32, 3, in_frame, false,
     "the step, and objects whose volumes began to overlap", "not of a recording or the past"},
    {Tag::volume_end, "volume_end", ScalarOfSection::uint32, 3, in_frame, false,
     "the step, and objects whose volumes ended to overlap", "not of a recording or the past"},
    {Tag::colliding_boxes, "colliding_boxes", ScalarOfSection::float32, 8, in_frame, true,
     "as `octree_boxes`: nodes that collide in the narrow phase", "when requested; with such nodes"},
    {Tag::colliding_spheres, "colliding_spheres", ScalarOfSection::float32, 8, in_frame, true,
     "as `octree_spheres`: the same for spheres", "when requested; with such nodes"},
    {Tag::octree_edges, "octree_edges", ScalarOfSection::float32, 8, in_frame, true,
     "one end of an edge, level, the other end, triangles (−1 for inner cells)", "when requested"},
    {Tag::colliding_edges, "colliding_edges", ScalarOfSection::float32, 8, in_frame, true,
     "as `octree_edges`: nodes that collide in the narrow phase", "when requested; with such nodes"},
    {Tag::field_values, "field_values", ScalarOfSection::float32, 1, in_frame, true,
     "value of a vertex or a triangle, NaN for none", "when a field of numbers is chosen; with values"},
    {Tag::field_vectors, "field_vectors", ScalarOfSection::float32, 3, in_frame, true,
     "vector of a vertex or a triangle, NaN for none", "when a field of vectors is chosen; with vectors"},
    {Tag::pin_rows, "pin_rows", ScalarOfSection::float64, pin_row_width, in_frame, true,
     "step, time, and the values of a pin, in the order of `pin_values` of the scene; the object is the "
     "number "
     "of the pin",
     "with rows"},
    {Tag::series, "series", ScalarOfSection::float64, 0, in_series, false,
     "one row for each frame: a float64 for each name in `series` of the scene", ""},
    {Tag::series_contact_begin, "series_contact_begin", ScalarOfSection::uint32, 3, in_series, false,
     "frame, object a, object b", ""},
    {Tag::series_contact_end, "series_contact_end", ScalarOfSection::uint32, 3, in_series, false,
     "frame, object a, object b", ""},
    {Tag::series_narrow_phase_begin, "series_narrow_phase_begin", ScalarOfSection::uint32, 3, in_series,
     false, "frame, object a, object b; only of recordings with colliding vertices", ""},
    {Tag::series_narrow_phase_end, "series_narrow_phase_end", ScalarOfSection::uint32, 3, in_series, false,
     "frame, object a, object b; only of recordings with colliding vertices", ""},
    {Tag::series_volume_begin, "series_volume_begin", ScalarOfSection::uint32, 3, in_series, false,
     "frame, object a, object b", ""},
    {Tag::series_volume_end, "series_volume_end", ScalarOfSection::uint32, 3, in_series, false,
     "frame, object a, object b", ""},
});

}  // namespace supple::viewer
