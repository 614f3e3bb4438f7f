#pragma once

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

/// How positions and velocities are carried on by a time step.
enum class Integrator : std::uint8_t {
  verlet,            ///< velocity Verlet, damped as Teschner et al. 2004 do; second order, one force a step
  symplectic_euler,  ///< velocities first, positions with the new velocities; first order, one force a step
  backward_euler,    ///< implicit: a sparse linear system a step; first order, stable at any stiffness
};

/// What a mesh is made of when it becomes masses and springs. Units are the user's; these are of metres,
/// kilograms and seconds.
struct MassSpringOptions {
  Integrator integrator = Integrator::verlet;
  /// Equal parts a step is cut into, ≥ 1.
  std::uint32_t substeps = 1;

  double vertex_mass = 1;        ///< m, kg, of each vertex, > 0
  double stiffness = 50;         ///< k_s, N/m, of the spring on each edge, ≥ 0
  double damping = 0.5;          ///< k_d, N s/m, along each spring, those across edges too, ≥ 0
  double air_friction = 0;       ///< k_d of eq. 1, N s/m, of each vertex against the air about it, ≥ 0
  double bending_stiffness = 0;  ///< N/m, of a spring across each edge, between the two corners opposite, ≥ 0
  /// N/m, of a force that keeps the area of each triangle: see `MassSpringBody`. ≥ 0
  double area_stiffness = 0;
  /// Pa, bulk modulus of what closed surfaces enclose: the pressure at twice the volume. A force that keeps
  /// the volume of each closed part of the mesh: see `MassSpringBody`. ≥ 0
  double volume_stiffness = 0;
  Vec3d gravity{};  ///< m/s²

  /// Limit to deformation: an edge is kept between (1 - max_strain) and (1 + max_strain) times its rest
  /// length (Provot 1995), as far as 50 rounds of corrections bring it. Infinite: no limit. > 0
  double max_strain = std::numeric_limits<double>::infinity();
  /// Strain beyond which a spring flows: its rest length follows so that the elastic strain goes back to
  /// this. Springs across edges flow as well, and areas take the rest lengths of their edges. Infinite:
  /// elastic. ≥ 0
  double yield_strain = std::numeric_limits<double>::infinity();
  /// How fast: what is left of the strain beyond `yield_strain` falls as e^(-plastic_rate t). 1/s, > 0
  double plastic_rate = 10;

  /// Vertices that forces do not move: their mass is infinite. They keep the velocity that `set_velocities`
  /// gives them, 0 at first; a handle is pulled so.
  std::vector<std::uint32_t> fixed_vertices{};
  /// Worker threads, 0 for one a core, on more than 10,000 vertices, of `backward_euler` on more than 2,000;
  /// there are none for less. Results are the same for any number.
  std::uint32_t threads = 0;
};

/// Joules.
struct MassSpringEnergy {
  double kinetic = 0;
  double elastic = 0;  ///< of springs on and across edges
  double area = 0;     ///< of the forces that keep areas
  double volume = 0;   ///< of the forces that keep volumes
  double gravity = 0;  ///< -m g·x, 0 at the origin
  double total() const { return kinetic + elastic + area + volume + gravity; }
};

/// How far triangles are from their areas at rest: |A - A0| / A0, of triangles with an area at rest.
struct AreaError {
  double largest = 0;
  double mean = 0;
};

