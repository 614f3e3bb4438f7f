#include "experiments/table1_scenes.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include "experiments/table1.hpp"
#include "scene_file.hpp"
#include "supple/error.hpp"

namespace supple::experiments {
namespace {

constexpr std::pair<const char*, std::string_view> texts[] = {
#include "table1_scene_texts.inc"
};

}  // namespace

std::vector<std::string> table1_scene_names() {
  std::vector<std::string> names;
  for (const auto& entry : texts) names.emplace_back(entry.first);
  return names;
}

cli::Input table1_scene(const std::string& name) {
  const auto found = std::find_if(std::begin(texts), std::end(texts),
                                  [&](const auto& entry) { return name == entry.first; });
  if (found == std::end(texts)) throw Error("there is no scene '" + name + "' in this program");
  return cli::read_scene_text(std::string(found->second), name + ".toml");
}

}  // namespace supple::experiments
