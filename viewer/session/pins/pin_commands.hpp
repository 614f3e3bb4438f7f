#pragma once

#include <optional>
#include <vector>

#include "arguments.hpp"
#include "messages/json_text.hpp"
#include "pins/pin_meter.hpp"
#include "scene_view.hpp"
#include "sources/source.hpp"

namespace supple::viewer {

/// The pins of the command `pins`; nothing after an error.
std::optional<std::vector<Pin>> read_pins(const SceneView& scene, const Source& source, Arguments& arguments);

/// Writes `pin_values`: the key, description and unit of each value of a pin.
void write_pin_values(JsonText& json);

}  // namespace supple::viewer
