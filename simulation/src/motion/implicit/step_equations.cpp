#include "motion/implicit/step_equations.hpp"

#include <algorithm>

#include "motion/element_forces.hpp"
#include "motion/implicit/vector_sums.hpp"

namespace supple {
namespace {

constexpr std::uint32_t none = ~std::uint32_t{0};

}  // namespace

StepEquations::StepEquations(const SpringNetwork& network, std::span<const VertexKind> kinds,
                             const MassSpringOptions& options)
    : options_(options), kinds_(kinds.begin(), kinds.end()), volumes_(network), row_of_(kinds.size(), none) {
  for (std::size_t v = 0; v < kinds.size(); ++v) {
    if (kinds[v] == VertexKind::free) row_of_[v] = free_count_++;
  }
  connect(network);
  positions_.resize(kinds.size());
  directions_.resize(spring_ends_.size());
  pulls_.resize(spring_ends_.size());
  blocks_.resize(spring_ends_.size());
  areas_.resize(triangles_.size());
  along_areas_.resize(triangles_.size());
  if (!network.parts.empty()) {
    part_of_.assign(kinds.size(), none);
    for (const VolumeElement& element : network.volumes.elements) {
      for (const std::uint32_t v : element.corners) part_of_[v] = element.part;
    }
    volume_gradient_.resize(kinds.size());
    along_parts_.resize(network.parts.size());
    along_response_.resize(network.parts.size());
  }
  chunk_sums_.resize(chunk_count(std::max({kinds.size(), spring_ends_.size(), triangles_.size()})));
}

void StepEquations::connect(const SpringNetwork& network) {
  for (const auto* springs : {&network.edges.elements, &network.bending.elements}) {
    for (const SpringElement& spring : *springs) spring_ends_.push_back({spring.a, spring.b});
  }
  for (const AreaElement& area : network.areas.elements) triangles_.push_back(area.corners);

  first_end_.assign(kinds_.size() + 1, 0);
  first_corner_.assign(kinds_.size() + 1, 0);
  for (const auto& ends : spring_ends_) {
    for (const std::uint32_t v : ends) ++first_end_[v + 1];
  }
  for (const Triangle& t : triangles_) {
    for (const std::uint32_t v : t) ++first_corner_[v + 1];
  }
  for (std::size_t v = 0; v < kinds_.size(); ++v) {
    first_end_[v + 1] += first_end_[v];
    first_corner_[v + 1] += first_corner_[v];
  }
  ends_.resize(first_end_.back());
  corners_.resize(first_corner_.back());
  std::vector<std::uint32_t> next(first_end_.begin(), first_end_.end() - 1);
  for (std::uint32_t s = 0; s < spring_ends_.size(); ++s) {
    const auto& [a, b] = spring_ends_[s];
    ends_[next[a]++] = {s, b};
    ends_[next[b]++] = {s, a};
  }
  next.assign(first_corner_.begin(), first_corner_.end() - 1);
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
    for (std::uint32_t c = 0; c < 3; ++c) corners_[next[triangles_[t][c]]++] = {t, c};
  }

  // The rows of two vertices, the lower row first. `none` is the largest number.
  const auto rows_of = [&](std::uint32_t p, std::uint32_t q) {
    const std::uint32_t i = row_of_[p], j = row_of_[q];
    return std::array{std::min(i, j), std::max(i, j)};
  };
  const auto for_each_pair = [&](auto visit) {
    for (std::uint32_t s = 0; s < spring_ends_.size(); ++s) {
      visit(rows_of(spring_ends_[s][0], spring_ends_[s][1]), pair_of_spring_[s]);
    }
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
      for (std::size_t c = 0; c < 3; ++c) {
        visit(rows_of(triangles_[t][c], triangles_[t][(c + 1) % 3]), pairs_of_area_[t][c]);
      }
    }
  };
  pair_of_spring_.assign(spring_ends_.size(), none);
  pairs_of_area_.assign(triangles_.size(), {none, none, none});
  for_each_pair([&](const auto& rows, std::uint32_t&) {
    if (rows[1] != none) pairs_.push_back(rows);
  });
  std::sort(pairs_.begin(), pairs_.end());
  pairs_.erase(std::unique(pairs_.begin(), pairs_.end()), pairs_.end());
  for_each_pair([&](const auto& rows, std::uint32_t& pair) {
    if (rows[1] == none) return;
    pair = static_cast<std::uint32_t>(std::lower_bound(pairs_.begin(), pairs_.end(), rows) - pairs_.begin());
  });
}

