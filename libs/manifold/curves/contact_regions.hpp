#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

#include "answers/penetration/surface_view.hpp"
#include "queries/feature_name.hpp"
#include "supple/mesh.hpp"
#include "supple/types.hpp"

namespace supple {

/// The regions of one surface that are behind another one: one region for each curve of the two. Keeps its
/// memory.
///
/// The contacts tell on which side of the other surface the ends of the edges are that they cut, exactly: an
/// edge that meets the other surface in a point ends behind it when its end is behind all triangles there. A
/// vertex on the other surface belongs to neither side. From the ends that are behind, a region grows over
/// the vertices that edges without contacts connect.
class ContactRegions {
 public:
  /// A point of a contact: the triangle of this surface, and its feature that holds the point; the triangle
  /// of the other surface.
  struct Point {
    FeatureName feature;
    Triangle triangle{};
    TrianglePoints other{};
    Vec3d position;
    std::uint32_t key = 0, curve = 0;  // points with the same key are the same
  };

  /// Starts another pair of surfaces. `surface` must live until the last `grow`.
  void start(const SurfaceView& surface);
  void add(const Point& point);
  /// Call after the last point. O(n log n) for n points.
  void link(std::uint32_t curve_count);

  /// Starts the region of a curve with what its contacts tell.
  void begin(std::uint32_t curve);
  /// Whether no contact told on which side the vertex is, and `decide` neither.
  bool is_open(std::uint32_t vertex) const;
  void decide(std::uint32_t vertex, bool is_inside);
  /// Grows the region, in O(contacts of the curve, vertices of the region). It ends after `most` vertices.
  void grow(std::uint32_t curve, std::size_t most);
  /// The vertices behind the other surface that are connected to the curve.
  std::span<const std::uint32_t> inside() const { return inside_; }
  /// The vertices that are behind the curve, but in front of the other surface again: the end of a rod that
  /// goes through a plate. Empty when there are many more than contacts.
  std::span<const std::uint32_t> beyond() const { return beyond_; }
  /// A point behind the other surface on each edge that has two contacts, one of this curve.
  std::span<const Vec3d> middles() const { return middles_; }

 private:
  enum Sides : std::uint8_t { in_front = 1, in_plane = 2, behind = 4 };
  enum class Place : std::uint8_t { inside, front, beyond };
  /// A point on an edge from `corner` to `other`, and on which sides of the triangles there `corner` is.
  struct Crossing {
    std::uint32_t corner = 0, other = 0;
    double distance = 0;  // from `corner`
    std::uint32_t key = 0, curve = 0;
    std::uint8_t sides = 0;
    Vec3d position;

    auto order() const { return std::tie(corner, other, distance, key); }
  };
  struct Seed {
    std::uint32_t curve = 0;
    Place place = Place::inside;
    std::uint32_t vertex = 0;
    constexpr auto operator<=>(const Seed&) const = default;
  };
  struct Middle {
    std::uint32_t curve = 0;
    Vec3d position;
  };

  void add_crossing(const Point& point, std::uint32_t corner, std::uint32_t other);
  std::span<const Seed> seeds_of(std::uint32_t curve) const {
    return std::span(seeds_).subspan(first_seed_[curve], first_seed_[curve + 1] - first_seed_[curve]);
  }
  void list_seeds(std::span<const Crossing> edge);
  std::span<const Crossing> crossings_of(std::uint32_t corner, std::uint32_t other) const;
  bool is_cut(std::uint32_t v, std::uint32_t w) const;
  bool is_cut_by(std::uint32_t curve, std::uint32_t v, std::uint32_t w) const;
  bool reach(std::uint32_t vertex);
  template <class IsCut>
  void add_neighbours(std::uint32_t v, const IsCut& is_cut, std::vector<std::uint32_t>& list);

  SurfaceView surface_;
  std::vector<Crossing> crossings_;
  std::vector<Seed> seeds_;
  std::vector<Middle> all_middles_;
  std::vector<std::uint32_t> first_seed_, first_middle_;  // of each curve
  std::vector<std::uint8_t> marks_;                       // by vertex
  std::vector<std::uint32_t> marked_;
  std::vector<std::uint64_t> state_;  // by vertex: `stamp_` when it was reached, one less in front
  std::uint64_t stamp_ = 0;
  std::vector<std::uint32_t> inside_, beyond_;
  std::vector<Vec3d> middles_;
};

}  // namespace supple
