#include "workloads/degrading_shapes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numeric>
#include <utility>

#include "supple/error.hpp"
#include "supple/models.hpp"
#include "supple/trigonometry.hpp"
#include "workloads/random_numbers.hpp"

namespace supple::benchmarks {
namespace {

using Shape = DegradingShapes::Shape;

constexpr std::array names_of_cells = {"soup", "parts", "stir", "roll", "crumple", "swing", "wave"};

/// Rises from 0 to 1 and falls back to 0 as x goes from 0 to 2.
double there_and_back(double x) {
  const double phase = x - 2 * std::floor(x / 2);
  return phase < 1 ? phase : 2 - phase;
}

void append(TriangleMesh& mesh, const TriangleMesh& other) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
  for (const Triangle& t : other.triangles) {
    mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
}

TriangleMesh placed(TriangleMesh mesh, double size, Vec3d center) {
  for (Vec3d& p : mesh.positions) p = p * size + center;
  return mesh;
}

/// Triangles in the unit cube around the origin, each with its own velocity per frame.
Shape drifting_soup(std::uint32_t triangles, double size, Vec3d center, std::uint64_t seed) {
  RandomNumbers random(seed);
  Shape shape;
  const auto velocities = std::make_shared<std::vector<Vec3d>>();
  for (std::uint32_t t = 0; t < triangles; ++t) {
    const Vec3d p = random.point_in_cube(1) - Vec3d{0.5, 0.5, 0.5};
    for (int corner = 0; corner < 3; ++corner) {
      shape.rest.positions.push_back(p + random.direction() * size);
    }
    shape.rest.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
    velocities->push_back(random.direction() * 0.004);
  }
  shape.move = [velocities, center](std::uint32_t vertex, Vec3d p, double time) {
    // Reflect at the walls of the cube.
    const Vec3d drift = (*velocities)[vertex / 3] * time;
    const Vec3d end = p + drift;
    return center + Vec3d{there_and_back(end.x + 0.5) - 0.5, there_and_back(end.y + 0.5) - 0.5,
                          there_and_back(end.z + 0.5) - 0.5};
  };
  return shape;
}

/// Sheets of 320 triangles in the cells of a cube; each moves to the cell of another one.
Shape exchanging_parts(double frames_to_go, Vec3d center, std::uint64_t seed) {
  RandomNumbers random(seed);
  std::vector<std::uint32_t> cells(64);
  std::iota(cells.begin(), cells.end(), 0u);
  for (std::size_t i = cells.size(); i-- > 1;) std::swap(cells[i], cells[random.next() % (i + 1)]);
  const auto cell = [](std::uint32_t i) {
    return Vec3d{0.25 * (i % 4), 0.25 * (i / 4 % 4), 0.25 * (i / 16)};
  };
  const TriangleMesh sheet = make_cloth(16, 10, 0.2, 0.2);
  Shape shape;
  const auto ways = std::make_shared<std::vector<Vec3d>>();
  for (std::uint32_t i = 0; i < 64; ++i) {
    append(shape.rest, placed(sheet, 1, cell(i)));
    ways->resize(shape.rest.positions.size(), cell(cells[i]) - cell(i));
  }
  shape.move = [ways, center, frames_to_go](std::uint32_t vertex, Vec3d p, double time) {
    const double ripple = 0.03 * sin_turns(3 * p.x + 2 * p.z + 0.01 * time);
    return center + p + (*ways)[vertex] * there_and_back(time / frames_to_go) + Vec3d{0, ripple, 0};
  };
  return shape;
}

Shape stirred(Vec3d center, std::uint64_t seed) {
  Shape soup = drifting_soup(4000, 0.02, {}, seed);
  Shape shape;
  const auto count = static_cast<std::uint32_t>(soup.rest.positions.size());
  shape.rest = soup.rest;
  append(shape.rest, make_icosphere(30));
  shape.move = [inner = soup.move, center, count](std::uint32_t vertex, Vec3d p, double time) {
    return center + (vertex < count ? inner(vertex, p, time) * 0.5
                                    : p * (1 + 0.04 * sin_turns(0.5 * p.x + 0.7 * p.y + 0.01 * time)));
  };
  return shape;
}

Shape ball(std::uint32_t frequency, double radius, Vec3d center) {
  Shape shape;
  shape.rest = make_icosphere(frequency);
  shape.move = [radius, center](std::uint32_t, Vec3d p, double time) {
    return center + p * radius * (1 + 0.05 * sin_turns(0.5 * p.x + 0.7 * p.y + 0.01 * time));
  };
  return shape;
}

/// A strip of length 8, about the length of the final spiral of six turns. Its direction changes linearly
/// with time.
Shape rolling_strip() {
  constexpr std::uint32_t columns = 1200;
  constexpr double length = 8, radius = 0.1, pitch = 0.005;
  Shape shape;
  shape.rest = make_cloth(columns, 8, length, 0.5);
  shape.self_collision = true;
  const double left = std::min_element(shape.rest.positions.begin(), shape.rest.positions.end(),
                                       [](const Vec3d& p, const Vec3d& q) { return p.x < q.x; })
                          ->x;
  struct Spine {
    double time = -1;
    std::vector<Vec3d> points;
  };
  const auto spine = std::make_shared<Spine>();
  shape.move = [spine, left](std::uint32_t, Vec3d p, double time) {
    if (spine->time != time) {
      spine->time = time;
      spine->points.assign(1, {});
      for (std::uint32_t i = 0; i < columns; ++i) {
        const double s = length * i / columns;
        const double angle =
            (std::sqrt(radius * radius + 2 * pitch * s) - radius) / pitch / 6.283185307179586;
        const double turns = angle * there_and_back(time / 400);
        spine->points.push_back(spine->points.back() +
                                Vec3d{cos_turns(turns), sin_turns(turns), 0} * (length / columns));
      }
    }
    const double place = std::clamp((p.x - left) / length * columns, 0.0, double{columns});
    const Vec3d at = spine->points[static_cast<std::size_t>(place + 0.5)];
    return at + Vec3d{0, 0.002 * sin_turns(5 * p.z + 0.02 * time), p.z};
  };
  return shape;
}

Shape crumpling_sheet() {
  Shape shape;
  shape.rest = make_cloth(120, 80, 2, 1.5);
  shape.self_collision = true;
  shape.move = [](std::uint32_t, Vec3d p, double time) {
    const double how_far = there_and_back(time / 200), along = 1 - 0.75 * how_far, across = 1 - 0.6 * how_far;
    const double fold = sin_turns(2.5 * p.x + 0.3 * p.z), dent = sin_turns(1.7 * p.z + 0.2 * p.x);
    const double height = how_far * (0.25 * fold + 0.2 * dent + 0.1 * fold * dent);
    return Vec3d{p.x * along + 0.1 * how_far * dent, height, p.z * across + 0.1 * how_far * fold};
  };
  return shape;
}

std::vector<Shape> shapes_of(const std::string& name) {
  const Vec3d there{0.4, 0.3, 0.2};
  if (name == "soup") return {drifting_soup(10000, 0.02, {}, 1), drifting_soup(10000, 0.02, there, 2)};
  if (name == "parts") return {exchanging_parts(400, {}, 1), exchanging_parts(400, there, 2)};
  if (name == "stir") return {stirred({}, 1), stirred(there, 2)};
  if (name == "roll") return {rolling_strip(), ball(15, 0.3, {0.3, 0.2, 0})};
  if (name == "crumple") return {crumpling_sheet(), ball(20, 0.3, {})};
  if (name == "swing") return {exchanging_parts(2, {}, 1), exchanging_parts(2, there, 2)};
  if (name == "wave") return {ball(30, 1, {}), ball(30, 1, there)};
  std::string known;
  for (const char* const cell : names_of_cells) known += (known.empty() ? "" : ", ") + std::string(cell);
  throw Error("no shapes are named '" + name + "'; choose one of " + known);
}

}  // namespace

DegradingShapes::DegradingShapes(const std::string& name) : shapes_(shapes_of(name)) {
  for (Shape& shape : shapes_) shape.positions.resize(shape.rest.positions.size());
  advance();
  frames_ = 0;
}

std::span<const char* const> DegradingShapes::names() {
  return names_of_cells;
}

void DegradingShapes::advance() {
  for (Shape& shape : shapes_) {
    for (std::uint32_t v = 0; v < shape.positions.size(); ++v) {
      const Vec3d p = shape.move(v, shape.rest.positions[v], frames_);
      shape.positions[v] = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
    }
  }
  ++frames_;
}

}  // namespace supple::benchmarks
