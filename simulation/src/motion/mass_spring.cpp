#include "motion/mass_spring.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "core/error.hpp"
#include "motion/check_options.hpp"
#include "motion/element_forces.hpp"
#include "motion/plastic_flow.hpp"
#include "motion/stable_step.hpp"

namespace supple {
namespace {

constexpr std::uint32_t none = ~std::uint32_t{0};

std::string in_digits(double value) {
  std::array<char, 32> text{};
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), end};
}

/// Three digits are enough for an estimated bound.
std::string rounded(double value) {
  std::array<char, 32> text{};
  const auto [end, error] =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, 3);
  return {text.data(), end};
}

std::vector<VertexKind> vertex_kinds(const TriangleMesh& rest, const MassSpringOptions& options) {
  std::vector<VertexKind> kinds(rest.positions.size(), VertexKind::free);
  for (const std::uint32_t vertex : options.fixed_vertices) kinds[vertex] = VertexKind::fixed;
  for (std::size_t v = 0; v < kinds.size(); ++v) {
    if (!is_finite(rest.positions[v])) kinds[v] = VertexKind::inert;
  }
  return kinds;
}

std::vector<double> inverse_masses(std::span<const VertexKind> kinds, double mass) {
  std::vector<double> inverse;
  inverse.reserve(kinds.size());
  for (const VertexKind kind : kinds) inverse.push_back(kind == VertexKind::free ? 1 / mass : 0);
  return inverse;
}

/// A hundred times the size of the body, squared; infinite for a single point.
double longest_way_squared(std::span<const Vec3d> positions) {
  constexpr double largest = std::numeric_limits<double>::max();
  Vec3d low{largest, largest, largest}, high = low * -1.0;
  for (const Vec3d& p : positions) {
    if (!is_finite(p)) continue;
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], p[axis]);
      high[axis] = std::max(high[axis], p[axis]);
    }
  }
  const Vec3d size = high - low;
  const double squared = 1e4 * dot(size, size);
  return high.x >= low.x && squared > 0 ? std::min(squared, largest) : largest;
}

MassSpringOptions checked(const MassSpringOptions& options, const TriangleMesh& rest) {
  check_mesh(rest);
  check_options(options, rest);
  return options;
}

/// The closed parts that preserve their volume: all of them, or none without `volume_stiffness`.
ClosedParts parts_to_keep(const ClosedParts& closed, const MassSpringOptions& options,
                          const TriangleMesh& rest) {
  if (!(options.volume_stiffness > 0)) return {};
  if (closed.parts.empty() && closed.left_out == 0 && !rest.triangles.empty()) {
    fail("masses and springs of mesh '" + rest.name + "': volume_stiffness is " +
         in_digits(options.volume_stiffness) +
         ", but no part of the mesh is closed; close it, wind its triangles alike, or leave the option at 0");
  }
  return closed;
}

}  // namespace

MassSpring::MassSpring(const TriangleMesh& rest, const MassSpringOptions& options)
    : options_(checked(options, rest)),
      name_(rest.name),
      triangles_(rest.triangles),
      closed_(closed_parts(rest)),
      network_(build_spring_network(rest, options, parts_to_keep(closed_, options, rest))),
      kinds_(vertex_kinds(rest, options)),
      inverse_masses_(inverse_masses(kinds_, options.vertex_mass)),
      longest_way_squared_(longest_way_squared(rest.positions)),
      stable_substep_(stable_explicit_step(network_, kinds_, options, rest.positions)),
      now_{rest.positions, std::vector<Vec3d>(rest.positions.size()), {}},
      next_(now_),
      forces_(network_),
      bad_vertices_(network_.block_count(), none),
      block_bounds_(network_.block_count()),
      has_inert_(std::find(kinds_.begin(), kinds_.end(), VertexKind::inert) != kinds_.end()) {
  rest_areas_.reserve(triangles_.size());
  for (const Triangle& t : triangles_) {
    rest_areas_.push_back(triangle_area(rest.positions[t[0]], rest.positions[t[1]], rest.positions[t[2]]));
  }
  if (options_.integrator == Integrator::verlet) {
    now_.accelerations.resize(rest.positions.size());
    next_.accelerations.resize(rest.positions.size());
    predicted_.resize(rest.positions.size());
  }
  if (options_.substeps > 1) after_next_ = now_;
  if (options_.integrator == Integrator::backward_euler) {
    backward_euler_ = std::make_unique<BackwardEuler>(network_, kinds_, options_);
  }
  if (options_.yield_strain < std::numeric_limits<double>::infinity()) {
    edge_numbers_ = sides_of_areas(network_.areas.elements, network_.edges.elements);
  }
  if (options_.max_strain < std::numeric_limits<double>::infinity()) {
    limit_ = std::make_unique<DeformationLimit>(network_, inverse_masses_, options_.max_strain);
  }
}