void StepEquations::begin(const ImplicitStep& step, const Parallel& parallel) {
  step_ = &step;
  diagonal_of_mass_ = options_.vertex_mass + step.seconds * options_.air_friction;
  for_chunks(spring_ends_.size(), parallel, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      const Vec3d d = step.positions[spring_ends_[s][1]] - step.positions[spring_ends_[s][0]];
      const double length = norm(d);
      directions_[s] = length > 0 ? d * (1 / length) : Vec3d{};
    }
  });
}

template <class Sum>
double StepEquations::sum_of_chunks(std::size_t count, const Parallel& parallel, Sum sum) const {
  return supple::sum_of_chunks(count, parallel, chunk_sums_, sum);
}

Vec3d StepEquations::load(std::uint32_t vertex) const {
  const Vec3d weight = options_.gravity * options_.vertex_mass;
  return step_->external_forces.empty() ? weight : weight + step_->external_forces[vertex];
}

double StepEquations::visit(std::span<const Vec3d> velocities, const Parallel& parallel) {
  double sum = visit_vertices(velocities, parallel);
  sum += visit_springs(step_->network.edges.elements, 0, options_.stiffness, velocities, parallel);
  sum += visit_springs(step_->network.bending.elements, step_->network.edges.elements.size(),
                       options_.bending_stiffness, velocities, parallel);
  return sum + visit_areas(parallel) + visit_volumes(parallel);
}

double StepEquations::visit_vertices(std::span<const Vec3d> velocities, const Parallel& parallel) {
  const double h = step_->seconds;
  return sum_of_chunks(kinds_.size(), parallel, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (auto v = static_cast<std::uint32_t>(begin); v < end; ++v) {
      positions_[v] = step_->positions[v] + velocities[v] * h;
      if (kinds_[v] != VertexKind::free) continue;
      const Vec3d change = velocities[v] - step_->velocities[v], wind = velocities[v] - step_->air_velocity;
      sum += 0.5 * options_.vertex_mass * dot(change, change) +
             0.5 * h * options_.air_friction * dot(wind, wind) - h * dot(load(v), change);
    }
    return sum;
  });
}

double StepEquations::visit_springs(const std::vector<SpringElement>& springs, std::size_t first_state,
                                    double stiffness, std::span<const Vec3d> velocities,
                                    const Parallel& parallel) {
  const double h = step_->seconds, of_stretch = h * h * stiffness, of_rate = h * options_.damping;
  return sum_of_chunks(springs.size(), parallel, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const auto& [a, b, rest_length] = springs[i];
      const Vec3d d = positions_[b] - positions_[a], direction = directions_[first_state + i];
      const double length = norm(d), inverse = length > 0 ? 1 / length : 0;
      const double stretch = length - rest_length, rate = dot(velocities[b] - velocities[a], direction);
      sum += 0.5 * stiffness * stretch * stretch + 0.5 * of_rate * rate * rate;
      const Vec3d n = d * inverse;
      // A compressed spring has negative stiffness across its direction, which would make the system
      // indefinite.
      const double across = length > 0 ? std::max(0.0, stretch * inverse) : 1;
      pulls_[first_state + i] = n * (h * stiffness * stretch) + direction * (of_rate * rate);
      SymmetricBlock block = SymmetricBlock::outer(n, of_stretch * (1 - across));
      block.add_diagonal(of_stretch * across);
      block += SymmetricBlock::outer(direction, of_rate);
      blocks_[first_state + i] = block;
    }
    return sum;
  });
}

