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
struct Description<viewer::PinValues> {
  static constexpr const char* name = "PinValues";
  template <class Visitor>
  static constexpr void visit(Visitor&& visitor) {
    using Values = viewer::PinValues;
    visit_field(visitor, "contacts", &Values::contacts,
                "Intersections, continuous contacts, near pairs and vertices inside");
    visit_field(visitor, "gap", &Values::gap, "Smallest distance of near pairs", {}, "length");
    visit_field(visitor, "depth", &Values::depth, "Largest depth of vertices inside solids, and of curves",
                {}, "length");
    visit_field(visitor, "length", &Values::length, "Length of the segments in which triangles intersect", {},
                "length");
    visit_field(visitor, "area", &Values::area, "Area of the closed curves of intersection", {}, "area");
    visit_field(visitor, "normal_x", &Values::normal_x,
                "Mean normal of the contacts, from the second object to the first: x");
    visit_field(visitor, "normal_y", &Values::normal_y, "The same normal: y");
    visit_field(visitor, "normal_z", &Values::normal_z, "The same normal: z");
    visit_field(visitor, "impact_time", &Values::impact_time,
                "Earliest continuous contact, as a part of the step");
    visit_field(visitor, "speed", &Values::speed, "Speed of the mean of the vertices", {}, "length/s");
    visit_field(visitor, "displacement", &Values::displacement,
                "Largest distance of a vertex from its place at the start", {}, "length");
  }
};

}  // namespace supple

namespace supple::viewer {

/// The numbers of a row in a frame: step, time, and the values.
inline constexpr std::size_t pin_row_width = 2 + count_leaves<PinValues>();

}  // namespace supple::viewer
