#include "experiments/table1/table1_runs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "experiments/table1/table1_scenes.hpp"
#include "supple/error.hpp"

namespace supple::experiments::table1_test {

namespace fs = std::filesystem;

/// The message of the error that a call throws.
template <class Call>
std::string error_of(Call&& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

RunCounts run_steps(const Table1Scene& scene, const Table1Method& method, BoundingVolume volume,
                    std::uint64_t steps, bool exact = true) {
  return run_scene({scene, {{method, volume}}}, 3, exact,
                   [&](const RunCounts& so_far) { return so_far.steps < steps; })
      .front();
}

TEST(Table1Runs, AllVariantsSeeTheSameMotion) {
  Table1Method modern;
  modern.scene = {};
  modern.octree = {};
  modern.root_is_border = false;
  const std::vector<Variant> variants{{{}, BoundingVolume::aabb},
                                      {{}, BoundingVolume::sphere},
                                      {modern, BoundingVolume::aabb},
                                      {modern, BoundingVolume::kdop18}};
  const Table1Scene scene = mixed_scene(9, 4);
  const std::vector<RunCounts> together =
      run_scene({scene, variants}, 3, true, [](const RunCounts& so_far) { return so_far.steps < 100; });
  for (std::size_t i = 0; i < variants.size(); ++i) {
    const RunCounts alone = run_steps(scene, variants[i].method, variants[i].volume, 100);
    EXPECT_GT(alone.broad, 0u);
    EXPECT_EQ(together[i].broad, alone.broad);
    EXPECT_EQ(together[i].narrow, alone.narrow);
    EXPECT_EQ(together[i].exact, alone.exact);
    EXPECT_EQ(together[i].largest_strain, alone.largest_strain);
    EXPECT_GT(together[i].detection_seconds, 0);
  }
}

TEST(Table1Runs, EachVariantEndsByItself) {
  const std::vector<Variant> variants{{{}, BoundingVolume::aabb}, {{}, BoundingVolume::sphere}};
  const Table1Scene scene = mixed_scene(9, 4);
  for (const bool first_ends : {true, false}) {
    std::size_t asked = 0;
    const std::vector<RunCounts> counts = run_scene({scene, variants}, 3, true, [&](const RunCounts& so_far) {
      const bool is_first = so_far.steps > 30 ? !first_ends : asked++ % 2 == 0;
      return so_far.steps < (is_first == first_ends ? 30u : 90u);
    });
    EXPECT_EQ(counts[0].steps, first_ends ? 30u : 90u);
    EXPECT_EQ(counts[1].steps, first_ends ? 90u : 30u);
    EXPECT_EQ(counts[0].broad, run_steps(scene, {}, BoundingVolume::aabb, counts[0].steps).broad);
    EXPECT_EQ(counts[1].broad, run_steps(scene, {}, BoundingVolume::sphere, counts[1].steps).broad);
  }
}

TEST(Table1Runs, TheMethodChangesOnlyWhatItCan) {
  const Table1Scene scene = mixed_scene(9, 4);
  const RunCounts paper = run_steps(scene, {}, BoundingVolume::sphere, 300);
  Table1Method brute;
  brute.scene.broad_phase = BroadPhaseMethod::brute;
  EXPECT_EQ(run_steps(scene, brute, BoundingVolume::sphere, 300).broad, paper.broad);
  Table1Method only_roots;
  only_roots.octree.max_level = 0;
  const RunCounts of_roots = run_steps(scene, only_roots, BoundingVolume::sphere, 300);
  EXPECT_EQ(of_roots.exact, paper.exact);
  EXPECT_EQ(of_roots.narrow, of_roots.broad) << "the only leaf of an octree is the volume of its object";
  EXPECT_LT(paper.narrow, paper.broad);
  const RunCounts without = run_steps(scene, {}, BoundingVolume::sphere, 300, false);
  EXPECT_EQ(without.narrow, paper.narrow);
  EXPECT_EQ(without.exact, 0u);
  EXPECT_GT(paper.exact, 0u);
}

TEST(Table1Scenes, MixedScenesHaveAnyNumberOfObjects) {
  for (const std::uint32_t objects : {2u, 3u, 4u, 9u, 12u, 20u, 30u, 100u}) {
    const cli::Input input = read_scene(mixed_scene(objects), {}, 1);
    EXPECT_EQ(input.objects.size(), objects);
    std::vector<std::uint32_t> of_model(3);
    for (const cli::InputObject& object : input.objects) {
      const std::size_t vertices = object.mesh.positions.size();
      ++of_model[vertices == 154 ? 0 : vertices == 216 ? 1 : 2];
      for (const Vec3d& p : object.mesh.positions) {
        for (int axis = 0; axis < 3; ++axis) EXPECT_LE(std::fabs(p[axis]), *edge_of(input) / 2);
      }
    }
    EXPECT_LE(of_model[0] - of_model[2], 1u) << objects;
    EXPECT_TRUE(of_model[1] == of_model[0] || of_model[1] == of_model[2]) << objects;
    EXPECT_EQ(run_steps(mixed_scene(objects), {}, BoundingVolume::aabb, 0).broad, 0u)
        << objects << " begin without overlaps";
  }
  EXPECT_EQ(edge_of(read_scene(mixed_scene(12), {}, 1)), 6);
  EXPECT_EQ(edge_of(read_scene(mixed_scene(12, 5.5), {}, 1)), 5.5);
}

TEST(Table1Scenes, EveryDefaultSceneBeginsWithoutOverlaps) {
  for (const Table1Scene& scene : default_table1_options(false).scenes)
    EXPECT_EQ(run_steps(scene, {}, BoundingVolume::aabb, 0).broad, 0u) << scene.name;
}

TEST(Table1Scenes, RefusesASizeThatIsTooSmall) {
  const std::string error = error_of([] { read_scene(mixed_scene(9, 2), {}, 1); });
  EXPECT_NE(error.find("start outside a cube of 2; give at least 3.6"), std::string::npos) << error;
  EXPECT_EQ(edge_of(read_scene(mixed_scene(9, 3.6), {}, 1)), 3.6);
  EXPECT_NE(error_of([] {
              read_scene({Table1Scene::Source::built_in, "table1_4"}, {}, 1);
            }).find("no scene"),
            std::string::npos);
}

class Table1Folder : public testing::Test {
 protected:
  void SetUp() override { fs::remove_all(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  bool run(bool resume) { return run_table1(options_, {.folder = folder_}, resume, interruption_); }
  std::string read(const char* name) const {
    std::ifstream stream(folder_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  /// The rows of a file below the header.
  std::vector<std::vector<std::string>> rows(const char* name) const {
    std::vector<std::vector<std::string>> rows;
    std::istringstream lines(read(name));
    for (std::string line; std::getline(lines, line);) {
      if (line.front() == '#' || line.starts_with("setting,")) continue;
      std::istringstream fields(line + ',');
      std::vector<std::string>& row = rows.emplace_back();
      for (std::string field; std::getline(fields, field, ',');) row.push_back(field);
    }
    return rows;
  }

  static Table1Options tiny() {
    Table1Options options;
    options.scenes = {mixed_scene(3)};
    options.runs = 2;
    options.simulated_seconds = 2;
    options.threads = 1;
    return options;
  }
  // Tests run in parallel.
  fs::path folder_ =
      fs::path(testing::TempDir()) / testing::UnitTest::GetInstance()->current_test_info()->name();
  Table1Options options_ = tiny();
  cli::Interruption interruption_;
};

TEST_F(Table1Folder, VolumesChangeNoExactContact) {
  ASSERT_TRUE(run(false));
  const auto one = rows("table1_runs.csv");
  ASSERT_EQ(one.size(), 4u);
  options_.threads = 3;
  ASSERT_TRUE(run(false));
  // All but the seconds are the same.
  const auto counts_of = [](std::vector<std::vector<std::string>> runs) {
    for (auto& row : runs) row.erase(row.begin() + 10, row.begin() + 13);
    std::sort(runs.begin(), runs.end());
    return runs;
  };
  EXPECT_EQ(counts_of(rows("table1_runs.csv")), counts_of(one));
  constexpr std::size_t seed = 4, exact = 8;
  for (const auto& a : one) {
    for (const auto& b : one) {
      if (a[seed] == b[seed]) {
        EXPECT_EQ(a[exact], b[exact]);
      }
    }
  }
}

TEST_F(Table1Folder, ResumeRepeatsNoCompleteRun) {
  ASSERT_TRUE(run(false));
  const std::string whole = read("table1_runs.csv");
  const auto all = rows("table1_runs.csv");
  // One complete run, marked by a number that no run has, and a line that a killed program left behind.
  const std::size_t end_of_header = whole.find('\n', whole.find("\nsetting,") + 1) + 1,
                    end_of_run = whole.find('\n', end_of_header) + 1;
  auto marked = all.front();
  marked[6] = "777";
  std::string line = marked.front();
  for (std::size_t i = 1; i < marked.size(); ++i) line += ',' + marked[i];
  std::ofstream(folder_ / "table1_runs.csv", std::ios::binary)
      << whole.substr(0, end_of_header) << line << '\n'
      << whole.substr(end_of_run, 20);
  ASSERT_TRUE(run(true));
  const auto resumed = rows("table1_runs.csv");
  ASSERT_EQ(resumed.size(), 4u);
  EXPECT_EQ(resumed.front(), marked);
  for (std::size_t i = 1; i < 4; ++i) {
    for (std::size_t column = 0; column < 10; ++column) EXPECT_EQ(resumed[i][column], all[i][column]);
  }
}

TEST_F(Table1Folder, ResumeNeedsTheSameProgramAndWholeRows) {
  ASSERT_TRUE(run(false));
  const std::string whole = read("table1_runs.csv");
  const auto error_with = [&](const std::string& text) {
    std::ofstream(folder_ / "table1_runs.csv", std::ios::binary) << text;
    return error_of([&] { run(true); });
  };
  const std::size_t commit = whole.find("# commit: ") + 10, date = whole.find("# date: ") + 8;
  EXPECT_NE(error_with(std::string(whole).insert(commit, "of another ")).find("# commit: of another"),
            std::string::npos);
  EXPECT_NE(error_with(std::string(whole).insert(whole.find("setting,"), "x")).find("xsetting"),
            std::string::npos);
  EXPECT_NE(error_with("").find("--resume"), std::string::npos);
  EXPECT_NE(error_with(whole + ",table1_3,6,aabb,1\n").find("row 5 is not a run"), std::string::npos);
  EXPECT_EQ(error_with(std::string(whole).insert(date, "1")), "no error") << "it may go on at another day";
}

TEST_F(Table1Folder, ResumeNeedsTheSameTextOfAScene) {
  const fs::path scene = folder_.string() + ".toml";
  const auto write = [&](const char* model) {
    std::ofstream(scene) << "[[object]]\nmodel = '" << model << "'\n[[object]]\nmodel = 'fish'\n";
  };
  options_.scenes = {scene_called(scene.string())};
  options_.simulated_seconds = 0.1;
  write("rabbit");
  ASSERT_TRUE(run(false));
  EXPECT_TRUE(run(true));
  write("pawn");
  EXPECT_NE(error_of([&] { run(true); }).find("# scenes: "), std::string::npos);
  fs::remove(scene);
}

TEST_F(Table1Folder, TheClockOfTheProgramCountsTheMotionToo) {
  options_.simulated_seconds = 0;
  options_.program_clock = 0.05;
  options_.runs = 1;
  ASSERT_TRUE(run(false));
  EXPECT_FALSE(fs::exists(folder_ / "table1_runs.csv"));
  for (const auto& row : rows("table1_program_runs.csv")) {
    const double detection = std::stod(row[11]), motion = std::stod(row[12]);
    EXPECT_LT(detection, 0.05);
    EXPECT_GE(detection + motion, 0.05);
  }
  const std::string whole = read("table1_program_runs.csv");
  ASSERT_TRUE(run(true));
  EXPECT_EQ(read("table1_program_runs.csv"), whole) << "nothing is repeated";
}

TEST_F(Table1Folder, RunsHaveTheStrainOfTheirBodies) {
  options_.simulated_seconds = 4;
  options_.runs = 1;
  ASSERT_TRUE(run(false));
  for (const auto& row : rows("table1_runs.csv")) {
    const double mean = std::stod(row[13]), largest = std::stod(row[14]);
    EXPECT_GT(mean, 0.02);
    EXPECT_LT(mean, 0.5 * largest);
    EXPECT_LT(largest, 0.15);
  }
}

}  // namespace supple::experiments::table1_test
