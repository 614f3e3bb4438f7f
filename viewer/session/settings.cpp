#include "settings.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include "failure.hpp"
#include "sources/extent.hpp"
#include "supple/mesh.hpp"

namespace supple::viewer {
namespace {

/// The side of a square grid in x and z that holds `copies` copies of all objects.
std::size_t grid_side(std::size_t copies) {
  std::size_t side = 1;
  while (side * side < copies) ++side;
  return side;
}

/// The distance between copies: the size of the border, or the size of the objects plus a tenth.
Vec3d cell_size(const SceneView& show) {
  Vec3d size = 1.1 * extent_of(show).size();
  const std::optional<Border>& border = show.simulation.border;
  for (const int axis : {0, 2}) {
    const double room = border ? (*border)[1][axis] - (*border)[0][axis] : 0;
    if (std::isfinite(room)) size[axis] = std::max(size[axis], room);
    if (!(size[axis] > 0)) size[axis] = 1;
  }
  return size;
}

void set_apart(ViewedObject& object, std::size_t copy, const Vec3d& offset) {
  if (object.options.name.empty()) object.options.name = object.mesh.name;
  object.options.name += " #";
  object.options.name += std::to_string(copy + 1);
  for (Vec3d& p : object.mesh.positions) p = p + offset;
  // With equal waves and random numbers, all copies would move in the same way.
  if (auto* const sway = std::get_if<WaveMotion>(&object.motion)) sway->seed += copy * 1'000'003;
  if (auto* const springs = std::get_if<MassSpringMotion>(&object.motion); springs && springs->seed)
    *springs->seed += copy * 1'000'003;
  if (auto* const rigid = std::get_if<RigidMotion>(&object.motion); rigid && rigid->seed)
    *rigid->seed += copy * 1'000'003;
}

/// Calls `visit(object)` for each object when the list of objects is repeated up to `count`.
template <class Visit>
void visit_repeated(const SceneView& show, std::size_t count, const Visit& visit) {
  for (std::size_t i = 0; i < count && !show.objects.empty(); ++i)
    visit(show.objects[i % show.objects.size()]);
}

/// Checks the total size when the list of objects is repeated up to `count`.
void check_size(const SceneView& show, std::size_t count) {
  constexpr std::uint64_t most_elements = 100'000'000;
  std::uint64_t vertices = 0, triangles = 0;
  visit_repeated(show, count, [&](const ViewedObject& object) {
    vertices += object.mesh.positions.size();
    triangles += object.mesh.triangles.size();
  });
  if (std::max(vertices, triangles) <= most_elements) return;
  fail(std::to_string(count) + " objects have " + std::to_string(vertices) + " vertices and " +
       std::to_string(triangles) + " triangles; a page can show " + std::to_string(most_elements) +
       " of each at most");
}

void repeat_objects(SceneView& show, std::size_t count) {
  std::vector<ViewedObject>& objects = show.objects;
  const std::size_t given = objects.size();
  if (count <= given || given == 0) {
    objects.resize(std::min(count, given));
    return;
  }
  check_size(show, count);
  const Vec3d cell = cell_size(show);
  const std::size_t copies = (count + given - 1) / given;
  const std::size_t side = grid_side(copies);
  objects.reserve(count);
  for (std::size_t i = given; i < count; ++i) {
    const std::size_t copy = i / given;
    const Vec3d offset{static_cast<double>(copy % side) * cell.x, 0,
                       static_cast<double>(copy / side) * cell.z};
    objects.push_back(objects[i % given]);
    set_apart(objects.back(), copy, offset);
  }
  if (show.simulation.border) {
    Vec3d& far = (*show.simulation.border)[1];
    far.x += static_cast<double>(side - 1) * cell.x;
    far.z += static_cast<double>((copies - 1) / side) * cell.z;
  }
}

void check_show(const SceneView& show) {
  for (const ViewedObject& object : show.objects) {
    check_mesh(object.mesh);
    if (const auto* const waves = std::get_if<WaveMotion>(&object.motion))
      check(*waves, object.options.name.empty() ? object.mesh.name : object.options.name);
  }
  check_size(show, show.objects.size());
}

}  // namespace

Settings read_settings(Settings settings, const SceneOptions& scene, bool of_simulation,
                       Arguments& arguments) {
  bool names_scene_octree = false;
  const auto read = [&]<class Struct, class Value>(const Field<Struct, Value>& field, Value& value) {
    const bool is_named = is_setting(field) && arguments.option(field, value);
    if (std::is_same_v<Struct, SceneOctreeOptions> && is_named) names_scene_octree = true;
    return is_named;
  };
  settings.scene.read(read);
  settings.octree.read(read);
  if (of_simulation) {
    for_each_restart_setting([&]<class Struct, class Value>(const Field<Struct, Value>& field, auto member) {
      Value value{};
      if (arguments.option(field, value)) settings.restart.*member = value;
    });
  }
  SceneOptions chosen = scene;
  settings.scene.apply_to(chosen);
  if (names_scene_octree && !uses_scene_octree(chosen.broad_phase))
    arguments.fail(std::string("options of the scene octree have no effect with the broad phase ") +
                   word_of(chosen.broad_phase) + "; choose automatic or octree first");
  return settings;
}

double estimated_memory(const SceneView& show, const Settings& settings) {
  // In bytes. Small leaves have as many nodes as triangles.
  constexpr double of_object = 24'000, of_vertex = 400, of_triangle = 400, of_leaf = 4'000;
  double bytes = 0;
  visit_repeated(
      show, settings.restart.objects.value_or(show.objects.size()), [&](const ViewedObject& object) {
        ObjectOctreeOptions octree = object.options.octree;
        settings.octree.apply_to(octree);
        const auto vertices = static_cast<double>(object.mesh.positions.size());
        const auto triangles = static_cast<double>(object.mesh.triangles.size());
        bytes += of_object + of_vertex * vertices + (of_triangle + of_leaf / octree.leaf_size) * triangles;
      });
  return bytes;
}

bool fits_in_memory(const SceneView& show, const Settings& settings, double bytes, Arguments& arguments) {
  const double needed = estimated_memory(show, settings);
  if (needed <= bytes) return true;
  const auto megabytes = [](double amount) {
    return std::to_string(static_cast<std::uint64_t>(amount / 1e6)) + " MB";
  };
  arguments.fail(std::to_string(settings.restart.objects.value_or(show.objects.size())) +
                 " objects with such octrees can need " + megabytes(needed) + ", and this session has " +
                 megabytes(bytes) +
                 "; show fewer objects, or larger leaves, or use supple view with a larger --max-memory");
  return false;
}

SceneView arranged(const SceneView& show, const Settings& settings) {
  check_show(show);
  SceneView arranged = show;
  if (settings.restart.objects) repeat_objects(arranged, *settings.restart.objects);
  SimulationOptions& simulation = arranged.simulation;
  settings.scene.apply_to(simulation.scene);
  simulation.scene.contacts = with_included(simulation.scene.contacts);
  if (!uses_scene_octree(simulation.scene.broad_phase)) simulation.scene.scene_octree = {};
  // `PaperVertices` computes these, and only on request.
  simulation.scene.comparison.colliding_vertices = false;
  simulation.scene.manifolds = false;
  simulation.scene.curves = true;
  simulation.fused_refit = simulation.fused_refit && simulation.scene.comparison.lazy_refit;
  simulation.time_step = settings.restart.time_step.value_or(simulation.time_step);
  simulation.seed = settings.restart.seed.value_or(simulation.seed);
  for (ViewedObject& object : arranged.objects) {
    settings.octree.apply_to(object.options.octree);
    if (auto* const motion = std::get_if<MassSpringMotion>(&object.motion))
      motion->springs.integrator = settings.restart.integrator.value_or(motion->springs.integrator);
  }
  return arranged;
}

}  // namespace supple::viewer
