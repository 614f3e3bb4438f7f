#pragma once

#include <cstdint>
#include <memory>

#include "center.hpp"
#include "recording_source.hpp"
#include "scene_view.hpp"
#include "settings.hpp"
#include "simulation_source.hpp"

namespace supple::viewer {

/// A show as the settings have it, and where its objects come from: a simulation or a recording.
class Stage {
 public:
  /// A recording begins at `frame`. Throws `Error` when an object or an option is not what it should be.
  Stage(const SceneView& show, const Settings& settings, std::uint64_t frame = 0);
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  const SceneView& show() const { return show_; }
  const Center& center() const { return center_; }
  const Source& source() const;
  SimulationSource* simulation() { return simulation_.get(); }  ///< null of a recording
  RecordingSource* recording() { return recording_.get(); }     ///< null of a simulation
  /// False when playing would change nothing.
  bool has_motion() const;

 private:
  SceneView show_;
  Center center_;
  std::unique_ptr<SimulationSource> simulation_;
  std::unique_ptr<RecordingSource> recording_;
};

}  // namespace supple::viewer
