#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "inputs/inputs.hpp"
#include "moving/ranks.hpp"
#include "supple/recording.hpp"

namespace supple::cli {

/// An object of the input, for the header of a recording.
RecordedObject recorded_object(ObjectId id, const InputObject& object);

/// Records a simulation frame by frame. Each rank writes the objects that it moves. All calls but `add` are
/// collective.
class FrameRecorder {
 public:
  FrameRecorder(Ranks& ranks, const MovingObjects& objects) : ranks_(ranks), objects_(objects) {}

  /// Creates the files.
  void start(const std::string& file_name, const Input& input);
  /// Adds a frame: where the objects are now, and the result of the detection.
  void add(const DetectResult& result);
  void flush_if_due();
  void close();

 private:
  void flush();

  Ranks& ranks_;
  const MovingObjects& objects_;
  bool is_on_ = false;  ///< on all ranks
  std::vector<ObjectId> ids_;
  std::vector<std::span<const Vec3d>> positions_;
  std::optional<Recorder> recorder_;  ///< on ranks that have objects, and on rank 0
};

}  // namespace supple::cli
