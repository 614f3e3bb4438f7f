#include "recorded_input.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>

#include "supple/error.hpp"
#include "supple/recording.hpp"

namespace supple::cli {

bool is_recording(const std::string& name) {
  std::string extension = std::filesystem::path(name).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension == ".h5" || extension == ".hdf5";
}

Input read_recording(const std::string& name) {
  Input input;
  input.recording = std::make_shared<const Recording>(name);
  input.recording_name = name;
  const RecordingHeader& header = input.recording->header();
  input.time_step = header.time_step;
  for (std::size_t i = 0; i < header.objects.size(); ++i) {
    const RecordedObject& object = header.objects[i];
    TriangleMesh mesh{object.options.name, object.rest_positions, object.triangles};
    // What is static cannot be moved from its rest to where it stands.
    if (object.options.is_static && input.recording->frame_count() > 0)
      mesh.positions = input.recording->positions(0, i);
    input.objects.push_back({std::move(mesh), object.options, {}});
  }
  return input;
}

std::vector<Vec3d> recorded_positions(const Input& input, std::size_t object, std::uint64_t frame) {
  return input.recording->positions(frame, object);
}

std::uint64_t count_recorded_steps(const Input& input, ContactMode contacts) {
  const std::uint64_t frames = input.recording->frame_count();
  if (frames == 0)
    throw Error(fmt::format("{}: the recording has no frame; record some steps", input.recording_name));
  if (contacts != ContactMode::continuous) return frames;
  if (frames < 2)
    throw Error(
        fmt::format("{}: one frame is no motion; continuous contacts of a recording need two frames or more",
                    input.recording_name));
  return frames - 1;
}

}  // namespace supple::cli
