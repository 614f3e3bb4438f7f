#include "supple/recording.hpp"
#include "supple/mesh_file.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <string_view>

#include "supple/error.hpp"
#include "supple/models.hpp"
#include "supple/result_descriptions.hpp"
#include "support/eventually.hpp"
#include "support/shared_meshes.hpp"
#include "unit/recording/recorded_scenes.hpp"

namespace supple::recording_test {

void expect_equal_bits(const std::vector<Vec3d>& a, const std::vector<Vec3d>& b) {
  ASSERT_EQ(a.size(), b.size());
  EXPECT_TRUE(a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Vec3d)) == 0);
}

void expect_equal(const RecordingHeader& a, const RecordingHeader& b) {
  EXPECT_EQ(a.time_step, b.time_step);
  EXPECT_EQ(a.scene_file, b.scene_file);
  EXPECT_EQ(a.scene.bounding_volume, b.scene.bounding_volume);
  EXPECT_EQ(a.scene.comparison.sphere_fit, b.scene.comparison.sphere_fit);
  EXPECT_EQ(a.scene.broad_phase, b.scene.broad_phase);
  EXPECT_EQ(a.scene.scene_octree.max_level, b.scene.scene_octree.max_level);
  EXPECT_EQ(a.scene.scene_octree.expand_at, b.scene.scene_octree.expand_at);
  EXPECT_EQ(a.scene.scene_octree.region_sphere_test, b.scene.scene_octree.region_sphere_test);
  EXPECT_EQ(a.scene.contacts, b.scene.contacts);
  EXPECT_EQ(a.scene.contact_points, b.scene.contact_points);
  EXPECT_EQ(a.scene.comparison.colliding_vertices, b.scene.comparison.colliding_vertices);
  EXPECT_EQ(a.scene.impact.min_separation, b.scene.impact.min_separation);
  EXPECT_EQ(a.scene.impact.exact, b.scene.impact.exact);
  ASSERT_EQ(a.objects.size(), b.objects.size());
  for (std::size_t i = 0; i < a.objects.size(); ++i) {
    const RecordedObject &p = a.objects[i], &q = b.objects[i];
    EXPECT_EQ(p.id, q.id);
    EXPECT_EQ(p.options.name, q.options.name);
    EXPECT_EQ(p.options.self_collision, q.options.self_collision);
    EXPECT_EQ(p.options.is_static, q.options.is_static);
    EXPECT_EQ(p.options.margin, q.options.margin);
    EXPECT_EQ(p.options.solid, q.options.solid);
    EXPECT_EQ(p.options.group, q.options.group);
    EXPECT_EQ(p.options.mask, q.options.mask);
    EXPECT_EQ(p.options.edges, q.options.edges);
    EXPECT_EQ(p.options.points, q.options.points);
    EXPECT_EQ(p.options.octree.max_level, q.options.octree.max_level);
    EXPECT_EQ(p.options.octree.leaf_size, q.options.octree.leaf_size);
    expect_equal_bits(p.rest_positions, q.rest_positions);
    EXPECT_EQ(p.triangles, q.triangles);
  }
}

/// Writes the contents, reads them back and compares. Returns the contents read.
Contents round_trip(const Contents& contents) {
  const TemporaryFolder folder;
  contents.write(folder / "run.h5");
  const Recording recording(folder / "run.h5");
  Contents read = read_contents(recording);
  expect_equal(contents.header, read.header);
  EXPECT_EQ(contents.frames.size(), recording.frame_count());
  for (std::size_t f = 0; f < std::min(contents.frames.size(), read.frames.size()); ++f) {
    expect_equal(contents.frames[f], read.frames[f]);
    RecordedFrame without_contacts = contents.frames[f];
    for_each_list([&](const auto& list, auto member) {
      if (!std::string_view(list.name).starts_with("events/")) member(without_contacts).clear();
    });
    expect_equal(without_contacts, recording.summary(f));
    for (std::size_t i = 0; i < read.header.objects.size(); ++i)
      expect_equal_bits(contents.positions[f][i], read.positions[f][i]);
  }
  return read;
}

auto begin_of(RecordedEvents RecordedFrame::*events) {
  return [events](const RecordedFrame& frame) { return (frame.*events).begin; };
}
auto end_of(RecordedEvents RecordedFrame::*events) {
  return [events](const RecordedFrame& frame) { return (frame.*events).end; };
}

template <class Rows>
std::size_t count_all(const std::vector<RecordedFrame>& frames, Rows rows) {
  std::size_t count = 0;
  for (const RecordedFrame& frame : frames) count += std::invoke(rows, frame).size();
  return count;
}

