#include "commands/commands.hpp"

#include <fmt/core.h>

#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "base/files.hpp"
#include "base/json_writer.hpp"
#include "base/run_program.hpp"
#include "base/text.hpp"
#include "commands/build_simulation.hpp"
#include "inputs/inputs.hpp"
#include "session/messages/described_json.hpp"
#include "supple/inspection.hpp"
#include "supple/inspection_descriptions.hpp"
#include "supple/orientation.hpp"
#include "supple/result_descriptions.hpp"
#include "supple/scene.hpp"
#include "supple/topology.hpp"

namespace supple::cli {
namespace {

/// All reported data of one object.
struct MeshInfo {
  const TriangleMesh& mesh;
  MeshTopology topology;
  bool is_open_at_seams = false;
  std::uint64_t inward_triangles = 0;
  std::uint64_t non_finite_vertices = 0;
  std::optional<std::array<Vec3d, 2>> bounds{};  ///< of the finite vertices; none when no vertex is finite
  std::uint32_t arity = 0;
  OctreeStatistics octree{};

  /// Edges and points of no triangle are in the octree, too.
  bool has_lines() const { return !mesh.edges.empty() || !mesh.points.empty(); }
};

MeshInfo measure(const InputObject& object, SceneOptions scene_options, const InfoOptions& options) {
  ObjectOptions chosen = object.options;
  options.given_objects.apply_to(chosen);
  const TriangleMesh surface = chosen.weld ? welded(object.mesh) : object.mesh;
  MeshInfo info{object.mesh, compute_topology(surface), is_open_at_seams(surface),
                count_inward_triangles(surface)};
  for (const Vec3d& p : object.mesh.positions) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
      ++info.non_finite_vertices;
      continue;
    }
    if (!info.bounds) info.bounds = {p, p};
    auto& [lowest, highest] = *info.bounds;
    for (int axis = 0; axis < 3; ++axis) {
      lowest[axis] = std::fmin(lowest[axis], p[axis]);
      highest[axis] = std::fmax(highest[axis], p[axis]);
    }
  }
  info.arity = chosen.octree.arity;
  scene_options.threads = 1;
  options.given_scene.apply_to(scene_options);
  Scene scene(scene_options);
  info.octree = SceneInspector(scene).octree_statistics(scene.add(object.mesh, chosen));
  return info;
}

std::string describe_polygons(const PolygonCounts& polygons) {
  std::string text;
  const auto add = [&](std::uint64_t number, const std::string& words) {
    if (number > 0) text += (text.empty() ? "" : ", ") + words;
  };
  add(polygons.quads, counted(polygons.quads, "quad"));
  add(polygons.larger, grouped(polygons.larger) + " of more than 4 corners");
  add(polygons.concave, grouped(polygons.concave) + " concave");
  add(polygons.crossing,
      grouped(polygons.crossing) + (polygons.crossing == 1 ? " crosses itself" : " cross themselves"));
  add(polygons.bent, grouped(polygons.bent) + " not flat");
  return text;
}

void print_text(const MeshInfo& info) {
  const MeshTopology& t = info.topology;
  fmt::print("{}\n", one_line(info.mesh.name));
  fmt::print("  vertices     {}", grouped(t.vertices));
  if (t.unused_vertices > 0) fmt::print(", {} in no triangle", grouped(t.unused_vertices));
  if (info.non_finite_vertices > 0) fmt::print(", {} not finite", grouped(info.non_finite_vertices));
  fmt::print("\n  triangles    {}", grouped(t.triangles));
  if (t.degenerate_triangles > 0) fmt::print(", {} with a repeated vertex", grouped(t.degenerate_triangles));
  if (info.mesh.polygons != PolygonCounts{})
    fmt::print("\n  polygons     {}", describe_polygons(info.mesh.polygons));
  fmt::print("\n  edges        {}\n", grouped(t.edges));
  if (info.has_lines())
    fmt::print("  lines        {}, and {}\n", counted(info.mesh.edges.size(), "edge"),
               counted(info.mesh.points.size(), "point"));
  fmt::print("  surface      {}\n", describe_surface(t));
  if (info.is_open_at_seams)
    fmt::print(
        "               most open edges are seams between vertices at equal positions; --weld closes them\n");
  if (info.inward_triangles > 0)
    fmt::print("               {} inwards; a solid takes them as if they faced outwards\n",
               counted(info.inward_triangles, "triangle faces", "triangles face"));
  fmt::print("  components   {}, Euler characteristic {}\n", grouped(t.components), t.euler_characteristic);
  if (info.bounds) {
    const auto& [lowest, highest] = *info.bounds;
    fmt::print("  bounds       ({}, {}, {}) to ({}, {}, {})\n", lowest.x, lowest.y, lowest.z, highest.x,
               highest.y, highest.z);
  }
  const OctreeStatistics& o = info.octree;
  const char* const item = info.has_lines() ? "element" : "triangle";
  fmt::print(
      "  octree       {}, {}, depth {}, {:.1f} {}s per leaf (largest {}), {:.1f} of {} children per node\n",
      counted(o.nodes, "node"), o.leaves == 1 ? "1 leaf" : grouped(o.leaves) + " leaves", o.depth,
      o.mean_leaf_size, item, o.largest_leaf, o.mean_node_width, info.arity);
  if (o.cost > 0) fmt::print("  quality      {:.1f} visits per query\n", o.cost);
  fmt::print("  memory       {} bytes, {:.1f} per {}\n\n", grouped(o.bytes), o.bytes_per_triangle, item);
}

void write_json(JsonWriter& json, const MeshInfo& info) {
  const MeshTopology& t = info.topology;
  json.member("name", info.mesh.name);
  json.member("vertices", t.vertices);
  json.member("triangles", t.triangles);
  json.object("polygons", [&] { viewer::write_members(json, info.mesh.polygons); });
  json.member("edges", t.edges);
  json.member("lines", std::uint64_t{info.mesh.edges.size()});
  json.member("points", std::uint64_t{info.mesh.points.size()});
  json.member("closed", t.closed());
  json.member("boundary_edges", t.boundary_edges);
  json.member("odd_edges", t.odd_edges);
  json.member("open_at_seams", info.is_open_at_seams);
  json.member("inward_triangles", info.inward_triangles);
  json.member("non_manifold_edges", t.non_manifold_edges);
  json.member("components", t.components);
  json.member("euler_characteristic", t.euler_characteristic);
  json.member("unused_vertices", t.unused_vertices);
  json.member("degenerate_triangles", t.degenerate_triangles);
  json.member("non_finite_vertices", info.non_finite_vertices);
  info.bounds ? json.list("bounds", *info.bounds) : json.member("bounds", std::optional<double>());
  json.object("octree", [&] { viewer::write_members(json, info.octree); });
}

}  // namespace

int run_info(const InfoOptions& options) {
  Input input = read_objects(options.inputs, {}, {options.conversion, {}, {}});
  apply_to_objects(options.given_objects, options.as_2007, options.parts, input);
  print_notes(input);
  check_output_names({{"--json", options.json}}, input.files);
  std::optional<JsonWriter> json;
  if (!options.json.empty()) json.emplace(options.json);
  std::vector<MeshInfo> measured;
  for (const InputObject& object : input.objects) {
    measured.push_back(measure(object, input.simulation.scene, options));
    if (options.json != "-") print_text(measured.back());
  }
  if (json) {
    json->objects("objects", measured, [&](const MeshInfo& info) { write_json(*json, info); });
    json->close();
  }
  return exit_done;
}

}  // namespace supple::cli
