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

/// One object's part in a step: where its vertices go, and what may be done about it.
struct RespondingObject {
  ObjectId id;
  std::span<const Vec3d> from, to;    // the same when it rests
  std::span<const Vec3d> velocities;  // at the end of the step, of what has mass
  double inverse_mass = 0;            // of each vertex; 0 when impulses do not move the object
};

/// Impulses at contacts by Bridson, Fedkiw and Anderson, "Robust treatment of collisions, contact and
/// friction for cloth animation", 2002: those at collisions within the step, and the gentle push apart of
/// what is near from the start. The paper's order of both, and its velocities, average over the step, are
/// kept; impulses are applied one after the other in the canonical order of contacts, so that each conserves
/// momentum and all machines agree.
///
/// Unlike theirs, an impulse moves not only the vertices of its elements, but also what their springs would
/// drag along within the step: see `ImpulseSpread`. With M = m + h² L for mass it is an inelastic one, which
/// takes motion from a body and strains its springs by less than that.
class ImpulseResponse {
 public:
  /// `seconds` is the length of each step.
  ImpulseResponse(const ContactResponse& options, double seconds, std::uint32_t threads);
  ImpulseResponse(const ImpulseResponse&) = delete;
  ImpulseResponse& operator=(const ImpulseResponse&) = delete;

  /// The calls of a scene, which then gives the same ids. `springs` of what has mass, else null; vertices
  /// that are fixed in them are moved by no impulse.
  ObjectId add(const TriangleMesh& mesh, const ObjectOptions& options, const MassSpringOptions* springs);
  void remove(ObjectId object);
  void set_positions(ObjectId object, std::span<const Vec3d> positions);

  /// Finds which impulses are needed on the way of a step. Objects that rest must be listed too.
  void resolve(std::span<const RespondingObject> objects);
  /// What impulses do to the vertices of an object.
  struct Change {
    std::span<const Vec3d> of_average_velocity;  // times the step's seconds, to be added to `to`
    std::span<const Vec3d> of_velocity;
  };
  /// Nothing when no impulse was given to it.
  std::optional<Change> change(ObjectId object) const;

 private:
  struct Participant {
    std::vector<Triangle> triangles;
    bool has_mass = false;
    std::optional<ImpulseSpread> spread;  // of what has mass
    bool is_resting = true;
    RespondingObject now;
    std::array<std::vector<Vec3d>, 2> changes;  // by `Velocity`
    bool is_changed = false;                    // in this step
    bool is_stale = false;                      // the scene does not know the path yet
  };
  /// Which of a vertex's velocities is meant.
  enum class Velocity : std::uint8_t { average, end };
  /// A point of an element: a vertex, a point of an edge or of a face.
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
  Vec3d start(const ElementPoint& point) const;
  Vec3d velocity(const ElementPoint& point, Velocity kind) const;
  double mobility(const ElementPoint& a, const ElementPoint& b) const;
  double mobility_of_both(const ElementPoint& a, const ElementPoint& b) const;
  void push(const ElementPoint& point, Vec3d impulse, Velocity kind);

  ContactResponse options_;
  double seconds_;
  Scene scene_;
  std::vector<Participant> participants_;  // by index
  std::vector<ObjectId> moving_;
  std::vector<Vec3d> to_;  // scratch
};

}  // namespace supple
