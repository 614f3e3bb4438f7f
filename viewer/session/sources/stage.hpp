#pragma once

#include <cstdint>
#include <memory>

#include "program/program_source.hpp"
#include "scene_view.hpp"
#include "settings.hpp"
#include "sources/center.hpp"
#include "sources/recording_source.hpp"
#include "sources/simulation_source.hpp"

namespace supple::viewer {

/// A scene view with settings applied, and the source of its positions: a simulation, a recording or a
/// running program.
class Stage {
 public:
  /// A recording starts at `frame`. Throws `Error` when an object or an option is invalid.
  Stage(const SceneView& show, const Settings& settings, std::uint64_t frame = 0);
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  /// For a simulation: detects with the options of these settings from now on; `show` is the scene view of
  /// the constructor. The motion keeps its state. When it throws `Error`, nothing has changed.
  void set_detection(const SceneView& show, const Settings& settings);

  const SceneView& show() const { return show_; }
  const Center& center() const { return center_; }
  const Source& source() const;
  // Two of these are null.
  SimulationSource* simulation() { return simulation_.get(); }
  RecordingSource* recording() { return recording_.get(); }
  ProgramSource* program() { return program_.get(); }
  /// Whether the scene of the source can be read now.
  bool is_open() const { return !program_ || program_->is_open(); }
  /// False when time changes nothing.
  bool has_motion() const;

 private:
  SceneView show_;
  Center center_;
  std::unique_ptr<SimulationSource> simulation_;
  std::unique_ptr<RecordingSource> recording_;
  std::unique_ptr<ProgramSource> program_;
};

}  // namespace supple::viewer
