#include "table1/table1_scenes.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>
#include <vector>

#include "scene_file/scene_file.hpp"
#include "supple/error.hpp"

namespace supple::experiments {
namespace {

constexpr std::size_t models = 3;  // pawn, fish and rabbit
constexpr double spacing = 1.3;    // of scenes/table1_9.toml

const SceneText* text_of(std::string_view name) {
  const auto texts = table1_scene_texts();
  const auto found =
      std::find_if(texts.begin(), texts.end(), [&](const SceneText& scene) { return name == scene.name; });
  return found == texts.end() ? nullptr : &*found;
}

cli::Input built_in(const std::string& name, std::uint64_t seed) {
  const SceneText* const found = text_of(name);
  if (found == nullptr) throw Error("there is no scene '" + name + "' in this program");
  return cli::read_scene_text(found->text, name + ".toml", {.seed = seed, .time_step = {}});
}

/// The offset of a copy of a model from the middle of its rows.
Vec3d offset_of(std::uint32_t copy, std::uint32_t copies) {
  std::uint32_t columns = std::min(copies, 3u);
  while (columns * columns < copies) ++columns;
  const std::uint32_t rows = (copies + columns - 1) / columns;
  return {(copy % columns - 0.5 * (columns - 1.0)) * spacing, 0,
          (copy / columns - 0.5 * (rows - 1.0)) * spacing};
}

Vec3d center_of(const std::optional<Border>& border) {
  return border ? ((*border)[0] + (*border)[1]) * 0.5 : Vec3d{};
}

/// The edge of the smallest cube around a point that contains all objects at the start.
double edge_around(Vec3d center, const cli::Input& input) {
  double half = 0;
  for (const cli::InputObject& object : input.objects) {
    for (const Vec3d& p : object.mesh.positions) {
      for (int axis = 0; axis < 3; ++axis) half = std::max(half, std::fabs(p[axis] - center[axis]));
    }
  }
  return 2 * half;
}

void set_border(cli::Input& input, Vec3d center, double edge) {
  const Vec3d half{edge / 2, edge / 2, edge / 2};
  input.simulation.border = Border{center - half, center + half};
}

cli::Input mixed(std::uint32_t objects, std::uint64_t seed) {
  cli::Input input = built_in("table1_3", seed);
  const std::vector<cli::InputObject> recipe = std::exchange(input.objects, {});
  for (std::uint32_t model = 0; model < models; ++model) {
    const std::uint32_t copies = (objects + 2 - model) / 3;
    for (std::uint32_t copy = 0; copy < copies; ++copy) {
      cli::InputObject& object = input.objects.emplace_back(recipe[model]);
      const Vec3d offset = offset_of(copy, copies);
      for (Vec3d& position : object.mesh.positions) position = position + offset;
      if (copies > 1) object.mesh.name += fmt::format(" {}", copy + 1);
      object.options.name = object.mesh.name;
    }
  }
  const Vec3d center = center_of(input.simulation.border);
  if (const double edge = edge_around(center, input); edge > edge_of(input))
    set_border(input, center, std::ceil(edge));
  return input;
}

void resize(cli::Input& input, const Table1Scene& scene) {
  const auto is_reflected = [](const cli::InputObject& object) {
    return object.motion && (std::holds_alternative<MassSpringMotion>(*object.motion) ||
                             std::holds_alternative<WaveMotion>(*object.motion));
  };
  if (std::none_of(input.objects.begin(), input.objects.end(), is_reflected))
    throw Error(
        fmt::format("--scene-size: has no effect on {}, in which a border reflects no object", scene.name));
  const Vec3d center = center_of(input.simulation.border);
  if (const double least = edge_around(center, input); least > *scene.size)
    throw Error(fmt::format("--scene-size: objects of {} start outside a cube of {}; give at least {:.1f}",
                            scene.name, *scene.size, std::ceil(least * 10) / 10));
  set_border(input, center, *scene.size);
}

void set_integrator(cli::Input& input, Integrator integrator, const std::string& name) {
  bool has_effect = false;
  for (cli::InputObject& object : input.objects) {
    if (!object.motion) continue;
    if (auto* const body = std::get_if<MassSpringMotion>(&*object.motion)) {
      body->springs.integrator = integrator;
      has_effect = true;
    }
  }
  if (!has_effect)
    throw Error(fmt::format("--integrator: has no effect on {}, which has no mass-spring body", name));
}

}  // namespace

bool is_built_in(std::string_view name) {
  return text_of(name) != nullptr;
}

cli::Input read_scene(const Table1Scene& scene, std::optional<Integrator> integrator, std::uint64_t seed) {
  cli::Input input = scene.source == Table1Scene::Source::built_in ? built_in(scene.name, seed)
                     : scene.source == Table1Scene::Source::mixed
                         ? mixed(scene.objects, seed)
                         : cli::read_scene_file(scene.name, {.seed = seed, .time_step = {}});
  // Waves do not use the seed of the scene; without their own, all runs would be equal.
  for (cli::InputObject& object : input.objects) {
    if (!object.motion) continue;
    if (auto* const waves = std::get_if<WaveMotion>(&*object.motion)) waves->seed += seed;
  }
  if (scene.size) resize(input, scene);
  if (integrator) set_integrator(input, *integrator, scene.name);
  return input;
}

std::optional<double> edge_of(const cli::Input& input) {
  if (!input.simulation.border) return std::nullopt;
  const Vec3d edges = (*input.simulation.border)[1] - (*input.simulation.border)[0];
  return std::max({edges.x, edges.y, edges.z});
}

}  // namespace supple::experiments
