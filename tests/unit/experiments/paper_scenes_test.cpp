// The scenes of the paper's section 7 preserve the areas of triangles, as its section 4 says.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <variant>
#include <vector>

#include "scene_file/scene_file.hpp"
#include "supple/simulation.hpp"

namespace supple::paper_scenes_test {

/// The mean area error of all objects after 1.1 seconds, in which random forces deform them.
double area_error_of(const std::string& scene, bool preserved) {
  const cli::Input input = cli::read_scene_file(SUPPLE_SCENES "/" + scene + ".toml");
  SimulationOptions options = input.simulation;
  options.scene.contacts = ContactKinds::none;
  options.scene.threads = 1;
  Simulation simulation(options);
  std::vector<ObjectId> ids;
  for (const cli::InputObject& object : input.objects) {
    MassSpringMotion motion = std::get<MassSpringMotion>(*object.motion);
    EXPECT_GT(motion.springs.area_stiffness, 0) << scene;
    if (!preserved) motion.springs.area_stiffness = 0;
    ids.push_back(simulation.add(object.mesh, object.options, motion));
    EXPECT_GT(simulation.body(ids.back())->stable_step(), options.time_step) << scene;
  }
  for (int step = 0; step < 55; ++step) simulation.step();
  double sum = 0;
  for (const ObjectId id : ids) sum += simulation.body(id)->area_error().mean;
  return sum / static_cast<double>(ids.size());
}

TEST(PaperScenes, PreserveTheAreasOfTriangles) {
  for (const std::string scene : {"table1_3", "table1_6", "table1_9", "three_humans", "three_bikes"}) {
    const double error = area_error_of(scene, true);
    EXPECT_LT(error, 0.015) << scene;
    EXPECT_LT(error, 0.4 * area_error_of(scene, false)) << scene;
  }
}

/// The mean strain of all objects and the largest of an edge, at each tenth of a second from 1.5 s on.
std::vector<EdgeStrain> strains_of(const std::string& scene, double seconds) {
  const cli::Input input = cli::read_scene_file(SUPPLE_SCENES "/" + scene + ".toml");
  SimulationOptions options = input.simulation;
  options.scene.contacts = ContactKinds::none;
  Simulation simulation(options);
  std::vector<ObjectId> ids;
  for (const cli::InputObject& object : input.objects)
    ids.push_back(simulation.add(object.mesh, object.options, std::get<MassSpringMotion>(*object.motion)));
  std::vector<EdgeStrain> strains;
  while (simulation.time() < seconds) {
    simulation.step();
    if (simulation.step_count() % 5 != 0 || simulation.time() < 1.5) continue;
    EdgeStrain all;
    for (const ObjectId id : ids) {
      const EdgeStrain strain = simulation.body(id)->edge_strain();
      all.largest = std::max(all.largest, strain.largest);
      all.mean += strain.mean / static_cast<double>(ids.size());
    }
    strains.push_back(all);
  }
  return strains;
}

TEST(PaperScenes, BendUntilTheEnd) {
  for (const std::string scene : {"table1_3", "table1_6", "table1_9", "three_humans", "three_bikes"}) {
    double mean = 0;
    // Bikes take long; until then they bend half as much as later.
    const bool are_bikes = scene == "three_bikes";
    const std::vector<EdgeStrain> strains = strains_of(scene, are_bikes ? 2.5 : 12);
    for (const EdgeStrain& strain : strains) {
      // Some of the 28,000 edges of a bike are shorter than a thousandth of it; its steps are half as long.
      EXPECT_LT(strain.largest, 0.13) << scene;
      EXPECT_GT(strain.mean, are_bikes ? 0.01 : 0.015) << scene;
      mean += strain.mean / static_cast<double>(strains.size());
    }
    EXPECT_GT(mean, are_bikes ? 0.015 : 0.03) << scene;
    EXPECT_LT(mean, 0.1) << scene;
  }
}

}  // namespace supple::paper_scenes_test
