#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "supple/description.hpp"

namespace supple::viewer {

// What a view file contains. The checks of the program and of the page
// (viewer/page/src/protocol/view_members_generated.json) and the table of docs/viewer.md are made from this
// list.

enum class ViewValue : std::uint8_t {
  number,
  whole,
  truth,
  word,
  colour,
  text,
  key,
  point,
  interval,
  objects
};

struct ViewMember {
  const char* path;  ///< names from the outside to the inside, with dots; `*` is any name
  ViewValue kind;
  const char* doc;
  ValueRange range{};      ///< of numbers
  const char* words = "";  ///< of a word, with a space between two
};

/// The version of view files. A change that gives a member another meaning increases it.
inline constexpr double version_of_views = 1;
/// In bytes. A member for each of 100,000 objects fits.
inline constexpr std::size_t largest_view = 16'000'000;

inline constexpr std::array view_members = std::to_array<ViewMember>({
    {"version", ViewValue::whole, "version of the form of this file; the only member that a file must have",
     ValueRange::from(version_of_views, version_of_views)},
    {"step", ViewValue::whole,
     "the step of a simulation or the frame of a recording; only a link and `supple render` use it",
     ValueRange::from(0, 9e15)},
    {"camera.position", ViewValue::point, "where the camera is; `center` of the scene is subtracted"},
    {"camera.target", ViewValue::point,
     "the point around which the camera turns; `center` of the scene is subtracted"},
    {"camera.zoom", ViewValue::number, "magnification of an orthographic camera", ValueRange::above(0)},
    {"camera.orthographic", ViewValue::truth, "whether the camera has no perspective"},
    {"layers.surface", ViewValue::truth, "surfaces of the objects"},
    {"layers.wireframe", ViewValue::truth, "edges of all triangles"},
    {"layers.regions", ViewValue::truth, "regions of the scene octree"},
    {"layers.octree", ViewValue::truth, "cells of the objects' octrees"},
    {"layers.nodes", ViewValue::truth, "octree nodes that collide in the narrow phase"},
    {"layers.pairs", ViewValue::truth, "objects whose volumes overlap"},
    {"layers.candidates", ViewValue::truth, "pairs of triangles that the exact stage decides"},
    {"layers.triangles", ViewValue::truth, "triangles that have a contact"},
    {"layers.points", ViewValue::truth, "contact points"},
    {"layers.normals", ViewValue::truth, "contact normals"},
    {"layers.segments", ViewValue::truth, "segments and outlines in which triangles intersect"},
    {"layers.proximity", ViewValue::truth, "closest points within the margins"},
    {"layers.depths", ViewValue::truth, "depths of vertices inside solid objects"},
    {"layers.curves", ViewValue::truth, "curves of intersections and what they enclose"},
    {"layers.vertices", ViewValue::truth, "vertices of colliding octree nodes"},
    {"octree.only_selected", ViewValue::truth, "octree of the selected object only"},
    {"octree.level", ViewValue::whole, "level of the octrees; −1 for leaves", ValueRange::from(-1, 32)},
    {"nodes.objects", ViewValue::objects, "the two objects of the colliding nodes; null for all"},
    {"nodes.level", ViewValue::whole, "level of the colliding nodes; −1 for leaves, −2 for all levels",
     ValueRange::from(-2, 32)},
    {"marks.through_surfaces", ViewValue::truth, "whether marks are visible through surfaces"},
    {"marks.point_size", ViewValue::number, "diameter of points in CSS pixels", ValueRange::from(1, 100)},
    {"marks.normal_length", ViewValue::number, "length of normals in CSS pixels", ValueRange::from(1, 1000)},
    {"marks.smooth", ViewValue::truth, "smooth shading"},
    {"marks.occlusion", ViewValue::truth, "ambient occlusion"},
    {"marks.xray", ViewValue::truth, "transparent surfaces"},
    {"marks.slice", ViewValue::word, "axis across which surfaces are cut open", {}, "off x y z"},
    {"marks.slice_at", ViewValue::number, "place of the cut along its axis", ValueRange::from(0, 1)},
    {"marks.slice_flipped", ViewValue::truth, "whether the cut removes the other side"},
    {"marks.up", ViewValue::word, "upward axis", {}, "y z"},
    {"field.key", ViewValue::key,
     "the field that the page shows, by its key in the list of fields; null for none"},
    {"field.map", ViewValue::word, "its colours", {}, "viridis cividis magma inferno coolwarm"},
    {"field.range", ViewValue::interval,
     "the values at the ends of the colours; null for those of the frame"},
    {"field.arrow_length", ViewValue::number,
     "length of the longest arrow of a field of vectors in CSS pixels", ValueRange::above(0)},
    {"marks.hover", ViewValue::truth, "whether the resting pointer shows values"},
    {"objects.*.visible", ViewValue::truth,
     "whether the objects of this name are visible; an object that is not listed is visible and opaque, and "
     "has its usual colour"},
    {"objects.*.colour", ViewValue::colour, "their colour"},
    {"objects.*.opacity", ViewValue::number, "their opacity", ValueRange::from(0, 1)},
    {"filter", ViewValue::text, "part of a name: the list of contacts shows only objects with it"},
    {"tab", ViewValue::word, "open tab of the details", {}, "Inspect Contacts Curves Pins Plots Settings"},
    {"panels", ViewValue::truth, "whether the panels are visible"},
    {"views.layout", ViewValue::word, "number of views of the scene beside each other", {}, "one two four"},
    {"views.cameras.*.position", ViewValue::point,
     "of the views besides the first, which has `camera`; their names are `second`, `third` and `fourth`"},
    {"views.cameras.*.target", ViewValue::point, "as `camera.target`"},
    {"views.cameras.*.zoom", ViewValue::number, "as `camera.zoom`", ValueRange::above(0)},
    {"views.cameras.*.orthographic", ViewValue::truth, "as `camera.orthographic`"},
    {"views.slices.*.axis",
     ViewValue::word,
     "as `marks.slice`, for each view besides the first; a view without it has the slice of the first",
     {},
     "off x y z"},
    {"views.slices.*.at", ViewValue::number, "as `marks.slice_at`", ValueRange::from(0, 1)},
    {"views.slices.*.flipped", ViewValue::truth, "as `marks.slice_flipped`"},
    {"views.hidden.*.*", ViewValue::truth,
     "whether the view does not show the objects of this name; a view that is not listed shows those of the "
     "first"},
    {"pins.*.a", ViewValue::text,
     "name of an object whose values are shown over time; pins are named 1, 2 and so on"},
    {"pins.*.b", ViewValue::text, "name of the second object of a pair"},
    {"pins.*.contact", ViewValue::text,
     "only this contact of the pair: its four or seven numbers, as in the command `pins` "
     "(viewer/PROTOCOL.md), with spaces"},
});

/// What a value must be, in words: `a number from 0 to 1`.
std::string text_of(const ViewMember& member);

}  // namespace supple::viewer
