#include "inputs/clips.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/text.hpp"
#include "supple/point_cache.hpp"

namespace supple::cli {
namespace {

std::vector<std::string> names_of(const AnimatedMesh& animation) {
  std::vector<std::string> names;
  for (const AnimationClip& clip : animation.clips()) names.push_back(one_line(clip.name));
  return names;
}

}  // namespace

ClipPlayer::ClipPlayer(const std::filesystem::path& path, const std::optional<std::string>& clip)
    : file_(path.string()), animation_(path) {
  const std::vector<std::string> names = names_of(animation_);
  if (names.empty()) fail("{}: has no clips; it is a mesh without an animation that moves it", file_);
  if (!clip) return;
  const auto found = std::find(names.begin(), names.end(), one_line(*clip));
  if (found == names.end())
    fail("{}: has no clip '{}'; choose one of {}", file_, *clip, fmt::join(names, ", "));
  clip_ = static_cast<std::size_t>(found - names.begin());
}

std::string ClipPlayer::note(const std::optional<std::string>& chosen, const char* how) const {
  const std::vector<std::string> names = names_of(animation_);
  if (chosen || names.size() == 1) return {};
  return one_line(fmt::format("{}: plays '{}', the first of {} clips; {} chooses one of {}", file_, names[0],
                              names.size(), how, fmt::join(names, ", ")));
}

void ClipPlayer::pose(double time, const CoordinateConversion& conversion, std::span<Vec3d> positions) const {
  animation_.positions(clip_, time, positions);
  convert(positions, animation_.frame(), conversion);
}

ComputedMotion ClipPlayer::frames(const ClipOptions& options, const CoordinateConversion& conversion) const {
  const double start = clip().start, seconds = clip().end - start;
  if (options.frames && !options.fps) {
    const std::uint64_t count = *options.frames;
    return {count,
            [*this, start, seconds, count, conversion](std::uint64_t frame, std::span<Vec3d> positions) {
              const auto last = static_cast<double>(std::max<std::uint64_t>(count, 2) - 1);
              pose(start + seconds * (static_cast<double>(frame) / last), conversion, positions);
            }};
  }
  const double fps = options.fps.value_or(film_rate);
  constexpr double most_frames = 1e9;
  // A clip of 1 s has 26 frames at 25 per second, also when the quotient is rounded.
  const double steps = std::floor(seconds * fps * (1 + 1e-12));
  if (steps >= most_frames)
    fail("{}: the clip has {} s, which are more than {:.0f} frames; give a lower --fps", file_, seconds,
         most_frames);
  return {static_cast<std::uint64_t>(steps) + 1,
          [*this, start, fps, conversion](std::uint64_t frame, std::span<Vec3d> positions) {
            pose(start + static_cast<double>(frame) / fps, conversion, positions);
          }};
}

ComputedMotion ClipPlayer::steps(double time_step, double speed, bool loop,
                                 const CoordinateConversion& conversion, const Placement& placement) const {
  const double start = clip().start, seconds = clip().end - start;
  const double steps = seconds / (time_step * speed);
  const std::uint64_t count =
      steps < 1e9 ? static_cast<std::uint64_t>(std::floor(steps * (1 + 1e-12))) + 1 : 1'000'000'000;
  return {count, [=, *this](std::uint64_t frame, std::span<Vec3d> positions) {
            double time = static_cast<double>(frame) * time_step * speed;
            if (loop && seconds > 0) time = std::fmod(time, seconds);
            pose(start + time, conversion, positions);
            place(positions, placement);
          }};
}

ComputedMotion play_cache(const std::filesystem::path& path, std::size_t vertices, bool loop,
                          const Placement& placement) {
  const PointCache cache(path);
  if (cache.vertex_count() != vertices)
    fail("{}: has {} vertices, but the mesh has {}; export both from the same mesh", path.string(),
         cache.vertex_count(), vertices);
  return {cache.frame_count(), [=](std::uint64_t frame, std::span<Vec3d> positions) {
            const std::uint64_t count = cache.frame_count();
            cache.positions(loop ? frame % count : std::min(frame, count - 1), positions);
            place(positions, placement);
          }};
}

}  // namespace supple::cli
