#include "layers.hpp"

#include <algorithm>
#include <utility>

#include "object_arguments.hpp"

namespace supple::viewer {
namespace {

constexpr std::int64_t deepest_level = 1000;

bool have_objects(const std::vector<std::uint32_t>& objects, const SceneView& scene, Arguments& arguments) {
  return std::all_of(objects.begin(), objects.end(),
                     [&](std::uint32_t object) { return has_object(object, scene, arguments); });
}

void read_octree(const JsonValue& octree, const SceneView& scene, Layers& layers, Arguments& arguments) {
  if (octree.kind != JsonValue::Kind::object)
    return arguments.must_be("octree", "null, or {\"objects\": […], \"level\": …}");
  Arguments inner(octree, "octree");
  auto objects = inner.required("objects", inner.numbers("objects"));
  const auto level = inner.required("level", inner.integer("level", -1, deepest_level));
  have_objects(objects, scene, inner);
  if (!inner.check()) return arguments.fail(inner.error());
  std::sort(objects.begin(), objects.end());
  objects.erase(std::unique(objects.begin(), objects.end()), objects.end());
  layers.octree_objects = std::move(objects);
  layers.octree_level.reset();
  if (level >= 0) layers.octree_level = static_cast<std::uint32_t>(level);
}

void read_colliding_nodes(const JsonValue& nodes, const SceneView& scene, Layers& layers,
                          Arguments& arguments) {
  if (nodes.kind != JsonValue::Kind::object)
    return arguments.must_be("colliding_nodes", "null, or {\"objects\": [a, b], \"level\": …}");
  Arguments inner(nodes, "colliding_nodes");
  const auto objects = inner.numbers("objects");
  const auto level =
      inner.required("level", inner.integer("level", CollidingNodes::all_levels, deepest_level));
  if (objects && objects->size() != 2) inner.must_be("objects", "the numbers of two objects");
  if (objects) have_objects(*objects, scene, inner);
  if (!inner.check()) return arguments.fail(inner.error());
  layers.colliding_nodes = CollidingNodes{{}, level};
  if (objects) layers.colliding_nodes->objects = {(*objects)[0], (*objects)[1]};
}

std::string read_field(const JsonValue& field, const std::vector<FieldForm>& fields, Arguments& arguments) {
  if (field.kind == JsonValue::Kind::null) return {};
  if (field.kind == JsonValue::Kind::text && find_field(fields, field.text) != nullptr) return field.text;
  std::string list = "null";
  for (const FieldForm& form : fields) list += ", " + form.key;
  arguments.must_be("field", "one of the fields of the scene: " + list);
  return {};
}

}  // namespace

std::vector<std::string> layer_names(const Layers& layers) {
  std::vector<std::string> names;
  if (layers.candidates) names.emplace_back("candidates");
  if (layers.scene_regions) names.emplace_back("scene_regions");
  if (layers.colliding_vertices) names.emplace_back("colliding_vertices");
  if (!layers.octree_objects.empty()) names.emplace_back("octree");
  if (layers.colliding_nodes) names.emplace_back("colliding_nodes");
  if (!layers.field.empty()) names.emplace_back("field");
  return names;
}

std::optional<Layers> read_layers(Layers layers, const SceneView& scene, const std::vector<FieldForm>& fields,
                                  Arguments& arguments) {
  layers.candidates = arguments.boolean("candidates").value_or(layers.candidates);
  layers.scene_regions = arguments.boolean("scene_regions").value_or(layers.scene_regions);
  layers.colliding_vertices = arguments.boolean("colliding_vertices").value_or(layers.colliding_vertices);
  if (const JsonValue* const octree = arguments.member("octree")) {
    layers.octree_objects.clear();
    if (octree->kind != JsonValue::Kind::null) read_octree(*octree, scene, layers, arguments);
  }
  if (const JsonValue* const nodes = arguments.member("colliding_nodes")) {
    layers.colliding_nodes.reset();
    if (nodes->kind != JsonValue::Kind::null) read_colliding_nodes(*nodes, scene, layers, arguments);
  }
  if (const JsonValue* const field = arguments.member("field"))
    layers.field = read_field(*field, fields, arguments);
  return arguments.check() ? std::optional(std::move(layers)) : std::nullopt;
}

void keep_objects(Layers& layers, std::size_t count) {
  std::erase_if(layers.octree_objects, [count](std::uint32_t object) { return object >= count; });
  if (auto& nodes = layers.colliding_nodes;
      nodes && nodes->objects && std::ranges::max(*nodes->objects) >= count)
    nodes->objects.reset();
}

}  // namespace supple::viewer
