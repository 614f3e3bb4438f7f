#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "pins/pin_meter.hpp"
#include "pins/pin_rows.hpp"
#include "scene_view.hpp"
#include "sources/recording_source.hpp"

namespace supple::viewer {

/// Measures pins in all frames of a recording, one frame at a time, in a scene of its own. The scene exists
/// only while there are frames to measure.
class PinSurvey {
 public:
  /// Replaces the pins. New ones are measured from the first frame on.
  void set(std::span<const Pin> pins);
  /// Call when the recording is shown by another source, and without a page. There are no pins then.
  void clear();
  /// Leaves out the frames that are not yet measured.
  void stop();
  /// How many frames are measured, and how many there are; nothing when all are.
  std::optional<std::array<std::uint64_t, 2>> progress(const RecordingSource& shown) const;
  /// Measures the next frame; there must be one. `show` and `shown` must outlive this object, or be followed
  /// by `clear`. Throws `Error` when the frame cannot be read.
  void measure_next(const SceneView& show, const RecordingSource& shown, PinRows& rows);

 private:
  bool knows(std::uint32_t number) const;

  std::vector<std::uint32_t> known_;  // the numbers of all pins
  std::vector<Pin> pins_;             // that lack frames
  PinMeter meter_;
  std::unique_ptr<RecordingSource> source_;
  std::uint64_t next_ = 0;  // frame
  std::vector<PinRow> found_;
};

}  // namespace supple::viewer
