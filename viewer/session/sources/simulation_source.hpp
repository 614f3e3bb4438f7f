#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene_view.hpp"
#include "sources/grip.hpp"
#include "sources/source.hpp"
#include "supple/simulation.hpp"

namespace supple::viewer {

/// Objects that a simulation moves and that the user can grab and drag.
class SimulationSource final : public Source {
 public:
  /// `show` must outlive this object. Detects at the start. Throws `Error` as `Simulation` does.
  explicit SimulationSource(const SceneView& show);

  const Scene& scene() const override { return simulation_.scene(); }
  ObjectId id(std::size_t object) const override { return ids_[object]; }
  std::span<const Vec3d> positions(std::size_t object) const override {
    return simulation_.positions(ids_[object]);
  }
  std::uint64_t version(std::size_t object) const override { return versions_[object]; }
  std::uint64_t step() const override { return simulation_.step_count(); }
  double time() const override { return simulation_.time(); }
  double motion_seconds() const override { return motion_seconds_; }
  const Simulation& simulation() const { return simulation_; }

  /// Detects with the options of `show`, which has the same objects, from now on. Their motion keeps its
  /// state. When it throws `Error`, nothing has changed.
  void set_detection(const SceneView& show);

  /// Takes one step. If a body cannot move, returns the reason and leaves everything unchanged.
  std::optional<std::string> take_step();

  /// Grabs a vertex. Returns the reason when that is impossible. The ids must exist.
  std::optional<std::string> grab(std::size_t object, std::uint32_t vertex, std::optional<double> radius);
  bool holds() const { return grip_.has_value(); }
  /// Sets the target of the held vertex. The next `settle` or step bends an object without motion, and
  /// carries a rigid one.
  void drag(const Vec3d& target);
  void release();
  /// True when an object in waves or of masses and springs is held and was dragged, so that only steps show
  /// the effect.
  bool needs_steps() const;
  /// Bends or carries the held object and detects again; false when nothing changed.
  bool settle();

 private:
  void add(const ViewedObject& object);
  void move_swaying(std::size_t object, double seconds, std::span<Vec3d> positions);
  void bend_held();
  void pull_held();
  bool moves_by_itself(std::size_t object) const { return show_.objects[object].motion.index() != 0; }
  bool is_rigid(std::size_t object) const {
    return std::holds_alternative<RigidMotion>(show_.objects[object].motion);
  }
  /// Only steps move the object.
  bool moves_in_steps(std::size_t object) const { return moves_by_itself(object) && !is_rigid(object); }

  const SceneView& show_;
  Simulation simulation_;
  std::vector<ObjectId> ids_;
  std::vector<std::uint64_t> versions_;
  double motion_seconds_ = 0;

  std::optional<Grip> grip_;
  bool is_dragged_ = false;  // since it was last bent
  bool is_detected_ = true;  // contacts match the current positions
  std::vector<bool> is_fixed_;
  std::vector<std::vector<Vec3d>> bends_;  // one per object, added to the waves; empty until bent
  Vec3d held_offset_;                      // of the held vertex of an object that waves move
  std::vector<Vec3d> scratch_;
};

}  // namespace supple::viewer