/// A mesh as masses at its vertices and springs on its edges: section 4 of the paper, eq. 1 and 2.
///
///     m a = f_springs + f_areas + f_volumes + f_external + m g - air_friction (v - v_air) (eq. 1)
///
/// Each two different vertices of a triangle have a spring, once. With d from an end to the other, s the
/// length at rest and |d|˙ the rate of |d|, it pulls that end with
///
///     (stiffness (|d| - s) + damping |d|˙) d / |d| (eq. 2)
///
/// and the other with the opposite, so damping takes nothing from rotation. `bending_stiffness` adds such
/// springs between the corners opposite to an edge, for each two triangles that follow each other around it
/// in the order of the mesh, unless these corners have an edge.
///
/// `area_stiffness` k adds the energy k (A - A0)² / 2 S a triangle (after Teschner et al. 2004), S being the
/// area of the equilateral triangle on its longest side at rest; corners are pulled by -k (A - A0) / S ∂A/∂x.
/// It is a force, so an error of area remains where something pulls: a square held at two sides 1.4 times as
/// far apart has a mean error of 31 % without it, 21 % with k = stiffness, 6 % with ten and 0.9 % with a
/// hundred times that.
///
/// `volume_stiffness` k adds the energy k (V - V0)² / 2 |V0| a closed part (after Teschner et al. 2004, who
/// have V0² for |V0|, so that k is a pressure here): a pressure p = k (V0 - V) / V0 inside, which pushes each
/// corner of a triangle of area A by p A / 3 along the normal. A part is what hangs together by vertices; it
/// is closed when each side is run through as often in one direction as in the other, as surfaces without
/// holes are whose triangles are wound alike. Each closed part keeps a volume of its own, wound outward or
/// inward. Open parts, and flat ones that enclose less than a millionth of the sphere of their area, feel
/// nothing. Plastic flow leaves V0 as it is.
///
/// Momentum is conserved but for gravity, friction, external forces and fixed vertices, to rounding; angular
/// momentum as well by the explicit integrators, also with limits and plastic flow.
///
/// Vertices that no triangle uses fly freely. Triangles of no area at rest, repeated ids and duplicates are
/// fine; an edge of no length at rest pulls its ends together, springs and triangles without a direction now
/// do not pull. Vertices whose rest position is not finite stay where they are, have no mass and pull at
/// nothing.
class MassSpringBody {
 public:
  /// At rest, without velocity. O(n log n). Throws `Error` as `check_mesh` does, or when an option is out of
  /// its range, or `volume_stiffness` asks to keep volumes of a mesh none of whose parts is closed.
  explicit MassSpringBody(const TriangleMesh& rest, const MassSpringOptions& options = {});
  ~MassSpringBody();
  MassSpringBody(MassSpringBody&&) noexcept;
  MassSpringBody& operator=(MassSpringBody&&) noexcept;

  /// Carries positions and velocities on by `seconds` > 0, in `substeps` parts. When a number stops being
  /// finite, or a vertex moves further in one substep than a hundred times the size of the body, state is put
  /// back to what it was before the call and `Error` is thrown, which names the vertex and says which step
  /// would be stable. O(n); no allocation in steady state except by `backward_euler`, which solves
  /// a sparse linear system up to six times, of stiff bodies by factors. Spans that were returned before are
  /// no longer valid.
  void step(double seconds);
  /// As `step`, but gives the message instead of throwing it when the body cannot be carried on; nothing when
  /// it was. For builds without exceptions.
  [[nodiscard]] std::optional<std::string> try_step(double seconds);
  /// Puts the body back to what it was before the last `step`, whatever positions and velocities it was given
  /// since; external forces, drift and the direction of the air stay. Throws `Error` when there is no such
  /// step, or it was undone or failed. O(1), or O(n) when the body flows.
  void undo_step();

  std::span<const Vec3d> positions() const;
  std::span<const Vec3d> velocities() const;  ///< metres a second
  // These replace all of them; the sizes must be that of the mesh, or `Error` is thrown.
  void set_positions(std::span<const Vec3d> positions);
  void set_velocities(std::span<const Vec3d> velocities);
  /// Newtons on each vertex, besides gravity; they hold until set again, and do nothing to fixed ones. Empty:
  /// none.
  void set_external_forces(std::span<const Vec3d> forces);
  /// Adds a velocity to each mass that is not fixed, as the paper does (v_i = v_i + v_d), and to the air
  /// about it, so that friction does not stop it.
  void add_drift(Vec3d velocity);
  /// Reverses the mean velocity, and that of the air, along an axis (0, 1, 2), by the same change for each
  /// mass that is not fixed: the body goes on swinging as it did.
  void turn_back(int axis);

  std::size_t vertex_count() const;
  const MassSpringOptions& options() const;
  /// The longest step, substeps considered, at which the explicit integrators stay stable, by Gershgorin's
  /// bound on the rest state's frequencies and damping; infinite for `backward_euler`. The built-in models
  /// bear 1.4 times that.
  double stable_step() const;

  // Each O(n). Fixed vertices, of infinite mass, count for neither momentum nor velocity nor the energies of
  // motion and gravity, but for the center.
  MassSpringEnergy energy() const;
  Vec3d momentum() const;          ///< Σ m v, kg m/s
  Vec3d angular_momentum() const;  ///< Σ m x × v, about the origin
  Vec3d center_of_mass() const;
  Vec3d mean_velocity() const;
  double area() const;  ///< of all triangles
  /// m³, of what closed parts enclose, below 0 for those wound inward; 0 when none is closed. Parts with a
  /// vertex that is not finite at rest do not count.
  double volume() const;
  AreaError area_error() const;
  /// On an edge: its vertices, a < b, and its rest length now (plastic flow changes it).
  struct Spring {
    std::uint32_t a = 0, b = 0;
    double rest_length = 0;
  };
  std::vector<Spring> springs() const;  ///< by a, then b

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace supple
