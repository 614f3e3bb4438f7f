#include "commands/frame_recorder.hpp"

#include <utility>

namespace supple::cli {
namespace {

RecordingHeader header_of(const std::vector<ObjectId>& objects, const Input& input) {
  RecordingHeader header;
  header.time_step = input.simulation.time_step;
  header.scene = input.simulation.scene;
  header.scene_file = input.scene_text;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const InputObject& object = input.objects[i];
    ObjectOptions options = object.options;
    options.edges.insert(options.edges.end(), object.mesh.edges.begin(), object.mesh.edges.end());
    options.points.insert(options.points.end(), object.mesh.points.begin(), object.mesh.points.end());
    header.objects.push_back({objects[i], std::move(options), object.mesh.positions, object.mesh.triangles});
  }
  return header;
}

}  // namespace

FrameRecorder::FrameRecorder(const std::string& file_name, std::vector<ObjectId> objects, const Input& input)
    : objects_(std::move(objects)) {
  if (!file_name.empty()) recorder_.emplace(file_name, header_of(objects_, input));
}

void FrameRecorder::add(double time, const std::function<std::span<const Vec3d>(ObjectId)>& positions,
                        const DetectResult& result) {
  if (!recorder_) return;
  positions_.clear();
  for (const ObjectId object : objects_) positions_.push_back(positions(object));
  recorder_->add(time, positions_, result);
}

void FrameRecorder::close() {
  if (recorder_) recorder_->close();
}

}  // namespace supple::cli
