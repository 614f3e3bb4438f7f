#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "supple/models.hpp"
#include "supple/recording.hpp"
#include "supple/result_lists.hpp"
#include "supple/scene.hpp"
#include "support/soups.hpp"
#include "unit/files/mesh_files.hpp"

namespace supple {

/// Copies the result of a frame.
inline RecordedFrame kept(double time, const DetectResult& result) {
  RecordedFrame frame;
  frame.time = time;
  for_each_list(
      [&](const auto&, auto member) { member(frame).assign(member(result).begin(), member(result).end()); });
  frame.stats = result.stats;
  return frame;
}

/// A `DetectResult` with views of a frame.
inline DetectResult shown(const RecordedFrame& frame) {
  DetectResult result;
  for_each_list([&](const auto&, auto member) { member(result) = member(frame); });
  result.stats = frame.stats;
  return result;
}

/// All contents of a recording in memory, so that tests can change them and write them again.
struct Contents {
  RecordingHeader header;
  std::vector<RecordedFrame> frames;
  std::vector<std::vector<std::vector<Vec3d>>> positions;  ///< of each frame and each object

  void write(const std::filesystem::path& path) const {
    Recorder recorder(path, header);
    for (std::size_t f = 0; f < frames.size(); ++f) {
      const std::vector<std::span<const Vec3d>> views(positions[f].begin(), positions[f].end());
      recorder.add(frames[f].time, views, shown(frames[f]));
    }
    recorder.close();
  }
};

inline Contents read_contents(const Recording& recording) {
  Contents contents{recording.header(), {}, {}};
  for (std::uint64_t f = 0; f < recording.frame_count(); ++f) {
    contents.frames.push_back(recording.frame(f));
    contents.positions.emplace_back();
    for (std::size_t i = 0; i < contents.header.objects.size(); ++i)
      contents.positions.back().push_back(recording.positions(f, i));
  }
  return contents;
}

/// The offset of a vertex from its rest position in a frame.
using OffsetOf = Vec3d (*)(std::uint64_t frame, std::size_t object, std::size_t vertex);

/// Deforms objects so that they pass through each other in random steps.
inline Vec3d random_offset(std::uint64_t frame, std::size_t object, std::size_t vertex) {
  const double x = static_cast<double>((frame * 7 + vertex * 3 + object * 5) % 11) / 11 - 0.4;
  return {x, 0.3 * x, static_cast<double>(frame % 5) / 8};
}

/// Records the objects while their vertices move.
inline Contents simulate(const std::vector<TriangleMesh>& meshes, std::vector<ObjectOptions> options,
                         const SceneOptions& scene_options, std::uint64_t frames,
                         OffsetOf offset_of = random_offset) {
  Contents contents;
  Scene scene(scene_options);
  contents.header.scene = scene_options;
  contents.header.time_step = 0.1;
  options.resize(meshes.size());
  std::vector<std::vector<Vec3d>> positions;
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    if (options[i].name.empty()) options[i].name = "object " + std::to_string(i);
    const ObjectId id = scene.add(meshes[i], options[i]);
    contents.header.objects.push_back({id, options[i], meshes[i].positions, meshes[i].triangles});
    positions.push_back(meshes[i].positions);
  }
  for (std::uint64_t f = 0; f < frames; ++f) {
    for (std::size_t i = 0; i < meshes.size(); ++i) {
      if (options[i].is_static) continue;
      const std::vector<Vec3d> from = positions[i];
      for (std::size_t v = 0; v < from.size(); ++v)
        positions[i][v] = meshes[i].positions[v] + offset_of(f, i, v);
      if (scene_options.contacts == ContactKinds::continuous)
        scene.set_motion(contents.header.objects[i].id, from, positions[i]);
      else
        scene.set_positions(contents.header.objects[i].id, positions[i]);
    }
    contents.frames.push_back(kept(0.1 * static_cast<double>(f), scene.detect()));
    contents.positions.push_back(positions);
  }
  return contents;
}

/// A static box, and what passes through it: a sphere, and a small box that touches it from outside, is half
/// inside, touches it from inside, and is contained. A cloth ends in the box and folds into itself. The
/// objects but the cloth are solid.
inline Contents simulate_solids(std::uint64_t frames) {
  ObjectOptions solid, fixed, folding;
  solid.solid = fixed.solid = true;
  fixed.is_static = true;
  folding.self_collision = true;
  SceneOptions scene;
  scene.contacts = ContactKinds::penetration;
  scene.curves = true;
  scene.threads = 1;
  const auto offset_of = [](std::uint64_t frame, std::size_t object, std::size_t vertex) {
    const double way = static_cast<double>(frame) / 4;
    if (object == 1) return Vec3d{-1.9 + way, 1.3, 0.1};
    if (object == 2) return Vec3d{1.25 - way, 0.25, -0.125};
    return Vec3d{0.8, 0.3, vertex % 5 == 0 ? 0.45 * way : 0};
  };
  return simulate({make_box({2, 2, 2}, 2), make_icosphere(3), make_box({0.5, 0.5, 0.5}, 2), make_cloth(5, 5)},
                  {fixed, solid, solid, folding}, scene, frames, offset_of);
}

inline void expect_equal(const RecordedFrame& a, const RecordedFrame& b) {
  EXPECT_EQ(a.time, b.time);
  for_each_list([&](const auto& list, auto member) { EXPECT_EQ(member(a), member(b)) << list.name; });
  for_each_leaf([](const auto& field, const auto& p, const auto& q) { EXPECT_EQ(p, q) << field.name; },
                a.stats, b.stats);
}

/// A soup with self-collision, a moving soup and a static soup.
inline Contents soups(ContactKinds mode, std::uint64_t frames = 12, bool colliding_vertices = false) {
  ObjectOptions folding, fixed;
  folding.self_collision = true;
  folding.margin = fixed.margin = 0.01;
  fixed.is_static = true;
  SceneOptions scene;
  scene.contacts = mode;
  scene.threads = 1;
  scene.comparison.colliding_vertices = colliding_vertices;
  return simulate({random_soup(30, 1, 0.5, 1), random_soup(20, 1, 0.6, 2), random_soup(20, 1, 0.6, 3)},
                  {folding, ObjectOptions{}, fixed}, scene, frames);
}

}  // namespace supple
