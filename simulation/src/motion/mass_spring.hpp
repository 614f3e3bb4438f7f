#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/parallel.hpp"
#include "motion/deformation_limit.hpp"
#include "motion/force_sum.hpp"
#include "motion/implicit/backward_euler.hpp"
#include "motion/network/spring_network.hpp"
#include "motion/vertex_kind.hpp"
#include "simulation/point_bounds.hpp"
#include "supple/motion.hpp"

namespace supple {

/// Implements `MassSpringBody` without threads of its own.
class MassSpring {
 public:
  MassSpring(const TriangleMesh& rest, const MassSpringOptions& options);

  std::optional<std::string> try_step(double seconds, const Parallel& parallel);
  void undo_step();

  std::span<const Vec3d> positions() const { return now_.positions; }
  std::span<const Vec3d> velocities() const { return now_.velocities; }
  void set_positions(std::span<const Vec3d> positions);
  void set_velocities(std::span<const Vec3d> velocities);
  void set_external_forces(std::span<const Vec3d> forces);
  void add_drift(Vec3d velocity);
  void reflect(int axis);

  const MassSpringOptions& options() const { return options_; }
  double stable_step() const { return stable_substep_ * options_.substeps; }

  MassSpringEnergy energy() const;
  Vec3d momentum() const;
  Vec3d angular_momentum() const;
  Vec3d center_of_mass() const;
  Vec3d mean_velocity() const;
  double area() const;
  double volume() const;
  AreaError area_error() const;
  EdgeStrain edge_strain() const;
  std::optional<std::array<Vec3d, 2>> bounds() const;
  std::vector<MassSpringBody::Spring> springs() const;

 private:
  struct State {
    std::vector<Vec3d> positions, velocities;
    std::vector<Vec3d> accelerations;  // used by Verlet only
    bool accelerations_known = false;
  };
  struct RestShape {
    std::vector<SpringElement> edges, bending;
    std::vector<AreaElement> areas;
  };

  void restore_rest_shape();
  void forget_accelerations();
  void check_size(std::size_t size, const char* what) const;
  void carry_on(State& from, State& to, double seconds, const Parallel& parallel);
  void verlet(State& from, State& to, double seconds, const Parallel& parallel);
  void symplectic_euler(const State& from, State& to, double seconds, const Parallel& parallel);
  void implicit_euler(const State& from, State& to, double seconds, const Parallel& parallel);
  void find_accelerations(State& state, const Parallel& parallel);
  Vec3d acceleration(std::uint32_t vertex, Vec3d velocity) const;
  void flow_plastically(State& state, double seconds, const Parallel& parallel);
  /// Calls `visit(first, last)` with the range of vertices of each block.
  template <class Visit>
  void for_blocks(const Parallel& parallel, Visit visit);
  void check_vertices(const State& from, const State& to, std::uint32_t first, std::uint32_t last);
  std::uint32_t first_bad_vertex() const;
  std::string why_bad(std::uint32_t vertex, double seconds) const;

  MassSpringOptions options_;
  std::string name_;
  std::vector<Triangle> triangles_;
  std::vector<double> rest_areas_;
  ClosedParts closed_;
  SpringNetwork network_;
  std::vector<Triangle> edge_numbers_;  // the three edges of each area element; empty without plastic flow
  std::vector<VertexKind> kinds_;
  std::vector<double> inverse_masses_;  // 0 for fixed and inert vertices
  std::vector<Vec3d> external_forces_;  // empty when there are none
  Vec3d air_velocity_;
  double longest_way_squared_;
  double stable_substep_;

  // Substeps alternate between the other two states, so that the state before the step survives a failure.
  State now_, next_, after_next_;
  State MassSpring::*before_ = nullptr;  // the state in which the last step began
  RestShape rest_before_;
  ForceSum forces_;
  std::vector<Vec3d> predicted_;
  std::vector<std::uint32_t> bad_vertices_;  // the first invalid vertex of each block
  std::vector<PointBounds> block_bounds_;    // of the positions after a step
  bool has_bounds_ = false;                  // they are those of `now_`
  bool has_inert_ = false;                   // vertices
  std::unique_ptr<DeformationLimit> limit_;
  std::unique_ptr<BackwardEuler> backward_euler_;
};

}  // namespace supple
