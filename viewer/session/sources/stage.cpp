#include "sources/stage.hpp"

#include <algorithm>
#include <utility>

#include "sources/extent.hpp"

namespace supple::viewer {

Stage::Stage(const SceneView& show, const Settings& settings, std::uint64_t frame)
    : show_(arranged(show, settings)), center_{extent_of(show_).center()} {
  if (show_.program != nullptr) {
    program_ = std::make_unique<ProgramSource>(show_);
    return;
  }
  if (show_.frames == nullptr) {
    simulation_ = std::make_unique<SimulationSource>(show_);
    return;
  }
  recording_ = std::make_unique<RecordingSource>(show_);
  if (frame > 0) recording_->seek(frame);
}

void Stage::set_detection(const SceneView& show, const Settings& settings) {
  SceneView changed = arranged(show, settings);
  simulation_->set_detection(changed);
  show_ = std::move(changed);
}

const Source& Stage::source() const {
  if (program_) return *program_;
  return simulation_ ? static_cast<const Source&>(*simulation_) : *recording_;
}

bool Stage::has_motion() const {
  if (program_) return true;
  if (recording_) return recording_->frame_count() > 1;
  return std::any_of(show_.objects.begin(), show_.objects.end(),
                     [](const ViewedObject& object) { return object.motion.index() != 0; });
}

}  // namespace supple::viewer
