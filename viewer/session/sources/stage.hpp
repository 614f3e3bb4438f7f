#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "history/history.hpp"
#include "program/program_source.hpp"
#include "scene_view.hpp"
#include "settings.hpp"
#include "sources/center.hpp"
#include "sources/recording_source.hpp"
#include "sources/simulation_source.hpp"

namespace supple::viewer {

/// A scene view with settings applied, and the source of its positions: a simulation, a recording or a
/// running program. It keeps the last steps of a simulation or a program, and can show them again.
class Stage {
 public:
  /// A recording starts at `frame`. Throws `Error` when an object or an option is invalid.
  Stage(const SceneView& show, const Settings& settings, double history_bytes, std::uint64_t frame = 0);
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  /// For a simulation or a program: detects with the options of these settings from now on; `show` is the
  /// scene view of the constructor. The motion keeps its state. The options of a program change only for its
  /// past. When it throws `Error`, nothing has changed.
  void set_detection(const SceneView& show, const Settings& settings);

  /// Keeps the present step.
  void keep();
  const History& history() const { return *history_; }
  /// Shows a kept step, which is detected again.
  void look_back(std::uint64_t frame);
  void look_at_present() { past_.reset(); }
  /// Null while the present is shown.
  RecordingSource* past() { return past_ ? past_->source.get() : nullptr; }
  /// The first and the last step that can be shown.
  std::array<std::uint64_t, 2> range() const;

  const SceneView& show() const { return past_ ? past_->show : show_; }
  const Center& center() const { return center_; }
  const Source& source() const;
  // Two of these are null.
  SimulationSource* simulation() { return simulation_.get(); }
  RecordingSource* recording() { return recording_.get(); }
  ProgramSource* program() { return program_.get(); }
  /// Whether the scene of the source can be read now.
  bool is_open() const { return !program_ || past_ || program_->is_open(); }
  /// False when time changes nothing.
  bool has_motion() const;

 private:
  /// A recording of the kept steps.
  struct Past {
    SceneView show;
    std::unique_ptr<RecordingSource> source{};
  };
  std::unique_ptr<Past> past_at(const SceneView& show, std::uint64_t frame) const;

  SceneView show_;
  Center center_;
  std::unique_ptr<SimulationSource> simulation_;
  std::unique_ptr<RecordingSource> recording_;
  std::unique_ptr<ProgramSource> program_;
  std::shared_ptr<History> history_;
  std::unique_ptr<Past> past_;
};

}  // namespace supple::viewer
