#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "scene_view.hpp"
#include "sources/source.hpp"

namespace supple::viewer {

/// The frames of a recording. Each frame is detected again, so that octrees and candidates can be shown as
/// in a simulation. The contacts of a frame depend on that frame only; continuous contacts also on the frame
/// before. The past of a simulation or a program is such a source, too (`History`).
class RecordingSource final : public Source {
 public:
  /// Starts at a frame, or in the rest pose when the recording is empty. `show` must outlive this object.
  /// Throws `Error` as `Scene` does, or when the frame cannot be read.
  explicit RecordingSource(const SceneView& show, std::uint64_t frame = 0);

  const Scene& scene() const override { return scene_; }
  ObjectId id(std::size_t object) const override { return ids_[object]; }
  std::span<const Vec3d> positions(std::size_t object) const override { return objects_[object].now; }
  std::uint64_t version(std::size_t object) const override { return objects_[object].version; }
  std::uint64_t step() const override { return frame_count() > 0 ? show_.frames->step(frame_) : 0; }
  double time() const override { return time_of(frame_); }
  double motion_seconds() const override { return read_seconds_; }

  std::uint64_t frame() const { return frame_; }
  std::uint64_t frame_count() const { return show_.frames->count(); }
  /// Whether the frame before shows the step before.
  bool has_path() const { return show_.frames->follows(frame_); }
  std::uint64_t last_frame() const { return std::max<std::uint64_t>(frame_count(), 1) - 1; }
  /// The last frame not after a step.
  std::uint64_t frame_of(std::uint64_t step) const;
  bool is_growing() const { return show_.frames->is_growing(); }
  /// Takes frames that were added; returns whether there are any. Throws `Error` as `Frames::refresh`.
  bool refresh();
  /// The time of a frame in seconds; never decreases.
  double time_of(std::uint64_t frame) const;
  /// The last frame not later than `seconds`; 0 before the first frame.
  std::uint64_t frame_at(double seconds) const;
  /// Throws `Error` when the frame cannot be read; the state is then unchanged.
  void seek(std::uint64_t frame);

 private:
  struct Object {
    std::vector<Vec3d> now, before, next_now, next_before;
    bool is_on_path = false;  // the scene has the path from the frame before
    std::uint64_t version = 1;
  };

  /// Whether objects move from their positions in the frame before to those of this frame.
  bool has_paths(std::uint64_t frame) const {
    return contains(scene_.options().contacts, ContactKinds::continuous) && show_.frames->follows(frame);
  }
  void read(std::uint64_t frame);
  void place(std::size_t object, bool has_path);

  const SceneView& show_;
  Scene scene_;
  std::vector<ObjectId> ids_;
  std::vector<Object> objects_;
  std::vector<double> times_;                // one per frame, when the recording has them
  std::uint64_t frame_ = ~std::uint64_t{0};  // none yet
  double read_seconds_ = 0;
};

}  // namespace supple::viewer
