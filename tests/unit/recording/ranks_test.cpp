#include <gtest/gtest.h>
#include <hdf5.h>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "supple/error.hpp"
#include "support/soups.hpp"
#include "unit/recording/recorded_scenes.hpp"

namespace supple::ranks_test {

namespace fs = std::filesystem;

/// Several ranks that record together, all in this process. Rank r has each object i with i % ranks = r.
class Job {
 public:
  Job(const fs::path& path, const Contents& contents, std::uint32_t ranks, std::uint32_t run)
      : contents_(contents), ranks_(ranks) {
    for (std::uint32_t rank = 1; rank < ranks; ++rank)
      others_.emplace_back(path, header_of(rank), RecordingRank{rank, run});
    first_.emplace(path, header_of(0), RecordingRank{0, run});
    flush_others();
    first_->flush();
  }

  void add_all() {
    for (std::size_t frame = 0; frame < contents_.frames.size(); ++frame) add(frame);
  }
  void add(std::size_t frame) {
    for (std::uint32_t rank = 0; rank < ranks_; ++rank) {
      std::vector<std::span<const Vec3d>> views(contents_.header.objects.size());
      for (std::size_t i = rank; i < views.size(); i += ranks_) views[i] = contents_.positions[frame][i];
      recorder(rank).add(contents_.frames[frame].time, views, shown(contents_.frames[frame]));
    }
  }
  void flush_others() {
    for (Recorder& other : others_) other.flush();
  }
  Recorder& recorder(std::uint32_t rank) { return rank == 0 ? *first_ : others_[rank - 1]; }
  void close() {
    for (Recorder& other : others_) other.close();
    first_->close();
  }

  static RecordingHeader header_of(const Contents& contents, std::uint32_t ranks, std::uint32_t rank) {
    RecordingHeader header = contents.header;
    for (std::uint32_t i = 0; i < header.objects.size(); ++i) {
      RecordedObject& object = header.objects[i];
      if (i % ranks == rank) continue;
      object.elsewhere = {i % ranks, object.rest_positions.size(), object.triangles.size()};
      object.rest_positions.clear();
      object.triangles.clear();
    }
    return header;
  }

 private:
  RecordingHeader header_of(std::uint32_t rank) const { return header_of(contents_, ranks_, rank); }

  const Contents& contents_;
  std::uint32_t ranks_;
  std::vector<Recorder> others_;
  std::optional<Recorder> first_;
};

class RecordingOfRanks : public testing::Test {
 protected:
  RecordingOfRanks() {
    SceneOptions scene;
    scene.threads = 1;
    ObjectOptions fixed, with_lines;
    fixed.is_static = true;
    with_lines.edges = {{0, 40}, {40, 41}};
    contents_ = simulate({random_soup(30, 1, 0.6, 4), random_soup(20, 1, 0.6, 5), random_soup(25, 1, 0.6, 6),
                          random_soup(10, 1, 0.6, 7)},
                         {{}, with_lines, fixed}, scene, 5);
    contents_.write(folder_ / "alone.h5");
  }

  void record(std::uint32_t ranks, std::uint32_t run = 1) const {
    Job job(folder_ / "run.h5", contents_, ranks, run);
    job.add_all();
    job.close();
  }

  bool has(const char* name) const { return fs::exists(folder_ / name); }

