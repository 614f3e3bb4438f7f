#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "answers/penetration/manifold_methods.hpp"
#include "manifold/curves/contact_regions.hpp"
#include "manifold/curves/curve_side.hpp"
#include "manifold/curves/parity_sets.hpp"
#include "manifold/curves/way_out.hpp"
#include "queries/feature_name.hpp"
#include "supple/penetration.hpp"
#include "supple/result.hpp"

namespace supple {

/// The power of two that brings coordinates of any size to about 1, so that their squares and sums neither
/// overflow nor vanish. It changes no other rounding.
inline double scale_of(double largest) {
  return std::ldexp(1.0, -std::clamp(largest > 0 ? std::ilogb(largest) : 0, -1000, 1023));
}

/// Links contacts to curves. Holds the memory of one worker.
class CurveFinder : public CurveMaker {
 public:
  void find(const CurveInput& input, CurveLists& lists) override;
  /// The work of the last `find`: vertices and triangles that it read for all curves.
  std::size_t visited() const { return visited_; }

 private:
  /// A point of a contact. Points with the same names are one point of a curve.
  struct Link {
    FeatureName a, b;
    std::uint32_t contact = 0, place = 0;  // of the group
    bool is_swapped = false;               // within one object: the names are in the other order
    constexpr auto operator<=>(const Link&) const = default;
  };
  /// A contact on its way along a curve: it enters and leaves it at these points.
  struct Step {
    std::uint32_t contact = 0, enter = 0, leave = 0;
  };

  void link_contacts();
  void add_curve(std::span<const std::uint32_t> members, CurveLists& lists);
  CurveKind kind_of(std::span<const std::uint32_t> members) const;
  void walk(std::span<const std::uint32_t> members, CurveKind kind);
  void turn_around(CurveKind kind);
  double turn_of_steps() const;
  void measure(std::span<const std::uint32_t> members, IntersectionCurve& curve);
  void list_face_normals(std::span<const std::uint32_t> members, bool counts_touching);
  Vec3d direction_of_segments(std::span<const std::uint32_t> members) const;
  Vec3d mean_normal(std::span<const std::uint32_t> members) const;
  void link_regions();
  bool only_touches(std::uint32_t i) const;
  bool separates(std::size_t side, std::uint32_t face, std::span<const std::uint32_t> members) const;
  double length_of(std::uint32_t i) const;
  bool find_separation(std::span<const std::uint32_t> members, IntersectionCurve& curve);
  void add_common_points();
  void find_way_out(std::span<const std::uint32_t> members, IntersectionCurve& curve);
  std::size_t enclose(std::span<const std::uint32_t> members, bool side_b, CurveLists& lists);

  const SurfaceView& surface_of(std::size_t side) const { return (side == 0 ? input_.a : input_.b)->surface; }
  const Contact& contact(std::uint32_t i) const { return contacts_[i]; }
  std::uint32_t first_place(std::uint32_t i) const {
    return contacts_[i].first_point - contacts_[0].first_point;
  }
  Vec3d position(std::uint32_t place) const { return points_[place].position; }
  template <class Function>
  void for_each_point(std::span<const std::uint32_t> members, Function function) const {
    for (const std::uint32_t i : members) {
      for (std::uint32_t k = 0; k < contact(i).point_count; ++k) function(position(first_place(i) + k));
    }
  }
  template <class Function>
  void for_each_behind(std::size_t side, Function function) const {
    for (const std::uint32_t v : regions_[side].inside()) function(v);
    for (const std::uint32_t v : regions_[side].beyond()) function(v);
  }
  /// On side a or b of the curve.
  std::uint32_t triangle_of(std::uint32_t i, std::size_t side) const {
    return (side != 0) != is_turned(i) ? contact(i).triangle_b : contact(i).triangle_a;
  }
  std::uint32_t degree(std::uint32_t key) const { return first_link_[key + 1] - first_link_[key]; }
  /// Whether side a of the curve is object b of the contact: only within one object.
  bool is_turned(std::uint32_t i) const { return is_turned_[i] != 0; }

  CurveInput input_;
  std::span<const Contact> contacts_;     // of the group
  std::span<const ContactPoint> points_;  // of these contacts

  std::vector<Link> links_;                         // sorted: by key
  std::vector<std::uint32_t> first_link_;           // of each key
  std::vector<std::uint32_t> key_;                  // of each place
  ParitySets sides_;                                // of the contacts; the sets are the curves
  std::vector<std::uint8_t> is_one_sided_;          // by smallest contact: the sides of the curve are one
  std::vector<std::uint8_t> is_turned_;             // by contact
  std::vector<std::array<Vec3d, 2>> face_normals_;  // of a and b, by contact
  std::vector<std::uint32_t> members_, first_member_, curve_of_;
  std::vector<Step> steps_;

  double scale_ = 1;        // brings the points of the curve to about 1
  Vec3d middle_, of_area_;  // its centroid, scaled, and the direction of its area, or zero

  /// A direction in which a may leave b, with the length of the curve on faces of that normal.
  struct Direction {
    std::array<double, 3> rounded{};  // equal for normals that differ by rounding
    std::uint8_t side = 0;            // of the faces
    std::array<double, 3> normal{};
    std::uint32_t triangle = 0;
    double length = 0;
    constexpr auto operator<=>(const Direction&) const = default;
  };
  std::vector<Direction> directions_;
  std::vector<std::uint32_t> counted_;  // contacts on whose faces the curve lies by `list_face_normals`
  std::vector<WayCandidate> candidates_;
  CurveSide side_;
  std::array<ContactRegions, 2> regions_;  // of the surfaces
  WayOut way_out_;
  std::size_t visited_ = 0;
};

}  // namespace supple
