#include "motion/stable_step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "motion/element_forces.hpp"

namespace supple {
namespace {

/// At rest the pressure is 0, and the stiffness of a part is k / V0 ∂V/∂x ∂V/∂xᵀ.
void add_volumes(const SpringNetwork& network, std::span<const VertexKind> kinds, double volume_stiffness,
                 std::span<const Vec3d> rest, std::vector<double>& stiffness) {
  std::vector<Vec3d> gradient(kinds.size());
  for (const VolumeElement& element : network.volumes.elements) {
    const Triangle& t = element.corners;
    const Vec3d third = area_vector(rest[t[0]], rest[t[1]], rest[t[2]]) * (1.0 / 3);
    for (const std::uint32_t v : t) gradient[v] = gradient[v] + third;
  }
  // A vertex belongs to at most one part.
  constexpr std::uint32_t no_part = ~std::uint32_t{0};
  std::vector<std::uint32_t> part_of(kinds.size(), no_part);
  for (const VolumeElement& element : network.volumes.elements) {
    for (const std::uint32_t v : element.corners) part_of[v] = element.part;
  }
  std::vector<double> sums(network.parts.size());
  for (std::size_t v = 0; v < kinds.size(); ++v) {
    if (part_of[v] != no_part && kinds[v] == VertexKind::free) sums[part_of[v]] += norm(gradient[v]);
  }
  for (std::size_t v = 0; v < kinds.size(); ++v) {
    if (part_of[v] == no_part) continue;
    stiffness[v] +=
        volume_stiffness * network.parts[part_of[v]].inverse_scale * norm(gradient[v]) * sums[part_of[v]];
  }
}

}  // namespace

double stable_explicit_step(const SpringNetwork& network, std::span<const VertexKind> kinds,
                            const MassSpringOptions& options, std::span<const Vec3d> rest) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (options.integrator == Integrator::backward_euler) return infinity;
  std::vector<double> stiffness(kinds.size()), damping(kinds.size(), options.air_friction);
  const auto is_free = [&](std::uint32_t v) { return kinds[v] == VertexKind::free; };
  const auto add_spring = [&](const SpringElement& spring, double k) {
    // A row contains the block of the spring once on the diagonal and, unless the other end is fixed, once
    // off it.
    for (const std::uint32_t v : spring.vertices()) {
      const double blocks = is_free(v == spring.a ? spring.b : spring.a) ? 2 : 1;
      stiffness[v] += blocks * k;
      damping[v] += blocks * options.damping;
    }
  };
  for (const SpringElement& spring : network.edges.elements) add_spring(spring, options.stiffness);
  for (const SpringElement& spring : network.bending.elements) add_spring(spring, options.bending_stiffness);
  for (const AreaElement& area : network.areas.elements) {
    const Triangle& t = area.corners;
    const AreaGradient gradient = area_gradient(rest[t[0]], rest[t[1]], rest[t[2]]);
    double sum = 0;
    for (int corner = 0; corner < 3; ++corner) {
      if (is_free(t[corner])) sum += norm(gradient.of_corner[corner]);
    }
    for (int corner = 0; corner < 3; ++corner) {
      stiffness[t[corner]] +=
          options.area_stiffness * area.inverse_scale * norm(gradient.of_corner[corner]) * sum;
    }
  }
  add_volumes(network, kinds, options.volume_stiffness, rest, stiffness);
  double shortest = infinity;
  for (std::uint32_t v = 0; v < kinds.size(); ++v) {
    if (!is_free(v)) continue;
    const double squared_frequency = stiffness[v] / options.vertex_mass;
    const double rate =
        damping[v] / options.vertex_mass * (options.integrator == Integrator::verlet ? 1 : 0.5);
    const double inverse_step = 0.5 * (rate + std::sqrt(rate * rate + squared_frequency));
    shortest = std::min(shortest, 1 / inverse_step);
  }
  return shortest;
}

}  // namespace supple
