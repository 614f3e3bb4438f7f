#include "sources/grip.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sources/extent.hpp"

namespace supple::viewer {
namespace {

/// Spring frequency times time step.
constexpr double stiffness = 0.5;

/// The factor by which the springs divide the velocity of a vertex with this weight in one step.
double slowing(double weight, double damping) {
  return 1 + weight * stiffness * (2 * damping + stiffness);
}

double squared_length(const Vec3d& v) {
  return v.x * v.x + v.y * v.y + v.z * v.z;
}

double mean_edge(const TriangleMesh& mesh) {
  double sum = 0;
  std::size_t count = 0;
  for (const Triangle& triangle : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3d edge = mesh.positions[triangle[i]] - mesh.positions[triangle[(i + 1) % 3]];
      const double length = std::sqrt(squared_length(edge));
      if (!std::isfinite(length)) continue;
      sum += length;
      ++count;
    }
  }
  return count == 0 ? 0 : sum / static_cast<double>(count);
}

Vec3d shortened(const Vec3d& v, double longest) {
  const double length = std::sqrt(squared_length(v));
  return length <= longest ? v : v * (longest / length);
}

}  // namespace

Grip take_hold(const TriangleMesh& rest, std::span<const Vec3d> now, std::uint32_t vertex,
               std::optional<double> radius) {
  Extent extent;
  extent.add(rest.positions);
  const double size = extent.longest_side();
  const double reach = radius.value_or(0.2 * size);
  Grip grip;
  grip.vertex = vertex;
  grip.anchor = now[vertex];
  for (std::size_t i = 0; i < rest.positions.size(); ++i) {
    // Comparisons with NaN are false.
    const double squares = squared_length(rest.positions[i] - rest.positions[vertex]) / (reach * reach);
    if (i != vertex && !(squares < 1)) continue;
    if (!is_finite(now[i])) continue;
    grip.vertices.push_back(static_cast<std::uint32_t>(i));
    grip.weights.push_back(i == vertex ? 1 : (1 - squares) * (1 - squares));
    grip.from.push_back(now[i]);
  }
  const double held = std::accumulate(grip.weights.begin(), grip.weights.end(), 0.0);
  grip.damping = std::sqrt(static_cast<double>(rest.positions.size()) / held);
  const double edge = mean_edge(rest);
  const double part_of_step = stiffness * stiffness / slowing(1, grip.damping);
  grip.reach = edge > 0 ? std::min(edge / part_of_step, size) : size;
  return grip;
}

void bend(const Grip& grip, std::span<Vec3d> positions) {
  const Vec3d offset = *grip.target - grip.anchor;
  for (std::size_t i = 0; i < grip.vertices.size(); ++i)
    positions[grip.vertices[i]] = grip.from[i] + grip.weights[i] * offset;
}

void carry(const Grip& grip, std::span<Vec3d> positions) {
  const Vec3d offset = *grip.target - positions[grip.vertex];
  for (Vec3d& p : positions) p += offset;
}

void pull(const Grip& grip, const std::vector<bool>& is_fixed, MassSpringBody& body, double seconds,
          std::vector<Vec3d>& velocities) {
  const std::span<const Vec3d> positions = body.positions();
  velocities.assign(body.velocities().begin(), body.velocities().end());
  const Vec3d offset = *grip.target - grip.anchor;
  for (std::size_t i = 0; i < grip.vertices.size(); ++i) {
    const std::uint32_t vertex = grip.vertices[i];
    if (!is_fixed.empty() && is_fixed[vertex]) continue;
    const double weight = grip.weights[i];
    const Vec3d way = shortened(grip.from[i] + offset - positions[vertex], grip.reach);
    Vec3d& v = velocities[vertex];
    v = (v + (weight * stiffness * stiffness / seconds) * way) * (1 / slowing(weight, grip.damping));
  }
  body.set_velocities(velocities);
}

}  // namespace supple::viewer
