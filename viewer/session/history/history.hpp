#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "scene_view.hpp"
#include "sources/source.hpp"

namespace supple::viewer {

/// The last steps of a simulation or a program, within a memory budget: the positions of its objects, exactly
/// as they were. Each step is a frame.
class History final : public Frames {
 public:
  /// Keeps the last two steps also when they need more `bytes`. With 0 bytes it keeps nothing.
  History(double bytes, std::size_t object_count) : most_bytes_(bytes), spare_(object_count) {}

  /// Keeps the present state. It replaces the last one when the step is the same. When memory runs out,
  /// nothing is kept any more.
  void keep(const Source& source);

  std::uint64_t count() const override { return steps_.size(); }
  void read(std::uint64_t frame, std::size_t object, std::span<Vec3d> positions) const override;
  const Series& series() const override { return series_; }
  std::uint64_t step(std::uint64_t frame) const override { return at(frame).number; }
  double time(std::uint64_t frame) const { return series_.values[static_cast<std::size_t>(frame)]; }
  /// False when steps between the two are missing.
  bool follows(std::uint64_t frame) const override { return frame > 0 && step(frame) == step(frame - 1) + 1; }
  std::uint64_t frame_of(std::uint64_t step) const override;
  /// The first frame to show: one of which the step before is kept, for continuous contacts, or step 0.
  std::uint64_t first() const { return steps_.size() > 1 && steps_[0].number > 0 ? 1 : 0; }

 private:
  using Positions = std::shared_ptr<std::vector<Vec3d>>;
  struct Step {
    std::uint64_t number = 0;
    std::vector<Positions> objects{};  ///< steps share the positions of objects that did not move
  };

  const Step& at(std::uint64_t frame) const { return steps_[static_cast<std::size_t>(frame)]; }
  void clear();
  void add(const Source& source, double needed, bool is_same_step);
  bool has_moved(const Source& source, std::size_t object) const {
    return versions_.empty() || versions_[object] != source.version(object);
  }
  void make_room(double bytes);
  void drop_first();
  Positions copy(std::size_t object, std::span<const Vec3d> positions);
  void put_back(std::size_t object, Positions& positions);

  double most_bytes_, bytes_ = 0;
  std::vector<Step> steps_;
  std::vector<std::uint64_t> versions_;        // one per object, of the last step
  std::vector<std::vector<Positions>> spare_;  // one list per object: memory of steps that were dropped
  std::vector<Step> spare_steps_;
  Series series_{{"time"}, {}, {}, {}, {}};
};

}  // namespace supple::viewer
