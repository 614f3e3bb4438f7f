#pragma once

#include <memory>
#include <vector>

#include "scene_view.hpp"
#include "source.hpp"

namespace supple::viewer {

/// The frames of a recording. Each is detected anew, so that it can be looked into as a simulation can: the
/// contacts of a frame depend on it alone, or, when they are continuous, on it and the frame before.
class RecordingSource final : public Source {
 public:
  /// At frame 0, or an empty recording's rest. The show must outlive it. Throws `Error` as `Scene` does, or
  /// when a frame cannot be read.
  explicit RecordingSource(const SceneView& show);

  const Scene& scene() const override { return scene_; }
  ObjectId id(std::size_t object) const override { return ids_[object]; }
  std::span<const Vec3d> positions(std::size_t object) const override { return objects_[object].now; }
  std::uint64_t version(std::size_t object) const override { return objects_[object].version; }
  std::uint64_t step() const override { return frame_; }
  double time() const override { return time_of(frame_); }
  double motion_seconds() const override { return read_seconds_; }

  std::uint64_t frame_count() const { return show_.frames->count(); }
  /// Seconds; never falls.
  double time_of(std::uint64_t frame) const;
  /// The last frame that is not later than `seconds`; 0 before the first.
  std::uint64_t frame_at(double seconds) const;
  /// Throws `Error` when the frame cannot be read; all is then as it was.
  void seek(std::uint64_t frame);

 private:
  struct Object {
    std::vector<Vec3d> now, before, next_now, next_before;
    bool is_on_path = false;  // in the scene, from the frame before
    std::uint64_t version = 1;
  };

  bool has_paths() const { return contains(scene_.options().contacts, ContactKinds::continuous); }
  void read(std::uint64_t frame);
  void place(std::size_t object, bool has_path);

  const SceneView& show_;
  Scene scene_;
  std::vector<ObjectId> ids_;
  std::vector<Object> objects_;
  std::vector<double> times_;  // of the frames, when the recording says them
  std::uint64_t frame_ = 0;
  double read_seconds_ = 0;
};

}  // namespace supple::viewer
