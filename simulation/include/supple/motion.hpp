#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "supple/mesh.hpp"
#include "supple/types.hpp"

namespace supple {

/// How a time step advances positions and velocities.
enum class Integrator : std::uint8_t {
  /// Velocity Verlet with the damping of Teschner et al. 2004. Second order, one evaluation of forces per
  /// step.
  verlet,
  /// New velocities first, then positions with these velocities. First order, one evaluation of forces per
  /// step.
  symplectic_euler,
  /// Implicit: up to six sparse linear systems per step. First order, stable at any stiffness.
  backward_euler,
};

/// The material of a mesh of masses and springs. Units are the user's; the comments assume metres, kilograms
/// and seconds.
struct MassSpringOptions {
  Integrator integrator = Integrator::verlet;
  /// Number of equal parts of a step, ≥ 1.
  std::uint32_t substeps = 1;

  double vertex_mass = 1;  ///< mass m of each vertex, kg, > 0
  double stiffness = 50;   ///< k_s of the spring on each edge, N/m, ≥ 0
  /// The paper's spring length s, as a factor of the distance in the mesh, > 0: springs on and across edges
  /// are at rest at this factor times the length that they have in the mesh. The areas to preserve change by
  /// its square, as the areas of triangles with these sides; the volumes to preserve stay.
  double rest_length = 1;
  /// Springs as those on edges also connect the pieces of a mesh, for models of several pieces, which would
  /// drift apart. Each piece is connected to the larger ones: of its vertices, the 16 that are nearest to a
  /// larger piece each get springs to the three corners of the nearest triangle. No effect on a mesh of one
  /// piece.
  bool connect_pieces = false;
  double damping = 0.5;          ///< k_d along each spring, also those across edges, N s/m, ≥ 0
  double air_friction = 0;       ///< k_d of eq. 1, of each vertex against the air around it, N s/m, ≥ 0
  double bending_stiffness = 0;  ///< of a spring across each edge, between the opposite corners, N/m, ≥ 0
  /// Stiffness of a force that preserves the area of each triangle, N/m, ≥ 0; see `MassSpringBody`.
  double area_stiffness = 0;
  /// Bulk modulus of the interior of closed surfaces, Pa, ≥ 0: the pressure at twice the volume. A force
  /// preserves the volume of each closed part of the mesh; see `MassSpringBody`.
  double volume_stiffness = 0;
  Vec3d gravity{};  ///< m/s²

  /// Limit of deformation, > 0: up to 50 rounds of corrections keep each edge between (1 - max_strain) and
  /// (1 + max_strain) times its rest length (Provot 1995). Infinite: no limit.
  double max_strain = std::numeric_limits<double>::infinity();
  /// Strain beyond which a spring flows, ≥ 0: its rest length changes until the elastic strain returns to
  /// this value. Springs across edges flow as well, and areas follow the rest lengths of their edges.
  /// Infinite: elastic.
  double yield_strain = std::numeric_limits<double>::infinity();
  /// Rate of the flow, 1/s, > 0: the strain beyond `yield_strain` decays as e^(-plastic_rate t).
  double plastic_rate = 10;

  /// Vertices of infinite mass, which forces do not move. They keep the velocity of `set_velocities`, which
  /// is 0 at first. Handles move this way.
  std::vector<std::uint32_t> fixed_vertices{};
  /// Worker threads; 0 means one for each core. They are used for more than 10,000 vertices, or more than
  /// 2,000 with `backward_euler`. The results are the same for any number.
  std::uint32_t threads = 0;
};

/// Energies in joules.
struct MassSpringEnergy {
  double kinetic = 0;
  double elastic = 0;  ///< of springs on and across edges
  double area = 0;     ///< of the forces that preserve areas
  double volume = 0;   ///< of the forces that preserve volumes
  double gravity = 0;  ///< -m g·x, 0 at the origin
  double total() const { return kinetic + elastic + area + volume + gravity; }
};

/// The relative area error |A - A0| / A0 over all triangles, with the area A0 > 0 that each has in the mesh.
struct AreaError {
  double largest = 0;
  double mean = 0;
};

/// The strain |l - l0| / l0 over all edges, with the length l0 > 0 that each has in the mesh times
/// `rest_length`, or that plastic flow gave it.
struct EdgeStrain {
  double largest = 0;
  double mean = 0;
};

/// A mesh as masses at its vertices and springs on its edges: section 4 of the paper, eq. 1 and 2.
///
///     m a = f_springs + f_areas + f_volumes + f_external + m g - air_friction (v - v_air) (eq. 1)
///
/// Each edge has one spring, and `connect_pieces` adds springs between pieces. With d the vector from one end
/// to the other, s the rest length (`rest_length` times the length in the mesh, until plastic flow changes
/// it) and |d|˙ the rate of |d|, the spring pulls that end with
///
///     (stiffness (|d| - s) + damping |d|˙) d / |d| (eq. 2)
///
/// and the other end with the opposite force, so damping does not slow rotation. `bending_stiffness` adds
/// such springs between the corners opposite to an edge, for each two triangles that are consecutive at the
/// edge in the order of the mesh, unless these corners share an edge.
///
/// `area_stiffness` k adds the energy k (A - A0)² / 2 S for each triangle (after Teschner et al. 2004). S is
/// the area of the equilateral triangle on its longest side in the mesh. The force on a corner is -k (A - A0)
/// / S ∂A/∂x. An area error remains while other forces act: a square with two sides held 1.4 times as far
/// apart has a mean error of 31 % without this force, 21 % with k = stiffness, 6 % with ten times and 0.9 %
/// with a hundred times that.
///
/// `volume_stiffness` k adds the energy k (V - V0)² / 2 |V0| for each closed part (after Teschner et al.
/// 2004, who use V0² instead of |V0|; here k is a pressure). The pressure inside is p = k (V0 - V) / V0,
/// which pushes each corner of a triangle of area A by p A / 3 along the normal. A part is a set of triangles
/// connected by vertices. It is closed when its triangles use each edge equally often in both directions, as
/// in a consistently wound surface without holes. Each closed part preserves its own volume, wound outward or
/// inward. The force does not act on open parts, nor on flat parts that enclose less than a millionth of the
/// volume of a sphere of their area. Plastic flow does not change V0.
///
/// Momentum is conserved to rounding, except for gravity, friction, external forces and fixed vertices. The
/// explicit integrators also conserve angular momentum, with limits and plastic flow too.
///
/// Vertices that no triangle uses move freely. Triangles without area at rest, repeated ids and duplicates
/// are allowed. An edge without length at rest pulls its ends together. Springs and triangles that have no
/// direction at the moment exert no force. Vertices whose rest position is not finite do not move, have no
/// mass and exert no force.
class MassSpringBody {
 public:
  /// The body starts with the positions of the mesh and without velocity. O(n log n). Throws `Error` as
  /// `check_mesh` does, when an option is out of its range, and when `volume_stiffness` is set for a mesh
  /// without closed parts.
  explicit MassSpringBody(const TriangleMesh& rest, const MassSpringOptions& options = {});
  ~MassSpringBody();
  MassSpringBody(MassSpringBody&&) noexcept;
  MassSpringBody& operator=(MassSpringBody&&) noexcept;

