#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "supple/recording.hpp"
#include "unit/descriptions/other_values.hpp"
#include "unit/mesh/mesh_files.hpp"

namespace supple {
namespace {

RecordingHeader header_with(const SceneOptions& scene, const ObjectOptions& object) {
  RecordingHeader header;
  header.scene = scene;
  header.objects = {{{}, object, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}};
  return header;
}

/// Calls `test(changed)` for each option that is recorded, with it alone changed.
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
  change_each<SceneOptions>([&](const std::string& key, const SceneOptions& scene) { expect(key, scene, {}); });
  change_each<ObjectOptions>(
      [&](const std::string& key, const ObjectOptions& object) { expect(key, {}, object); });
}

}  // namespace
}  // namespace supple
