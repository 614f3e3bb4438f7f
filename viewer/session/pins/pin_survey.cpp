#include "pins/pin_survey.hpp"

#include <algorithm>
#include <utility>

namespace supple::viewer {

bool PinSurvey::knows(std::uint32_t number) const {
  return std::find(known_.begin(), known_.end(), number) != known_.end();
}

void PinSurvey::set(std::span<const Pin> pins) {
  std::vector<Pin> lacking;
  bool has_new = false;
  for (const Pin& pin : pins) {
    const bool is_new = !knows(pin.number);
    const bool is_lacking =
        std::any_of(pins_.begin(), pins_.end(), [&](const Pin& other) { return other.number == pin.number; });
    if (is_new || is_lacking) lacking.push_back(pin);
    has_new = has_new || is_new;
  }
  if (has_new) {
    next_ = 0;
    meter_.forget();
  }
  known_.clear();
  for (const Pin& pin : pins) known_.push_back(pin.number);
  pins_ = std::move(lacking);
  meter_.set(pins_);
  if (pins_.empty()) source_.reset();
}

void PinSurvey::clear() {
  known_.clear();
  stop();
}

void PinSurvey::stop() {
  pins_.clear();
  source_.reset();
}

std::optional<std::array<std::uint64_t, 2>> PinSurvey::progress(const RecordingSource& shown) const {
  if (pins_.empty() || next_ >= shown.frame_count()) return std::nullopt;
  return std::array{next_, shown.frame_count()};
}

void PinSurvey::measure_next(const SceneView& show, const RecordingSource& shown, PinRows& rows) {
  if (source_ != nullptr)
    source_->seek(next_);
  else
    source_ = std::make_unique<RecordingSource>(show, next_);
  meter_.measure(source_->scene(), source_->step(), shown.time_of(next_), found_);
  rows.add(found_);
  found_.clear();
  ++next_;
  if (next_ >= shown.frame_count() && !shown.is_growing()) stop();
}

}  // namespace supple::viewer
