#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "supple/queries.hpp"
#include "supple/triangle_intersection.hpp"
#include "verify/algebra/distance_algebra.hpp"
#include "verify/brute_force_contacts.hpp"

// The surface of one object, for `verify`. Intervals of doubles decide what they can, and integers the rest.
// Shares no code with detection and queries.
namespace supple {

/// A number that is not reduced, because that takes longer than to compare a few of them.
struct Fraction {
  sturm::Integer over = 0, under = 1;

  int compare(const Fraction& other) const { return (over * other.under).compare(other.over * under); }
  Rational value() const { return Rational(over, under); }
};
/// The squared distance of a point and a triangle with finite coordinates, exactly.
Fraction squared_distance_by_integers(const Vec3d& point, const TrianglePoints& corners);

/// A triangle with finite corners, and its exact box.
struct BoxedCorners {
  TrianglePoints corners;
  Vec3d min, max;
  std::uint32_t triangle = 0;  ///< the user's number
};

/// A binary tree of boxes, each split at the median along its longest axis.
class PlainTree {
 public:
  explicit PlainTree(const std::vector<BoxedCorners>& triangles);

  /// Calls `visit(i)` for the triangles of every leaf that `enter(min, max)` accepts with all boxes above it.
  /// Boxes on the side of the point come first.
  template <class Enter, class Visit>
  void visit(const Vec3d& point, const Enter& enter, const Visit& visit) const {
    if (!nodes_.empty()) visit_node(0, point, enter, visit);
  }

 private:
  struct Node {
    Vec3d min, max;
    std::uint32_t begin = 0, end = 0;  // in items_
    std::uint32_t right = 0;           // 0 for a leaf; the left child is the next node
    int axis = 0;
  };

  void build(const std::vector<BoxedCorners>& triangles, std::uint32_t begin, std::uint32_t end);
  template <class Enter, class Visit>
  void visit_node(std::uint32_t index, const Vec3d& point, const Enter& enter, const Visit& visit) const {
    const Node& node = nodes_[index];
    if (!enter(node.min, node.max)) return;
    if (node.right == 0) {
      for (std::uint32_t i = node.begin; i < node.end; ++i) visit(items_[i]);
      return;
    }
    const bool is_right_first = point[node.axis] > nodes_[node.right].min[node.axis];
    visit_node(is_right_first ? node.right : index + 1, point, enter, visit);
    visit_node(is_right_first ? index + 1 : node.right, point, enter, visit);
  }

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> items_;
};

/// The triangles of one object.
struct PlainSurface {
  bool has_inert = false;               ///< triangles with a corner that is not finite are left out
  std::vector<BoxedCorners> triangles;  ///< the others, ascending
  PlainTree tree;

  explicit PlainSurface(const PlainObject& object);

  /// Where a finite point is: on a triangle, else inside by an odd number of crossings of a ray along x. With
  /// a triangle that is left out, nothing is inside.
  Containment containment(const Vec3d& point) const;

  struct Nearest {
    std::uint32_t triangle = 0;  ///< the user's number; the smallest of several
    Fraction squared;
    std::size_t place = 0;  ///< in `triangles`
  };
  /// The nearest triangle of a finite point. There must be one. The search starts at the place `guess`.
  Nearest nearest(const Vec3d& point, std::size_t guess = 0) const;
};

}  // namespace supple
