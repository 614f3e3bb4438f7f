#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "supple/mesh.hpp"
#include "support/random.hpp"

// Polygons with integer coordinates, and exact checks of triangles that cover them.

namespace supple::polygons {

/// Below 2^30, so that areas fit 64 bits.
using Point = std::array<std::int64_t, 2>;
using Polygon = std::vector<Point>;

inline std::int64_t doubled_area(const Point& a, const Point& b, const Point& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}
inline std::int64_t doubled_area(const Polygon& polygon) {
  std::int64_t sum = 0;
  for (std::size_t k = 2; k < polygon.size(); ++k)
    sum += doubled_area(polygon[0], polygon[k - 1], polygon[k]);
  return sum;
}

/// How often the polygon winds around point / 3, which lies on no edge.
inline int winding_number(const Polygon& polygon, const Point& tripled) {
  int winding = 0;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Point &from = polygon[k], &to = polygon[(k + 1) % polygon.size()];
    const Point a{3 * from[0], 3 * from[1]}, b{3 * to[0], 3 * to[1]};
    if ((a[1] > tripled[1]) == (b[1] > tripled[1])) continue;
    const std::int64_t side = doubled_area(a, b, tripled);
    if (b[1] > tripled[1] && side > 0) ++winding;
    if (a[1] > tripled[1] && side < 0) --winding;
  }
  return winding;
}

/// Whether two triangles that turn left share no inner point: an edge of one separates them.
inline bool are_apart(const std::array<Point, 3>& a, const std::array<Point, 3>& b) {
  for (const auto& [first, second] : {std::pair(&a, &b), std::pair(&b, &a)}) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto is_outside = [&](const Point& p) {
        return doubled_area((*first)[i], (*first)[(i + 1) % 3], p) <= 0;
      };
      if (std::all_of(second->begin(), second->end(), is_outside)) return true;
    }
  }
  return false;
}

/// What is wrong with triangles that must cover the inside of a polygon once; empty when nothing is. The
/// polygon must not cross itself. Tests pairs of triangles, so it takes quadratic time.
inline std::string fault_of_cover(Polygon polygon, std::vector<Triangle> triangles) {
  if (triangles.size() + 2 != polygon.size()) return "the number of triangles";
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  const auto add = [&](std::uint32_t from, std::uint32_t to, int count) {
    edges[std::minmax(from, to)] += from < to ? count : -count;
  };
  const auto corners = static_cast<std::uint32_t>(polygon.size());
  for (std::uint32_t k = 0; k < corners; ++k) add(k, (k + 1) % corners, -1);
  for (const Triangle& t : triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (t[i] >= corners) return "a corner that does not exist";
      add(t[i], t[(i + 1) % 3], 1);
    }
  }
  for (const auto& [edge, count] : edges) {
    if (count != 0)
      return "edge " + std::to_string(edge.first) + ' ' + std::to_string(edge.second) + " is left over";
  }
  if (doubled_area(polygon) < 0) {
    for (Point& p : polygon) std::swap(p[0], p[1]);
  }
  std::vector<std::array<Point, 3>> parts;
  std::int64_t area = 0;
  for (const Triangle& t : triangles) {
    const std::array points{polygon[t[0]], polygon[t[1]], polygon[t[2]]};
    const std::int64_t part = doubled_area(points[0], points[1], points[2]);
    if (part < 0) return "a triangle turns the other way";
    area += part;
    if (part == 0) continue;
    const auto& [a, b, c] = points;
    if (winding_number(polygon, {a[0] + b[0] + c[0], a[1] + b[1] + c[1]}) != 1)
      return "a triangle is outside";
    parts.push_back(points);
  }
  if (area != doubled_area(polygon)) return "the area";
  for (std::size_t i = 0; i < parts.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (!are_apart(parts[i], parts[j])) return "two triangles overlap";
    }
  }
  return {};
}

