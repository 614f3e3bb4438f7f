#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "inputs/inputs.hpp"
#include "supple/recording.hpp"
#include "supple/simulation.hpp"

namespace supple::cli {

/// Records a simulation frame by frame.
class FrameRecorder {
 public:
  /// Writes no file when the name is empty.
  FrameRecorder(const std::string& file_name, const Simulation& simulation, const Input& input);

  /// Adds a frame: the state of the simulation and the result of its detection.
  void add(const DetectResult& result);
  void close();

 private:
  const Simulation& simulation_;
  std::vector<ObjectId> objects_;
  std::vector<std::span<const Vec3d>> positions_;
  std::optional<Recorder> recorder_;
};

}  // namespace supple::cli