TEST(Recording, RoundTripOfIntersections) {
  const Contents read = round_trip(soups(ContactKinds::intersection));
  EXPECT_GT(count_all(read.frames, &RecordedFrame::contacts), 100u);
  EXPECT_GT(count_all(read.frames, &RecordedFrame::contact_points), 100u);
  EXPECT_GT(count_all(read.frames, begin_of(&RecordedFrame::volume_events)), 0u);
  EXPECT_GT(count_all(read.frames, begin_of(&RecordedFrame::contact_events)), 0u);
}

TEST(Recording, RoundTripOfProximity) {
  const Contents read = round_trip(soups(ContactKinds::proximity));
  EXPECT_GT(count_all(read.frames, &RecordedFrame::proximity_pairs), 100u);
  EXPECT_GT(count_all(read.frames, begin_of(&RecordedFrame::proximity_events)), 0u);
}

TEST(Recording, RoundTripOfPenetration) {
  const Contents read = round_trip(simulate_solids(8));
  EXPECT_GT(count_all(read.frames, &RecordedFrame::penetrations), 100u);
  for (const auto list : {&RecordedFrame::vertices_on_surface, &RecordedFrame::curve_contacts,
                          &RecordedFrame::enclosed_vertices})
    EXPECT_GT(count_all(read.frames, list), 20u);
  EXPECT_GT(count_all(read.frames, &RecordedFrame::penetration_groups), 8u);
  EXPECT_GT(count_all(read.frames, &RecordedFrame::contained_parts), 1u);
  EXPECT_GT(count_all(read.frames, &RecordedFrame::curve_points), 20u);
  EXPECT_GT(count_all(read.frames, begin_of(&RecordedFrame::penetration_events)), 1u);
  EXPECT_GT(count_all(read.frames, end_of(&RecordedFrame::penetration_events)), 0u);
  std::array<std::size_t, 3> of_kind{};
  std::size_t of_itself = 0;
  for (const RecordedFrame& frame : read.frames) {
    for (const IntersectionCurve& curve : frame.curves) {
      ++of_kind[static_cast<std::size_t>(curve.kind)];
      of_itself += curve.a == curve.b ? 1 : 0;
    }
  }
  for (const std::size_t count : of_kind) EXPECT_GT(count, 0u);
  EXPECT_GT(of_itself, 0u);
}

/// Real meshes: a closed cow in another one, and an open bunny that cuts through both.
TEST(Recording, RoundTripOfPenetrationOfRealMeshes) {
  const auto folder = shared_meshes() / "models";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is missing";
  const TriangleMesh cow = load_mesh(folder / "spot.obj");
  TriangleMesh small = cow, bunny = load_mesh(folder / "stanford-bunny.obj");
  for (Vec3d& p : small.positions) p = 0.1 * p;
  for (Vec3d& p : bunny.positions) p = 8 * p - Vec3d{0, 0.8, 0};
  SceneOptions scene;
  scene.contacts = ContactKinds::penetration;
  scene.curves = true;
  const auto offset_of = [](std::uint64_t frame, std::size_t object, std::size_t) {
    const double way = static_cast<double>(frame) * 0.15;
    return object == 1 ? Vec3d{way, 0.1, 0.2} : object == 2 ? Vec3d{0, 0.1, way} : Vec3d{};
  };
  const Contents read =
      round_trip(simulate({cow, cow, small, bunny}, {{.solid = true}, {.solid = true}, {.solid = true}, {}},
                          scene, 4, offset_of));
  EXPECT_GT(count_all(read.frames, &RecordedFrame::penetrations), 1000u);
  EXPECT_GT(count_all(read.frames, &RecordedFrame::contained_parts), 0u);
  EXPECT_GT(count_all(read.frames, &RecordedFrame::curves), 10u);
}

TEST(Recording, RoundTripOfContinuousContacts) {
  const Contents read = round_trip(soups(ContactKinds::continuous));
  EXPECT_GT(count_all(read.frames, &RecordedFrame::continuous_contacts), 100u);
  EXPECT_EQ(count_all(read.frames, &RecordedFrame::contacts), 0u);
}

TEST(Recording, RoundTripOfManifolds) {
  ObjectOptions with_margin;
  with_margin.margin = 0.3;
  SceneOptions scene;
  scene.contacts = ContactKinds::proximity;
  scene.manifolds = true;
  const auto offset_of = [](std::uint64_t frame, std::size_t object, std::size_t) {
    return object == 0 ? Vec3d{} : Vec3d{0, 0, 1.1 + 0.1 * static_cast<double>(frame)};
  };
  const Contents read = round_trip(simulate({make_box({2, 2, 1}, 2), make_box({1, 1, 1}, 2)},
                                            {with_margin, with_margin}, scene, 3, offset_of));
  EXPECT_EQ(count_all(read.frames, &RecordedFrame::manifolds), 3u);
  EXPECT_EQ(count_all(read.frames, &RecordedFrame::manifold_points), 12u);
}

