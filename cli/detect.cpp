#include "detect.hpp"

#include <fmt/core.h>

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "csv_report.hpp"
#include "exit_status.hpp"
#include "inputs.hpp"
#include "json_report.hpp"
#include "progress.hpp"
#include "recorded_input.hpp"
#include "supple/error.hpp"
#include "supple/scene.hpp"
#include "text.hpp"
#include "text_report.hpp"

namespace supple::cli {
namespace {

Input read_input(const DetectOptions& options) {
  Input input = options.sequence ? read_sequence(options.inputs) : read_objects(options.inputs);
  if (options.steps > 1 && !is_scene_file(options.inputs.front()))
    throw Error("--steps: only a scene file has steps; leave it out, or give frames with --sequence");
  return input;
}

std::vector<ObjectId> add_objects(Scene& scene, const Input& input, const DetectOptions& options) {
  std::vector<ObjectId> ids;
  for (const InputObject& object : input.objects) {
    ObjectOptions chosen = object.options;
    chosen.self_collision = chosen.self_collision || options.self;
    chosen.octree.max_level = options.max_level.value_or(chosen.octree.max_level);
    chosen.octree.leaf_size = options.leaf_size.value_or(chosen.octree.leaf_size);
    chosen.octree.arity = options.tree_arity.value_or(chosen.octree.arity);
    ids.push_back(scene.add(object.mesh, chosen));
  }
  return ids;
}

/// How often `detect` is called: for each frame, or from each frame to the next.
std::uint64_t count_steps(const Input& input, const DetectOptions& options) {
  if (input.recording) return count_recorded_steps(input, options.scene.contacts);
  if (input.frames.empty()) return options.steps;
  if (options.scene.contacts != ContactMode::continuous) return input.frames.size();
  if (input.frames.size() < 2)
    throw Error(
        fmt::format("{}: one frame is no motion; continuous contacts of a sequence need two frames or more",
                    input.frames.front().string()));
  return input.frames.size() - 1;
}

/// Moves the objects of a scene from frame to frame.
class Mover {
 public:
  Mover(Scene& scene, const std::vector<ObjectId>& ids, const Input& input)
      : scene_(scene), ids_(ids), input_(input), next_(ids.size()) {}

  /// Brings the objects to where they are in this frame; of continuous contacts, on their way from this frame
  /// to the next. Frames are asked for one after the other.
  void move(std::uint64_t frame);

 private:
  bool is_moved(std::size_t object) const {
    if (input_.recording) return !input_.objects[object].options.is_static;
    return !input_.frames.empty() || input_.objects[object].motion;
  }
  std::vector<Vec3d> positions(std::size_t object, std::uint64_t frame) const;

  Scene& scene_;
  const std::vector<ObjectId>& ids_;
  const Input& input_;
  std::vector<std::vector<Vec3d>> next_;  ///< positions where the last step ended
};

void Mover::move(std::uint64_t frame) {
  for (std::size_t i = 0; i < ids_.size(); ++i) {
    if (!is_moved(i)) continue;
    if (scene_.options().contacts != ContactMode::continuous) {
      scene_.set_positions(ids_[i], positions(i, frame));
      continue;
    }
    const std::vector<Vec3d> from = frame == 0 ? positions(i, 0) : std::move(next_[i]);
    next_[i] = positions(i, frame + 1);
    scene_.set_motion(ids_[i], from, next_[i]);
  }
}

std::vector<Vec3d> Mover::positions(std::size_t object, std::uint64_t frame) const {
  const InputObject& moved = input_.objects[object];
  if (input_.recording) return recorded_positions(input_, object, frame);
  if (!input_.frames.empty()) return frame == 0 ? moved.mesh.positions : read_frame(input_, frame).positions;
  std::vector<Vec3d> positions;
  sway(*moved.motion, input_.bounds, moved.mesh.positions, static_cast<double>(frame) * input_.time_step,
       positions);
  return positions;
}

/// The reports that were asked for; tables unless something else has standard output.
class Reports {
 public:
  Reports(const DetectOptions& options, const Scene& scene) : scene_(scene) {
    if (!options.json.empty()) json_.emplace(options.json, scene, options.json_content);
    if (!options.csv.empty()) csv_.emplace(options.csv, options.scene.contacts);
    if (!options.quiet && options.json != "-" && options.csv != "-") text_.emplace();
  }

