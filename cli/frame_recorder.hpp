#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "inputs.hpp"
#include "supple/recording.hpp"
#include "supple/simulation.hpp"

namespace supple::cli {

/// Records a simulation, a frame at a time.
class FrameRecorder {
 public:
  /// No file is written when its name is empty.
  FrameRecorder(const std::string& file_name, const Simulation& simulation, const Input& input);

  /// The state of the simulation and what was found there.
  void add(const DetectResult& result);
  void close();

 private:
  const Simulation& simulation_;
  std::vector<ObjectId> objects_;
  std::vector<std::span<const Vec3d>> positions_;
  std::optional<Recorder> recorder_;
};

}  // namespace supple::cli
