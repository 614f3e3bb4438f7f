#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene_view.hpp"
#include "sources/center.hpp"

namespace supple::viewer {

/// Frames in memory as floats. Objects that never move have only their first frame.
class PackedFrames final : public Frames {
 public:
  /// The frames of one object one after the other, minus a center. Empty when the object rests at the
  /// positions of its mesh.
  struct Track {
    std::vector<float> coordinates{};
  };

  PackedFrames() = default;
  /// Reads all frames. Throws `Error` when one cannot be read.
  PackedFrames(const Frames& frames, std::span<const ViewedObject> objects, const Vec3d& center);

  std::uint64_t count() const override { return count_; }
  void read(std::uint64_t frame, std::size_t object, std::span<Vec3d> positions) const override;
  const Series& series() const override { return series_; }

  /// Call after unpacking: sets the positions of objects at rest. Returns false when the tracks do not match
  /// the objects.
  bool fit_to(std::span<const ViewedObject> objects);

  friend void fields(auto& archive, PackedFrames& frames) {
    archive(frames.count_, frames.center_, frames.tracks_, frames.series_);
  }
  friend void fields(auto& archive, const PackedFrames& frames) {
    archive(frames.count_, frames.center_, frames.tracks_, frames.series_);
  }

 private:
  std::uint64_t count_ = 0;
  Vec3d center_{};
  std::vector<Track> tracks_;
  Series series_;
  std::vector<std::vector<Vec3d>> rest_;  // positions of objects that do not move
};

void fields(auto& archive, PackedFrames::Track& track) {
  archive(track.coordinates);
}
void fields(auto& archive, const PackedFrames::Track& track) {
  archive(track.coordinates);
}

}  // namespace supple::viewer
