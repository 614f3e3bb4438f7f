#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "simulation/impulse_spread.hpp"
#include "supple/mesh.hpp"
#include "supple/scene.hpp"
#include "supple/simulation.hpp"

namespace supple {

/// One object in a step: the motion of its vertices and how impulses may change it.
struct RespondingObject {
  ObjectId id;
  std::span<const Vec3d> from, to;    // equal for an object at rest
  std::span<const Vec3d> velocities;  // at the end of the step, for objects with mass
  double inverse_mass = 0;            // per vertex; 0 when impulses do not move the object
};

/// Contact impulses of Bridson, Fedkiw and Anderson, "Robust treatment of collisions, contact and friction
/// for cloth animation", 2002: impulses for collisions within the step, and repulsion between elements that
/// are close at the start. The order of the two and the use of average velocities follow the paper. Impulses
/// are applied one at a time in the canonical order of contacts, so each conserves momentum and all machines
/// agree.
///
/// Unlike in the paper, an impulse also moves the vertices that springs drag along within the step; see
/// `ImpulseSpread`. With the effective mass M = m + h² L the impulse is inelastic: it removes more kinetic
/// energy from a body than it adds strain energy to its springs.
class ImpulseResponse {
 public:
  /// `seconds` is the duration of a step.
  ImpulseResponse(const ContactResponse& options, double seconds, std::uint32_t threads);
  ImpulseResponse(const ImpulseResponse&) = delete;
  ImpulseResponse& operator=(const ImpulseResponse&) = delete;

  /// The same calls as for the scene give the same ids. `springs` is null for objects without mass. Impulses
  /// do not move vertices that are fixed in it.
  ObjectId add(const TriangleMesh& mesh, const ObjectOptions& options, const MassSpringOptions* springs);
  void remove(ObjectId object);
  void set_positions(ObjectId object, std::span<const Vec3d> positions);

  /// Computes the impulses for a step. `objects` must include objects at rest.
  void resolve(std::span<const RespondingObject> objects);
  /// The effect of the impulses on the vertices of one object.
  struct Change {
    std::span<const Vec3d> of_average_velocity;  // times the duration of the step, this is added to `to`
    std::span<const Vec3d> of_velocity;
  };
  /// Empty when the object received no impulse.
  std::optional<Change> change(ObjectId object) const;

 private:
  struct Participant {
    std::vector<Triangle> triangles;
    bool has_mass = false;
    std::optional<ImpulseSpread> spread;  // for objects with mass
    bool is_resting = true;
    RespondingObject now;
    std::array<std::vector<Vec3d>, 2> changes;  // indexed by `Velocity`
    bool is_changed = false;                    // in this step
    bool is_stale = false;                      // the scene still has an older path
  };
  /// Selects one of the two velocities of a vertex.
  enum class Velocity : std::uint8_t { average, end };
  /// A vertex, a point on an edge, or a point on a face.
  struct ElementPoint {
    Participant* object = nullptr;
    std::array<std::uint32_t, 3> vertices{};
    std::array<double, 3> weights{};
    std::uint32_t count = 0;
  };

  void begin(std::span<const RespondingObject> objects);
  void show_paths();
  bool respond(const ContinuousContact& contact);
  ElementPoint point_of(ObjectId object, const std::array<std::uint32_t, 2>& element, bool is_face,
                        const std::array<double, 3>& weights);
  bool push_apart(const ElementPoint& a, const ElementPoint& b, Vec3d normal, double least_speed,
                  double restitution, Velocity kind);
  Vec3d velocity(const ElementPoint& point, Velocity kind) const;
  double mobility(const ElementPoint& a, const ElementPoint& b) const;
  double mobility_of_both(const ElementPoint& a, const ElementPoint& b) const;
  void push(const ElementPoint& point, Vec3d impulse, Velocity kind);

  ContactResponse options_;
  double seconds_;
  Scene scene_;
  std::vector<Participant> participants_;  // indexed by object
  std::vector<ObjectId> moving_;
  std::vector<Vec3d> to_;  // scratch
};

}  // namespace supple
