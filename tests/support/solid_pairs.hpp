#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "supple/mesh.hpp"

// Pairs of solids of convex pieces, with small integer coordinates, in general and in degenerate position.
// They come from any source of numbers that has `below(count)`, for counts of at most 256.

namespace supple::solids {

using Point = std::array<std::int64_t, 3>;
/// The lattice of the coordinates in the meshes.
constexpr double unit = 0x1p-6;

inline Point minus(const Point& a, const Point& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline std::int64_t dot(const Point& a, const Point& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// A convex polyhedron.
struct Piece {
  std::vector<Point> points;
  std::vector<Triangle> facets;  ///< outward

  Point normal(const Triangle& facet) const {
    return cross(minus(points[facet[1]], points[facet[0]]), minus(points[facet[2]], points[facet[0]]));
  }
};

/// A body that is the union of its pieces, whose insides share no point.
struct Body {
  std::string kind;
  std::vector<Point> vertices;
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> piece_of;  ///< by triangle
  std::vector<Piece> pieces;

  bool is_convex() const { return pieces.size() == 1; }
  /// Adds its vertices and triangles of a piece as they are.
  void add_piece(Piece piece) {
    for (const Triangle& facet : piece.facets) {
      Triangle triangle;
      for (std::size_t i = 0; i < 3; ++i) triangle[i] = vertex(piece.points[facet[i]]);
      triangles.push_back(triangle);
      piece_of.push_back(static_cast<std::uint32_t>(pieces.size()));
    }
    pieces.push_back(std::move(piece));
  }
  std::uint32_t vertex(const Point& p) {
    const auto found = std::find(vertices.begin(), vertices.end(), p);
    const auto id = static_cast<std::uint32_t>(found - vertices.begin());
    if (found == vertices.end()) vertices.push_back(p);
    return id;
  }
  TriangleMesh mesh(const Vec3d& offset = {}) const {
    TriangleMesh mesh{.name = kind, .positions = {}, .triangles = triangles};
    for (const Point& p : vertices)
      mesh.positions.push_back(Vec3d{unit * static_cast<double>(p[0]), unit * static_cast<double>(p[1]),
                                     unit * static_cast<double>(p[2])} +
                               offset);
    return mesh;
  }
};

struct SolidPair {
  Body a, b;
};

/// The convex hull of points that are not all in one plane. Points on its faces and edges are left out.
inline Piece hull_of(const std::vector<Point>& points) {
  Piece hull;
  std::set<std::vector<std::uint32_t>> known;
  const auto count = static_cast<std::uint32_t>(points.size());
  std::vector<std::uint32_t> used(count, count);
  const auto use = [&](std::uint32_t p) {
    if (used[p] == count) {
      used[p] = static_cast<std::uint32_t>(hull.points.size());
      hull.points.push_back(points[p]);
    }
    return used[p];
  };
  for (std::uint32_t i = 0; i < count; ++i) {
    for (std::uint32_t j = i + 1; j < count; ++j) {
      for (std::uint32_t k = j + 1; k < count; ++k) {
        Point normal = cross(minus(points[j], points[i]), minus(points[k], points[i]));
        if (normal == Point{}) continue;
        std::vector<std::uint32_t> face;
        int sides = 0;  // bits: points below and above
        for (std::uint32_t p = 0; p < count && sides != 3; ++p) {
          const std::int64_t height = dot(normal, minus(points[p], points[i]));
          if (height == 0) face.push_back(p);
          sides |= height < 0 ? 1 : height > 0 ? 2 : 0;
        }
        if (sides == 3 || !known.insert(face).second) continue;
        if (sides == 2) normal = minus({}, normal);
        // Around the face: each next corner has all points of the face on its left.
        std::vector<std::uint32_t> around;
        std::uint32_t corner =
            *std::min_element(face.begin(), face.end(),
                              [&](std::uint32_t p, std::uint32_t q) { return points[p] < points[q]; });
        do {
          around.push_back(corner);
          std::uint32_t next = corner;
          for (const std::uint32_t p : face) {
            const Point way = minus(points[p], points[corner]), best = minus(points[next], points[corner]);
            const std::int64_t turn = dot(normal, cross(best, way));
            if (p != corner && (next == corner || turn < 0 || (turn == 0 && dot(way, way) > dot(best, best))))
              next = p;
          }
          corner = next;
        } while (corner != around.front());
        for (std::size_t c = 2; c < around.size(); ++c)
          hull.facets.push_back({use(around[0]), use(around[c - 1]), use(around[c])});
      }
    }
  }
  return hull;
}

/// A box from one corner to the other, whose sides have n x n squares.
inline Body box_of(const Point& low, const Point& high, std::int64_t n) {
  Body body;
  std::vector<Point> corners;
  for (int c = 0; c < 8; ++c)
    corners.push_back(
        {(c & 1) != 0 ? high[0] : low[0], (c & 2) != 0 ? high[1] : low[1], (c & 4) != 0 ? high[2] : low[2]});
  body.pieces.push_back(hull_of(corners));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (const bool is_high : {false, true}) {
      const auto at = [&](std::int64_t i, std::int64_t k) {
        Point p;
        p[axis] = is_high ? high[axis] : low[axis];
        p[u] = low[u] + (high[u] - low[u]) * i / n;
        p[v] = low[v] + (high[v] - low[v]) * k / n;
        return body.vertex(p);
      };
      for (std::int64_t i = 0; i < n; ++i) {
        for (std::int64_t k = 0; k < n; ++k) {
          const std::uint32_t p = at(i, k), q = at(i + 1, k), r = at(i + 1, k + 1), s = at(i, k + 1);
          for (Triangle triangle : {Triangle{p, q, r}, Triangle{p, r, s}}) {
            if (!is_high) std::swap(triangle[1], triangle[2]);
            body.triangles.push_back(triangle);
            body.piece_of.push_back(0);
          }
        }
      }
    }
  }
  return body;
}

/// Convex cells of a plane that share whole edges or nothing, from z = 0 to `height`.
inline Body extruded(const std::vector<std::vector<std::array<std::int64_t, 2>>>& cells,
                     std::int64_t height) {
  Body body;
  std::set<std::pair<std::array<std::int64_t, 2>, std::array<std::int64_t, 2>>> edges;
  for (const auto& cell : cells) {
    for (std::size_t i = 0; i < cell.size(); ++i) edges.insert({cell[i], cell[(i + 1) % cell.size()]});
  }
  for (const auto& cell : cells) {
    const auto piece = static_cast<std::uint32_t>(body.pieces.size());
    std::vector<Point> points;
    for (const std::int64_t z : {std::int64_t{0}, height}) {
      for (const auto& [x, y] : cell) points.push_back({x, y, z});
    }
    const std::size_t n = cell.size();
    const auto add = [&](std::size_t i, std::size_t j, std::size_t k) {
      body.triangles.push_back({body.vertex(points[i]), body.vertex(points[j]), body.vertex(points[k])});
      body.piece_of.push_back(piece);
    };
    for (std::size_t i = 2; i < n; ++i) {
      add(0, i, i - 1);
      add(n, n + i - 1, n + i);
    }
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t next = (i + 1) % n;
      if (edges.count({cell[next], cell[i]}) != 0) continue;
      add(i, next, n + next);
      add(i, n + next, n + i);
    }
    body.pieces.push_back(hull_of(points));
  }
  return body;
}

template <class Source>
std::int64_t between(Source& source, std::int64_t low, std::int64_t high) {
  return low + static_cast<std::int64_t>(source.below(static_cast<std::uint32_t>(high - low + 1)));
}

/// One of the kinds of bodies, about 16 to 64 lattice units large.
template <class Source>
Body random_body(Source& source) {
  const auto number = [&](std::int64_t low, std::int64_t high) { return between(source, low, high); };
  Body body;
  switch (source.below(8)) {
    case 0: {
      body = box_of({}, {number(1, 16) * 4, number(1, 16) * 4, number(1, 16) * 4}, 1);
      body.kind = "box";
      break;
    }
    case 1:
    case 2: {
      const std::int64_t n = number(2, 4);
      body = box_of({}, {n * number(2, 12), n * number(2, 12), n * number(2, 12)}, n);
      body.kind = "crate";
      break;
    }
    case 3: {
      // The corners of a convex polygon with sides of different directions.
      constexpr std::array<std::array<std::int64_t, 2>, 8> directions{
          {{4, 0}, {4, 2}, {2, 4}, {0, 4}, {-2, 4}, {-4, 0}, {-4, -4}, {0, -4}}};
      std::vector<std::array<std::int64_t, 2>> outline{{0, 0}};
      const std::int64_t size = number(2, 6);
      for (std::size_t i = 0; i + 2 < directions.size(); ++i) {
        if (source.below(2) == 0 && i > 1) continue;
        outline.push_back(
            {outline.back()[0] + size * directions[i][0], outline.back()[1] + size * directions[i][1]});
      }
      std::vector<Point> points;
      for (const std::int64_t z : {std::int64_t{0}, number(4, 48)}) {
        for (const auto& [x, y] : outline) points.push_back({x, y, z});
      }
      body.add_piece(hull_of(points));
      body.kind = "prism";
      break;
    }
    case 4: {
      // Integer points on a sphere; 12 of them on each of three equators.
      const std::int64_t size = number(1, 6);
      std::vector<Point> points;
      for (std::int64_t x = -5; x <= 5; ++x) {
        for (std::int64_t y = -5; y <= 5; ++y) {
          for (std::int64_t z = -5; z <= 5; ++z) {
            if (x * x + y * y + z * z == 25) points.push_back({size * x, size * y, size * z});
          }
        }
      }
      body.add_piece(hull_of(points));
      body.kind = "sphere";
      break;
    }
    case 5: {
      Piece hull;
      while (hull.facets.empty() || hull.points.size() < 4) {
        std::vector<Point> points;
        const std::int64_t count = number(4, 14);
        for (std::int64_t i = 0; i < count; ++i)
          points.push_back({number(0, 48), number(0, 48), number(0, 48)});
        // Without four points in general position there is no hull.
        points.push_back({0, 0, 0});
        points.push_back({40, 1, 0});
        points.push_back({2, 40, 3});
        points.push_back({5, 1, 40});
        hull = hull_of(points);
      }
      body.add_piece(std::move(hull));
      body.kind = "hull";
      break;
    }
    default: {
      // A grid of cells, of which an L takes three and a U five.
      const bool is_u = source.below(2) != 0;
      const std::array<std::int64_t, 4> x{0, 4 * number(1, 8), 0, 0}, y{0, 4 * number(1, 6), 0, 0};
      const std::int64_t x2 = x[1] + 4 * number(1, 10), x3 = x2 + 4 * number(1, 8),
                         y2 = y[1] + 4 * number(1, 10);
      const auto cell = [](std::int64_t x0, std::int64_t y0, std::int64_t x1, std::int64_t y1) {
        return std::vector<std::array<std::int64_t, 2>>{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
      };
      std::vector<std::vector<std::array<std::int64_t, 2>>> cells{
          cell(0, 0, x[1], y[1]), cell(x[1], 0, x2, y[1]), cell(0, y[1], x[1], y2)};
      if (is_u) {
        cells.push_back(cell(x2, 0, x3, y[1]));
        cells.push_back(cell(x2, y[1], x3, y2));
      }
      body = extruded(cells, 4 * number(1, 12));
      body.kind = is_u ? "U" : "L";
      break;
    }
  }
  return body;
}

/// Applies a linear map with integer coefficients and adds an offset.
inline void place(Body& body, const std::array<Point, 3>& rows, const Point& offset) {
  const auto placed = [&](Point& p) {
    p = {dot(rows[0], p) + offset[0], dot(rows[1], p) + offset[1], dot(rows[2], p) + offset[2]};
  };
  for (Point& p : body.vertices) placed(p);
  const bool mirrors = dot(cross(rows[0], rows[1]), rows[2]) < 0;
  const auto turn = [&](std::vector<Triangle>& triangles) {
    for (Triangle& triangle : triangles) {
      if (mirrors) std::swap(triangle[1], triangle[2]);
    }
  };
  turn(body.triangles);
  for (Piece& piece : body.pieces) {
    for (Point& p : piece.points) placed(p);
    turn(piece.facets);
  }
}

/// Half of the bodies are turned by a right angle or mirrored, some by other angles, which makes them larger.
template <class Source>
void turn(Source& source, Body& body) {
  constexpr std::array<std::array<Point, 3>, 3> turns{{{{{3, -4, 0}, {4, 3, 0}, {0, 0, 5}}},
                                                       {{{2, -2, 1}, {2, 1, -2}, {1, 2, 2}}},
                                                       {{{6, -3, -2}, {2, 6, -3}, {3, 2, 6}}}}};
  std::array<Point, 3> rows{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  if (source.below(3) == 0) rows = turns[source.below(3)];
  for (std::size_t i = 2; i > 0; --i)
    std::swap(rows[i], rows[source.below(static_cast<std::uint32_t>(i) + 1)]);
  for (Point& row : rows) {
    if (source.below(2) != 0) row = minus({}, row);
  }
  place(body, rows, {});
}

/// Two bodies whose boxes overlap or touch. Along some axes, a vertex of a is as high as one of b.
template <class Source>
SolidPair random_pair(Source& source) {
  SolidPair pair{random_body(source), random_body(source)};
  for (Body* const body : {&pair.a, &pair.b}) {
    if (source.below(2) != 0) turn(source, *body);
  }
  const std::uint32_t style = source.below(3);  // general, aligned, mixed
  Point offset{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto by_axis = [axis](const Point& p, const Point& q) { return p[axis] < q[axis]; };
    const auto [low_a, high_a] = std::minmax_element(pair.a.vertices.begin(), pair.a.vertices.end(), by_axis);
    const auto [low_b, high_b] = std::minmax_element(pair.b.vertices.begin(), pair.b.vertices.end(), by_axis);
    if (style == 1 || (style == 2 && source.below(2) == 0)) {
      const auto any = [&](const Body& body) {
        return body.vertices[source.below(
            static_cast<std::uint32_t>(std::min<std::size_t>(body.vertices.size(), 256)))][axis];
      };
      offset[axis] = any(pair.b) - any(pair.a);
      if (source.below(6) == 0) offset[axis] += between(source, -1, 1);
    } else {
      const std::int64_t least = (*low_b)[axis] - (*high_a)[axis], most = (*high_b)[axis] - (*low_a)[axis];
      offset[axis] = least + (most - least) * between(source, 0, 255) / 255;
    }
  }
  place(pair.a, {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, offset);
  return pair;
}

}  // namespace supple::solids
