#pragma once

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "mesh/vertex_sets.hpp"
#include "queries/feature_name.hpp"
#include "supple/scene.hpp"
#include "support/solid_pairs.hpp"

// What must hold for the depths and normals of the curves of two solids.

namespace supple::solids {

using Rational = boost::multiprecision::cpp_rational;

/// How far a convex body a has to move along a unit vector until its inside and that of b share no point. The
/// insides overlap exactly when they do along the normals of the faces and across each two edges.
class SeparatingMove {
 public:
  SeparatingMove(const Piece& a, const Piece& b) {
    std::array<std::set<Point>, 2> edges;
    for (const auto& [piece, own] : {std::pair(&a, &edges[0]), std::pair(&b, &edges[1])}) {
      for (const Triangle& facet : piece->facets) {
        add(piece->normal(facet), a, b);
        add(minus({}, piece->normal(facet)), a, b);
        for (std::size_t i = 0; i < 3; ++i) {
          const Point edge = minus(piece->points[facet[(i + 1) % 3]], piece->points[facet[i]]);
          own->insert(std::max(edge, minus({}, edge)));
        }
      }
    }
    for (const Point& p : edges[0]) {
      for (const Point& q : edges[1]) {
        const Point normal = cross(p, q);
        add(normal, a, b);
        add(minus({}, normal), a, b);
      }
    }
  }

  /// Whether the insides share no point.
  bool is_apart() const { return is_apart_; }

  /// The exact move, rounded, in the units of the meshes; 0 when they are apart.
  double along(const Vec3d& n) const {
    if (is_apart_) return 0;
    // Doubles find the directions that can be the best one, and rationals decide between these.
    double least = std::numeric_limits<double>::infinity();
    std::vector<std::pair<double, const Direction*>> candidates;  // at least this move
    for (const Direction& direction : directions_) {
      const Point& m = direction.normal;
      const double part[] = {static_cast<double>(m[0]) * n.x, static_cast<double>(m[1]) * n.y,
                             static_cast<double>(m[2]) * n.z};
      const double length = part[0] + part[1] + part[2];
      const double error = 0x1p-50 * (std::fabs(part[0]) + std::fabs(part[1]) + std::fabs(part[2]));
      if (length <= -error) continue;
      const double low = direction.overlap / (length + error);
      if (length > error) least = std::min(least, direction.overlap / (length - error));
      candidates.emplace_back(low, &direction);
    }
    std::optional<Rational> exact;
    for (const auto& [low, direction] : candidates) {
      if (low > least * (1 + 0x1p-40)) continue;
      const Point& m = direction->normal;
      const Rational length =
          Rational(m[0]) * Rational(n.x) + Rational(m[1]) * Rational(n.y) + Rational(m[2]) * Rational(n.z);
      if (length <= 0) continue;
      const Rational move = Rational(direction->overlap) / length;
      if (!exact || move < *exact) exact = move;
    }
    return unit * exact->convert_to<double>();
  }

 private:
  struct Direction {
    Point normal;
    double overlap;  // an integer
  };
  void add(const Point& normal, const Piece& a, const Piece& b) {
    if (normal == Point{} || is_apart_) return;
    std::int64_t lowest_a = std::numeric_limits<std::int64_t>::max(),
                 highest_b = std::numeric_limits<std::int64_t>::min();
    for (const Point& p : a.points) lowest_a = std::min(lowest_a, dot(normal, p));
    for (const Point& p : b.points) highest_b = std::max(highest_b, dot(normal, p));
    is_apart_ = highest_b <= lowest_a;
    directions_.push_back({normal, static_cast<double>(highest_b - lowest_a)});
  }

  std::vector<Direction> directions_;
  bool is_apart_ = false;
};

/// What a scene finds for two solids, and the faults of its curves.
class PairChecker {
 public:
  explicit PairChecker(const SolidPair& pair) : pair_(pair) {
    for (const Body* const body : {&pair.a, &pair.b}) {
      for (const Point& p : body->vertices) {
        for (const std::int64_t x : p) size_ = std::max(size_, unit * std::fabs(static_cast<double>(x)));
      }
    }
    tiny_ = 0x1p-32 * size_;
  }

