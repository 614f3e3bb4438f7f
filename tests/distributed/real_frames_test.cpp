// Real frames, one object cut into parts over all ranks: the results of one scene.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "compare_results.hpp"
#include "random_lives.hpp"
#include "supple/distributed.hpp"
#include "supple/mesh.hpp"
#include "supple/mesh_file.hpp"
#include "supple/scene.hpp"
#include "support/shared_meshes.hpp"

namespace supple {
namespace {

/// The triangles of the mesh in as many slabs along an axis as there are ranks, and the same frames of both.
class Frames {
 public:
  Frames(const std::vector<std::string>& files, int axis) {
    for (const std::string& file : files) meshes_.push_back(load_mesh(shared_meshes() / file));
    object_.id = {0};
    object_.mesh = meshes_[0];
    object_.options = {.name = files[0], .self_collision = true, .margin = 0.002};
    const std::vector<Vec3d>& rest = meshes_[0].positions;
    std::vector<double> along;
    for (const Triangle& triangle : meshes_[0].triangles) along.push_back(rest[triangle[0]][axis]);
    std::vector<double> sorted = along;
    std::sort(sorted.begin(), sorted.end());
    const auto ranks = static_cast<std::size_t>(size_of_world());
    for (const double place : along) {
      const auto before =
          static_cast<std::size_t>(std::lower_bound(sorted.begin(), sorted.end(), place) - sorted.begin());
      object_.rank_of_triangle.push_back(static_cast<int>(before * ranks / sorted.size()));
    }
    part_ = part_of(object_, rank_of_world());
    plain_.add(rest, meshes_[0].triangles, object_.options);
    distributed_.add_part(object_.id, positions(0), part_.corners, {part_.vertices, part_.triangles},
                          object_.options);
  }

  /// Moves both scenes from one frame to the next one and compares what they find.
  std::size_t compare(std::size_t frame, ContactKinds kinds) {
    const std::vector<Vec3d>&from = meshes_[frame].positions, &to = meshes_[frame + 1].positions;
    plain_.set_motion(object_.id, from, to);
    distributed_.set_motion(object_.id, positions(frame), positions(frame + 1));
    const DetectResult& expected = plain_.detect({.contacts = kinds});
    const DetectResult& found = distributed_.detect({.contacts = kinds});
    if (rank_of_world() == 0) expect_same(found, expected, "frame " + std::to_string(frame));
    EXPECT_EQ(distributed_.collision_free_step(), plain_.collision_free_step());
    return expected.contacts.size() + expected.continuous_contacts.size() + expected.proximity_pairs.size();
  }

 private:
  std::vector<Vec3d> positions(std::size_t frame) const {
    return chosen<double>(meshes_[frame].positions, &part_.vertices);
  }

  std::vector<TriangleMesh> meshes_;
  LivingObject object_;
  Part part_;
  Scene plain_{{.threads = 1}};
  DistributedScene distributed_{MPI_COMM_WORLD, {.scene = {.threads = 1}}};
};

constexpr ContactKinds all_kinds =
    ContactKinds::intersection | ContactKinds::continuous | ContactKinds::proximity;

TEST(RealFrames, AWalkingFigureInParts) {
  if (!std::filesystem::exists(shared_meshes() / "kick")) GTEST_SKIP() << "needs SUPPLE_DATA";
  Frames frames({"kick/43.obj", "kick/44.obj", "kick/45.obj", "kick/46.obj"}, 1);
  for (std::size_t frame = 0; frame < 3; ++frame) EXPECT_GT(frames.compare(frame, all_kinds), 100u);
}

TEST(RealFrames, ACrumpledClothInParts) {
  const std::string folder = "scalable-ccd/cloth-ball/frames/";
  if (!std::filesystem::exists(shared_meshes() / folder)) GTEST_SKIP() << "needs SUPPLE_DATA";
  Frames frames({folder + "cloth_ball92.ply", folder + "cloth_ball93.ply"}, 0);
  EXPECT_GT(frames.compare(0, all_kinds), 1000u);
}

}  // namespace
}  // namespace supple
