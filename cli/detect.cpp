#include "detect.hpp"

#include <fmt/core.h>

#include <optional>
#include <utility>
#include <vector>

#include "csv_report.hpp"
#include "exit_status.hpp"
#include "inputs.hpp"
#include "json_report.hpp"
#include "progress.hpp"
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
    ids.push_back(scene.add(object.mesh, chosen));
  }
  return ids;
}

/// Brings the objects to where they are in this frame.
void move(Scene& scene, const std::vector<ObjectId>& ids, const Input& input, std::uint64_t frame) {
  if (!input.frames.empty()) {
    if (frame > 0) scene.set_positions(ids.front(), read_frame(input, frame).positions);
    return;
  }
  const double seconds = static_cast<double>(frame) * input.time_step;
  std::vector<Vec3d> positions;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const InputObject& object = input.objects[i];
    if (!object.motion) continue;
    sway(*object.motion, input.bounds, object.mesh.positions, seconds, positions);
    scene.set_positions(ids[i], positions);
  }
}

/// The reports that were asked for; tables unless something else has standard output.
class Reports {
 public:
  Reports(const DetectOptions& options, const Scene& scene) : scene_(scene) {
    if (!options.json.empty()) json_.emplace(options.json, scene, options.json_stats);
    if (!options.csv.empty()) csv_.emplace(options.csv);
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

/// The first difference of the run, told to people: the rest is in the JSON.
void print_difference(const Scene& scene, std::uint64_t frame, const VerifyReport& report) {
  const Difference& d = report.differences.front();
  fmt::print(stderr,
             "supple: verify: frame {} has {} from brute force; the first: triangle {} of {} and triangle {} "
             "of {} {}\n",
             frame, counted(report.differences.size(), "difference"), d.triangle_a,
             one_line(scene.name(d.object_a)), d.triangle_b, one_line(scene.name(d.object_b)),
             d.missed ? "intersect and were not reported" : "were reported and do not intersect");
}

}  // namespace

int run_detect(const DetectOptions& options) {
  const Input input = read_input(options);
  const std::uint64_t frames = input.frames.empty() ? options.steps : input.frames.size();
  Scene scene(options.scene);
  const std::vector<ObjectId> ids = add_objects(scene, input, options);

  Reports reports(options, scene);
  Progress progress(frames, !options.quiet);
  bool touched = false, differed = false;
  for (std::uint64_t number = 0; number < frames; ++number) {
    move(scene, ids, input, number);
    Frame frame{number, scene.detect(), {}};
    if (options.verify) frame.verify = scene.verify();
    reports.add(frame);
    touched = touched || !frame.result.contacts.empty();
    if (frame.verify && !frame.verify->agrees() && !std::exchange(differed, true))
      print_difference(scene, number, *frame.verify);
    progress.update(number + 1, fmt::format("frame {} of {}", number + 1, frames));
  }
  reports.finish();
  if (differed) return exit_differences;
  return options.fail_on_contact && touched ? exit_contact : exit_done;
}

}  // namespace supple::cli
