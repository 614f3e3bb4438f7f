#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "messages/json_text.hpp"
#include "scene_view.hpp"
#include "supple/viewer.hpp"

namespace supple::viewer {

/// What a field is: numbers that the page shows as colours, or vectors that it shows as arrows.
struct FieldForm {
  std::string key;  ///< for commands
  std::string label;
  std::string doc;  ///< a sentence without a full stop; empty for a field of a program
  std::string unit;
  FieldElement element = FieldElement::vertex;
  bool is_vector = false;
  /// The list of frames and its column with the values of contacts; of vectors, the values are their lengths.
  /// Empty for fields of vertices and triangles.
  std::string list{};
  std::string column{};

  bool operator==(const FieldForm&) const = default;
};

/// The fields of the viewer itself.
std::vector<FieldForm> built_in_fields();
/// Those that a scene has at present, then those of the program.
std::vector<FieldForm> offered_fields(const SceneView& show);
/// Null when there is none with this key.
const FieldForm* find_field(const std::vector<FieldForm>& fields, std::string_view key);
/// Writes the member `fields` of a scene.
void write_fields(const std::vector<FieldForm>& fields, JsonText& json);

}  // namespace supple::viewer
