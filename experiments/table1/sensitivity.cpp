#include <fmt/core.h>

#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "results.hpp"
#include "table1/table1_runs.hpp"

namespace supple::experiments {
namespace {

/// One setting: what differs from the scenes as they are.
struct Setting {
  std::string name;
  std::optional<double> size{};
  std::function<void(MassSpringMotion&)> motion{};
};

/// Settings of the method, which see the motion of the scenes as they are.
std::vector<Variant> method_settings() {
  std::vector<Variant> all;
  const auto add = [&](const std::string& name, const std::function<void(Table1Method&)>& change) {
    Table1Method method;
    change(method);
    for (const BoundingVolume volume : {BoundingVolume::aabb, BoundingVolume::sphere})
      all.push_back({method, volume, name});
  };
  add("the scenes as they are", [](Table1Method&) {});
  for (const std::uint32_t level : {1u, 3u, 4u})
    add(fmt::format("level-allowed {} of the scene", level),
        [=](Table1Method& m) { m.scene.scene_octree.max_level = level; });
  for (const std::uint32_t level : {1u, 2u, 3u, 4u})
    add(fmt::format("level-allowed {} of the objects", level),
        [=](Table1Method& m) { m.octree.max_level = level; });
  for (const std::uint32_t size : {4u, 16u})
    add(fmt::format("leaves of up to {} triangles", size),
        [=](Table1Method& m) { m.octree.leaf_size = size; });
  add("spheres of eq. 3 and 4", [](Table1Method& m) { m.scene.comparison.sphere_fit = SphereFit::box; });
  return all;
}

std::vector<Setting> settings() {
  std::vector<Setting> all;
  const std::vector<double> sizes{4, 5, 8, 10}, speeds{0.25, 0.5, 2, 4};
  for (const double size : sizes) all.push_back({fmt::format("cube of {}", size), size});
  const auto faster = [](double factor) { return [=](MassSpringMotion& m) { m.random_speed *= factor; }; };
  for (const double speed : speeds) {
    all.push_back({fmt::format("speed × {}", speed), {}, faster(speed)});
    for (const double size : sizes)
      all.push_back({fmt::format("speed × {}, cube of {}", speed, size), size, faster(speed)});
  }
  for (const double factor : {0.25, 0.5, 2.0})
    all.push_back({fmt::format("stiffness × {}", factor), {}, [=](MassSpringMotion& m) {
                     m.springs.stiffness *= factor;
                     m.springs.bending_stiffness *= factor;
                     m.springs.area_stiffness *= factor;
                     m.springs.damping *= std::sqrt(factor);
                   }});
  for (const double factor : {0.0, 0.5, 2.0})
    all.push_back(
        {fmt::format("forces × {}", factor), {}, [=](MassSpringMotion& m) { m.random_force *= factor; }});
  return all;
}

}  // namespace

bool run_sensitivity(const Table1Options& options, const Request& request, bool resume,
                     const cli::Interruption& interruption) {
  const bool quick = request.quick;
  std::vector<Motion> motions;
  for (const std::uint32_t objects : {3u, 6u, 9u}) {
    // Three objects collide rarely.
    const double seconds = quick ? 10 : objects == 3 ? 600 : 120;
    std::vector<Variant> methods = method_settings();
    if (quick) methods.resize(4);
    motions.push_back({mixed_scene(objects), methods, {}, seconds});
    for (const Setting& setting : quick ? std::vector<Setting>{settings().front()} : settings()) {
      Motion& motion = motions.emplace_back(Motion{mixed_scene(objects, setting.size), {}, {}, seconds});
      for (const BoundingVolume volume : {BoundingVolume::aabb, BoundingVolume::sphere})
        motion.variants.push_back({{}, volume, setting.name});
      if (setting.motion)
        motion.change = [change = setting.motion](cli::Input& input) {
          for (cli::InputObject& object : input.objects) change(std::get<MassSpringMotion>(*object.motion));
        };
    }
  }
  return run_all(motions,
                 {.folder = request.folder,
                  .name = "sensitivity",
                  .resume = resume,
                  .runs = quick ? 2 : options.runs,
                  .seed = options.seed,
                  .threads = options.threads},
                 interruption, request.show_progress);
}

}  // namespace supple::experiments
