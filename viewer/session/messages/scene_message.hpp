#pragma once

#include <cstdint>
#include <vector>

#include "fields/field_forms.hpp"
#include "messages/json_text.hpp"
#include "messages/message.hpp"
#include "sources/stage.hpp"

namespace supple::viewer {

struct SceneNumbers {
  std::uint64_t generation = 0;  ///< counts scene messages
  std::uint64_t run = 1;         ///< counts restarts: steps of the same run follow each other
};

/// Writes the message that describes the scene: objects, topology, settings and fields.
void pack_scene(Stage& stage, SceneNumbers numbers, const std::vector<FieldForm>& fields, JsonText& json,
                MessageWriter& message);
/// Writes the time series of a recording.
void pack_series(const Frames& frames, MessageWriter& message);

}  // namespace supple::viewer
