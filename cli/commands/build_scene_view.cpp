#include "commands/build_scene_view.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <system_error>
#include <utility>
#include <variant>

#include "base/progress.hpp"
#include "base/text.hpp"
#include "export/embedded.hpp"
#include "inputs/frame_files.hpp"
#include "session/messages/statistics.hpp"
#include "supple/error.hpp"

namespace supple::cli {
namespace {

template <class Kind>
const Kind* motion_of(const InputObject& object) {
  return object.motion ? std::get_if<Kind>(&*object.motion) : nullptr;
}

template <class Kind>
bool has_motion(const Input& input) {
  return std::any_of(input.objects.begin(), input.objects.end(),
                     [](const InputObject& object) { return motion_of<Kind>(object) != nullptr; });
}

/// A scene in which files move some objects and waves move others.
class FileFrames : public viewer::Frames {
 public:
  explicit FileFrames(const Input& input) : simulation_(input.simulation) {
    for (const InputObject& object : input.objects) objects_.push_back(mover(object));
    for (const InputObject& object : input.objects) {
      if (const auto* sequence = motion_of<FrameSequence>(object))
        count_ = std::max<std::uint64_t>(count_, sequence->files.size());
      if (const auto* motion = motion_of<ComputedMotion>(object)) count_ = std::max(count_, motion->count);
    }
  }

  std::uint64_t count() const override { return count_; }
  void read(std::uint64_t frame, std::size_t object, std::span<Vec3d> positions) const override {
    objects_[object](frame, positions);
  }
  const viewer::Series& series() const override { return series_; }

 private:
  using Mover = std::function<void(std::uint64_t frame, std::span<Vec3d> positions)>;

  Mover mover(const InputObject& object) const {
    if (const auto* sequence = motion_of<FrameSequence>(object)) {
      const auto files = std::make_shared<const FrameFiles>(*sequence, object.mesh);
      return [files](std::uint64_t frame, std::span<Vec3d> positions) { files->read(frame, positions); };
    }
    if (const auto* motion = motion_of<ComputedMotion>(object)) return motion->positions;
    const auto rest = std::make_shared<const std::vector<Vec3d>>(object.mesh.positions);
    if (const auto* motion = motion_of<WaveMotion>(object)) {
      return [this, motion = *motion, rest](std::uint64_t frame, std::span<Vec3d> positions) {
        apply_wave_motion(motion, simulation_.border, *rest,
                          static_cast<double>(frame) * simulation_.time_step, positions);
      };
    }
    return [rest](std::uint64_t, std::span<Vec3d> positions) {
      std::copy(rest->begin(), rest->end(), positions.begin());
    };
  }

  SimulationOptions simulation_;
  std::vector<Mover> objects_;
  std::uint64_t count_ = 0;
  viewer::Series series_;
};

/// A recording. All objects move except static ones.
class RecordedFrames : public viewer::Frames {
 public:
  RecordedFrames(std::shared_ptr<const Recording> recording, const ViewOptions& options)
      : path_(options.inputs.front()), recording_(std::move(recording)), is_growing_(options.follow) {
    std::uint32_t place = 0;
    for (const RecordedObject& object : recording_->header().objects) places_.emplace(object.id, place++);
    // The same names as in frames, so that a page plots both in the same way.
    series_.names.emplace_back("time");
    viewer::for_each_statistic({}, [&](const char* name, double) { series_.names.emplace_back(name); });
    file_ = state_of_file();
    Progress progress(recording_->frame_count(), true);
    read_series(&progress);
  }

  /// Frames that were added are counted when their series has been read.
  std::uint64_t count() const override { return count_; }
  void read(std::uint64_t frame, std::size_t object, std::span<Vec3d> positions) const override {
    const std::vector<Vec3d> recorded = recording_->positions(frame, object);
    std::copy(recorded.begin(), recorded.end(), positions.begin());
  }
  const viewer::Series& series() const override { return series_; }
  bool is_growing() const override { return is_growing_; }
  bool refresh() override;

 private:
  using FileState = std::pair<std::filesystem::file_time_type, std::uintmax_t>;  // last change, size

  FileState state_of_file() const {
    std::error_code error;  // a file that is gone has changed
    return {std::filesystem::last_write_time(path_, error), std::filesystem::file_size(path_, error)};
  }
  bool continues(const Recording& recording) const;
  void read_series(Progress* progress);