/// Whether two edges cross, or the polygon winds around some area other than once, in the direction of its
/// area. The coordinates must be small integers: it computes in double, with points near each part of each
/// edge.
inline bool crosses_itself(const Polygon& polygon) {
  const std::size_t count = polygon.size();
  const auto side = [](const Point& a, const Point& b, const Point& c) {
    const std::int64_t area = doubled_area(a, b, c);
    return (area > 0) - (area < 0);
  };
  const std::int64_t area = doubled_area(polygon);
  const int direction = (area > 0) - (area < 0);
  const auto winding = [&](double x, double y) {
    int sum = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const auto [ax, ay] = polygon[k];
      const auto [bx, by] = polygon[(k + 1) % count];
      const double left = static_cast<double>(bx - ax) * (y - static_cast<double>(ay)) -
                          static_cast<double>(by - ay) * (x - static_cast<double>(ax));
      if (static_cast<double>(ay) <= y && static_cast<double>(by) > y && left > 0) ++sum;
      if (static_cast<double>(ay) > y && static_cast<double>(by) <= y && left < 0) --sum;
    }
    return sum;
  };
  for (std::size_t i = 0; i < count; ++i) {
    const Point &a = polygon[i], &b = polygon[(i + 1) % count];
    const double dx = static_cast<double>(b[0] - a[0]), dy = static_cast<double>(b[1] - a[1]);
    std::vector<double> cuts{0, 1};
    for (std::size_t j = 0; j < count; ++j) {
      const Point &c = polygon[j], &d = polygon[(j + 1) % count];
      const int sides[] = {side(a, b, c), side(a, b, d), side(c, d, a), side(c, d, b)};
      if (sides[0] * sides[1] < 0 && sides[2] * sides[3] < 0) return true;
      if (sides[0] == 0 && (dx != 0 || dy != 0))
        cuts.push_back((static_cast<double>(c[0] - a[0]) * dx + static_cast<double>(c[1] - a[1]) * dy) /
                       (dx * dx + dy * dy));
    }
    std::sort(cuts.begin(), cuts.end());
    for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
      const double middle = (cuts[k] + cuts[k + 1]) / 2;
      if (cuts[k + 1] - cuts[k] < 1e-9 || middle <= 0 || middle >= 1) continue;
      for (const double aside : {-1e-6, 1e-6}) {
        const int found = winding(static_cast<double>(a[0]) + middle * dx - aside * dy,
                                  static_cast<double>(a[1]) + middle * dy + aside * dx);
        if (found != 0 && found != direction) return true;
      }
    }
  }
  return false;
}

inline Polygon starting_at(Polygon polygon, std::size_t first) {
  std::rotate(polygon.begin(), polygon.begin() + static_cast<std::ptrdiff_t>(first), polygon.end());
  return polygon;
}

/// A polygon through distinct random points of a grid, whose edges share no point except at corners: it
/// reverses paths between edges that meet until none do. May give up and return no corners.
inline Polygon random_simple_polygon(RandomNumbers& random, std::uint32_t corners, std::uint32_t grid) {
  std::set<Point> points;
  while (points.size() < corners) points.insert({random.below(grid), random.below(grid)});
  Polygon polygon(points.begin(), points.end());
  random.shuffle(polygon);
  const auto side = [](const Point& a, const Point& b, const Point& c) {
    const std::int64_t area = doubled_area(a, b, c);
    return (area > 0) - (area < 0);
  };
  const auto in_box = [](const Point& a, const Point& b, const Point& p) {
    return std::min(a[0], b[0]) <= p[0] && p[0] <= std::max(a[0], b[0]) && std::min(a[1], b[1]) <= p[1] &&
           p[1] <= std::max(a[1], b[1]);
  };
  const auto meet = [&](const Point& a, const Point& b, const Point& c, const Point& d) {
    const int sides[] = {side(a, b, c), side(a, b, d), side(c, d, a), side(c, d, b)};
    if (sides[0] * sides[1] < 0 && sides[2] * sides[3] < 0) return true;
    return (sides[0] == 0 && in_box(a, b, c)) || (sides[1] == 0 && in_box(a, b, d)) ||
           (sides[2] == 0 && in_box(c, d, a)) || (sides[3] == 0 && in_box(c, d, b));
  };
  for (int round = 0; round < 200; ++round) {
    bool crossed = false;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      for (std::size_t j = i + 2; j < polygon.size(); ++j) {
        if (i == 0 && j + 1 == polygon.size()) continue;
        if (!meet(polygon[i], polygon[i + 1], polygon[j], polygon[(j + 1) % polygon.size()])) continue;
        std::reverse(polygon.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                     polygon.begin() + static_cast<std::ptrdiff_t>(j) + 1);
        crossed = true;
      }
    }
    // Two edges that follow each other can also lie on each other.
    for (std::size_t i = 0; i < polygon.size() && !crossed; ++i) {
      const Point &a = polygon[i], &b = polygon[(i + 1) % polygon.size()],
                  &c = polygon[(i + 2) % polygon.size()];
      if (side(a, b, c) == 0 && (in_box(a, b, c) || in_box(b, c, a))) return {};
    }
    if (!crossed) return polygon;
  }
  return {};
}

