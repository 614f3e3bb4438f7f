#include "experiments/table1_scenes.hpp"

#include <algorithm>

#include "experiments/table1.hpp"
#include "scene_file.hpp"
#include "supple/error.hpp"

namespace supple::experiments {
std::vector<std::string> table1_scene_names() {
  std::vector<std::string> names;
  for (const SceneText& scene : table1_scene_texts()) names.emplace_back(scene.name);
  return names;
}

cli::Input table1_scene(const std::string& name) {
  const auto texts = table1_scene_texts();
  const auto found =
      std::find_if(texts.begin(), texts.end(), [&](const SceneText& scene) { return name == scene.name; });
  if (found == texts.end()) throw Error("there is no scene '" + name + "' in this program");
  return cli::read_scene_text(found->text, name + ".toml");
}

}  // namespace supple::experiments
