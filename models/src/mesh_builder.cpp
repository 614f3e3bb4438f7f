#include "mesh_builder.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include "supple/trigonometry.hpp"

namespace supple::models {

std::uint32_t MeshBuilder::add_section(const Section& section, std::uint32_t sides) {
  const auto first = static_cast<std::uint32_t>(mesh_.positions.size());
  for (std::uint32_t side = 0; side < sides; ++side) {
    const double turns = static_cast<double>(side) / sides;
    mesh_.positions.push_back(section.center + section.u * cos_turns(turns) + section.v * sin_turns(turns));
  }
  return first;
}

void MeshBuilder::add_quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  const auto& p = mesh_.positions;
  const Vec3d ac = p[c] - p[a];
  const Vec3d bd = p[d] - p[b];
  // The shorter diagonal gives the rounder triangles.
  if (dot(ac, ac) <= dot(bd, bd)) {
    mesh_.triangles.push_back({a, b, c});
    mesh_.triangles.push_back({a, c, d});
  } else {
    mesh_.triangles.push_back({a, b, d});
    mesh_.triangles.push_back({b, c, d});
  }
}

void MeshBuilder::bridge(std::uint32_t ring, std::uint32_t next_ring, std::uint32_t sides) {
  for (std::uint32_t side = 0; side < sides; ++side) {
    const std::uint32_t next_side = (side + 1) % sides;
    add_quad(ring + side, ring + next_side, next_ring + next_side, next_ring + side);
  }
}

void MeshBuilder::close(std::uint32_t ring, std::uint32_t sides, const Tip& tip, bool at_start) {
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (at_start) std::swap(b, c);
    mesh_.triangles.push_back({a, b, c});
  };
  if (tip) {
    const auto pole = static_cast<std::uint32_t>(mesh_.positions.size());
    mesh_.positions.push_back(*tip);
    for (std::uint32_t side = 0; side < sides; ++side) add(pole, ring + side, ring + (side + 1) % sides);
    return;
  }
  // A zigzag across the ring has better angles than a fan from one of its corners.
  std::uint32_t low = 0;
  std::uint32_t high = sides - 1;
  for (bool from_low = true; high - low > 1; from_low = !from_low) {
    if (from_low) {
      add(ring + low, ring + low + 1, ring + high);
      ++low;
    } else {
      add(ring + low, ring + high - 1, ring + high);
      --high;
    }
  }
}

void MeshBuilder::add_loft(std::span<const Section> sections, std::uint32_t sides, Tip start, Tip end) {
  assert(sections.size() >= 2 && sides >= 3);
  const std::uint32_t first = add_section(sections[0], sides);
  close(first, sides, start, true);
  std::uint32_t last = first;
  for (const Section& section : sections.subspan(1)) {
    const std::uint32_t ring = add_section(section, sides);
    bridge(last, ring, sides);
    last = ring;
  }
  close(last, sides, end, false);
}

void MeshBuilder::add_loop(std::span<const Section> sections, std::uint32_t sides) {
  assert(sections.size() >= 3 && sides >= 3);
  const std::uint32_t first = add_section(sections[0], sides);
  std::uint32_t last = first;
  for (const Section& section : sections.subspan(1)) {
    const std::uint32_t ring = add_section(section, sides);
    bridge(last, ring, sides);
    last = ring;
  }
  bridge(last, first, sides);
}

void MeshBuilder::add_tube(std::span<const Vec3d> path, std::span<const double> radii, std::uint32_t sides) {
  assert(path.size() >= 2 && path.size() == radii.size());
  std::vector<Section> sections;
  Vec3d u = any_perpendicular(path[1] - path[0]);
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Vec3d forward = unit(path[std::min(i + 1, path.size() - 1)] - path[i == 0 ? 0 : i - 1]);
    // Transport the frame along the path, so that the tube does not twist.
    u = unit(u - forward * dot(u, forward));
    sections.push_back({path[i], u * radii[i], cross(forward, u) * radii[i]});
  }
  add_loft(sections, sides);
}

void MeshBuilder::add_bar(Vec3d start, Vec3d end, double start_radius, double end_radius, std::uint32_t rings,
                          std::uint32_t sides) {
  assert(rings >= 2);
  std::vector<Vec3d> path;
  std::vector<double> radii;
  for (std::uint32_t ring = 0; ring < rings; ++ring) {
    const double t = static_cast<double>(ring) / (rings - 1);
    path.push_back(lerp(start, end, t));
    radii.push_back(start_radius + (end_radius - start_radius) * t);
  }
  add_tube(path, radii, sides);
}

void MeshBuilder::add_lathe(Vec3d origin, Vec3d axis, std::span<const LathePoint> profile,
                            std::uint32_t sides, Tip start, Tip end) {
  const Vec3d up = unit(axis);
  const Vec3d u = any_perpendicular(up);
  const Vec3d v = cross(up, u);
  std::vector<Section> sections;
  for (const auto& [radius, height] : profile)
    sections.push_back({origin + up * height, u * radius, v * radius});
  add_loft(sections, sides, start, end);
}