TEST(Recording, RoundTripOfCollidingVertices) {
  Contents contents = soups(ContactKinds::none, 12, true);
  contents.frames[5].narrow_phase_events.end = {
      {contents.header.objects[0].id, contents.header.objects[1].id}};
  const Contents read = round_trip(contents);
  EXPECT_GT(count_all(read.frames, &RecordedFrame::colliding_vertices), 100u);
  EXPECT_GT(count_all(read.frames, &RecordedFrame::colliding_vertex_groups), 12u);
  EXPECT_GT(count_all(read.frames, begin_of(&RecordedFrame::narrow_phase_events)), 0u);
  EXPECT_EQ(count_all(soups(ContactKinds::none).frames, &RecordedFrame::colliding_vertices), 0u);
}

TEST(Recording, RoundTripOfEndingPairs) {
  Contents contents = soups(ContactKinds::intersection, 3);
  const auto& objects = contents.header.objects;
  contents.frames[2].volume_events.end = {{objects[0].id, objects[2].id}};
  contents.frames[2].contact_events.end = {{objects[0].id, objects[1].id}, {objects[1].id, objects[2].id}};
  round_trip(contents);
}

TEST(Recording, RoundTripOfEveryOption) {
  Contents contents = soups(ContactKinds::none, 2);
  SceneOptions& scene = contents.header.scene;
  scene.bounding_volume = BoundingVolume::sphere;
  scene.comparison.sphere_fit = SphereFit::box;
  scene.broad_phase = BroadPhaseMethod::octree;
  scene.scene_octree = {7, 3, RegionSphereTest::grown_box};
  scene.contact_points = false;
  scene.impact = {0.125, false};
  scene.comparison.colliding_vertices = true;
  contents.header.time_step = 0x1.8p-7;
  contents.header.scene_file = "[scene]\nname = \"\xe2\x88\x9e\"\n";
  ObjectOptions& options = contents.header.objects[1].options;
  options.name = "\xe5\x85\x94 & <rabbit> \"x\"";
  options.group = 6;
  options.mask = 9;
  options.octree = {3, 77};
  round_trip(contents);
}

TEST(Recording, RoundTripOfNumbersThatAreNotFinite) {
  Contents contents = soups(ContactKinds::intersection, 3);
  const double infinity = std::numeric_limits<double>::infinity();
  contents.positions[1][0][3] = {std::numeric_limits<double>::quiet_NaN(), -infinity, infinity};
  contents.positions[2][1][0] = {-0.0, std::numeric_limits<double>::denorm_min(), 1e308};
  round_trip(contents);
}

TEST(Recording, RoundTripOfIdsThatWereUsedBefore) {
  Contents contents = soups(ContactKinds::intersection, 2);
  const auto rename = [&](ObjectId from, ObjectId to) {
    for (RecordedObject& object : contents.header.objects) object.id = object.id == from ? to : object.id;
    for (RecordedFrame& frame : contents.frames) {
      for (auto* pairs : {&frame.object_pairs, &frame.volume_events.begin, &frame.contact_events.begin}) {
        for (ObjectPair& pair : *pairs) pair = {pair.a == from ? to : pair.a, pair.b == from ? to : pair.b};
      }
      for (Contact& c : frame.contacts) {
        c.object_a = c.object_a == from ? to : c.object_a;
        c.object_b = c.object_b == from ? to : c.object_b;
      }
    }
  };
  rename(contents.header.objects[2].id, {900, 4});
  rename(contents.header.objects[0].id, {0, 17});
  round_trip(contents);
}

TEST(Recording, SceneWithoutObjects) {
  Contents contents = simulate({}, {}, {.threads = 1}, 4);
  round_trip(contents);
}

TEST(Recording, NoFrames) {
  round_trip(soups(ContactKinds::intersection, 0));
  round_trip(Contents{});
}

TEST(Recording, ObjectsWithoutVerticesAndTriangles) {
  TriangleMesh empty, points;
  points.positions = {{0, 0, 0}, {1, 2, 3}};
  ObjectOptions fixed;
  fixed.is_static = true;
  round_trip(simulate({empty, make_icosphere(1), points, empty}, {{}, {}, {}, fixed}, {.threads = 1}, 5));
}

TEST(Recording, TenThousandFrames) {
  SceneOptions scene;
  scene.contacts = ContactKinds::none;
  scene.threads = 1;
  const Contents contents = simulate({make_box({1, 1, 1}), make_box({1, 1, 1})}, {}, scene, 10000);
  const TemporaryFolder folder;
  contents.write(folder / "long.h5");
  const Recording recording(folder / "long.h5");
  ASSERT_EQ(recording.frame_count(), 10000u);
  for (const std::uint64_t f : {0u, 1u, 63u, 64u, 65u, 1023u, 1024u, 4095u, 4096u, 7777u, 9999u, 3u}) {
    expect_equal(contents.frames[f], recording.frame(f));
    expect_equal_bits(contents.positions[f][1], recording.positions(f, 1));
  }
}

