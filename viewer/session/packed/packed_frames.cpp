#include "packed/packed_frames.hpp"

#include <algorithm>
#include <cstring>
#include <string>

#include "failure.hpp"

namespace supple::viewer {
namespace {

void append(std::vector<float>& coordinates, std::span<const Vec3d> positions, const Center& center) {
  for (const Vec3d& p : positions) {
    const std::array<float, 3> shown = center(p);
    coordinates.insert(coordinates.end(), shown.begin(), shown.end());
  }
}

/// Compares bits, so that NaN equals itself.
bool same(std::span<const Vec3d> a, std::span<const Vec3d> b) {
  return a.empty() || std::memcmp(a.data(), b.data(), a.size_bytes()) == 0;
}

}  // namespace

PackedFrames::PackedFrames(const Frames& frames, std::span<const ViewedObject> objects, const Vec3d& center)
    : count_(frames.count()), center_(center), tracks_(objects.size()), series_(frames.series()) {
  std::vector<Vec3d> positions;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const std::vector<Vec3d>& rest = objects[i].mesh.positions;
    bool moves = false;
    positions.resize(rest.size());
    for (std::uint64_t frame = 0; frame < count_ && !objects[i].options.is_static; ++frame) {
      frames.read(frame, i, positions);
      moves = moves || !same(positions, rest);
      append(tracks_[i].coordinates, positions, {center});
    }
    if (!moves) tracks_[i].coordinates = {};
  }
  fit_to(objects);
}

void PackedFrames::read(std::uint64_t frame, std::size_t object, std::span<Vec3d> positions) const {
  if (frame >= count_) {
    fail("there is no frame " + std::to_string(frame) + "; there are " + std::to_string(count_) +
         ", numbered from 0");
  }
  const std::vector<float>& coordinates = tracks_[object].coordinates;
  if (coordinates.empty()) {
    std::copy(rest_[object].begin(), rest_[object].end(), positions.begin());
    return;
  }
  const float* from = coordinates.data() + frame * 3 * positions.size();
  for (Vec3d& p : positions) {
    p = Vec3d{from[0], from[1], from[2]} + center_;
    from += 3;
  }
}

bool PackedFrames::fit_to(std::span<const ViewedObject> objects) {
  if (tracks_.size() != objects.size()) return false;
  rest_.resize(objects.size());
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const std::vector<Vec3d>& positions = objects[i].mesh.positions;
    const std::size_t size = tracks_[i].coordinates.size();
    if (size == 0)
      rest_[i] = positions;
    else if (count_ == 0 || size % count_ != 0 || size / count_ != 3 * positions.size())
      return false;
  }
  const auto exists = [&](const Series::Event& event) {
    return event.frame < count_ && event.a < objects.size() && event.b < objects.size();
  };
  const auto all_exist = [&](const Series::Events& events) {
    return std::all_of(events.begin.begin(), events.begin.end(), exists) &&
           std::all_of(events.end.begin(), events.end.end(), exists);
  };
  return all_exist(series_.contacts) && all_exist(series_.narrow_phase) && all_exist(series_.volumes) &&
         series_.values.size() == series_.names.size() * (series_.values.empty() ? 0 : count_);
}

}  // namespace supple::viewer
