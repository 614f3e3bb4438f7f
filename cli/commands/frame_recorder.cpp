#include "commands/frame_recorder.hpp"

#include <algorithm>
#include <cstdint>
#include <random>
#include <utility>

namespace supple::cli {

RecordedObject recorded_object(ObjectId id, const InputObject& object) {
  ObjectOptions options = object.options;
  options.edges.insert(options.edges.end(), object.mesh.edges.begin(), object.mesh.edges.end());
  options.points.insert(options.points.end(), object.mesh.points.begin(), object.mesh.points.end());
  return {id, std::move(options), object.mesh.positions, object.mesh.triangles};
}

namespace {

RecordingHeader header_of(const Input& input, const MovingObjects& objects, const Ranks& ranks) {
  RecordingHeader header;
  header.ranks = static_cast<std::uint32_t>(ranks.size());
  header.time_step = input.simulation.time_step;
  header.scene = input.simulation.scene;
  header.scene_file = input.scene_text;
  for (std::uint32_t i = 0; i < input.objects.size(); ++i) {
    const InputObject& object = input.objects[i];
    if (const int rank = objects.rank_of({i}); rank != ranks.rank()) {
      const RecordedElsewhere elsewhere{static_cast<std::uint32_t>(rank), object.mesh.positions.size(),
                                        object.mesh.triangles.size()};
      header.objects.push_back({{i}, object.options, {}, {}, elsewhere});
      continue;
    }
    header.objects.push_back(recorded_object({i}, object));
  }
  return header;
}

}  // namespace

void FrameRecorder::start(const std::string& file_name, const Input& input) {
  if (file_name.empty()) return;
  is_on_ = true;
  for (std::uint32_t i = 0; i < input.objects.size(); ++i) ids_.push_back({i});
  const int rank = ranks_.rank();
  const auto run = static_cast<std::uint32_t>(
      ranks_.largest(rank == 0 ? static_cast<int>(std::random_device()() >> 1) : 0));
  const auto create = [&] {
    recorder_.emplace(file_name, header_of(input, objects_, ranks_),
                      RecordingRank{static_cast<std::uint32_t>(rank), run});
  };
  ranks_.together([&] {
    const auto is_own = [&](ObjectId object) { return objects_.rank_of(object) == rank; };
    if (rank == 0 || std::ranges::any_of(ids_, is_own)) create();
  });
  ranks_.others_first([&] { flush(); });
}

void FrameRecorder::add(const DetectResult& result) {
  if (!recorder_) return;
  positions_.clear();
  for (const ObjectId object : ids_) {
    const bool is_own = objects_.rank_of(object) == ranks_.rank();
    positions_.push_back(is_own ? objects_.positions(object) : std::span<const Vec3d>());
  }
  recorder_->add(objects_.time(), positions_, result);
}

void FrameRecorder::flush() {
  if (recorder_) recorder_->flush();
}

void FrameRecorder::flush_if_due() {
  if (is_on_ && ranks_.largest(recorder_ && recorder_->needs_flush() ? 1 : 0) != 0)
    ranks_.others_first([this] { flush(); });
}

void FrameRecorder::close() {
  if (!is_on_) return;
  ranks_.others_first([this] {
    if (recorder_) recorder_->close();
  });
}

}  // namespace supple::cli