TEST(Recording, OfStaticObjectsOneRow) {
  const TemporaryFolder folder;
  soups(ContactKinds::none, 5).write(folder / "run.h5");
  const Recording recording(folder / "run.h5");
  expect_equal_bits(recording.positions(0, 2), recording.positions(4, 2));
  Contents moving = soups(ContactKinds::none, 5);
  moving.positions[3][2][7].y += 1;
  EXPECT_THROW(moving.write(folder / "run.h5"), Error);
}

TEST(Recording, ReadsWhatWasFlushedWhileItIsWritten) {
  constexpr std::size_t frames = 40;
  const Contents contents = soups(ContactKinds::intersection, frames);
  const TemporaryFolder folder;
  Recorder recorder(folder / "run.h5", contents.header);
  EXPECT_EQ(Recording(folder / "run.h5").frame_count(), 0u);
  bool some_frames_waited = false;
  for (std::size_t f = 0; f < frames; ++f) {
    const std::vector<std::span<const Vec3d>> views(contents.positions[f].begin(),
                                                    contents.positions[f].end());
    recorder.add(contents.frames[f].time, views, shown(contents.frames[f]));
    if (f % 5 == 4) recorder.flush();
    const Recording now(folder / "run.h5");
    // The first frames are flushed early, so at most an eighth of the frames waits.
    ASSERT_GE(8 * now.frame_count(), 7 * (f + 1));
    ASSERT_LE(now.frame_count(), f + 1);
    if (f % 5 == 4) {
      ASSERT_EQ(now.frame_count(), f + 1);
    }
    some_frames_waited = some_frames_waited || now.frame_count() <= f;
    expect_equal(contents.frames[now.frame_count() - 1], now.frame(now.frame_count() - 1));
  }
  EXPECT_TRUE(some_frames_waited);
}

TEST(Recording, OldOneStaysUntilTheNewOneIsThere) {
  const TemporaryFolder folder;
  soups(ContactKinds::none, 3).write(folder / "run.h5");
  RecordingHeader wrong = soups(ContactKinds::none, 0).header;
  wrong.objects[0].triangles[2][1] = 100000;
  EXPECT_THROW(Recorder(folder / "run.h5", wrong), Error);
  EXPECT_EQ(Recording(folder / "run.h5").frame_count(), 3u);
  soups(ContactKinds::none, 1).write(folder / "run.h5");
  EXPECT_EQ(Recording(folder / "run.h5").frame_count(), 1u);
}

TEST(Recording, SaysThatItWasRecordedAgain) {
  const TemporaryFolder folder;
  soups(ContactKinds::intersection, 500).write(folder / "run.h5");
  soups(ContactKinds::intersection, 2).write(folder / "other.h5");
  const Recording recording(folder / "run.h5");
  std::filesystem::copy_file(folder / "other.h5", folder / "run.h5",
                             std::filesystem::copy_options::overwrite_existing);
  try {
    static_cast<void>(recording.frame(499));
    FAIL() << "the lists of the frame are no longer in the file";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("was recorded again"), std::string::npos) << error.what();
  }
  EXPECT_THROW(static_cast<void>(recording.positions(499, 0)), Error);
}

TEST(Recording, EqualContentsAreEqualFiles) {
  const Contents contents = soups(ContactKinds::intersection, 20);
  const TemporaryFolder folder;
  const auto bytes_of = [](const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  contents.write(folder / "a.h5");
  // HDF5 stores times in whole seconds.
  const std::time_t written = std::time(nullptr);
  ASSERT_TRUE(eventually([&] { return std::time(nullptr) > written; }));
  contents.write(folder / "b.h5");
  EXPECT_TRUE(bytes_of(folder / "a.h5") == bytes_of(folder / "b.h5"));
}

TEST(Recording, NoSuchFrameOrObject) {
  const TemporaryFolder folder;
  soups(ContactKinds::none, 2).write(folder / "run.h5");
  const Recording recording(folder / "run.h5");
  EXPECT_NE(error_of([&] { recording.frame(2); }).find("no frame 2; the recording has 2"), std::string::npos);
  EXPECT_NE(error_of([&] { recording.summary(2); }).find("no frame 2"), std::string::npos);
  EXPECT_NE(error_of([&] { recording.positions(0, 3); }).find("no object 3"), std::string::npos);
  EXPECT_NE(error_of([&] { recording.positions(7, 0); }).find("no frame 7"), std::string::npos);
}

}  // namespace supple::recording_test