  std::string error_of_reading(const fs::path& path) const {
    try {
      read_contents(Recording(path));
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }
  void expect_error(const std::string& start, const std::string& part) const {
    const std::string error = error_of_reading(folder_ / "run.h5");
    EXPECT_EQ(error.find((folder_ / start).string()), 0u) << error;
    EXPECT_NE(error.find(part), std::string::npos) << error;
  }
  void expect_equal(const fs::path& path) const {
    const auto difference = find_first_difference(Recording(folder_ / "alone.h5"), Recording(path));
    EXPECT_FALSE(difference) << difference->what;
  }

  std::string bytes_of(const char* name) const {
    std::ifstream file(folder_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  /// Changes the recording through HDF5.
  void change(const std::function<void(hid_t)>& change) const {
    const hid_t file = H5Fopen((folder_ / "run.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    change(file);
    H5Fclose(file);
  }

  TemporaryFolder folder_;
  Contents contents_;
};

TEST_F(RecordingOfRanks, IsReadAsOne) {
  for (const std::uint32_t ranks : {1u, 2u, 3u, 4u}) {
    record(ranks);
    expect_equal(folder_ / "run.h5");
    EXPECT_EQ(has("run.rank1.h5"), ranks > 1);
    EXPECT_EQ(has("run.rank3.h5"), ranks > 3);
  }
  for (const char* link : {"run.h5:/objects/0/positions<", "run.rank1.h5:/objects/1/triangles<",
                           "run.rank3.h5:/objects/3/positions<"})
    EXPECT_NE(bytes_of("run.xdmf").find(link), std::string::npos) << link;
}

TEST_F(RecordingOfRanks, OneRankWritesTheFileOfOneProcess) {
  record(1);
  EXPECT_EQ(bytes_of("run.h5"), bytes_of("alone.h5"));
}

TEST_F(RecordingOfRanks, HasFramesThatAllRanksHaveFlushed) {
  {
    Job job(folder_ / "run.h5", contents_, 3, 1);
    for (std::size_t frame = 0; frame < 4; ++frame) {
      job.add(frame);
      EXPECT_TRUE(job.recorder(0).needs_flush() || frame > 0);
      if (frame == 3) continue;
      job.flush_others();
      job.recorder(0).flush();
      EXPECT_FALSE(job.recorder(0).needs_flush());
    }
    EXPECT_EQ(Recording(folder_ / "run.h5").frame_count(), 3u);
    job.recorder(2).flush();
    EXPECT_EQ(read_contents(Recording(folder_ / "run.h5")).frames.size(), 3u);
  }
  // Without `close`, others may not have the last frame.
  EXPECT_EQ(read_contents(Recording(folder_ / "run.h5")).frames.size(), 3u);
}

TEST_F(RecordingOfRanks, NamesAFileWithTooFewFrames) {
  Job job(folder_ / "run.h5", contents_, 2, 1);
  job.add_all();
  job.recorder(0).close();
  expect_error("run.rank1.h5: /objects/1/positions", "has 0 frames, the recording has 5");
}

TEST_F(RecordingOfRanks, NamesAFileThatIsMissingOrDamaged) {
  record(3);
  const std::string whole = bytes_of("run.rank2.h5");
  fs::remove(folder_ / "run.rank2.h5");
  expect_error("run.rank2.h5: is missing", "put all files of the recording into one folder");
  folder_.write("run.rank2.h5", std::string_view(whole).substr(0, whole.size() / 2));
  expect_error("run.rank2.h5: is damaged or cut short", "copy it again");
  folder_.write("run.rank2.h5", "text");
  expect_error("run.rank2.h5: is no recording", "");
  folder_.write("run.rank2.h5", whole);
  expect_equal(folder_ / "run.h5");
}

TEST_F(RecordingOfRanks, RefusesFilesOfOtherRuns) {
  record(2, 1);
  const std::string of_run_1 = bytes_of("run.rank1.h5");
  record(2, 2);
  folder_.write("run.rank1.h5", of_run_1);
  expect_error("run.rank1.h5: does not belong to ", "but to another run");
  fs::copy_file(folder_ / "alone.h5", folder_ / "run.rank1.h5", fs::copy_options::overwrite_existing);
  expect_error("run.rank1.h5: does not belong to ", "but to another run");
  folder_.write("run.rank1.h5", of_run_1);
  EXPECT_NE(error_of_reading(folder_ / "run.rank1.h5").find("has only the objects of one rank"),
            std::string::npos);
}

TEST_F(RecordingOfRanks, StaysWholeInAnotherFolder) {
  record(3);
  fs::create_directory(folder_ / "other");
  for (const char* name : {"run.h5", "run.rank1.h5", "run.rank2.h5"})
    fs::rename(folder_ / name, folder_ / "other" / name);
  expect_equal(folder_ / "other/run.h5");
  fs::create_symlink(folder_ / "other/run.h5", folder_ / "link.h5");
  expect_equal(folder_ / "link.h5");
}

TEST_F(RecordingOfRanks, RemovesFilesOfTheReplacedRecording) {
  record(4, 1);
  fs::rename(folder_ / "run.rank2.h5", folder_ / "kept.rank2.h5");
  fs::copy_file(folder_ / "alone.h5", folder_ / "run.rank7.h5");  // no file of a rank
  record(2, 2);
  EXPECT_TRUE(has("run.rank1.h5") && has("run.rank7.h5") && has("kept.rank2.h5"));
  EXPECT_FALSE(has("run.rank3.h5"));
  expect_equal(folder_ / "run.h5");
  contents_.write(folder_ / "run.h5");
  EXPECT_FALSE(has("run.rank1.h5"));
  expect_equal(folder_ / "run.h5");
}

TEST_F(RecordingOfRanks, StaysUntilAllRanksCanReplaceIt) {
  record(3, 1);
  fs::create_directory(folder_ / "run.rank2.h5.part");
  EXPECT_THROW(record(3, 2), Error);
  fs::remove(folder_ / "run.rank2.h5.part");
  EXPECT_FALSE(has("run.rank1.h5.part"));
  expect_equal(folder_ / "run.h5");
}

TEST_F(RecordingOfRanks, LinksLeadToObjectsOfTheSameFolder) {
  record(2);
  const auto link_to = [this](const std::string& file, const char* item) {
    change([&](hid_t id) {
      H5Ldelete(id, "objects/1", H5P_DEFAULT);
      ASSERT_GE(H5Lcreate_external(file.c_str(), item, id, "objects/1", H5P_DEFAULT, H5P_DEFAULT), 0);
    });
  };
  for (const std::string& file : {(folder_ / "run.rank1.h5").string(), std::string("../run.rank1.h5")}) {
    link_to(file, "/objects/1");
    expect_error("run.h5: /objects/1", "is a link to another place");
  }
  link_to("run.rank1.h5", "/objects/0");
  expect_error("run.h5: /objects/1", "is a link to another place");
  link_to("..", "/objects/1");
  expect_error("..: ", "is a folder");
  link_to("run.h5", "/objects/1");
  expect_error("run.h5: ", "");
  link_to("run.rank1.h5", "/objects/1");
  expect_equal(folder_ / "run.h5");
  change([](hid_t id) { H5Lcreate_soft("/objects/0", id, "objects/4", H5P_DEFAULT, H5P_DEFAULT); });
  expect_error("run.h5: /objects/4", "is a soft or an external link");
}

}  // namespace supple::ranks_test
