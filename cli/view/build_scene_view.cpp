#include "view/build_scene_view.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <variant>

#include "base/text.hpp"
#include "export/embedded.hpp"
#include "inputs/inputs.hpp"
#include "view/recorded_frames.hpp"

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

/// Null for a simulation.
std::shared_ptr<viewer::Frames> view_frames_of(const Input& input, const ViewOptions& options) {
  for (const InputObject& object : input.objects) {
    if (const auto* motion = motion_of<RecordedMotion>(object))
      return std::make_shared<RecordedFrames>(options.inputs.front(), motion->recording, options.follow);
  }
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

std::shared_ptr<const Recording> recording_of(const Input& input) {
  for (const InputObject& object : input.objects) {
    if (const auto* motion = motion_of<RecordedMotion>(object)) return motion->recording;
  }
  return nullptr;
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

/// Adds the objects and the frames of the second recording, and where the two differ first.
void compare(viewer::SceneView& show, const Input& input, const ViewOptions& options) {
  const std::string& first = options.inputs.front();
  if (options.inputs.size() != 1 || !is_recording(first))
    fail("--compare: {} is not a recording; compare two recordings", first);
  if (!is_recording(options.compared))
    fail("--compare: {} is not a recording; compare two recordings", options.compared);
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

}  // namespace

void check_viewer() {
  if (viewer::embedded_page().empty())
    fail(
        "this supple was built without the viewer; run make program, or configure the build with "
        "-DSUPPLE_BUILD_VIEWER=ON, which needs npm and clang-19's WebAssembly (tools/install_dependencies.sh "
        "installs them on Debian 12)");
}

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

viewer::SceneView build_scene_view(const Input& input, const ViewOptions& options) {
  viewer::SceneView show;
  show.title = title_of(options.inputs);
  show.simulation = input.simulation;
  for (const InputObject& object : input.objects) show.objects.push_back(object_of(object));
  show.frames = view_frames_of(input, options);
  if (!options.compared.empty()) compare(show, input, options);
  return show;
}

}  // namespace supple::cli