double StepEquations::visit_areas(const Parallel& parallel) {
  const double h = step_->seconds, stiffness = options_.area_stiffness;
  const std::vector<AreaElement>& elements = step_->network.areas.elements;
  return sum_of_chunks(elements.size(), parallel, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const AreaElement& element = elements[i];
      const Triangle& t = element.corners;
      const AreaGradient gradient = area_gradient(positions_[t[0]], positions_[t[1]], positions_[t[2]]);
      const double growth = gradient.area - element.rest_area;
      sum += 0.5 * stiffness * growth * growth * element.inverse_scale;
      areas_[i] = {gradient.of_corner, -h * stiffness * growth * element.inverse_scale,
                   h * h * stiffness * element.inverse_scale};
    }
    return sum;
  });
}

double StepEquations::visit_volumes(const Parallel& parallel) {
  if (!has_volumes()) return 0;
  volumes_.compute(step_->network, positions_, parallel);
  double sum = 0;
  for (std::size_t part = 0; part < along_parts_.size(); ++part) {
    const double growth = volumes_.growth(step_->network, part);
    sum += 0.5 * options_.volume_stiffness * growth * growth * step_->network.parts[part].inverse_scale;
  }
  return sum;
}

void StepEquations::find_volume_gradient() {
  std::fill(volume_gradient_.begin(), volume_gradient_.end(), Vec3d{});
  for (const VolumeElement& element : step_->network.volumes.elements) {
    const Triangle& t = element.corners;
    const Vec3d third = area_vector(positions_[t[0]], positions_[t[1]], positions_[t[2]]) * (1.0 / 3);
    for (const std::uint32_t v : t) {
      if (kinds_[v] == VertexKind::free) volume_gradient_[v] = volume_gradient_[v] + third;
    }
  }
}

double StepEquations::volume_stiffness(std::size_t part) const {
  return step_->seconds * step_->seconds * options_.volume_stiffness *
         step_->network.parts[part].inverse_scale;
}

/// g·x for each closed part.
void StepEquations::sum_of_parts(std::span<const Vec3d> x, std::span<double> along) const {
  std::fill(along.begin(), along.end(), 0.0);
  for (std::size_t v = 0; v < part_of_.size(); ++v) {
    if (part_of_[v] != none) along[part_of_[v]] += dot(volume_gradient_[v], x[v]);
  }
}

void StepEquations::keep_volumes(std::span<const Vec3d> response, std::span<Vec3d> solution) {
  sum_of_parts(solution, along_parts_);
  sum_of_parts(response, along_response_);
  for (std::size_t part = 0; part < along_parts_.size(); ++part) {
    const double stiffness = volume_stiffness(part);
    along_parts_[part] *= stiffness / (1 + stiffness * along_response_[part]);
  }
  for (std::size_t v = 0; v < part_of_.size(); ++v) {
    if (part_of_[v] != none) solution[v] = solution[v] - response[v] * along_parts_[part_of_[v]];
  }
}