  void add(const Frame& frame) {
    if (json_) json_->add(frame);
    if (csv_) csv_->add(frame);
    if (text_) text_->add(frame);
  }

  void finish() {
    if (json_) json_->finish();
    if (csv_) csv_->finish();
    if (text_) text_->print(scene_);
  }

 private:
  const Scene& scene_;
  std::optional<JsonReport> json_;
  std::optional<CsvReport> csv_;
  std::optional<TextReport> text_;
};

std::string describe(const Scene& scene, const Difference& d) {
  return fmt::format("triangle {} of {} and triangle {} of {} {}", d.triangle_a,
                     one_line(scene.name(d.object_a)), d.triangle_b, one_line(scene.name(d.object_b)),
                     d.missed ? "intersect and were not reported" : "were reported and do not intersect");
}

const char* outcome_of(ContinuousDifference::Fault fault) {
  switch (fault) {
    case ContinuousDifference::Fault::missed:
      return "touch and were not reported";
    case ContinuousDifference::Fault::added:
      return "were reported and do not touch";
    case ContinuousDifference::Fault::late:
      return "were reported with a time after they touch";
    case ContinuousDifference::Fault::early:
      break;
  }
  return "were reported with a time too long before they touch";
}

/// What the elements of a and of b are.
std::array<const char*, 2> nouns_of(ElementPairKind kind) {
  if (kind == ElementPairKind::vertex_face) return {"vertex", "face"};
  if (kind == ElementPairKind::face_vertex) return {"face", "vertex"};
  return {"edge", "edge"};
}

std::string describe(const Scene& scene, const ContinuousDifference& d) {
  const auto [noun_a, noun_b] = nouns_of(d.kind);
  const auto numbers = [](const std::array<std::uint32_t, 2>& ids) {
    return ids[0] == ids[1] ? fmt::format("{}", ids[0]) : fmt::format("{} {}", ids[0], ids[1]);
  };
  return fmt::format("{} {} of {} and {} {} of {} {}", noun_a, numbers(d.element_a),
                     one_line(scene.name(d.object_a)), noun_b, numbers(d.element_b),
                     one_line(scene.name(d.object_b)), outcome_of(d.fault));
}

/// The first difference of the run, told to people: the rest is in the JSON.
void print_difference(const Scene& scene, std::uint64_t frame, const VerifyReport& report) {
  const bool continuous = !report.continuous_differences.empty();
  fmt::print(stderr, "supple: verify: {} {} has {} from brute force; the first: {}\n",
             continuous ? "step" : "frame", frame,
             counted(report.differences.size() + report.continuous_differences.size(), "difference"),
             continuous ? describe(scene, report.continuous_differences.front())
                        : describe(scene, report.differences.front()));
}

}  // namespace

int run_detect(const DetectOptions& options) {
  const Input input = read_input(options);
  const std::uint64_t steps = count_steps(input, options);
  Scene scene(options.scene);
  const std::vector<ObjectId> ids = add_objects(scene, input, options);

  Mover mover(scene, ids, input);
  Reports reports(options, scene);
  Progress progress(steps, !options.quiet);
  const char* const noun = options.scene.contacts == ContactMode::continuous ? "step" : "frame";
  bool touched = false, differed = false;
  for (std::uint64_t number = 0; number < steps; ++number) {
    mover.move(number);
    Frame frame{number, scene.detect(), {}};
    if (options.verify) frame.verify = scene.verify();
    reports.add(frame);
    touched = touched || !frame.result.groups.empty();
    if (frame.verify && !frame.verify->agrees() && !std::exchange(differed, true))
      print_difference(scene, number, *frame.verify);
    progress.update(number + 1, fmt::format("{} {} of {}", noun, number + 1, steps));
  }
  reports.finish();
  if (differed) return exit_differences;
  return options.fail_on_contact && touched ? exit_contact : exit_done;
}

}  // namespace supple::cli
