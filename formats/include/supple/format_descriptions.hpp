#pragma once

#include "supple/description.hpp"
#include "supple/formats.hpp"

// Descriptions of the options that read files (description.hpp).

namespace supple {

template <>
inline constexpr std::array words<UpAxis>{"file", "x", "y", "z"};
template <>
inline constexpr std::array words<LengthUnit>{"file", "um", "mm", "cm", "m", "km", "in", "ft"};

template <>
struct Description<CoordinateConversion> {
  static constexpr const char* name = "CoordinateConversion";
  static constexpr void visit(auto&& visitor) {
    using Options = CoordinateConversion;
    visitor(Field<Options, UpAxis>{
        .name = "up",
        .member = &Options::up,
        .doc = "Turn meshes so that this axis points up, if their files state which axis does: glTF, FBX, "
               "COLLADA, 3DS and others; file keeps the axes of each file"});
    visitor(Field<Options, LengthUnit>{
        .name = "unit",
        .member = &Options::unit,
        .doc = "Scale meshes to this unit, if their files state their unit: glTF, FBX, COLLADA and 3MF; file "
               "keeps the unit of each file"});
  }
};

}  // namespace supple
