#pragma once

#include <cstddef>
#include <limits>

#include "supple/description.hpp"

namespace supple::viewer {

/// What a step says about a pin; NaN where there is nothing to measure.
struct PinValues {
  static constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

  double contacts = 0;
  double gap = nothing;
  double depth = nothing;
  double length = nothing;
  double area = nothing;
  double normal_x = nothing, normal_y = nothing, normal_z = nothing;
  double impact_time = nothing;
  double speed = nothing;
  double displacement = nothing;
};

}  // namespace supple::viewer

namespace supple {

template <>
struct Description<viewer::PinValues> : RecordDescription<viewer::PinValues> {
  static constexpr const char* name = "PinValues";
  static constexpr void fields(auto&& field) {
    field("contacts", &Row::contacts, "Intersections, continuous contacts, near pairs and vertices inside");
    field("gap", &Row::gap, "Smallest distance of near pairs", {}, "length");
    field("depth", &Row::depth, "Largest depth of vertices inside solids, and of curves", {}, "length");
    field("length", &Row::length, "Length of the segments in which triangles intersect", {}, "length");
    field("area", &Row::area, "Area of the closed curves of intersection", {}, "area");
    field("normal_x", &Row::normal_x, "Mean normal of the contacts, from the second object to the first: x");
    field("normal_y", &Row::normal_y, "The same normal: y");
    field("normal_z", &Row::normal_z, "The same normal: z");
    field("impact_time", &Row::impact_time, "Earliest continuous contact, as a part of the step");
    field("speed", &Row::speed, "Speed of the mean of the vertices", {}, "length/s");
    field("displacement", &Row::displacement, "Largest distance of a vertex from its place at the start", {},
          "length");
  }
};

}  // namespace supple

namespace supple::viewer {

/// The numbers of a row in a frame: step, time, and the values.
inline constexpr std::size_t pin_row_width = 2 + count_leaves<PinValues>();

}  // namespace supple::viewer
