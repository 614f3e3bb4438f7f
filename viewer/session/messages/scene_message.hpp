#pragma once

#include <cstdint>

#include "messages/json_text.hpp"
#include "messages/message.hpp"
#include "sources/stage.hpp"

namespace supple::viewer {

struct SceneNumbers {
  std::uint64_t generation = 0;  ///< counts scene messages
  std::uint64_t run = 1;         ///< counts restarts: steps of the same run follow each other
};

/// Writes the message that describes the scene: objects, topology and settings.
void pack_scene(Stage& stage, SceneNumbers numbers, JsonText& json, MessageWriter& message);
/// Writes the time series of a recording.
void pack_series(const Frames& frames, MessageWriter& message);

}  // namespace supple::viewer