std::optional<std::string> MassSpring::try_step(double seconds, const Parallel& parallel) {
  if (!(seconds > 0) || !std::isfinite(seconds)) {
    fail("masses and springs of mesh '" + name_ + "': a step of " + in_digits(seconds) +
         " s; it must be finite and above 0");
  }
  const bool is_plastic = options_.yield_strain < std::numeric_limits<double>::infinity();
  if (is_plastic) {
    rest_before_.edges = network_.edges.elements;
    rest_before_.bending = network_.bending.elements;
    rest_before_.areas = network_.areas.elements;
  }
  before_ = nullptr;
  has_bounds_ = false;
  const double substep = seconds / options_.substeps;
  State* from = &now_;
  for (std::uint32_t i = 0; i < options_.substeps; ++i) {
    State& to = from == &next_ ? after_next_ : next_;
    carry_on(*from, to, substep, parallel);
    if (const std::uint32_t bad = first_bad_vertex(); bad != none) {
      restore_rest_shape();
      return why_bad(bad, seconds);
    }
    from = &to;
  }
  before_ = from == &next_ ? &MassSpring::next_ : &MassSpring::after_next_;
  std::swap(now_, this->*before_);
  has_bounds_ = true;
  return std::nullopt;
}

void MassSpring::undo_step() {
  if (before_ == nullptr) {
    fail("masses and springs of mesh '" + name_ +
         "': there is no step to undo; only the last one can be undone");
  }
  std::swap(now_, this->*before_);
  before_ = nullptr;
  has_bounds_ = false;
  restore_rest_shape();
}

void MassSpring::restore_rest_shape() {
  if (!(options_.yield_strain < std::numeric_limits<double>::infinity())) return;
  network_.edges.elements = rest_before_.edges;
  network_.bending.elements = rest_before_.bending;
  network_.areas.elements = rest_before_.areas;
}

void MassSpring::carry_on(State& from, State& to, double seconds, const Parallel& parallel) {
  switch (options_.integrator) {
    case Integrator::verlet:
      verlet(from, to, seconds, parallel);
      break;
    case Integrator::symplectic_euler:
      symplectic_euler(from, to, seconds, parallel);
      break;
    case Integrator::backward_euler:
      implicit_euler(from, to, seconds, parallel);
      break;
  }
  if (limit_ != nullptr && first_bad_vertex() == none) {
    if (limit_->apply(network_.edges.elements, seconds, to.positions, to.velocities, parallel)) {
      to.accelerations_known = false;
      for_blocks(parallel,
                 [&](std::uint32_t first, std::uint32_t last) { check_vertices(from, to, first, last); });
    }
  }
  if (options_.yield_strain < std::numeric_limits<double>::infinity() && first_bad_vertex() == none) {
    flow_plastically(to, seconds, parallel);
  }
}

