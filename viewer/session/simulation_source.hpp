#pragma once

#include <optional>
#include <string>
#include <vector>

#include "grip.hpp"
#include "scene_view.hpp"
#include "source.hpp"
#include "supple/simulation.hpp"

namespace supple::viewer {

/// Objects that move by themselves, and that a person can take hold of.
class SimulationSource final : public Source {
 public:
  /// The show must outlive it. Detects at the start. Throws `Error` as `Simulation` does.
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

  /// Moves everything on by one step. Gives why a body could not be moved on, everything being as before; or
  /// nothing.
  std::optional<std::string> take_step();

  /// Holds a vertex; says why it cannot, or nothing. The numbers exist.
  std::optional<std::string> grab(std::size_t object, std::uint32_t vertex, std::optional<double> radius);
  bool holds() const { return grip_.has_value(); }
  /// To where the vertex that is held shall go. An object without motion is bent by the next `settle` or
  /// step.
  void drag(const Vec3d& target);
  void release();
  /// What is held moves by itself and was dragged: only steps can show where it goes.
  bool needs_steps() const;
  /// Bends what is held and detects again; false when there was nothing to do.
  bool settle();

 private:
  void add(const ViewedObject& object);
  void move_swaying(std::size_t object, double seconds, std::span<Vec3d> positions);
  void bend_held();
  void pull_held();
  bool moves_by_itself(std::size_t object) const { return show_.objects[object].motion.index() != 0; }

  const SceneView& show_;
  Simulation simulation_;
  std::vector<ObjectId> ids_;
  std::vector<std::uint64_t> versions_;
  double motion_seconds_ = 0;

  std::optional<Grip> grip_;
  bool is_dragged_ = false;  // since it was last bent
  bool is_detected_ = true;  // everything where it is now
  std::vector<bool> is_fixed_;
  std::vector<std::vector<Vec3d>> bends_;  // by object, added to waves; empty until bent
  Vec3d held_offset_;                      // of the swaying vertex that is held
  std::vector<Vec3d> scratch_;
};

}  // namespace supple::viewer
