#include "mpi/refused_options.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <variant>

#include "base/text.hpp"
#include "options/option_needs.hpp"
#include "supple/error.hpp"

namespace supple::cli {
namespace {

bool is_mass_spring(const InputObject& object) {
  return object.motion && std::holds_alternative<MassSpringMotion>(*object.motion);
}

}  // namespace

void refuse_options(const DetectionOptions& options, const Input& input, bool has_steps) {
  const SceneOptions& scene = input.simulation.scene;
  const struct {
    bool is_given;
    const char* what;
  } refused[] = {
      {options.verify, "--verify"},
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
      {has_steps && input.simulation.response && std::ranges::any_of(input.objects, is_mass_spring),
       "the response of masses and springs to contacts"},
  };
  for (const auto& [is_given, what] : refused) {
    if (is_given)
      throw Error(fmt::format("{}: several ranks do not have it; leave it out, or start one process", what));
  }
}

}  // namespace supple::cli
