#include "table1/table1_options.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "options/option_kinds.hpp"
#include "table1/table1_scenes.hpp"

namespace supple::experiments {

Table1Scene mixed_scene(std::uint32_t objects, std::optional<double> size) {
  return {Table1Scene::Source::mixed, fmt::format("table1_{}", objects), objects, size};
}

Table1Scene scene_called(const std::string& name) {
  return {is_built_in(name) ? Table1Scene::Source::built_in : Table1Scene::Source::file, name};
}

bool is_met(const cli::OptionNeed& need, const Table1Method& method) {
  return std::any_of(method.volumes.begin(), method.volumes.end(), [&](auto volume) {
    SceneOptions scene = method.scene;
    scene.bounding_volume = volume;
    return need.is_met(scene);
  });
}

bool has_effect(const Table1Method& method, std::string_view key) {
  const auto needs = cli::option_needs();
  return std::all_of(needs.begin(), needs.end(),
                     [&](const cli::OptionNeed& need) { return key != need.key || is_met(need, method); });
}

Table1Options default_table1_options(bool quick) {
  constexpr double small_edge = 4;  // about the smallest cube in which the nine objects start
  const Table1Scene humans{Table1Scene::Source::built_in, "three_humans"},
      bikes{Table1Scene::Source::built_in, "three_bikes"};
  Table1Options options;
  if (quick) {
    options.scenes = {mixed_scene(3), mixed_scene(6), mixed_scene(9), mixed_scene(9, small_edge), humans};
    options.simulated_seconds = 10;
    return options;
  }
  for (const std::uint32_t objects : {3u, 6u, 9u, 12u, 20u, 30u})
    options.scenes.push_back(mixed_scene(objects));
  options.scenes.insert(options.scenes.end(), {mixed_scene(9, small_edge), humans, bikes});
  return options;
}

std::vector<std::pair<std::string, std::string>> describe(const Table1Options& options) {
  std::vector<std::string> scenes, volumes;
  for (const Table1Scene& scene : options.scenes)
    scenes.push_back(scene.size ? fmt::format("{} in a cube of {}", scene.name, *scene.size) : scene.name);
  for (const BoundingVolume volume : options.method.volumes) volumes.push_back(cli::spelled(word_of(volume)));
  std::vector<std::pair<std::string, std::string>> rows{
      {"scenes", fmt::format("{}", fmt::join(scenes, ", "))},
      {"hash of the scenes", fmt::format("{:016x}", hash_of(options))},
      {"--bounding-volume", fmt::format("{}", fmt::join(volumes, ","))}};
  for_each_option(
      [&](const auto& field, const auto& value) {
        if (has_effect(options.method, field.key))
          rows.emplace_back(cli::flag_of(field.key), cli::spelled_value(field, value));
      },
      options.method);
  if (has_effect(options.method, "lazy_refit") && options.method.scene.comparison.lazy_refit)
    rows.emplace_back("--fused-refit", options.method.fused_refit ? "on" : "off");
  if (options.method.root_is_border) {
    rows.emplace_back("--scene-octree-root", "border");
  } else if (const auto& root = options.method.scene.scene_octree.root) {
    rows.emplace_back("--scene-octree-root",
                      fmt::format("{},{},{},{}", root->corner.x, root->corner.y, root->corner.z, root->edge));
  }
  if (options.method.integrator)
    rows.emplace_back("--integrator", cli::spelled(word_of(*options.method.integrator)));
  rows.emplace_back("--runs", fmt::format("{}", options.runs));
  rows.emplace_back("--seed", fmt::format("{}", options.seed));
  rows.emplace_back("--seconds", fmt::format("{}", options.simulated_seconds));
  if (options.program_clock) rows.emplace_back("--program-clock", fmt::format("{}", *options.program_clock));
  return rows;
}

}  // namespace supple::experiments
