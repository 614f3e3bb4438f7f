#pragma once

#include <cstdint>
#include <span>

#include "supple/scene.hpp"
#include "supple/types.hpp"

namespace supple {

/// Simple contact response by impulses (Bridson, Fedkiw and Anderson, "Robust treatment of collisions,
/// contact and friction for cloth animation", 2002), for `respond` and for `Simulation`.
///
/// Proximity finds what is near at the start of a step. Pairs of features that are farther apart than
/// `thickness` may approach to it by half the distance in the step. Pairs that are nearer are moved apart by
/// a tenth of the missing distance in each step. Continuous contacts find what is fast: elements that would
/// touch within the step stop their approach. Impulses act along the normal, one at a time in the canonical
/// order of contacts, so each conserves momentum and the results are the same on every machine and for any
/// number of threads.
struct ContactResponse {
  double thickness = 1e-3;  ///< distance that the response keeps between elements, m, > 0
  double restitution = 0;   ///< 0 stops the approach, 1 reverses it
  double friction = 0;      ///< Coulomb's coefficient, ≥ 0
  /// Largest number of rounds of impulses and detection per step, and of sweeps over all contacts per round,
  /// ≥ 1.
  std::uint32_t iterations = 4;

  constexpr bool operator==(const ContactResponse&) const = default;
};

/// The least margin with which proximity finds the pairs of two objects before they come nearer than the
/// thickness, m. `Simulation` raises the margins of its objects to it.
constexpr double least_margin(const ContactResponse& response) {
  return 0.75 * response.thickness;
}

/// An object that moves, for `respond`.
struct ResponseBody {
  ObjectId object;
  /// One for each vertex, m/s: in a step of duration dt each vertex moves by dt times its velocity.
  std::span<Vec3d> velocities;
  /// One for each vertex, kg, > 0. Impulses do not change the velocity of a vertex of infinite mass. Empty:
  /// all masses are infinite.
  std::span<const double> masses{};
};

/// Changes the velocities of bodies so that they do not pass through anything in a step of `dt` seconds, with
/// friction and restitution. Call it when the velocities of the step are known, and move the vertices after
/// it:
///
/// ```cpp
/// for (std::size_t v = 0; v < x.size(); ++v) velocities[v] += dt / masses[v] * forces[v];
/// const double part = supple::respond(scene, cloth, velocities, masses, dt, {.thickness = 0.01});
/// for (std::size_t v = 0; v < x.size(); ++v) x[v] += part * dt * velocities[v];
/// scene.set_positions(cloth, x);
/// ```
///
/// The scene holds the positions at the start of the step. `respond` searches proximity once, with the
/// margins of the objects, then continuous contacts with `SceneOptions::impact`, at most `iterations` times.
/// Give objects that may meet margins whose sum is about 1.5 times the thickness; with smaller margins, or
/// none, they come nearer than the thickness, but still do not pass through each other. Objects that are not
/// among `bodies` are at rest and do not react. Groups, masks, the filter and `self_collision` apply.
///
/// It does not change `Scene::result` and the events. The bodies are on the paths of the whole step
/// (`Scene::set_motion`) until other positions are set.
///
/// Returns the part of the step, 0 to 1, in which nothing touches: 1 when the impulses removed all impacts,
/// otherwise `Scene::max_step`. Bodies that move no further than this do not pass through anything. It is 0
/// where surfaces that touch at the start would cross; surfaces that part or slide do not shorten it.
///
/// Costs one search of proximity and usually one or two of continuous contacts, and memory in proportion
/// to the bodies and their contacts. Throws `Error` when an option, `dt` > 0 or a mass is out of its range,
/// when the number of velocities or masses differs from that of the vertices, when an object is listed twice,
/// and as `Scene::set_motion` does, which needs objects that are not static.
double respond(Scene& scene, std::span<const ResponseBody> bodies, double dt,
               const ContactResponse& options = {});
/// The same for one body.
double respond(Scene& scene, ObjectId object, std::span<Vec3d> velocities, std::span<const double> masses,
               double dt, const ContactResponse& options = {});

}  // namespace supple
