#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "center.hpp"
#include "scene_view.hpp"

namespace supple::viewer {

/// Frames in memory, as floats; of what never moves only the first.
class PackedFrames final : public Frames {
 public:
  /// What is packed of an object: its frames one after the other, minus a center, or nothing when it rests
  /// where its mesh is.
  struct Track {
    std::vector<float> coordinates{};
  };

  PackedFrames() = default;
  /// Reads all of them. Throws `Error` when one cannot be read.
  PackedFrames(const Frames& frames, std::span<const ViewedObject> objects, const Vec3d& center);

  std::uint64_t count() const override { return count_; }
  void read(std::uint64_t frame, std::size_t object, std::span<Vec3d> positions) const override;
  const Series& series() const override { return series_; }

  /// After unpacking: where objects rest. False when the tracks do not fit to them.
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
  std::vector<std::vector<Vec3d>> rest_;  // of what does not move
};

void fields(auto& archive, PackedFrames::Track& track) {
  archive(track.coordinates);
}
void fields(auto& archive, const PackedFrames::Track& track) {
  archive(track.coordinates);
}

}  // namespace supple::viewer
