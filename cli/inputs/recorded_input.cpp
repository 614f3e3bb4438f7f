#include "inputs/recorded_input.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <utility>

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
  const auto recording = std::make_shared<const Recording>(name);
  if (recording->frame_count() == 0)
    throw Error(fmt::format("{}: the recording has no frame; record some steps", name));
  const RecordingHeader& header = recording->header();
  Input input;
  input.files = {name};
  input.frames = {name, recording->frame_count()};
  input.simulation.time_step = header.time_step;
  for (std::size_t i = 0; i < header.objects.size(); ++i) {
    const RecordedObject& object = header.objects[i];
    InputObject& added = input.objects.emplace_back();
    added.options = object.options;
    added.mesh = {object.options.name, recording->positions(0, i), object.triangles,
                  std::exchange(added.options.edges, {}), std::exchange(added.options.points, {})};
    if (!object.options.is_static) added.motion = RecordedMotion{recording, i};
  }
  return input;
}

}  // namespace supple::cli
