#include "messages/answers.hpp"

#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include "messages/described_json.hpp"
#include "sources/extent.hpp"
#include "supple/inspection.hpp"
#include "supple/inspection_descriptions.hpp"
#include "supple/result_descriptions.hpp"
#include "supple/triangle_intersection.hpp"

namespace supple::viewer {
namespace {

void add_pair(std::uint32_t a, std::uint32_t b, JsonText& json) {
  json.begin_array();
  json.value(a);
  json.value(b);
  json.end_array();
}

/// Adds at most `most` of the triangles that a triangle touches.
void add_contacts_of(const DetectResult& result, std::uint32_t object, std::uint32_t triangle,
                     JsonText& json) {
  constexpr std::uint64_t most = 1000;
  std::uint64_t count = 0;
  json.key("contacts");
  json.begin_array();
  for (const Contact& c : result.contacts) {
    const bool is_a = c.object_a.index == object && c.triangle_a == triangle;
    const bool is_b = c.object_b.index == object && c.triangle_b == triangle;
    if (!is_a && !is_b) continue;
    if (++count > most) continue;
    if (is_a)
      add_pair(c.object_b.index, c.triangle_b, json);
    else
      add_pair(c.object_a.index, c.triangle_a, json);
  }
  json.end_array();
  json.member("contact_count", count);
}

/// Adds the names of the leaf regions of the scene octree that contain the object, as in the paper.
void add_regions(const Source& source, std::uint32_t object, JsonText& json) {
  constexpr std::size_t most = 64;
  const std::vector<SceneRegion> regions = SceneInspector(source.scene()).regions(source.id(object));
  json.key("regions");
  json.begin_array();
  for (const SceneRegion& region : std::span(regions).first(std::min(most, regions.size())))
    json.value("R(" + std::to_string(region.number) + ", " + std::to_string(region.level) + ")");
  json.end_array();
}

void add_octree(const OctreeStatistics& octree, JsonText& json) {
  json.key("octree");
  json.begin_object();
  write_members(json, octree);
  json.end_object();
}

std::uint64_t contact_count(const DetectResult& result, std::uint32_t object) {
  std::uint64_t count = 0;
  for (const auto groups : {result.groups, result.continuous_groups}) {
    for (const ContactGroup& group : groups) {
      if (group.a.index == object || group.b.index == object) count += group.contact_count;
    }
  }
  return count;
}

/// `A(9, 2)`, or `S(9, 2)` for a sphere, as in the paper.
std::string name_of(const OctreeCell& node) {
  return node_name(!node.sphere.empty(), node.number, node.number_level);
}

}  // namespace

std::string node_name(bool is_sphere, std::optional<std::uint64_t> number, std::uint32_t level) {
  return std::string(is_sphere ? "S(" : "A(") + (number ? std::to_string(*number) : "?") + ", " +
         std::to_string(level) + ")";
}

void answer_node_pairs(const Source& source, std::uint32_t a, std::uint32_t b, JsonText& json) {
  constexpr std::size_t most_names = 100;
  const NodePairList list = SceneInspector(source.scene()).node_pairs(source.id(a), source.id(b));
  json.key("levels");
  json.begin_array();
  for (std::uint32_t level = 0; level < list.level_count(); ++level) {
    const auto pairs = list.pairs_of(level);
    json.begin_object();
    json.member("pairs", std::uint64_t{pairs.size()});
    json.member("leaf_pairs",
                static_cast<std::uint64_t>(std::count_if(
                    pairs.begin(), pairs.end(), [&](const auto& pair) { return list.is_leaf_pair(pair); })));
    json.key("names");
    json.begin_array();
    for (const NodePairList::Pair& pair : pairs.first(std::min(most_names, pairs.size()))) {
      const std::string names[] = {name_of(list.nodes_a[pair.a]), name_of(list.nodes_b[pair.b])};
      json.value(std::span<const std::string>(names));
    }
    json.end_array();
    json.end_object();
  }
  json.end_array();
}

void answer_read_vertex(const Source& source, std::uint32_t object, std::uint32_t vertex, JsonText& json) {
  json.member("object", object);
  json.member("vertex", vertex);
  json.member("position", source.positions(object)[vertex]);
}

void answer_read_triangle(const SceneView& show, const Source& source, std::uint32_t object,
                          std::uint32_t triangle, JsonText& json) {
  const Triangle& corners = show.objects[object].mesh.triangles[triangle];
  const std::span<const Vec3d> positions = source.positions(object);
  const TrianglePoints points{positions[corners[0]], positions[corners[1]], positions[corners[2]]};
  json.member("object", object);
  json.member("triangle", triangle);
  json.key("vertices");
  json.begin_array();
  for (const std::uint32_t corner : corners) json.value(corner);
  json.end_array();
  json.member("area", area(points));
  json.member("normal", unit_normal(points));
  json.member("leaf", name_of(SceneInspector(source.scene()).leaf(source.id(object), triangle)));
  add_contacts_of(source.scene().result(), object, triangle, json);
}

void answer_read_object(const SceneView& show, const Source& source, std::uint32_t object, JsonText& json) {
  const TriangleMesh& mesh = show.objects[object].mesh;
  Extent extent;
  extent.add(source.positions(object));
  json.member("object", object);
  json.member("name", source.scene().options(source.id(object)).name);
  json.member("vertices", std::uint64_t{mesh.positions.size()});
  json.member("triangles", std::uint64_t{mesh.triangles.size()});
  json.key("bounds");
  if (extent.empty()) {
    json.null();
  } else {
    json.begin_array();
    json.value(extent.low);
    json.value(extent.high);
    json.end_array();
  }
  json.member("contact_count", contact_count(source.scene().result(), object));
  add_regions(source, object, json);
  add_octree(SceneInspector(source.scene()).octree_statistics(source.id(object)), json);
}

}  // namespace supple::viewer