void StepEquations::gather(std::span<const Vec3d> velocities, std::span<Vec3d> descent,
                           std::span<SymmetricBlock> diagonal, const Parallel& parallel) {
  const double h = step_->seconds;
  if (has_volumes()) find_volume_gradient();
  for_chunks(kinds_.size(), parallel, [&](std::size_t begin, std::size_t end) {
    for (auto v = static_cast<std::uint32_t>(begin); v < end; ++v) {
      if (kinds_[v] != VertexKind::free) {
        descent[v] = {};
        continue;
      }
      Vec3d sum = load(v) * h - (velocities[v] - step_->velocities[v]) * options_.vertex_mass -
                  (velocities[v] - step_->air_velocity) * (h * options_.air_friction);
      SymmetricBlock block;
      block.add_diagonal(diagonal_of_mass_);
      for (std::uint32_t i = first_end_[v]; i < first_end_[v + 1]; ++i) {
        const Vec3d pull = pulls_[ends_[i].spring];
        sum = ends_[i].other > v ? sum + pull : sum - pull;
        block += blocks_[ends_[i].spring];
      }
      for (std::uint32_t i = first_corner_[v]; i < first_corner_[v + 1]; ++i) {
        const AreaState& area = areas_[corners_[i].area];
        const Vec3d of_corner = area.of_corner[corners_[i].corner];
        sum = sum + of_corner * area.push;
        block += SymmetricBlock::outer(of_corner, area.weight);
      }
      if (has_volumes() && part_of_[v] != none) {
        sum = sum - volume_gradient_[v] *
                        (volume_stiffness(part_of_[v]) / h * volumes_.growth(step_->network, part_of_[v]));
      }
      descent[v] = sum;
      diagonal[v] = block;
    }
  });
}

double StepEquations::multiply(std::span<const Vec3d> x, std::span<Vec3d> product, const Parallel& parallel) {
  for_chunks(areas_.size(), parallel, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Triangle& t = triangles_[i];
      const auto& g = areas_[i].of_corner;
      along_areas_[i] = areas_[i].weight * (dot(g[0], x[t[0]]) + dot(g[1], x[t[1]]) + dot(g[2], x[t[2]]));
    }
  });
  if (has_volumes()) {
    sum_of_parts(x, along_parts_);
    for (std::size_t part = 0; part < along_parts_.size(); ++part)
      along_parts_[part] *= volume_stiffness(part);
  }
  return sum_of_chunks(kinds_.size(), parallel, [&](std::size_t begin, std::size_t end) {
    double along = 0;
    for (auto v = static_cast<std::uint32_t>(begin); v < end; ++v) {
      if (kinds_[v] != VertexKind::free) {
        product[v] = {};
        continue;
      }
      Vec3d sum = x[v] * diagonal_of_mass_;
      for (std::uint32_t i = first_end_[v]; i < first_end_[v + 1]; ++i) {
        sum = sum + blocks_[ends_[i].spring] * (x[v] - x[ends_[i].other]);
      }
      for (std::uint32_t i = first_corner_[v]; i < first_corner_[v + 1]; ++i) {
        const auto& [area, corner] = corners_[i];
        sum = sum + areas_[area].of_corner[corner] * along_areas_[area];
      }
      if (has_volumes() && part_of_[v] != none) {
        sum = sum + volume_gradient_[v] * along_parts_[part_of_[v]];
      }
      product[v] = sum;
      along += dot(x[v], sum);
    }
    return along;
  });
}

SparseFactor StepEquations::make_factor() const {
  return SparseFactor(free_count_, pairs_);
}

void StepEquations::fill(std::span<const SymmetricBlock> diagonal, SparseFactor& factor) const {
  factor.set_zero();
  for (std::size_t v = 0; v < kinds_.size(); ++v) {
    if (row_of_[v] != none) factor.add_diagonal(row_of_[v], diagonal[v]);
  }
  for (std::size_t s = 0; s < blocks_.size(); ++s) {
    if (pair_of_spring_[s] != none) factor.add(pair_of_spring_[s], blocks_[s].negative());
  }
  for (std::size_t t = 0; t < areas_.size(); ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      if (pairs_of_area_[t][c] == none) continue;
      std::uint32_t p = triangles_[t][c], q = triangles_[t][(c + 1) % 3];
      Vec3d of_p = areas_[t].of_corner[c], of_q = areas_[t].of_corner[(c + 1) % 3];
      if (row_of_[p] > row_of_[q]) std::swap(of_p, of_q);
      factor.add(pairs_of_area_[t][c], of_p * areas_[t].weight, of_q);
    }
  }
}

}  // namespace supple
