#include "view/build_scene_view.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <span>
#include <system_error>
#include <tuple>
#include <utility>
#include <vector>

#include "base/progress.hpp"
#include "base/text.hpp"
#include "commands/build_simulation.hpp"
#include "export/embedded.hpp"
#include "export/page_file.hpp"
#include "inputs/inputs.hpp"
#include "session/messages/frame_message.hpp"
#include "session/messages/mesh_warnings.hpp"
#include "supple/recording.hpp"
#include "view_file/view_file.hpp"

namespace supple::cli {
namespace {

namespace fs = std::filesystem;

template <class Kind>
bool has_motion(const Input& input) {
  return std::any_of(input.objects.begin(), input.objects.end(),
                     [](const InputObject& object) { return motion_of<Kind>(object) != nullptr; });
}

/// The frames of a recording. All objects move except static ones.
class RecordedFrames : public viewer::Frames {
 public:
  /// Reads times, statistics and events of all frames. With `is_growing`, `refresh` looks for more of them in
  /// the file; nobody else may then keep the recording.
  RecordedFrames(std::string path, std::shared_ptr<const Recording> recording, bool is_growing)
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

  /// Frames that were added are counted when their series has been read.
  std::uint64_t count() const override { return count_; }
  void read(std::uint64_t frame, std::size_t object, std::span<Vec3d> positions) const override {
    std::ranges::copy(recording().positions(frame, object), positions.begin());
  }
  const viewer::Series& series() const override { return series_; }
  bool is_growing() const override { return is_growing_; }
  bool refresh() override {
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
      fail("{}: was recorded again; open it again", path_);
    }
    const std::uint64_t before = count_;
    read_series(nullptr);
    return count_ > before;
  }

 private:
  using FileState = std::pair<fs::file_time_type, std::uintmax_t>;  // last change, size
  /// Id, name, vertices and triangles.
  using Object = std::tuple<ObjectId, std::string, std::size_t, std::size_t>;

  FileState state_of_file() const {
    std::error_code error;  // a file that is gone has changed
    return {fs::last_write_time(path_, error), fs::file_size(path_, error)};
  }

  static std::vector<Object> objects_of(const Recording& recording) {
    std::vector<Object> objects;
    for (const RecordedObject& object : recording.header().objects)
      objects.emplace_back(object.id, object.options.name, object.rest_positions.size(),
                           object.triangles.size());
    return objects;
  }

  const Recording& recording() const {
    if (recording_ == nullptr) recording_ = std::make_shared<const Recording>(path_);
    return *recording_;
  }

  /// Reads the series of frames that it does not have.
  void read_series(Progress* progress) {
    const std::uint64_t all = recording_->frame_count();
    for (; count_ < all; ++count_) {
      const RecordedFrame frame = recording_->summary(count_);
      series_.values.push_back(frame.time);
      viewer::for_each_statistic(frame.stats,
                                 [&](const char*, double value) { series_.values.push_back(value); });
      const auto add = [&](const auto& events, viewer::Series::Events& to) {
        const auto add_side = [&](const std::vector<ObjectPair>& pairs,
                                  std::vector<viewer::Series::Event>& side) {
          for (const ObjectPair& pair : pairs)
            side.push_back({static_cast<std::uint32_t>(count_), places_.at(pair.a), places_.at(pair.b)});
        };
        add_side(events.begin, to.begin);
        add_side(events.end, to.end);
      };
      add(frame.contact_events, series_.contacts);
      add(frame.narrow_phase_events, series_.narrow_phase);
      add(frame.volume_events, series_.volumes);
      if (progress != nullptr)
        progress->update(count_ + 1, fmt::format("reading frame {} of {}", count_ + 1, all));
    }
  }

  std::string path_;
  /// Null when it could not be opened again. HDF5 reads a file again only when nobody has it open.
  mutable std::shared_ptr<const Recording> recording_;
  std::vector<Object> objects_;
  std::map<ObjectId, std::uint32_t> places_;
  std::uint64_t count_ = 0;
  viewer::Series series_;
  bool is_growing_;
  FileState file_;
};

/// Two recordings, frame by frame: the objects of the first, then those of the second. The one that ends
/// first stays at its last frame. The series has the columns of the first, then those of the second with
/// names that end with `_b`.
class ComparedFrames : public viewer::Frames {
 public:
  ComparedFrames(std::shared_ptr<const viewer::Frames> a, std::shared_ptr<const viewer::Frames> b,
                 std::size_t objects_of_a)
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

  std::uint64_t count() const override { return count_; }
  void read(std::uint64_t frame, std::size_t object, std::span<Vec3d> positions) const override {
    const bool is_of_a = object < objects_of_a_;
    const viewer::Frames& frames = is_of_a ? *a_ : *b_;
    frames.read(std::min(frame, frames.count() - 1), is_of_a ? object : object - objects_of_a_, positions);
  }
  const viewer::Series& series() const override { return series_; }

 private:
  std::shared_ptr<const viewer::Frames> a_, b_;
  std::size_t objects_of_a_;
  std::uint64_t count_;
  viewer::Series series_;
};

/// A scene in which files move some objects and waves move others.
class FileFrames : public viewer::Frames {
 public:
  explicit FileFrames(const Input& input) : simulation_(input.simulation) {
    for (const InputObject& object : input.objects) objects_.push_back(mover(object));
  }

