#include <gtest/gtest.h>
#include <hdf5.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "supple/recording.hpp"
#include "support/soups.hpp"
#include "unit/descriptions/other_values.hpp"
#include "unit/recording/recorded_scenes.hpp"

namespace supple::recorded_options_test {

RecordingHeader header_with(const SceneOptions& scene, const ObjectOptions& object) {
  RecordingHeader header;
  header.scene = scene;
  header.objects = {{{}, object, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}};
  return header;
}

/// Calls `test(changed)` once per recorded option, with only that option changed.
template <class Options, class Test>
void change_each(Test test) {
  std::size_t count = 0;
  Options defaults{};
  for_each_leaf([&](const auto&, const auto&) { ++count; }, defaults);
  for (std::size_t changed = 0; changed < count; ++changed) {
    Options options{};
    std::size_t place = 0;
    std::string key;
    for_each_leaf(
        [&](const auto& field, auto& value) {
          if (place++ != changed || field.is_of_machine) return;
          set_other(field, value);
          key = field.key;
        },
        options);
    if (!key.empty()) test(key, options);
  }
}

TEST(RecordedOptions, AllComeBack) {
  const TemporaryFolder folder;
  const auto path = folder / "a.h5";
  const RecordingHeader given = header_with(other_values<SceneOptions>(), other_values<ObjectOptions>());
  Recorder(path, given).close();
  const RecordingHeader read = Recording(path).header();
  EXPECT_EQ(differences_of(read.scene, given.scene), keys_of_machine<SceneOptions>());
  ASSERT_EQ(read.objects.size(), 1u);
  EXPECT_EQ(differences_of(read.objects[0].options, given.objects[0].options), std::vector<std::string>{});
}

TEST(RecordedOptions, DiffNamesEachThatDiffers) {
  const TemporaryFolder folder;
  Recorder(folder / "a.h5", header_with({}, {})).close();
  const auto expect = [&](const std::string& key, const SceneOptions& scene, const ObjectOptions& object) {
    Recorder(folder / "b.h5", header_with(scene, object)).close();
    const auto difference = find_first_difference(Recording(folder / "a.h5"), Recording(folder / "b.h5"));
    ASSERT_TRUE(difference) << key;
    EXPECT_EQ(difference->what.rfind(key, 0), 0u) << difference->what;
  };
  change_each<SceneOptions>(
      [&](const std::string& key, const SceneOptions& scene) { expect(key, scene, {}); });
  change_each<ObjectOptions>(
      [&](const std::string& key, const ObjectOptions& object) { expect(key, {}, object); });
}

void rename_attribute(hid_t file, const char* group, const char* from, const char* to) {
  ASSERT_GE(H5Arename_by_name(file, group, from, to, H5P_DEFAULT), 0) << from;
}

void rename_dataset(hid_t file, const char* from, const char* to) {
  ASSERT_GE(H5Lmove(file, from, file, to, H5P_DEFAULT, H5P_DEFAULT), 0) << from;
}

void write_number(hid_t file, const char* name, hid_t type, std::uint32_t value) {
  H5Adelete(file, name);
  const hid_t space = H5Screate(H5S_SCALAR);
  const hid_t attribute = H5Acreate2(file, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
  ASSERT_GE(H5Awrite(attribute, H5T_NATIVE_UINT32, &value), 0);
  H5Aclose(attribute);
  H5Sclose(space);
}

/// Converts a recording to version 1 of the format.
void make_version_1(const std::filesystem::path& path, std::size_t objects) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  ASSERT_GE(file, 0);
  write_number(file, "version", H5T_STD_U32LE, 1);
  write_number(file, "undecided", H5T_STD_U8LE, 1);
  rename_attribute(file, "/", "undecided", "exact_impacts");
  rename_attribute(file, "/", "contacts", "contact_mode");
  rename_attribute(file, "/", "region_test", "region_sphere_test");
  for (const char* const name : {"scene_octree_arity", "scene_octree_expand_for_large",
                                 "scene_octree_min_level", "descent", "lazy_refit"})
    H5Adelete(file, name);
  for (std::size_t place = 0; place < objects; ++place) {
    const std::string group = "objects/" + std::to_string(place);
    rename_attribute(file, group.c_str(), "self", "self_collision");
    rename_attribute(file, group.c_str(), "static", "is_static");
    rename_attribute(file, group.c_str(), "max_level", "octree_max_level");
    rename_attribute(file, group.c_str(), "leaf_size", "octree_leaf_size");
    for (const char* name : {"tree_arity", "object_octree", "rebuild_degraded"})
      ASSERT_GE(H5Adelete_by_name(file, group.c_str(), name, H5P_DEFAULT), 0) << name;
  }
  ASSERT_GE(H5Ldelete(file, "contacts/normal", H5P_DEFAULT), 0);
  rename_dataset(file, "statistics/sort_and_events_seconds", "statistics/finish_seconds");
  rename_dataset(file, "continuous_contacts/toi", "continuous_contacts/time");
  rename_dataset(file, "continuous_contacts/barycentric_a", "continuous_contacts/weights_a");
  rename_dataset(file, "continuous_contacts/barycentric_b", "continuous_contacts/weights_b");
  ASSERT_GE(H5Fclose(file), 0);
}

TEST(RecordedOptions, Version1IsRead) {
  SceneOptions scene;
  scene.contacts = ContactKinds::continuous;
  scene.bounding_volume = BoundingVolume::sphere;
  scene.scene_octree.region_sphere_test = RegionSphereTest::grown_box;
  ObjectOptions object;
  object.self_collision = true;
  object.octree = {.max_level = 3, .leaf_size = 5};
  const Contents contents = simulate({random_soup(30, 1, 0.6, 4), random_soup(20, 1, 0.6, 5)},
                                     {object, {.is_static = true}}, scene, 4);
  ASSERT_GT(contents.frames.back().continuous_contacts.size(), 5u);
  const TemporaryFolder folder;
  contents.write(folder / "now.h5");
  contents.write(folder / "then.h5");
  make_version_1(folder / "then.h5", 2);
  const Recording now(folder / "now.h5"), then(folder / "then.h5");
  const auto difference = find_first_difference(now, then);
  EXPECT_FALSE(difference) << difference->what;
  EXPECT_EQ(now.frame(2).stats.sort_and_events_seconds, then.frame(2).stats.sort_and_events_seconds);
}

}  // namespace supple::recorded_options_test