  /// Advances positions and velocities by `seconds` > 0, in `substeps` parts. When a number is no longer
  /// finite, or a vertex moves further in one substep than a hundred times the size of the body, the call
  /// restores the state from before and throws `Error`, which names the vertex and a stable step. O(n),
  /// without allocation in steady state, except for `backward_euler`, which solves a sparse linear system up
  /// to six times (stiff bodies by factorization). Invalidates spans that were returned before.
  void step(double seconds);
  /// As `step`, but returns the message of the error instead of throwing it, or nothing when the step
  /// succeeded. For builds without exceptions.
  [[nodiscard]] std::optional<std::string> try_step(double seconds);
  /// Restores the state from before the last `step`, also when positions or velocities were set since.
  /// External forces, drift and the velocity of the air stay. Throws `Error` when there is no such step, or
  /// it was undone or failed. O(1), or O(n) when the body flows.
  void undo_step();

  std::span<const Vec3d> positions() const;
  std::span<const Vec3d> velocities() const;  ///< m/s
  /// Both replace all values. They throw `Error` when the size differs from the mesh.
  void set_positions(std::span<const Vec3d> positions);
  void set_velocities(std::span<const Vec3d> velocities);
  /// Forces on each vertex in addition to gravity, in newtons. They stay until they are set again and do not
  /// act on fixed vertices. An empty span removes them. Throws `Error` when the size differs from the mesh.
  void set_external_forces(std::span<const Vec3d> forces);
  /// Adds a velocity to each mass that is not fixed, as the paper does (v_i = v_i + v_d), and to the air
  /// around it, so that friction does not stop the drift.
  void add_drift(Vec3d velocity);
  /// Reverses the mean velocity of the body, and the velocity of the air, along an axis (0, 1, 2). The same
  /// change applies to each mass that is not fixed, so the body keeps its oscillation.
  void reflect(int axis);

  std::size_t vertex_count() const;
  const MassSpringOptions& options() const;
  /// The longest step, with `substeps`, at which the explicit integrators are stable, by Gershgorin's bound
  /// on the frequencies and the damping of the rest state; infinite for `backward_euler`. The built-in models
  /// are stable up to 1.4 times this value.
  double stable_step() const;

  // Each takes O(n). Fixed vertices count only for the center of mass, not for momentum, velocity, kinetic
  // energy and the energy of gravity.
  MassSpringEnergy energy() const;
  Vec3d momentum() const;          ///< Σ m v, kg m/s
  Vec3d angular_momentum() const;  ///< Σ m x × v, about the origin
  Vec3d center_of_mass() const;
  Vec3d mean_velocity() const;
  double area() const;  ///< area of all triangles, m²
  /// The volume that closed parts enclose, m³, negative for parts wound inward; 0 when none is closed. Parts
  /// with a vertex that is not finite at rest do not count.
  double volume() const;
  AreaError area_error() const;
  EdgeStrain edge_strain() const;
  /// The lowest and the highest coordinates of all vertices, which `step` has found in its loop; nothing when
  /// a vertex is not finite or there is none. O(n / 2048) after a step, otherwise O(n).
  std::optional<std::array<Vec3d, 2>> bounds() const;
  /// The spring on an edge: its vertices, a < b, and its present rest length, which plastic flow changes.
  struct Spring {
    std::uint32_t a = 0, b = 0;
    double rest_length = 0;
  };
  std::vector<Spring> springs() const;  ///< sorted by a, then by b

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace supple