  std::uint64_t count() const override { return count_; }
  void read(std::uint64_t frame, std::size_t object, std::span<Vec3d> positions) const override {
    objects_[object](frame, positions);
  }
  const viewer::Series& series() const override { return series_; }

 private:
  using Mover = std::function<void(std::uint64_t frame, std::span<Vec3d> positions)>;

  Mover mover(const InputObject& object) {
    if (const auto frames = frames_of(object)) {
      count_ = std::max(count_, frames->count);
      return frames->positions;
    }
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

std::shared_ptr<const Recording> recording_of(const Input& input) {
  for (const InputObject& object : input.objects) {
    if (const auto* motion = motion_of<RecordedMotion>(object)) return motion->recording;
  }
  return nullptr;
}

/// Null for a simulation.
std::shared_ptr<viewer::Frames> view_frames_of(const Input& input, const ViewOptions& options) {
  if (auto recording = recording_of(input))
    return std::make_shared<RecordedFrames>(options.inputs.front(), std::move(recording), options.follow);
  if (options.follow)
    fail("--follow: {} is not a recording; record one with supple simulate --record run.h5",
         options.inputs.front());
  if (!has_motion<FrameSequence>(input) && !has_motion<ComputedMotion>(input)) return nullptr;
  if (has_motion<MassSpringMotion>(input) || has_motion<RigidMotion>(input))
    fail(
        "{}: some objects are moved by files, others are bodies that a simulation moves, which the viewer "
        "cannot show together; record them first, supple simulate {} --record run.h5, and view run.h5",
        options.inputs.front(), options.inputs.front());
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
  return input.scene_text.empty() && input.frames && has_motion<ComputedMotion>(input);
}

std::string title_of(const std::vector<std::string>& inputs) {
  const std::string first = valid_utf8(fs::path(inputs.front()).filename().string());
  return inputs.size() == 1 ? first : fmt::format("{} and {} more", first, inputs.size() - 1);
}

/// Adds the objects and the frames of the second recording, and where the two differ first.
void compare(viewer::SceneView& show, const Input& input, const ViewOptions& options) {
  const std::string& first = options.inputs.front();
  for (const std::string& name : {first, options.compared}) {
    if (options.inputs.size() != 1 || !is_recording(name))
      fail("--compare: {} is not a recording; compare two recordings", name);
  }
  const Input other = read_recording(options.compared);
  const auto a = recording_of(input), b = recording_of(other);
  if (!a || !b) fail("--compare: nothing moves in {}", a ? options.compared : first);
  show.title = fmt::format("{} and {}", show.title, title_of({options.compared}));
  viewer::Comparison comparison{
      {title_of({first}), title_of({options.compared})}, show.objects.size(), {}, {}};
  show.frames = std::make_shared<ComparedFrames>(
      show.frames, std::make_shared<RecordedFrames>(options.compared, b, false), show.objects.size());
  for (const InputObject& object : other.objects) show.objects.push_back(object_of(object));
  for (std::size_t i = 0; i < show.objects.size(); ++i)
    show.objects[i].options.name += i < comparison.objects_of_a ? " (A)" : " (B)";
  if (const auto difference = find_first_difference(*a, *b, options.tolerance)) {
    comparison.frame = difference->frame;
    comparison.text = difference->what;
  }
  show.comparison = std::move(comparison);
}

/// Throws for options that have no effect on this input.
Input read_view_input(const ViewOptions& options) {
  const bool is_scene = is_scene_file(options.inputs.front());
  if (options.seed && !is_scene) fail("--seed: only a scene file uses random numbers; leave it out");
  if (options.time_step && !is_scene && !options.sequence)
    fail("--time-step: only a scene file or --sequence has time steps; leave it out");
  if (!options.sequence) {
    Input input = read_objects(options.inputs, {options.seed, options.time_step}, options.reading);
    if (options.reading.clips.frames && !moves_by_itself(input))
      fail("--frames: only the animation of a mesh file has a choice of frames; leave it out");
    return input;
  }
  Input input = read_sequence(options.inputs, options.reading.conversion);
  // Mesh files contain no times, so play 25 frames per second.
  constexpr double film_seconds = 0.04;
  input.simulation.time_step = options.time_step.value_or(film_seconds);
  return input;
}

}  // namespace

void check_viewer() {
  if (viewer::embedded_page().empty())
    fail(
        "this supple was built without the viewer; run make program, or configure the build with "
        "-DSUPPLE_BUILD_VIEWER=ON, which needs npm and clang-19's WebAssembly (tools/install_dependencies.sh "
        "installs them on Debian 12)");
}

std::string page_of(const ViewOptions& options) {
  std::string page(viewer::embedded_page());
  if (options.view_file.empty()) return page;
  return viewer::page_with_json(page, "supple-view", viewer::read_view(options.view_file));
}

viewer::SceneView read_scene_view(const ViewOptions& options, const OutputName& output) {
  Input input = read_view_input(options);
  check_output_names({output, {"--view", options.view_file}}, input.files);
  apply(options, input);
  print_notes(input);
  viewer::SceneView show;
  show.title = title_of(options.inputs);
  show.simulation = input.simulation;
  for (const InputObject& object : input.objects) show.objects.push_back(object_of(object));
  show.frames = view_frames_of(input, options);
  if (!options.compared.empty()) compare(show, input, options);
  return show;
}

void print_warnings(const viewer::SceneView& show) {
  for (const std::string& warning : viewer::warnings_of_meshes(show))
    fmt::print(stderr, "supple: warning: {}\n", one_line(warning));
}

}  // namespace supple::cli