/// Velocity Verlet (Teschner et al. 2004). Forces that depend on velocity use a prediction for the end of
/// the step. The prediction has an error of second order in the time step, which changes the result in third
/// order.
void MassSpring::verlet(State& from, State& to, double seconds, const Parallel& parallel) {
  if (!from.accelerations_known) find_accelerations(from, parallel);
  for_blocks(parallel, [&](std::uint32_t first, std::uint32_t last) {
    for (std::uint32_t v = first; v < last; ++v) {
      to.positions[v] = from.positions[v] +
                        (from.velocities[v] * seconds + from.accelerations[v] * (0.5 * seconds * seconds));
      predicted_[v] = from.velocities[v] + from.accelerations[v] * seconds;
    }
  });
  forces_.compute(network_, options_, to.positions, predicted_, parallel);
  for_blocks(parallel, [&](std::uint32_t first, std::uint32_t last) {
    for (std::uint32_t v = first; v < last; ++v) {
      const Vec3d after = acceleration(v, predicted_[v]);
      to.velocities[v] = from.velocities[v] + (from.accelerations[v] + after) * (0.5 * seconds);
      to.accelerations[v] = after;
    }
    check_vertices(from, to, first, last);
  });
  to.accelerations_known = true;
}

void MassSpring::find_accelerations(State& state, const Parallel& parallel) {
  forces_.compute(network_, options_, state.positions, state.velocities, parallel);
  for_blocks(parallel, [&](std::uint32_t first, std::uint32_t last) {
    for (std::uint32_t v = first; v < last; ++v)
      state.accelerations[v] = acceleration(v, state.velocities[v]);
  });
  state.accelerations_known = true;
}

void MassSpring::symplectic_euler(const State& from, State& to, double seconds, const Parallel& parallel) {
  forces_.compute(network_, options_, from.positions, from.velocities, parallel);
  for_blocks(parallel, [&](std::uint32_t first, std::uint32_t last) {
    for (std::uint32_t v = first; v < last; ++v) {
      to.velocities[v] = from.velocities[v] + acceleration(v, from.velocities[v]) * seconds;
      to.positions[v] = from.positions[v] + to.velocities[v] * seconds;
    }
    check_vertices(from, to, first, last);
  });
}

void MassSpring::implicit_euler(const State& from, State& to, double seconds, const Parallel& parallel) {
  backward_euler_->solve(
      {network_, from.positions, from.velocities, external_forces_, air_velocity_, seconds}, to.velocities,
      parallel);
  for_blocks(parallel, [&](std::uint32_t first, std::uint32_t last) {
    for (std::uint32_t v = first; v < last; ++v) {
      to.positions[v] = from.positions[v] + to.velocities[v] * seconds;
    }
    check_vertices(from, to, first, last);
  });
}

void MassSpring::flow_plastically(State& state, double seconds, const Parallel& parallel) {
  const auto springs_flow = [&](std::span<SpringElement> springs) {
    return flow(springs, options_.yield_strain, options_.plastic_rate, seconds, state.positions, parallel);
  };
  const bool edges_flowed = springs_flow(network_.edges.elements);
  const bool bending_flowed = springs_flow(network_.bending.elements);
  if (edges_flowed) follow_rest_lengths(network_.areas.elements, edge_numbers_, network_.edges.elements);
  if (edges_flowed || bending_flowed) state.accelerations_known = false;
}

/// Eq. 1 of the paper, solved for the acceleration: m a = f_ext - k_d v - f_s. Friction is relative to the
/// air, which is at rest or drifts with the body.
Vec3d MassSpring::acceleration(std::uint32_t vertex, Vec3d velocity) const {
  if (kinds_[vertex] != VertexKind::free) return {};
  Vec3d force = forces_.on_vertex(network_, vertex) - (velocity - air_velocity_) * options_.air_friction;
  if (!external_forces_.empty()) force = force + external_forces_[vertex];
  return force * inverse_masses_[vertex] + options_.gravity;
}

template <class Visit>
void MassSpring::for_blocks(const Parallel& parallel, Visit visit) {
  parallel.for_ranges(network_.block_count(), 1, [&](std::size_t begin, std::size_t end, std::uint32_t) {
    for (auto block = static_cast<std::uint32_t>(begin); block < end; ++block) {
      const std::uint32_t first = block * vertex_block_size;
      visit(first, std::min(first + vertex_block_size, network_.vertex_count));
    }
  });
}

