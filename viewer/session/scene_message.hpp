#pragma once

#include <cstdint>

#include "json_text.hpp"
#include "message.hpp"
#include "stage.hpp"

namespace supple::viewer {

/// The message that tells a page what there is: objects, topology and settings.
void pack_scene(Stage& stage, std::uint64_t generation, JsonText& json, MessageWriter& message);
/// What a recording says of all its frames.
void pack_series(const Frames& frames, MessageWriter& message);

}  // namespace supple::viewer
