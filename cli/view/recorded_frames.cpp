#include "view/recorded_frames.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <limits>
#include <system_error>
#include <vector>

#include "session/messages/frame_message.hpp"
#include "supple/error.hpp"

namespace supple::cli {

RecordedFrames::RecordedFrames(std::string path, std::shared_ptr<const Recording> recording, bool is_growing)
    : path_(std::move(path)), recording_(std::move(recording)), is_growing_(is_growing) {
  objects_ = objects_of(*recording_);
  std::uint32_t place = 0;
  for (const RecordedObject& object : recording_->header().objects) places_.emplace(object.id, place++);
  // The same names as in frames, so that a page plots both in the same way.
  series_.names.emplace_back("time");
  viewer::for_each_statistic({}, [&](const char* name, double) { series_.names.emplace_back(name); });
  file_ = state_of_file();
  Progress progress(recording_->frame_count(), true);
  read_series(&progress);
}

void RecordedFrames::read(std::uint64_t frame, std::size_t object, std::span<Vec3d> positions) const {
  const std::vector<Vec3d> recorded = recording().positions(frame, object);
  std::copy(recorded.begin(), recorded.end(), positions.begin());
}

RecordedFrames::FileState RecordedFrames::state_of_file() const {
  std::error_code error;  // a file that is gone has changed
  return {std::filesystem::last_write_time(path_, error), std::filesystem::file_size(path_, error)};
}

/// Reads the series of frames that it does not have.
void RecordedFrames::read_series(Progress* progress) {
  const std::uint64_t all = recording_->frame_count();
  for (; count_ < all; ++count_) {
    const RecordedFrame frame = recording_->summary(count_);
    series_.values.push_back(frame.time);
    viewer::for_each_statistic(frame.stats,
                               [&](const char*, double value) { series_.values.push_back(value); });
    const auto add = [&](const std::vector<ObjectPair>& pairs, std::vector<viewer::Series::Event>& events) {
      for (const ObjectPair& pair : pairs)
        events.push_back({static_cast<std::uint32_t>(count_), places_.at(pair.a), places_.at(pair.b)});
    };
    add(frame.contact_events.begin, series_.contacts.begin);
    add(frame.contact_events.end, series_.contacts.end);
    add(frame.narrow_phase_events.begin, series_.narrow_phase.begin);
    add(frame.narrow_phase_events.end, series_.narrow_phase.end);
    add(frame.volume_events.begin, series_.volumes.begin);
    add(frame.volume_events.end, series_.volumes.end);
    if (progress != nullptr)
      progress->update(count_ + 1, fmt::format("reading frame {} of {}", count_ + 1, all));
  }
}

std::vector<RecordedFrames::Object> RecordedFrames::objects_of(const Recording& recording) {
  std::vector<Object> objects;
  for (const RecordedObject& object : recording.header().objects)
    objects.emplace_back(object.id, object.options.name, object.rest_positions.size(),
                         object.triangles.size());
  return objects;
}

const Recording& RecordedFrames::recording() const {
  if (recording_ == nullptr) recording_ = std::make_shared<const Recording>(path_);
  return *recording_;
}

bool RecordedFrames::refresh() {
  if (!is_growing_) return false;
  const FileState now = state_of_file();
  if (now == file_) return false;
  file_ = now;
  recording_.reset();
  try {
    recording();
  } catch (const Error&) {
    return false;  // it is being replaced; the next change is looked at again
  }
  if (recording_->frame_count() < count_ || objects_of(*recording_) != objects_) {
    is_growing_ = false;
    throw Error(path_ + ": was recorded again; open it again");
  }
  const std::uint64_t before = count_;
  read_series(nullptr);
  return count_ > before;
}

ComparedFrames::ComparedFrames(std::shared_ptr<const viewer::Frames> a,
                               std::shared_ptr<const viewer::Frames> b, std::size_t objects_of_a)
    : a_(std::move(a)),
      b_(std::move(b)),
      objects_of_a_(objects_of_a),
      count_(std::max(a_->count(), b_->count())) {
  const viewer::Series &first = a_->series(), &second = b_->series();
  series_.names = first.names;
  for (std::size_t i = 1; i < second.names.size(); ++i) series_.names.push_back(second.names[i] + "_b");
  const auto add_row = [&](const viewer::Series& series, std::uint64_t frame, std::size_t from) {
    const std::size_t width = series.names.size();
    for (std::size_t i = from; i < width; ++i) {
      const std::size_t place = static_cast<std::size_t>(frame) * width + i;
      series_.values.push_back(place < series.values.size() ? series.values[place]
                                                            : std::numeric_limits<double>::quiet_NaN());
    }
  };
  const viewer::Series& longer = a_->count() >= b_->count() ? first : second;
  for (std::uint64_t frame = 0; frame < count_; ++frame) {
    series_.values.push_back(longer.values[static_cast<std::size_t>(frame) * longer.names.size()]);
    add_row(first, frame, 1);
    add_row(second, frame, 1);
  }
  const auto add = [](viewer::Series::Events& to, const viewer::Series::Events& from, std::uint32_t shift) {
    for (const auto side : {&viewer::Series::Events::begin, &viewer::Series::Events::end}) {
      for (const viewer::Series::Event& event : from.*side)
        (to.*side).push_back({event.frame, event.a + shift, event.b + shift});
    }
  };
  for (const auto kind :
       {&viewer::Series::contacts, &viewer::Series::narrow_phase, &viewer::Series::volumes}) {
    add(series_.*kind, first.*kind, 0);
    add(series_.*kind, second.*kind, static_cast<std::uint32_t>(objects_of_a_));
  }
}

void ComparedFrames::read(std::uint64_t frame, std::size_t object, std::span<Vec3d> positions) const {
  const bool is_of_a = object < objects_of_a_;
  const viewer::Frames& frames = is_of_a ? *a_ : *b_;
  frames.read(std::min(frame, frames.count() - 1), is_of_a ? object : object - objects_of_a_, positions);
}

}  // namespace supple::cli
