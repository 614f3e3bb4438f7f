#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "inputs/inputs.hpp"
#include "supple/recording.hpp"

namespace supple::cli {

/// Records a simulation frame by frame.
class FrameRecorder {
 public:
  /// `objects` are those of the input, in its order. Writes no file when the name is empty.
  FrameRecorder(const std::string& file_name, std::vector<ObjectId> objects, const Input& input);

  /// Adds a frame: the positions of each object at this time, and the result of the detection.
  void add(double time, const std::function<std::span<const Vec3d>(ObjectId)>& positions,
           const DetectResult& result);
  void close();

 private:
  std::vector<ObjectId> objects_;
  std::vector<std::span<const Vec3d>> positions_;
  std::optional<Recorder> recorder_;
};

}  // namespace supple::cli
