#pragma once

#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <vector>

#include "supple/triangle_intersection.hpp"

namespace supple::truth {

using Rational =
    boost::multiprecision::number<boost::multiprecision::cpp_rational_backend, boost::multiprecision::et_off>;
using RationalPoint = std::array<Rational, 3>;

RationalPoint rational(const Vec3d& point);
RationalPoint subtract(const RationalPoint& a, const RationalPoint& b);
RationalPoint cross(const RationalPoint& a, const RationalPoint& b);
Rational dot(const RationalPoint& a, const RationalPoint& b);

/// The extreme points of the intersection of two closed triangles, in order around the polygon. The first
/// triangle is clipped by the half-spaces of the second one in rational arithmetic.
std::vector<RationalPoint> clipped_extreme_points(const TrianglePoints& a, const TrianglePoints& b);

/// Whether the point is in the relative interior of the feature.
bool in_relative_interior(const RationalPoint& point, const TrianglePoints& triangle, Feature feature);

/// The point at which two features meet. At least one of them is a vertex or an edge.
RationalPoint exact_meeting_point(const TrianglePoints& a, Feature on_a, const TrianglePoints& b,
                                  Feature on_b);

}  // namespace supple::truth
