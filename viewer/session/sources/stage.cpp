#include "sources/stage.hpp"

#include <algorithm>
#include <utility>

#include "sources/extent.hpp"

namespace supple::viewer {

Stage::Stage(const SceneView& show, const Settings& settings, double history_bytes, std::uint64_t frame)
    : show_(arranged(show, settings)),
      center_{extent_of(show_).center()},
      history_(std::make_shared<History>(history_bytes, show_.objects.size())) {
  if (show_.program != nullptr) {
    program_ = std::make_unique<ProgramSource>(show_);
  } else if (show_.frames == nullptr) {
    simulation_ = std::make_unique<SimulationSource>(show_);
  } else {
    recording_ = std::make_unique<RecordingSource>(show_, frame);
  }
}

void Stage::set_detection(const SceneView& show, const Settings& settings) {
  SceneView changed = arranged(show, settings);
  auto past = past_ ? past_at(changed, past_->source->frame()) : nullptr;
  if (program_ != nullptr) {
    past_ = std::move(past);
    return;
  }
  simulation_->set_detection(changed);
  show_ = std::move(changed);
  past_ = std::move(past);
}

void Stage::keep() {
  history_->keep(source());
}

std::unique_ptr<Stage::Past> Stage::past_at(const SceneView& show, std::uint64_t frame) const {
  auto past = std::make_unique<Past>(Past{show});
  past->show.program.reset();
  past->show.frames = history_;
  // The steps of a program without time are shown as a film.
  constexpr double film_seconds = 0.04;
  if (!(past->show.simulation.time_step > 0)) past->show.simulation.time_step = film_seconds;
  past->source = std::make_unique<RecordingSource>(past->show, frame);
  return past;
}

void Stage::look_back(std::uint64_t frame) {
  if (past_)
    past_->source->seek(frame);
  else
    past_ = past_at(show_, frame);
}

std::array<std::uint64_t, 2> Stage::range() const {
  if (recording_) return {0, recording_->last_frame()};
  if (history_->count() > 0)
    return {history_->step(history_->first()), history_->step(history_->count() - 1)};
  return {source().step(), source().step()};
}

const Source& Stage::source() const {
  if (past_) return *past_->source;
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
