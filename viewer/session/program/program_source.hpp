#pragma once

#include <optional>
#include <vector>

#include "messages/json_text.hpp"
#include "program.hpp"
#include "scene_view.hpp"
#include "sources/center.hpp"
#include "sources/source.hpp"

namespace supple::viewer {

/// The scene of a running program, which can be read while the program waits. Objects have the index of their
/// id, so an object that was removed leaves an object without vertices.
class ProgramSource final : public Source {
 public:
  /// `show` must outlive this object.
  explicit ProgramSource(const SceneView& show);
  ~ProgramSource() override { program().leave(); }

  const Scene& scene() const override { return *step_->scene; }
  ContactKinds contacts() const override { return step_->contacts; }
  ObjectId id(std::size_t object) const override { return ids_[object]; }
  std::span<const Vec3d> positions(std::size_t object) const override { return positions_[object]; }
  std::uint64_t version(std::size_t object) const override { return versions_[object]; }
  std::uint64_t step() const override { return state_.last_step; }
  double time() const override { return static_cast<double>(step()) * program().time_step(); }
  double motion_seconds() const override { return read_seconds_; }

  Program& program() const { return *show_.program; }
  const ProgramState& state() const { return state_; }
  /// Whether the scene can be read now.
  bool is_open() const { return step_ != nullptr; }
  /// Enters the step at which the program waits, or leaves it when the program must go on. Returns whether
  /// there is something new.
  bool advance();
  /// Leaves the step.
  void leave();
  void add_to(JsonText& json, const Center& center) const override;
  /// The objects of the scene when they are no longer those of the scene view.
  std::optional<SceneView> changed_view() const;

 private:
  void read_positions();

  const SceneView& show_;
  std::vector<ObjectId> ids_;
  std::vector<std::vector<Vec3d>> positions_;
  std::vector<std::uint64_t> versions_;
  std::vector<Vec3d> scratch_;
  ProgramState state_;
  std::uint64_t read_count_ = 0;  // `step_count` of the positions
  double read_seconds_ = 0;
  const ProgramStep* step_ = nullptr;
};

/// What a session shows of a program: the objects of its scene as they are now.
SceneView view_of_program(const Scene& scene, std::shared_ptr<Program> program, std::string title);

}  // namespace supple::viewer
