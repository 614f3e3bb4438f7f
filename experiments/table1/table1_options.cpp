#include "table1/table1_options.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "table1/table1_scenes.hpp"

namespace supple::experiments {

Table1Scene mixed_scene(std::uint32_t objects, std::optional<double> size) {
  return {Table1Scene::Source::mixed, fmt::format("table1_{}", objects), objects, size};
}

Table1Scene built_in_scene(const std::string& name) {
  return {Table1Scene::Source::built_in, name};
}

Table1Scene scene_called(const std::string& name) {
  return is_built_in(name) ? built_in_scene(name) : Table1Scene{Table1Scene::Source::file, name};
}

bool is_met(const cli::OptionNeed& need, const Table1Method& method) {
  return std::any_of(method.volumes.begin(), method.volumes.end(), [&](auto volume) {
    SceneOptions scene = method.scene;
    scene.bounding_volume = volume;
    return need.is_met(scene);
  });
}

Table1Options default_table1_options(bool quick) {
  constexpr double small_edge = 4;  // about the smallest cube in which the nine objects start
  const Table1Scene humans = built_in_scene("three_humans"), bikes = built_in_scene("three_bikes");
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

}  // namespace supple::experiments
