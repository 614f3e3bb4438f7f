#include "sources/recording_source.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>

#include "sources/start.hpp"

namespace supple::viewer {
namespace {

/// Compares bits, so that NaN equals itself.
bool same(const std::vector<Vec3d>& a, const std::vector<Vec3d>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Vec3d)) == 0);
}

/// The first column of the series, when it has one row per frame and grows.
std::vector<double> times_of(const Frames& frames) {
  const Series& series = frames.series();
  const std::size_t columns = series.names.size();
  if (columns == 0 || series.values.size() != columns * frames.count()) return {};
  std::vector<double> times;
  for (std::size_t row = 0; row < series.values.size(); row += columns) {
    const double time = series.values[row];
    if (!std::isfinite(time) || (!times.empty() && time < times.back())) return {};
    times.push_back(time);
  }
  if (times.size() > 1 && times.front() == times.back()) return {};
  return times;
}

}  // namespace

RecordingSource::RecordingSource(const SceneView& show, std::uint64_t frame)
    : show_(show), scene_(show.simulation.scene), times_(times_of(*show.frames)) {
  if (show.comparison) scene_.set_pair_filter(filter_of(*show.comparison));
  for (const ViewedObject& object : show.objects) {
    ids_.push_back(scene_.add(object.mesh, object.options));
    objects_.emplace_back().now = object.mesh.positions;
  }
  if (frame_count() > 0) {
    seek(frame);
  } else {
    frame_ = 0;
    scene_.detect();
  }
}

bool RecordingSource::refresh() {
  if (!show_.frames->refresh()) return false;
  times_ = times_of(*show_.frames);
  return true;
}

double RecordingSource::time_of(std::uint64_t frame) const {
  if (frame < times_.size()) return times_[static_cast<std::size_t>(frame)];
  return static_cast<double>(frame) * show_.simulation.time_step;
}

std::uint64_t RecordingSource::frame_of(std::uint64_t step) const {
  return std::min(show_.frames->frame_of(step), last_frame());
}

std::uint64_t RecordingSource::frame_at(double seconds) const {
  if (!times_.empty()) {
    const auto after = std::upper_bound(times_.begin(), times_.end(), seconds);
    return after == times_.begin() ? 0 : static_cast<std::uint64_t>(after - times_.begin()) - 1;
  }
  // The factor keeps rounding from selecting the frame before.
  const double frame = std::floor(seconds / show_.simulation.time_step * (1 + 1e-12));
  return frame > 0 ? static_cast<std::uint64_t>(std::min(frame, static_cast<double>(last_frame()))) : 0;
}

void RecordingSource::seek(std::uint64_t frame) {
  const auto start = std::chrono::steady_clock::now();
  read(frame);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  read_seconds_ = std::max(taken.count(), 0.0);
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    if (!show_.objects[i].options.is_static) place(i, has_paths(frame));
  }
  frame_ = frame;
  scene_.detect();
}

/// Does everything that may fail.
void RecordingSource::read(std::uint64_t frame) {
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    if (show_.objects[i].options.is_static) continue;
    Object& object = objects_[i];
    object.next_now.resize(object.now.size());
    show_.frames->read(frame, i, object.next_now);
    if (!has_paths(frame)) continue;
    object.next_before.resize(object.now.size());
    if (frame == frame_ + 1)
      object.next_before = object.now;
    else
      show_.frames->read(frame - 1, i, object.next_before);
  }
}

void RecordingSource::place(std::size_t number, bool has_path) {
  Object& object = objects_[number];
  const bool has_moved = !same(object.now, object.next_now);
  if (has_moved) {
    object.now.swap(object.next_now);
    ++object.version;
  }
  if (has_path) {
    object.before.swap(object.next_before);
    scene_.set_motion(ids_[number], object.before, object.now);
  } else if (has_moved || object.is_on_path) {
    scene_.set_positions(ids_[number], object.now);
  }
  object.is_on_path = has_path;
}

}  // namespace supple::viewer
