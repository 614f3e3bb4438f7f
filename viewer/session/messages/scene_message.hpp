#pragma once

#include <cstdint>

#include "messages/json_text.hpp"
#include "messages/message.hpp"
#include "sources/stage.hpp"

namespace supple::viewer {

/// Writes the message that describes the scene: objects, topology and settings.
void pack_scene(Stage& stage, std::uint64_t generation, JsonText& json, MessageWriter& message);
/// Writes the time series of a recording.
void pack_series(const Frames& frames, MessageWriter& message);

}  // namespace supple::viewer