  std::string path_;
  std::shared_ptr<const Recording> recording_;
  std::map<ObjectId, std::uint32_t> places_;
  std::uint64_t count_ = 0;
  viewer::Series series_;
  bool is_growing_;
  FileState file_;
};

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

bool RecordedFrames::continues(const Recording& recording) const {
  const auto& before = recording_->header().objects;
  const auto& now = recording.header().objects;
  return recording.frame_count() >= count_ &&
         std::equal(before.begin(), before.end(), now.begin(), now.end(),
                    [](const RecordedObject& a, const RecordedObject& b) {
                      return a.id == b.id && a.options.name == b.options.name && a.triangles == b.triangles &&
                             a.rest_positions.size() == b.rest_positions.size();
                    });
}

bool RecordedFrames::refresh() {
  if (!is_growing_) return false;
  const FileState now = state_of_file();
  if (now == file_) return false;
  file_ = now;
  std::shared_ptr<const Recording> recording;
  try {
    recording = std::make_shared<const Recording>(path_);
  } catch (const Error&) {
    return false;  // it is being replaced; the next change is looked at again
  }
  if (!continues(*recording)) {
    is_growing_ = false;
    throw Error(path_ + ": has been recorded anew; open it again");
  }
  const std::uint64_t before = count_;
  recording_ = std::move(recording);
  read_series(nullptr);
  return count_ > before;
}

/// Null for a simulation.
std::shared_ptr<viewer::Frames> frames_of(const Input& input, const ViewOptions& options) {
  for (const InputObject& object : input.objects) {
    if (const auto* motion = motion_of<RecordedMotion>(object))
      return std::make_shared<RecordedFrames>(motion->recording, options);
  }
  if (options.follow)
    throw Error(
        fmt::format("--follow: {} is not a recording; record one with supple simulate --record run.h5",
                    options.inputs.front()));
  if (!has_motion<FrameSequence>(input) && !has_motion<ComputedMotion>(input)) return nullptr;
  if (has_motion<MassSpringMotion>(input) || has_motion<RigidMotion>(input))
    throw Error(fmt::format(
        "{}: some objects are moved by files, others are bodies that a simulation moves, which the viewer "
        "cannot show together; record them first, supple simulate {} --record run.h5, and view run.h5",
        options.inputs.front(), options.inputs.front()));
  return std::make_shared<FileFrames>(input);
}

viewer::ViewedObject object_of(const InputObject& object) {
  viewer::ViewedObject shown{object.mesh, object.options, {}};
  if (const auto* motion = motion_of<WaveMotion>(object)) shown.motion = *motion;
  if (const auto* motion = motion_of<MassSpringMotion>(object)) shown.motion = *motion;
  if (const auto* motion = motion_of<RigidMotion>(object)) shown.motion = *motion;
  return shown;
}

/// Whether a mesh of the command line plays an animation.
bool moves_by_itself(const Input& input) {
  return input.scene_text.empty() && input.frames &&
         std::any_of(input.objects.begin(), input.objects.end(), [](const InputObject& object) {
           return object.motion && std::holds_alternative<ComputedMotion>(*object.motion);
         });
}

std::string title_of(const std::vector<std::string>& inputs) {
  const std::string first = valid_utf8(std::filesystem::path(inputs.front()).filename().string());
  return inputs.size() == 1 ? first : fmt::format("{} and {} more", first, inputs.size() - 1);
}

}  // namespace

void check_viewer() {
  if (viewer::embedded_page().empty())
    throw Error(
        "this supple was built without the viewer; run make program, or configure the build with "
        "-DSUPPLE_BUILD_VIEWER=ON, which needs npm and clang-19's WebAssembly (tools/install_dependencies.sh "
        "installs them on Debian 12)");
}

Input read_view_input(const ViewOptions& options) {
  const bool is_scene = is_scene_file(options.inputs.front());
  if (options.seed && !is_scene) throw Error("--seed: only a scene file uses random numbers; leave it out");
  if (options.time_step && !is_scene && !options.sequence)
    throw Error("--time-step: only a scene file or --sequence has time steps; leave it out");
  if (!options.sequence) {
    Input input = read_objects(options.inputs, {options.seed, options.time_step}, options.reading);
    if (options.reading.clips.frames && !moves_by_itself(input))
      throw Error("--frames: only the animation of a mesh file has a choice of frames; leave it out");
    return input;
  }
  Input input = read_sequence(options.inputs, options.reading.conversion);
  // Mesh files contain no times, so play 25 frames per second.
  constexpr double film_seconds = 0.04;
  input.simulation.time_step = options.time_step.value_or(film_seconds);
  return input;
}

viewer::SceneView build_scene_view(const Input& input, const ViewOptions& options) {
  viewer::SceneView show;
  show.title = title_of(options.inputs);
  show.simulation = input.simulation;
  for (const InputObject& object : input.objects) show.objects.push_back(object_of(object));
  show.frames = frames_of(input, options);
  return show;
}

}  // namespace supple::cli
