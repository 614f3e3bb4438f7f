#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "simulation/impulse_spread.hpp"
#include "supple/response.hpp"
#include "supple/scene.hpp"

namespace supple {

/// One object in a step: the motion of its vertices and how impulses may change it.
struct RespondingObject {
  ObjectId id;
  std::span<const Vec3d> from, to;
  /// At the end of the step; empty when they are those of the path.
  std::span<const Vec3d> end_velocities{};
  /// Per vertex, of the change of velocity by impulses; 0 for fixed vertices. Empty when impulses do not move
  /// the object.
  std::span<const double> inverse_masses{};
  /// Impulses also move the vertices around; null when they do not.
  ImpulseSpread* spread = nullptr;
};

/// The impulses of `ContactResponse`. The order of repulsion and collisions and the use of average velocities
/// follow Bridson et al. 2002.
///
/// Unlike in the paper, an impulse also moves the vertices that springs drag along within the step; see
/// `ImpulseSpread`. With the effective mass M = m + h² L the impulse is inelastic: it removes more kinetic
/// energy from a body than it adds strain energy to its springs.
class ContactImpulses {
 public:
  /// `seconds` is the duration of a step.
  ContactImpulses(const ContactResponse& options, double seconds) : options_(options), seconds_(seconds) {}

  /// Computes the impulses for a step. `objects` are those that move; all others are at rest where the scene
  /// has them. `near` is the proximity at the start of the step. Searches `impacts` by `Scene::search`, and
  /// leaves the objects on their paths. Returns whether these are known to be free of impacts.
  bool resolve(Scene& scene, std::span<const ProximityPair> near, std::span<const RespondingObject> objects,
               const DetectRequest& impacts, const PairFilter& only = {});
  /// The effect of the impulses on the vertices of one object.
  struct Change {
    std::span<const Vec3d> of_average_velocity;  // times the duration of the step, this is added to `to`
    std::span<const Vec3d> of_end_velocity;      // empty without `end_velocities`
  };
  /// Empty when the object received no impulse.
  std::optional<Change> change(ObjectId object) const;

 private:
  /// Selects one of the two velocities of a vertex.
  enum class Velocity : std::uint8_t { average, end };
  struct Participant {
    std::optional<RespondingObject> now;        // empty for objects at rest
    std::array<std::vector<Vec3d>, 2> changes;  // indexed by `Velocity`
    bool is_changed = false;                    // in this step
    bool is_stale = false;                      // the scene has no path, or an older one
  };
  /// A vertex, a point on an edge, or a point on a face.
  struct ElementPoint {
    std::uint32_t object = 0;  // index
    ElementVertices vertices;
    std::array<double, 3> weights{};
  };
  /// Two elements with a point on each, which must not approach faster than a speed. Arrays are indexed by
  /// `Velocity`.
  struct Touch {
    ElementPoint a, b;
    Vec3d normal;         // unit vector from b to a
    double mobility = 0;  // change of relative velocity per impulse on a and its opposite on b
    std::array<double, 2> least_speed{};  // along the normal
    std::array<double, 2> impulse{};      // sum along the normal
  };

  void begin(std::span<const RespondingObject> objects);
  Participant& participant_of(ObjectId object);
  void show_paths(Scene& scene);
  Touch touch_of(const Scene& scene, const ProximityPair& pair);
  Touch touch_of(const Scene& scene, const ContinuousContact& impact);
  template <class Contact>
  Touch unlimited_touch_of(const Scene& scene, const Contact& contact);
  void bounce(Touch& touch) const;
  bool keep_apart();
  bool keep_apart(Touch& touch, Velocity kind);
  bool push_apart(const Touch& touch, double impulse, Velocity kind);
  /// The number of velocities that differ: those of the path, or also those at the end of the step.
  std::size_t velocity_count(const Touch& touch) const;
  double normal_speed(const Touch& touch, Velocity kind) const;
  Vec3d relative_velocity(const Touch& touch, Velocity kind) const;
  Vec3d velocity(const ElementPoint& point, Velocity kind) const;
  double mobility(const ElementPoint& a, const ElementPoint& b) const;
  void push(const ElementPoint& point, Vec3d impulse, Velocity kind);

  ContactResponse options_;
  double seconds_;
  std::vector<Participant> participants_;  // indexed by object
  std::vector<Touch> touches_;
  std::vector<Vec3d> to_;  // scratch
};

}  // namespace supple
