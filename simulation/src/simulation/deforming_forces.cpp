#include "simulation/deforming_forces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "geometry/vector.hpp"
#include "supple/trigonometry.hpp"

namespace supple {
namespace {

struct Wave {
  Vec3d force, along;
  double phase = 0;
};

std::array<Wave, 3> random_waves(Random& random, double length) {
  std::array<Wave, 3> waves;
  for (Wave& wave : waves) {
    wave.force = random.direction();
    wave.along = random.direction() * (1 / length);
    wave.phase = random.uniform();
  }
  return waves;
}

/// The turn a for which the forces a × r have the given torque, where J a is the torque and J the inertia of
/// unit masses. 0 for points on a line, which have no inertia about it.
Vec3d turn_of(Vec3d torque, const std::array<Vec3d, 3>& inertia) {
  const auto& [a, b, c] = inertia;
  const double determinant = dot(a, cross(b, c));
  const double trace = a.x + b.y + c.z;
  if (!(determinant > 1e-12 * trace * trace * trace)) return {};
  return (torque.x * cross(b, c) + torque.y * cross(c, a) + torque.z * cross(a, b)) * (1 / determinant);
}

/// The vertices with a finite position, in their connected components of the spring graph.
std::vector<std::vector<std::uint32_t>> pieces_of(std::span<const Vec3d> rest,
                                                  std::span<const MassSpringBody::Spring> springs) {
  std::vector<std::uint32_t> parents(rest.size());
  std::iota(parents.begin(), parents.end(), 0u);
  const auto root_of = [&](std::uint32_t vertex) {
    while (parents[vertex] != vertex) vertex = parents[vertex] = parents[parents[vertex]];
    return vertex;
  };
  for (const MassSpringBody::Spring& spring : springs) parents[root_of(spring.a)] = root_of(spring.b);
  std::map<std::uint32_t, std::vector<std::uint32_t>> by_root;
  for (std::uint32_t i = 0; i < rest.size(); ++i) {
    if (is_finite(rest[i])) by_root[root_of(i)].push_back(i);
  }
  std::vector<std::vector<std::uint32_t>> pieces;
  for (auto& [root, piece] : by_root) pieces.push_back(std::move(piece));
  return pieces;
}

}  // namespace

DeformingForces::DeformingForces(std::span<const Vec3d> rest, std::span<const MassSpringBody::Spring> springs,
                                 const MassSpringMotion& motion, Random random)
    : size_(motion.random_force),
      change_seconds_(size_ > 0 ? motion.force_change_seconds : 0),
      random_(random) {
  if (!(size_ > 0) || !(change_seconds_ > 0 || motion.deform_seconds > 0)) return;
  Vec3d sum, low, high;
  for (const Vec3d& position : rest) {
    if (!is_finite(position)) continue;
    if (vertex_count_ == 0) low = high = position;
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], position[axis]);
      high[axis] = std::max(high[axis], position[axis]);
    }
    sum = sum + position;
    ++vertex_count_;
  }
  length_ = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
  if (length_ > 0) {
    pieces_ = pieces_of(rest, springs);
    const Vec3d centre = sum * (1 / vertex_count_);
    for (const Vec3d& position : rest) rest_.push_back(position - centre);
  }
  from_.resize(rest.size());
  from_ = next_field();
  if (change()) {
    to_ = next_field();
    now_.resize(rest.size());
  }
}

std::vector<Vec3d> DeformingForces::next_field() {
  std::vector<Vec3d> forces(from_.size());
  if (!(length_ > 0)) return forces;
  for (const Wave& wave : random_waves(random_, length_)) {
    for (const Piece& piece : pieces_) {
      for (const std::uint32_t i : piece)
        forces[i] = forces[i] + wave.force * sin_turns(dot(wave.along, rest_[i]) + wave.phase);
    }
  }
  keep_in_place(rest_, forces);
  double squares = 0;
  for (const Vec3d& force : forces) squares += dot(force, force);
  if (!(squares > 0)) return forces;
  const double factor = size_ * std::sqrt(vertex_count_ / squares);
  for (Vec3d& force : forces) force = force * factor;
  return forces;
}

/// Removes the sum and the torque of the forces on each piece: subtracts their mean, then a × r with the arm
/// r from the centre.
void DeformingForces::keep_in_place(std::span<const Vec3d> positions, std::vector<Vec3d>& forces) const {
  for (const Piece& piece : pieces_) {
    Vec3d centre, mean;
    for (const std::uint32_t i : piece) {
      centre = centre + positions[i];
      mean = mean + forces[i];
    }
    const double share = 1 / static_cast<double>(piece.size());
    centre = centre * share;
    mean = mean * share;
    Vec3d torque;
    std::array<Vec3d, 3> inertia{};  // rows
    for (const std::uint32_t i : piece) {
      const Vec3d r = positions[i] - centre;
      forces[i] = forces[i] - mean;
      torque = torque + cross(r, forces[i]);
      for (int row = 0; row < 3; ++row) {
        Vec3d& j = inertia[static_cast<std::size_t>(row)];
        j = j - r * r[row];
        j[row] += dot(r, r);
      }
    }
    const Vec3d turn = turn_of(torque, inertia);
    for (const std::uint32_t i : piece) forces[i] = forces[i] - cross(turn, positions[i] - centre);
  }
}

std::span<const Vec3d> DeformingForces::at(double seconds, std::span<const Vec3d> positions) {
  const double changes = seconds / change_seconds_;
  if (const double begun = std::floor(changes); begun > changes_) {
    if (begun > changes_ + 1) to_ = next_field();  // more than one change in a step
    from_.swap(to_);
    to_ = next_field();
    changes_ = begun;
  }
  // The slope of the weights is 0 where the next change begins.
  const double part = changes > changes_ ? changes - changes_ : 0;
  const double quarter_turns = part * part * (3 - 2 * part);
  const double weight = cos_turns(quarter_turns / 4), next_weight = sin_turns(quarter_turns / 4);
  for (std::size_t i = 0; i < now_.size(); ++i) now_[i] = from_[i] * weight + to_[i] * next_weight;
  keep_in_place(positions, now_);
  return now_;
}

}  // namespace supple
