// A recorder in which an allocation fails leaves whole frames, or the old file. Reading can be repeated.

#include <gtest/gtest.h>
#include <hdf5.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "every_allocation.hpp"
#include "supple/error.hpp"
#include "supple/models.hpp"
#include "supple/recording.hpp"
#include "supple/scene.hpp"

namespace supple::recording_test {

namespace fs = std::filesystem;

constexpr std::uint64_t frames = 3;

// HDF5 1.10 crashes at the end of a program in which it lacked memory while it closed a file. The command
// line calls this, too.
[[maybe_unused]] const herr_t is_not_closed_at_exit = H5dont_atexit();

/// A folder that is removed at the end.
struct Folder {
  Folder() : path(fs::temp_directory_path() / ("supple_out_of_memory_" + std::to_string(getpid()))) {
    fs::create_directories(path);
  }
  ~Folder() { fs::remove_all(path); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  std::size_t file_count() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(path), fs::directory_iterator()));
  }
  fs::path path;
};

/// Two balls that intersect, and their header.
struct Scenery {
  Scenery() {
    for (const double x : {0.0, 1.1}) {
      TriangleMesh mesh = make_icosphere(2);
      for (Vec3d& p : mesh.positions) p.x += x;
      const ObjectId id = scene.add(mesh);
      header.objects.push_back({id, {.name = "ball"}, mesh.positions, mesh.triangles});
    }
    scene.detect();
  }

  Scene scene{{.threads = 1}};
  RecordingHeader header;
};

void add_frame(const Scenery& scenery, std::uint64_t frame, Recorder& recorder) {
  const std::array<std::span<const Vec3d>, 2> positions{scenery.header.objects[0].rest_positions,
                                                        scenery.header.objects[1].rest_positions};
  recorder.add(static_cast<double>(frame), positions, scenery.scene.result());
}

void record(const Scenery& scenery, const fs::path& path, std::optional<Recorder>& recorder) {
  recorder.emplace(path, scenery.header);
  for (std::uint64_t frame = 0; frame < frames; ++frame) {
    add_frame(scenery, frame, *recorder);
    if (frame == 0) recorder->flush();
  }
  recorder->close();
}

void expect_whole_frames(const Scenery& scenery, const fs::path& path) {
  const Recording recording(path);
  EXPECT_LE(recording.frame_count(), frames + 1);
  for (std::uint64_t frame = 0; frame < recording.frame_count(); ++frame) {
    EXPECT_EQ(recording.frame(frame).contacts.size(), scenery.scene.result().contacts.size());
    EXPECT_EQ(recording.positions(frame, 1), scenery.header.objects[1].rest_positions);
  }
}

TEST(RecordingOutOfMemory, ARecorderLeavesWholeFramesAndNoOtherFiles) {
  const Folder folder;
  const Scenery scenery;
  const fs::path path = folder.path / "run.h5";
  refuse_every_allocation([&](Refusal& refusal) {
    fs::remove(path);
    fs::remove(folder.path / "run.xdmf");
    std::optional<Recorder> recorder;
    const bool is_out = refusal.strikes([&] { record(scenery, path, recorder); });
    if (is_out && recorder) {
      // The recorder refuses more frames after a half one.
      try {
        add_frame(scenery, frames, *recorder);
        recorder->close();
      } catch (const Error&) {
      }
    }
    recorder.reset();
    EXPECT_LE(folder.file_count(), 2u);
    EXPECT_FALSE(fs::exists(folder.path / "run.h5.part"));
    if (fs::exists(path)) expect_whole_frames(scenery, path);
    EXPECT_TRUE(is_out || fs::exists(path));
  });
}

TEST(RecordingOutOfMemory, ReadingCanBeRepeated) {
  const Folder folder;
  const Scenery scenery;
  const fs::path path = folder.path / "run.h5";
  std::optional<Recorder> recorder;
  record(scenery, path, recorder);
  refuse_every_allocation([&](Refusal& refusal) {
    std::optional<Recording> recording;
    refusal.repeat([&] { recording.emplace(path); });
    RecordedFrame frame;
    refusal.repeat([&] { frame = recording->frame(1); });
    std::vector<Vec3d> positions;
    refusal.repeat([&] { positions = recording->positions(2, 0); });
    EXPECT_EQ(recording->frame_count(), frames);
    EXPECT_EQ(frame.contacts.size(), scenery.scene.result().contacts.size());
    EXPECT_EQ(positions, scenery.header.objects[0].rest_positions);
  });
}

}  // namespace supple::recording_test