  /// The first property that does not hold, in words; empty when all do.
  std::string fault() {
    Scene scene({.contacts = ContactKinds::penetration, .curves = true, .threads = 1});
    scene.add(pair_.a.mesh(), {.solid = true});
    scene.add(pair_.b.mesh(), {.solid = true});
    const DetectResult& result = scene.detect();
    if (result.curves.empty()) return {};
    find_regions(result);
    const bool are_convex = pair_.a.is_convex() && pair_.b.is_convex();
    if (are_convex) move_.emplace(pair_.a.pieces[0], pair_.b.pieces[0]);
    for (std::uint32_t c = 0; c < result.curves.size(); ++c) {
      const IntersectionCurve& curve = result.curves[c];
      std::string wrong = std::fabs(norm(curve.normal) - 1) > 1e-14 ? "the normal is not a unit vector"
                          : !(curve.depth >= 0)                     ? "the depth is negative"
                          : are_convex                              ? fault_of_move(curve)
                                                                    : "";
      if (wrong.empty()) wrong = fault_of_vertices(c, curve);
      if (!wrong.empty()) return "curve " + std::to_string(c) + ": " + wrong + described(curve);
    }
    return are_convex ? fault_of_other_scenes(result) : "";
  }

 private:
  /// Vertices of one body inside the other, which edges inside connect, and the curves around them.
  struct Region {
    std::vector<std::uint32_t> vertices;
    std::set<std::uint32_t> curves;
    double depth = 0;  // of the deepest vertex
  };

  const Body& body(std::size_t side) const { return side == 0 ? pair_.a : pair_.b; }

  static std::string described(const IntersectionCurve& curve) {
    const auto text = [](double x) {
      char buffer[32];
      std::snprintf(buffer, sizeof buffer, "%.10g", x);
      return std::string(buffer);
    };
    return "; depth " + text(curve.depth) + ", normal " + text(curve.normal.x) + " " + text(curve.normal.y) +
           " " + text(curve.normal.z);
  }

  /// Convex bodies: the move separates them, and no shorter one does.
  std::string fault_of_move(const IntersectionCurve& curve) const {
    const double move = move_->along(curve.normal);
    if (curve.depth < move * (1 - 0x1p-30) - tiny_)
      return "the bodies still overlap after the move, which must be " + std::to_string(move);
    if (curve.depth > move * (1 + 0x1p-30) + tiny_)
      return "the move is longer than the bodies overlap, " + std::to_string(move);
    return {};
  }

  /// After the move, no vertex of the contact is inside the pieces of the contact; the deepest vertex is not
  /// deeper than the curve.
  std::string fault_of_vertices(std::uint32_t number, const IntersectionCurve& curve) const {
    const double move = curve.depth * (1 + 0x1p-30) + tiny_;
    for (std::size_t side = 0; side < 2; ++side) {
      std::set<std::uint32_t> pieces = pieces_of_curve_[number][1 - side];
      for (const Region& region : regions_[side]) {
        if (region.curves != std::set{number}) continue;
        if (curve.depth < region.depth * (1 - 0x1p-30) - tiny_)
          return "a vertex is deeper, " + std::to_string(region.depth);
        for (const std::uint32_t v : region.vertices) {
          for (std::uint32_t p = 0; p < body(1 - side).pieces.size(); ++p) {
            if (depth_in(body(1 - side).pieces[p], position(side, v)) > 0) pieces.insert(p);
          }
        }
        for (const std::uint32_t v : region.vertices) {
          const Vec3d moved = position(side, v) + (side == 0 ? move : -move) / unit * curve.normal;
          for (const std::uint32_t p : pieces) {
            if (depth_in(body(1 - side).pieces[p], moved) * unit > tiny_)
              return std::string("after the move, vertex ") + std::to_string(v) +
                     (side == 0 ? " of a" : " of b") + " is still inside";
          }
        }
      }
    }
    return {};
  }

  Vec3d position(std::size_t side, std::uint32_t v) const {
    const Point& p = body(side).vertices[v];
    return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
  }
  /// The distance to the nearest plane of a face, in lattice units; negative outside. The rounding is far
  /// below `tiny_`.
  static double depth_in(const Piece& piece, const Vec3d& p) {
    double depth = std::numeric_limits<double>::infinity();
    for (const Triangle& facet : piece.facets) {
      const Point m = piece.normal(facet);
      const Vec3d n{static_cast<double>(m[0]), static_cast<double>(m[1]), static_cast<double>(m[2])};
      const double height = static_cast<double>(dot(m, piece.points[facet[0]]));
      depth = std::min(depth, (height - supple::dot(n, p)) / norm(n));
    }
    return depth;
  }

