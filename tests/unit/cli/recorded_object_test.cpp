#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "commands/build_simulation.hpp"
#include "supple/comparison.hpp"
#include "supple/inspection.hpp"
#include "supple/models.hpp"

namespace supple::cli::recorded_object_test {

Input moving_objects() {
  Input input;
  input.simulation.border = Border{Vec3d{-1, -1, -1}, Vec3d{1, 1, 1}};
  const auto add = [&](const char* model, std::optional<Motion> motion) {
    InputObject& object = input.objects.emplace_back();
    object.mesh = make_model(model);
    object.options.octree = octree_of_2007();
    object.motion = std::move(motion);
  };
  add("pawn", WaveMotion{.velocity = {1, 0.5, 0}, .amplitude = 0.06, .wavelength = 0.6});
  add("fish", ComputedMotion{2, [](std::uint64_t frame, std::span<Vec3d> positions) {
                               for (Vec3d& p : positions)
                                 p = {p.z, p.x * p.y, p.y + static_cast<double>(frame)};
                             }});
  add("rabbit", RigidMotion{.velocity = {1, 0, 0}, .spin = {0, 90, 0}});
  add("pawn", std::nullopt);
  return input;
}

TEST(RecordedObject, HasThePositionsFromWhichTheOctreeIsBuilt) {
  const Input input = moving_objects();
  Simulation simulation = build_simulation(input);
  simulation.detect();
  Scene rebuilt;
  const std::vector<ObjectId> ids = simulation.scene().objects();
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const RecordedObject recorded = recorded_object(ids[i], input.objects[i], input.simulation.border);
    const std::span<const Vec3d> start = simulation.positions(ids[i]);
    EXPECT_TRUE(std::ranges::equal(recorded.rest_positions, start)) << i;
    EXPECT_EQ(std::ranges::equal(recorded.rest_positions, input.objects[i].mesh.positions), i >= 2) << i;
    rebuilt.add({"recorded", recorded.rest_positions, recorded.triangles}, recorded.options);
  }
  rebuilt.detect();
  for (const ObjectId id : ids) {
    const OctreeStatistics expected = SceneInspector(simulation.scene()).octree_statistics(id),
                           found = SceneInspector(rebuilt).octree_statistics(id);
    EXPECT_EQ(found.nodes, expected.nodes);
    EXPECT_EQ(found.leaves_by_level, expected.leaves_by_level);
    EXPECT_EQ(found.cost, expected.cost);
    EXPECT_EQ(found.bytes, expected.bytes);
  }
}

}  // namespace supple::cli::recorded_object_test
