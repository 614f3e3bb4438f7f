// Energy, momentum, volume and other observables of `MassSpringBody`.

#include <algorithm>
#include <cmath>

#include "motion/element_forces.hpp"
#include "motion/mass_spring.hpp"

namespace supple {
namespace {

double elastic_energy(std::span<const SpringElement> springs, double stiffness,
                      std::span<const Vec3d> positions) {
  double sum = 0;
  for (const SpringElement& spring : springs) {
    const double stretch = norm(positions[spring.b] - positions[spring.a]) - spring.rest_length;
    sum += 0.5 * stiffness * stretch * stretch;
  }
  return sum;
}

template <class Sum, class Term>
Sum sum_of_free(std::span<const VertexKind> kinds, Term term) {
  Sum sum{};
  for (std::size_t v = 0; v < kinds.size(); ++v) {
    if (kinds[v] == VertexKind::free) sum = sum + term(v);
  }
  return sum;
}

}  // namespace

MassSpringEnergy MassSpring::energy() const {
  const std::vector<Vec3d>&x = now_.positions, &v = now_.velocities;
  const double mass = options_.vertex_mass;
  MassSpringEnergy energy;
  energy.kinetic = sum_of_free<double>(kinds_, [&](std::size_t i) { return 0.5 * mass * dot(v[i], v[i]); });
  energy.gravity =
      sum_of_free<double>(kinds_, [&](std::size_t i) { return -mass * dot(options_.gravity, x[i]); });
  energy.elastic = elastic_energy(network_.edges.elements, options_.stiffness, x) +
                   elastic_energy(network_.bending.elements, options_.bending_stiffness, x);
  for (const AreaElement& element : network_.areas.elements) {
    const Triangle& t = element.corners;
    const double growth = triangle_area(x[t[0]], x[t[1]], x[t[2]]) - element.rest_area;
    energy.area += 0.5 * options_.area_stiffness * growth * growth * element.inverse_scale;
  }
  VolumeSum volumes(network_);
  volumes.compute(network_, x, Parallel(1));
  for (std::size_t part = 0; part < network_.parts.size(); ++part) {
    const double growth = volumes.growth(network_, part);
    energy.volume += 0.5 * options_.volume_stiffness * growth * growth * network_.parts[part].inverse_scale;
  }
  return energy;
}

Vec3d MassSpring::momentum() const {
  return options_.vertex_mass * sum_of_free<Vec3d>(kinds_, [&](std::size_t v) { return now_.velocities[v]; });
}

Vec3d MassSpring::angular_momentum() const {
  return options_.vertex_mass * sum_of_free<Vec3d>(kinds_, [&](std::size_t v) {
           return cross(now_.positions[v], now_.velocities[v]);
         });
}

Vec3d MassSpring::center_of_mass() const {
  Vec3d sum;
  double count = 0;
  for (std::size_t v = 0; v < kinds_.size(); ++v) {
    if (kinds_[v] == VertexKind::inert) continue;
    sum = sum + now_.positions[v];
    ++count;
  }
  return count > 0 ? sum * (1 / count) : Vec3d{};
}

Vec3d MassSpring::mean_velocity() const {
  const double count = sum_of_free<double>(kinds_, [](std::size_t) { return 1.0; });
  const Vec3d sum = sum_of_free<Vec3d>(kinds_, [&](std::size_t v) { return now_.velocities[v]; });
  return count > 0 ? sum * (1 / count) : Vec3d{};
}

double MassSpring::area() const {
  double sum = 0;
  for (const Triangle& t : triangles_) {
    const double area = triangle_area(now_.positions[t[0]], now_.positions[t[1]], now_.positions[t[2]]);
    if (std::isfinite(area)) sum += area;
  }
  return sum;
}

double MassSpring::volume() const {
  double sum = 0;
  const std::span<const VolumeElement> elements = closed_.elements;
  for (std::size_t begin = 0, end = 0; begin < elements.size(); begin = end) {
    const std::uint32_t part = elements[begin].part;
    while (end < elements.size() && elements[end].part == part) ++end;
    sum += volume_of(elements.subspan(begin, end - begin), now_.positions[closed_.parts[part].origin],
                     now_.positions);
  }
  return sum;
}

AreaError MassSpring::area_error() const {
  AreaError error;
  double count = 0;
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    if (!(rest_areas_[i] > 0) || !std::isfinite(rest_areas_[i])) continue;
    const Triangle& t = triangles_[i];
    const double area = triangle_area(now_.positions[t[0]], now_.positions[t[1]], now_.positions[t[2]]);
    const double relative = std::abs(area - rest_areas_[i]) / rest_areas_[i];
    error.largest = std::max(error.largest, relative);
    error.mean += relative;
    ++count;
  }
  if (count > 0) error.mean /= count;
  return error;
}

EdgeStrain MassSpring::edge_strain() const {
  EdgeStrain strain;
  double count = 0;
  for (const SpringElement& edge : network_.edges.elements) {
    if (!(edge.rest_length > 0) || !std::isfinite(edge.rest_length)) continue;
    const Vec3d along = now_.positions[edge.b] - now_.positions[edge.a];
    const double relative = std::abs(std::sqrt(dot(along, along)) - edge.rest_length) / edge.rest_length;
    strain.largest = std::max(strain.largest, relative);
    strain.mean += relative;
    ++count;
  }
  if (count > 0) strain.mean /= count;
  return strain;
}

std::optional<std::array<Vec3d, 2>> MassSpring::bounds() const {
  if (kinds_.empty() || has_inert_) return std::nullopt;
  PointBounds bounds;
  if (has_bounds_) {
    for (const PointBounds& block : block_bounds_) bounds.add(block);
  } else {
    for (const Vec3d& position : now_.positions) {
      if (!is_finite(position)) return std::nullopt;
      bounds.add(position);
    }
  }
  return std::array{bounds.low, bounds.high};
}

std::vector<MassSpringBody::Spring> MassSpring::springs() const {
  std::vector<MassSpringBody::Spring> springs;
  springs.reserve(network_.edges.elements.size());
  for (const SpringElement& edge : network_.edges.elements)
    springs.push_back({edge.a, edge.b, edge.rest_length});
  std::sort(springs.begin(), springs.end(),
            [](const auto& p, const auto& q) { return p.a != q.a ? p.a < q.a : p.b < q.b; });
  return springs;
}

}  // namespace supple