  void find_regions(const DetectResult& result) {
    pieces_of_curve_.assign(result.curves.size(), {});
    for (std::size_t side = 0; side < 2; ++side) {
      const Body& own = body(side);
      // The curves through each edge and each vertex.
      std::map<std::array<std::uint32_t, 2>, std::set<std::uint32_t>> curves_at;
      for (std::uint32_t c = 0; c < result.curves.size(); ++c) {
        for (const std::uint32_t i : result.contacts_of(result.curves[c])) {
          const Contact& contact = result.contacts[i];
          const std::uint32_t t = side == 0 ? contact.triangle_a : contact.triangle_b;
          pieces_of_curve_[c][side].insert(own.piece_of[t]);
          for (const ContactPoint& point : result.points_of(contact)) {
            const FeatureName name = name_of(side == 0 ? point.on_a : point.on_b, own.triangles[t], t);
            if (name.kind == FeatureKind::vertex) curves_at[{name.first, name.first}].insert(c);
            if (name.kind == FeatureKind::edge) curves_at[{name.first, name.last}].insert(c);
          }
        }
      }
      std::map<std::uint32_t, double> inside;
      for (const Penetration& penetration : result.penetrations) {
        if (penetration.object_a.index == side) inside[penetration.vertex] = penetration.depth;
      }
      VertexSets sets(own.vertices.size());
      std::map<std::uint32_t, Region> by_root;
      for (const bool joins : {true, false}) {
        for (const Triangle& triangle : own.triangles) {
          for (std::size_t i = 0; i < 3; ++i) {
            for (const std::size_t k : {(i + 1) % 3, (i + 2) % 3}) {
              const std::uint32_t v = triangle[i], w = triangle[k];
              if (inside.count(v) == 0) continue;
              const auto at_edge = curves_at.find({std::min(v, w), std::max(v, w)});
              const auto at_end = curves_at.find({w, w});
              if (joins && at_edge == curves_at.end() && inside.count(w) != 0) sets.join(v, w);
              if (joins) continue;
              for (const auto& found : {at_edge, at_end}) {
                if (found != curves_at.end())
                  by_root[sets.root(v)].curves.insert(found->second.begin(), found->second.end());
              }
            }
          }
        }
      }
      regions_[side].clear();
      for (const auto& [v, depth] : inside) {
        Region& region = by_root[sets.root(v)];
        region.vertices.push_back(v);
        region.depth = std::max(region.depth, depth);
      }
      for (auto& [root, region] : by_root) regions_[side].push_back(std::move(region));
    }
  }

  static double largest_depth(const DetectResult& result) {
    double depth = 0;
    for (const IntersectionCurve& curve : result.curves) depth = std::max(depth, curve.depth);
    return depth;
  }

  /// Exchanged bodies have the same depths and reversed normals. A body that moves by 2^-20 changes its depth
  /// by about as much.
  std::string fault_of_other_scenes(const DetectResult& result) const {
    Scene swapped({.contacts = ContactKinds::penetration, .curves = true, .threads = 1});
    swapped.add(pair_.b.mesh(), {.solid = true});
    swapped.add(pair_.a.mesh(), {.solid = true});
    const double depth = largest_depth(result), other = largest_depth(swapped.detect());
    if (std::fabs(depth - other) > 0x1p-30 * depth + tiny_)
      return "exchanged, the depth is " + std::to_string(other) + " instead of " + std::to_string(depth);
    constexpr double step = 0x1p-20;
    for (const Vec3d& offset : {Vec3d{step, 0, 0}, Vec3d{0, -step, 0}, Vec3d{step, step, -step}}) {
      Scene moved({.contacts = ContactKinds::penetration, .curves = true, .threads = 1});
      moved.add(pair_.a.mesh(offset), {.solid = true});
      moved.add(pair_.b.mesh(), {.solid = true});
      const DetectResult& found = moved.detect();
      // Bodies that only touch can part, and one that touches another one from inside can be contained.
      if (found.curves.empty() && (move_->is_apart() || !found.contained_parts.empty())) continue;
      const double change = std::fabs(largest_depth(found) - depth);
      if (change > 0x1p-16 * std::max(size_, 1.0))
        return "moved by 2^-20, the depth is " + std::to_string(largest_depth(found)) + " instead of " +
               std::to_string(depth);
    }
    return {};
  }

  const SolidPair& pair_;
  double size_ = 0, tiny_ = 0;
  std::optional<SeparatingMove> move_;
  std::array<std::vector<Region>, 2> regions_;  // of vertices of a in b, and of b in a
  std::vector<std::array<std::set<std::uint32_t>, 2>> pieces_of_curve_;  // whose triangles the curve crosses
};

/// Whether a fault comes from the directions that are tried: the faces on which a curve lies change with a
/// small move, and with them the least depth.
inline bool is_of_directions(const std::string& fault) {
  return fault.find("moved by") != std::string::npos || fault.find("exchanged") != std::string::npos;
}

}  // namespace supple::solids
