#include "mpi/refused_options.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "base/text.hpp"
#include "options/option_needs.hpp"
#include "supple/error.hpp"

namespace supple::cli {
void refuse_options(const DetectionOptions& options, const Input& input) {
  const SceneOptions& scene = input.simulation.scene;
  const struct {
    bool is_given;
    const char* what;
  } refused[] = {
      {options.limits.max_contacts != RunLimits{}.max_contacts, "--max-contacts"},
      {options.json_content.node_pairs.has_value(), "--node-pairs"},
      {scene.bounding_volume != BoundingVolume::aabb, "a bounding volume other than aabb"},
      {scene.comparison.colliding_vertices, "colliding vertices"},
      {scene.comparison.lazy_refit, "lazy refit"},
      {scene.manifolds, "manifolds"},
      {has_continuous(scene) && scene.continuous_listing == ContinuousListing::first,
       "continuous listing first"},
      {std::ranges::any_of(input.objects, [](const InputObject& object) { return object.options.weld; }),
       "weld"},
  };
  for (const auto& [is_given, what] : refused) {
    if (is_given)
      throw Error(fmt::format("{}: several ranks do not have it; leave it out, or start one process", what));
  }
}

}  // namespace supple::cli
