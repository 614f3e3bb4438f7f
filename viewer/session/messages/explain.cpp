#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>

#include "messages/answers.hpp"
#include "supple/inspection.hpp"
#include "supple/inspection_descriptions.hpp"
#include "supple/result_descriptions.hpp"

namespace supple::viewer {
namespace {

/// Two triangles and the scene's explanation of the pair.
struct Pair {
  const ViewedObject &a, &b;
  const std::string &name_a, &name_b;
  PairExplanation why;

  bool is_one_object() const { return &a == &b; }
};

std::string short_number(double value) {
  char digits[32];
  std::snprintf(digits, sizeof(digits), "%.3g", value);
  return digits;
}

/// ` are 0.12 apart along z`.
std::string gap_of(const PairExplanation& why) {
  std::string text = " are " + short_number(why.distance) + " apart";
  for (int axis = 0; axis < 3; ++axis) {
    if (std::fabs(why.axis[axis]) == 1) text += std::string(" along ") + "xyz"[axis];
  }
  return text;
}

/// The name of the volumes that are apart.
std::string shape_of(const PairExplanation& why) {
  constexpr std::size_t axes_of_box = 3;
  if (!why.sphere_a.empty()) return "sphere";
  if (why.slabs_a.empty()) return "box";
  return why.slabs_a.size() == axes_of_box ? "oriented box" : std::to_string(2 * why.slabs_a.size()) + "-DOP";
}

std::string why_not_tested(const Pair& pair) {
  if (pair.is_one_object() && !pair.a.options.self_collision)
    return pair.name_a + " is not tested against itself: its self-collision is off";
  std::string text = pair.name_a + " and " + pair.name_b + " are not tested against each other: ";
  if (pair.a.options.is_static && pair.b.options.is_static) return text + "both are static";
  return text + "their groups and masks, or those of the triangles' vertices, exclude each other";
}

std::string sentence_of(const Pair& pair) {
  const bool has_spheres = !pair.why.sphere_a.empty();
  const std::string shape = shape_of(pair.why), shapes = shape + (shape.ends_with("box") ? "es" : "s");
  switch (pair.why.stage) {
    case PairStage::not_tested:
      return why_not_tested(pair);
    case PairStage::shared_vertex:
      return "they share a vertex and meet nowhere else, or neighbours of one object are not tested";
    case PairStage::inert:
      return "a corner is not finite, so they touch nothing";
    case PairStage::object_volumes:
      return "broad phase: the " + shapes + " of " + pair.name_a + " and " + pair.name_b + gap_of(pair.why);
    case PairStage::octree_volumes:
      return "narrow phase: the " + shape + " " +
             node_name(has_spheres, pair.why.number_a, pair.why.level_a) + " of " + pair.name_a +
             " and the " + shape + " " + node_name(has_spheres, pair.why.number_b, pair.why.level_b) +
             " of " + pair.name_b + gap_of(pair.why);
    case PairStage::triangle_boxes:
      return "narrow phase, in the leaves: the boxes of the two triangles" + gap_of(pair.why);
    case PairStage::exact_test:
      return "exact test: their boxes meet, but the triangles" + gap_of(pair.why);
    case PairStage::contact:
      break;
  }
  return "they touch: a contact";
}

void add_boxes(const PairExplanation& why, const Center& center, JsonText& json) {
  json.key("boxes");
  if (why.box_a.empty() || why.box_b.empty()) return json.null();
  json.begin_array();
  for (const Aabb& box : {why.box_a, why.box_b}) {
    json.begin_array();
    json.value(Vec3d{box.min.x, box.min.y, box.min.z} - center.at);
    json.value(Vec3d{box.max.x, box.max.y, box.max.z} - center.at);
    json.end_array();
  }
  json.end_array();
}

void add_spheres(const PairExplanation& why, const Center& center, JsonText& json) {
  json.key("spheres");
  if (why.sphere_a.empty() || why.sphere_b.empty()) return json.null();
  json.begin_array();
  for (const BoundingSphere& sphere : {why.sphere_a, why.sphere_b}) {
    const Vec3d middle = Vec3d{sphere.center.x, sphere.center.y, sphere.center.z} - center.at;
    json.begin_array();
    for (const double number : {middle.x, middle.y, middle.z, double{sphere.radius}}) json.value(number);
    json.end_array();
  }
  json.end_array();
}

void add_edges(const PairExplanation& why, const Center& center, JsonText& json) {
  json.key("edges");
  if (why.slabs_a.empty() || why.slabs_b.empty()) return json.null();
  json.begin_array();
  for (const auto& slabs : {why.slabs_a, why.slabs_b}) {
    json.begin_array();
    for (const auto& [from, to] : edges_of(slabs)) {
      json.begin_array();
      json.value(from - center.at);
      json.value(to - center.at);
      json.end_array();
    }
    json.end_array();
  }
  json.end_array();
}

}  // namespace

void answer_explain(const SceneView& show, const Source& source, const Center& center, ObjectTriangle a,
                    ObjectTriangle b, JsonText& json) {
  const Scene& scene = source.scene();
  const ObjectId id_a = source.id(a[0]), id_b = source.id(b[0]);
  const Pair pair{show.objects[a[0]], show.objects[b[0]], scene.options(id_a).name, scene.options(id_b).name,
                  SceneInspector(scene).explain(id_a, a[1], id_b, b[1])};
  json.member("stage", word_of(pair.why.stage));
  json.member("text", sentence_of(pair));
  add_boxes(pair.why, center, json);
  add_spheres(pair.why, center, json);
  add_edges(pair.why, center, json);
  json.key("levels");
  json.begin_array();
  json.value(pair.why.level_a);
  json.value(pair.why.level_b);
  json.end_array();
  json.member("axis", pair.why.axis);
  json.member("distance", pair.why.distance);
}

void answer_measure(const SceneView& show, const Source& source, const Center& center, std::uint32_t a,
                    std::uint32_t b, JsonText& json) {
  Scene both;
  const ObjectId id_a = both.add(source.positions(a), show.objects[a].mesh.triangles),
                 id_b = both.add(source.positions(b), show.objects[b].mesh.triangles);
  decltype(both.distance(id_a, id_b)) found;
  if (a != b) found = both.distance(id_a, id_b);
  json.key("distance");
  if (!found) json.null();
  if (found) json.value(found->distance);
  json.key("points");
  if (!found) return json.null();
  json.begin_array();
  json.value(found->point_a - center.at);
  json.value(found->point_b - center.at);
  json.end_array();
}

}  // namespace supple::viewer