void MassSpring::check_vertices(const State& from, const State& to, std::uint32_t first, std::uint32_t last) {
  std::uint32_t bad = none;
  PointBounds bounds;
  for (std::uint32_t v = last; v-- > first;) {
    bounds.add(to.positions[v]);
    const Vec3d way = to.positions[v] - from.positions[v], velocity = to.velocities[v];
    const bool good = dot(way, way) <= longest_way_squared_ &&
                      dot(velocity, velocity) <= std::numeric_limits<double>::max();
    if (!good && kinds_[v] != VertexKind::inert) bad = v;
  }
  bad_vertices_[first / vertex_block_size] = bad;
  block_bounds_[first / vertex_block_size] = bounds;
}

std::uint32_t MassSpring::first_bad_vertex() const {
  for (const std::uint32_t vertex : bad_vertices_) {
    if (vertex != none) return vertex;
  }
  return none;
}

std::string MassSpring::why_bad(std::uint32_t vertex, double seconds) const {
  const std::string where = "masses and springs of mesh '" + name_ + "': vertex " + std::to_string(vertex);
  if (!is_finite(now_.positions[vertex]) || !is_finite(now_.velocities[vertex]))
    return where + " was given a position or velocity that is not finite";
  const std::string what = where + " flies off in a step of " + in_digits(seconds) + " s";
  if (!(seconds > stable_step())) return what + "; reduce its velocities, forces or stretch";
  return what + "; steps below " + rounded(stable_step()) +
         " s are stable, more substeps or backward_euler make them longer";
}

void MassSpring::check_size(std::size_t size, const char* what) const {
  if (size == network_.vertex_count) return;
  fail("masses and springs of mesh '" + name_ + "': " + std::to_string(size) + " " + what +
       " given; the mesh has " + std::to_string(network_.vertex_count) + " vertices");
}

void MassSpring::set_positions(std::span<const Vec3d> positions) {
  check_size(positions.size(), "positions");
  std::copy(positions.begin(), positions.end(), now_.positions.begin());
  has_bounds_ = false;
  now_.accelerations_known = false;
}

void MassSpring::set_velocities(std::span<const Vec3d> velocities) {
  check_size(velocities.size(), "velocities");
  for (std::size_t v = 0; v < velocities.size(); ++v) {
    now_.velocities[v] = kinds_[v] == VertexKind::inert ? Vec3d{} : velocities[v];
  }
  now_.accelerations_known = false;
}

void MassSpring::set_external_forces(std::span<const Vec3d> forces) {
  if (!forces.empty()) check_size(forces.size(), "forces");
  bool known = now_.accelerations_known && !forces.empty() && !external_forces_.empty();
  // Forces that change in every step do not cost another evaluation of the springs.
  for (std::size_t v = 0; known && v < kinds_.size(); ++v) {
    if (kinds_[v] != VertexKind::free) continue;
    now_.accelerations[v] = now_.accelerations[v] + (forces[v] - external_forces_[v]) * inverse_masses_[v];
    known = is_finite(now_.accelerations[v]);
  }
  external_forces_.assign(forces.begin(), forces.end());
  forget_accelerations();
  now_.accelerations_known = known;
}

/// Also those of the state that `undo_step` restores, because forces and air stay.
void MassSpring::forget_accelerations() {
  for (State* const state : {&now_, &next_, &after_next_}) state->accelerations_known = false;
}

void MassSpring::add_drift(Vec3d velocity) {
  for (std::size_t v = 0; v < kinds_.size(); ++v) {
    if (kinds_[v] == VertexKind::free) now_.velocities[v] = now_.velocities[v] + velocity;
  }
  air_velocity_ = air_velocity_ + velocity;
  forget_accelerations();
}

void MassSpring::reflect(int axis) {
  if (axis < 0 || axis > 2) {
    fail("masses and springs of mesh '" + name_ + "': axis " + std::to_string(axis) + "; it is 0, 1 or 2");
  }
  const double mean = mean_velocity()[axis];
  for (std::size_t v = 0; v < kinds_.size(); ++v) {
    if (kinds_[v] == VertexKind::free) now_.velocities[v][axis] -= 2 * mean;
  }
  air_velocity_[axis] = -air_velocity_[axis];
  forget_accelerations();
}

}  // namespace supple