/// The outline of connected cells of a grid without holes. Each corner of a cell on the outline is a corner
/// of the polygon, so many lie on one line. Its coordinates are mapped by random maps that keep their order
/// but let some coincide: so the polygon can touch itself and have spikes, bridges, and repeated corners, but
/// it does not cross itself.
inline Polygon random_collapsed_polygon(RandomNumbers& random, int size, int cells) {
  std::set<std::pair<int, int>> inside{{size / 2, size / 2}};
  const auto has = [&](int x, int y) { return inside.count({x, y}) != 0; };
  for (int attempts = 0; attempts < 100 * cells && static_cast<int>(inside.size()) < cells; ++attempts) {
    const int x = random.between(0, size - 1), y = random.between(0, size - 1);
    // The cells around, in order. The outline stays one simple loop when the cell touches the others along
    // one connected part of its border.
    const bool around[] = {has(x + 1, y), has(x + 1, y + 1), has(x, y + 1), has(x - 1, y + 1),
                           has(x - 1, y), has(x - 1, y - 1), has(x, y - 1), has(x + 1, y - 1)};
    int runs = 0, sides = 0;
    for (int k = 0; k < 8; ++k) {
      const bool is_side = k % 2 == 0;
      sides += is_side && around[k];
      if (around[k] && !around[(k + 7) % 8]) ++runs;
      // A run that is only a diagonal cell touches in a point.
      if (!is_side && around[k] && !around[(k + 1) % 8] && !around[(k + 7) % 8]) runs += 2;
    }
    if (sides > 0 && runs == 1) inside.insert({x, y});
  }
  std::map<std::pair<int, int>, std::pair<int, int>> next;
  for (const auto& [x, y] : inside) {
    if (!has(x, y - 1)) next[{x, y}] = {x + 1, y};
    if (!has(x + 1, y)) next[{x + 1, y}] = {x + 1, y + 1};
    if (!has(x, y + 1)) next[{x + 1, y + 1}] = {x, y + 1};
    if (!has(x - 1, y)) next[{x, y + 1}] = {x, y};
  }
  std::array<std::vector<std::int64_t>, 2> map;
  for (auto& values : map) {
    values.resize(static_cast<std::size_t>(size) + 1);
    for (std::size_t i = 1; i < values.size(); ++i) values[i] = values[i - 1] + random.between(0, 2);
  }
  const bool all_corners = random.below(2) != 0;
  Polygon polygon;
  auto place = next.begin()->first;
  do {
    const auto before = place;
    place = next[place];
    const auto after = next[place];
    const bool turns = (before.first == place.first) != (place.first == after.first);
    if (all_corners || turns)
      polygon.push_back(
          {map[0][static_cast<std::size_t>(place.first)], map[1][static_cast<std::size_t>(place.second)]});
  } while (place != next.begin()->first);
  return polygon;
}

/// A copy under a random integer map of the plane with determinant ±1.
inline Polygon sheared(RandomNumbers& random, Polygon polygon) {
  const int a = random.between(-3, 3), b = random.between(-3, 3);
  const bool mirrored = random.below(2) != 0;
  for (Point& p : polygon) {
    p[0] += a * p[1];
    p[1] += b * p[0];
    if (mirrored) p[0] = -p[0];
  }
  return polygon;
}

}  // namespace supple::polygons
