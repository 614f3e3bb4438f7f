#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <vector>

#include "supple/recording.hpp"
#include "supple/scene.hpp"
#include "unit/recording/recorded_scenes.hpp"

namespace supple::recorder_test {

TEST(Recorder, RefusesWhatDoesNotFitTheHeaderAndGoesOn) {
  const Contents contents = soups(ContactKinds::intersection, 3);
  const TemporaryFolder folder;
  Recorder recorder(folder / "run.h5", contents.header);
  std::vector<std::span<const Vec3d>> views(contents.positions[0].begin(), contents.positions[0].end());
  const DetectResult nothing;
  const std::span<const std::span<const Vec3d>> all = views;
  EXPECT_NE(error_of([&] { recorder.add(0, all.first(2), nothing); }).find("2 objects, the recording has 3"),
            std::string::npos);
  views[1] = views[1].first(5);
  EXPECT_NE(error_of([&] { recorder.add(0, views, nothing); }).find("5 positions of object 1"),
            std::string::npos);
  views[1] = contents.positions[0][1];
  RecordedFrame strange = contents.frames[0];
  strange.object_pairs = {{{0, 0}, {8, 1}}};
  EXPECT_NE(error_of([&] { recorder.add(0, views, shown(strange)); }).find("object 8 of generation 1"),
            std::string::npos);
  recorder.add(contents.frames[0].time, views, shown(contents.frames[0]));
  recorder.close();
  EXPECT_NE(error_of([&] { recorder.add(0, views, nothing); }).find("closed"), std::string::npos);
  const Recording recording(folder / "run.h5");
  ASSERT_EQ(recording.frame_count(), 1u);
  expect_equal(contents.frames[0], recording.frame(0));
}

TEST(Recorder, RefusesIdsThatAreNotDistinct) {
  RecordingHeader header = soups(ContactKinds::none, 0).header;
  header.objects[2].id = header.objects[0].id;
  const TemporaryFolder folder;
  EXPECT_NE(error_of([&] { Recorder(folder / "run.h5", header); }).find("same id"), std::string::npos);
}

TEST(Recorder, NamesPathsThatCannotBeWritten) {
  const TemporaryFolder folder;
  for (const std::filesystem::path& path :
       {folder / "missing/run.h5", std::filesystem::path("/proc/run.h5")}) {
    const std::string error = error_of([&] { Recorder(path, RecordingHeader{}); });
    EXPECT_EQ(error.find(path.string() + ": cannot write: "), 0u) << error;
  }
  EXPECT_NE(error_of([&] { Recorder("/dev/null", RecordingHeader{}); }).find("no regular file"),
            std::string::npos);
  EXPECT_NE(error_of([&] { Recorder(folder / "run.xdmf", RecordingHeader{}); }).find(".h5"),
            std::string::npos);
}

/// A recording whose XDMF text is long: a hundred triangles at rest.
class ManyTriangles {
 public:
  static constexpr int frame_count = 300;

  explicit ManyTriangles(const std::filesystem::path& path) : recorder_(path, header()) {}

  void add(int frame) { recorder_.add(frame, positions_, scene_.detect()); }
  void close() { recorder_.close(); }

 private:
  static constexpr std::uint32_t object_count = 100;

  RecordingHeader header() const {
    RecordingHeader header;
    for (std::uint32_t i = 0; i < object_count; ++i)
      header.objects.push_back({{i, 0}, {.name = "triangle"}, triangle_, {{0, 1, 2}}});
    return header;
  }

  std::vector<Vec3d> triangle_{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  std::vector<std::span<const Vec3d>> positions_{object_count, triangle_};
  Scene scene_;
  Recorder recorder_;
};

void expect_xdmf_of_many_triangles(const std::filesystem::path& path) {
  std::ifstream file(path);
  const std::string text(std::istreambuf_iterator<char>(file), {});
  const std::string before_time = "<Time Value=\"";
  std::size_t at = 0;
  for (int frame = 0; frame < ManyTriangles::frame_count; ++frame) {
    at = text.find(before_time, at);
    ASSERT_NE(at, std::string::npos) << frame;
    at += before_time.size();
    ASSERT_EQ(std::stod(text.substr(at)), frame);
    const std::string first_row = std::to_string(frame) + " 0 0 1 1 1 1 3 3<";
    ASSERT_NE(text.find(first_row, at), std::string::npos) << frame;
  }
  EXPECT_EQ(text.find(before_time, at), std::string::npos);
  EXPECT_EQ(text.find("</Xdmf>\n"), text.size() - 8);
}

/// The text of the last flush is longer than the pieces in which the recorder writes it.
TEST(Recorder, WritesXdmfOfManyObjectsInTheOrderOfFrames) {
  const TemporaryFolder folder;
  ManyTriangles recording(folder / "run.h5");
  for (int frame = 0; frame < ManyTriangles::frame_count; ++frame) recording.add(frame);
  recording.close();
  expect_xdmf_of_many_triangles(folder / "run.xdmf");
}

TEST(Recorder, WritesXdmfAgainThatDidNotFit) {
  const TemporaryFolder folder;
  ManyTriangles recording(folder / "run.h5");
  rlimit limit{};
  getrlimit(RLIMIT_FSIZE, &limit);
  const rlimit small{rlim_t{10} << 20, limit.rlim_max};  // more than the HDF5 file needs
  std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &small);
  int failures = 0;
  for (int frame = 0; frame < ManyTriangles::frame_count; ++frame) {
    const std::string error = error_of([&] { recording.add(frame); });
    if (error.empty()) continue;
    EXPECT_NE(error.find("run.xdmf: cannot write"), std::string::npos) << error;
    ++failures;
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  setrlimit(RLIMIT_FSIZE, &limit);
  recording.close();
  EXPECT_EQ(failures, 1);
  expect_xdmf_of_many_triangles(folder / "run.xdmf");
}

TEST(Recorder, FollowsALink) {
  const TemporaryFolder folder;
  std::ofstream(folder / "target.h5") << "old";
  std::filesystem::create_symlink(folder / "target.h5", folder / "link.h5");
  soups(ContactKinds::none, 2).write(folder / "link.h5");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.h5"));
  EXPECT_EQ(Recording(folder / "target.h5").frame_count(), 2u);
}

}  // namespace supple::recorder_test