void MeshBuilder::add_ring(Vec3d center, Vec3d axis, double radius, double half_width, double half_height,
                           std::uint32_t rings, std::uint32_t sides) {
  const Vec3d up = unit(axis);
  const Vec3d x = any_perpendicular(up);
  const Vec3d y = cross(up, x);
  std::vector<Section> sections;
  for (std::uint32_t ring = 0; ring < rings; ++ring) {
    const double turns = static_cast<double>(ring) / rings;
    const Vec3d outward = x * cos_turns(turns) + y * sin_turns(turns);
    sections.push_back({center + outward * radius, up * half_width, outward * half_height});
  }
  add_loop(sections, sides);
}

void MeshBuilder::add_strip(std::span<const Vec3d> right, std::span<const Vec3d> left) {
  assert(right.size() == left.size() && right.size() >= 2);
  const auto count = static_cast<std::uint32_t>(right.size());
  const auto first_right = static_cast<std::uint32_t>(mesh_.positions.size());
  const std::uint32_t first_left = first_right + count;
  mesh_.positions.insert(mesh_.positions.end(), right.begin(), right.end());
  mesh_.positions.insert(mesh_.positions.end(), left.begin(), left.end());
  for (std::uint32_t i = 0; i + 1 < count; ++i)
    add_quad(first_right + i, first_right + i + 1, first_left + i + 1, first_left + i);
}

TriangleMesh MeshBuilder::finish(std::string name) && {
  mesh_.name = std::move(name);
  normalize(mesh_);
  return std::move(mesh_);
}

std::vector<Vec3d> smooth_curve(std::span<const Vec3d> control_points, std::uint32_t steps) {
  assert(control_points.size() >= 2 && steps >= 1);
  const std::size_t last = control_points.size() - 1;
  std::vector<Vec3d> curve;
  for (std::size_t i = 0; i < last; ++i) {
    const Vec3d before = control_points[i == 0 ? 0 : i - 1];
    const Vec3d from = control_points[i];
    const Vec3d to = control_points[i + 1];
    const Vec3d after = control_points[std::min(i + 2, last)];
    for (std::uint32_t step = 0; step < steps; ++step) {
      const double t = static_cast<double>(step) / steps;
      const Vec3d bend = (before * 2.0 - from * 5.0 + to * 4.0 - after) * t + (from - to) * 3.0 * t * t +
                         (after - before) * t * t;
      curve.push_back(from + ((to - before) + bend) * (0.5 * t));
    }
  }
  curve.push_back(control_points[last]);
  return curve;
}

std::vector<Vec3d> resample(std::span<const Vec3d> polyline, std::uint32_t count) {
  assert(polyline.size() >= 2 && count >= 2);
  double total = 0;
  for (std::size_t i = 0; i + 1 < polyline.size(); ++i) total += norm(polyline[i + 1] - polyline[i]);

  std::vector<Vec3d> points{polyline.front()};
  std::size_t piece = 0;
  double walked = 0;
  double piece_length = norm(polyline[1] - polyline[0]);
  while (points.size() + 1 < count) {
    const double target = total * static_cast<double>(points.size()) / (count - 1);
    while (walked + piece_length < target && piece + 2 < polyline.size()) {
      walked += piece_length;
      ++piece;
      piece_length = norm(polyline[piece + 1] - polyline[piece]);
    }
    points.push_back(lerp(polyline[piece], polyline[piece + 1], (target - walked) / piece_length));
  }
  points.push_back(polyline.back());
  return points;
}

Vec3d any_perpendicular(Vec3d direction) {
  const Vec3d d = unit(direction);
  // The z axis is perpendicular to the plane of most parts, so rings are symmetric to that plane.
  const Vec3d helper = d.z * d.z < 0.8 ? Vec3d{0, 0, 1} : Vec3d{1, 0, 0};
  return unit(helper - d * dot(helper, d));
}

void normalize(TriangleMesh& mesh) {
  assert(!mesh.positions.empty());
  Vec3d low = mesh.positions[0];
  Vec3d high = low;
  for (const Vec3d& p : mesh.positions) {
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], p[axis]);
      high[axis] = std::max(high[axis], p[axis]);
    }
  }
  const Vec3d center = (low + high) * 0.5;
  const Vec3d size = high - low;
  const int longest = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  for (Vec3d& p : mesh.positions) {
    // Assign the ends instead of computing them: rounding would leave the side one ulp off 1.
    const double end = p[longest] == low[longest] ? -0.5 : p[longest] == high[longest] ? 0.5 : 0;
    p = (p - center) * (1 / size[longest]);
    if (end != 0) p[longest] = end;
  }
}

}  // namespace supple::models
