// Writes a recording of objects whose positions in each frame a script can compute. The tests of recordings
// stop this program at any moment and read its output.
//
// usage: record_motion OUT.h5 FRAMES [OPTION...]
//
//   --contacts none|intersection|continuous
//   --frames-between-flushes N  0 (default): the recorder decides when to flush
//   --copies N                  number of objects of each kind, default 1
//   --pause MICROSECONDS        pause after each frame
//   --log FILE                  log all file operations, so that a script can repeat any part of them
//   --fail-at N                 the Nth write and all later writes fail as on a full disk
//
// It prints the number of frames after each flush.
//
// Each entry of the log has four 64-bit integers in native byte order, and possibly data:
//   0 FILE OFFSET SIZE   a write of the SIZE bytes that follow; FILE is the number of an open file
//   1 FILE SIZE 0        the file gets this size
//   2 FRAMES 0 0         this many frames are flushed; the recording has no name before the first one

#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "supple/comparison.hpp"
#include "supple/models.hpp"
#include "supple/recording.hpp"
#include "supple/scene.hpp"

namespace {

std::int64_t writes = 0, fail_at = -1;
std::FILE* log_file = nullptr;

void note(std::int64_t kind, std::int64_t a, std::int64_t b, std::int64_t c, const void* bytes = nullptr) {
  if (!log_file) return;
  const std::int64_t entry[] = {kind, a, b, c};
  std::fwrite(entry, sizeof entry, 1, log_file);
  if (bytes) std::fwrite(bytes, 1, static_cast<std::size_t>(c), log_file);
}

ssize_t noted_write(int file, const void* bytes, std::size_t size, off_t offset) {
  const std::int64_t number = writes++;
  if (fail_at >= 0 && number >= fail_at) {
    errno = ENOSPC;
    return -1;
  }
  note(0, file, offset, static_cast<std::int64_t>(size), bytes);
  return syscall(SYS_pwrite64, file, bytes, size, offset);
}

int noted_truncation(int file, off_t size) {
  note(1, file, size, 0);
  return static_cast<int>(syscall(SYS_ftruncate, file, size));
}

}  // namespace

// These functions replace those of the C library in this program.
extern "C" ssize_t pwrite(int file, const void* bytes, std::size_t size, off_t offset) {
  return noted_write(file, bytes, size, offset);
}
extern "C" ssize_t pwrite64(int file, const void* bytes, std::size_t size, off_t offset) {
  return noted_write(file, bytes, size, offset);
}
extern "C" int ftruncate(int file, off_t size) noexcept {
  return noted_truncation(file, size);
}
extern "C" int ftruncate64(int file, off_t size) noexcept {
  return noted_truncation(file, size);
}

namespace {

using namespace supple;

struct Arguments {
  std::string path;
  std::uint64_t frames = 0, frames_between_flushes = 0, copies = 1, pause = 0;
  ContactKinds contacts = ContactKinds::intersection;
  bool colliding_vertices = false;
};

std::FILE* open_log(const char* name) {
  std::FILE* const file = std::fopen(name, "wb");
  if (!file) std::exit(2);
  return file;
}

Arguments parse(int count, char** words) {
  Arguments arguments;
  if (count < 3) std::exit(2);
  arguments.path = words[1];
  arguments.frames = std::strtoull(words[2], nullptr, 10);
  for (int i = 3; i + 1 < count; i += 2) {
    const std::string_view option = words[i], value = words[i + 1];
    const std::int64_t number = std::strtoll(words[i + 1], nullptr, 10);
    if (option == "--contacts")
      arguments.contacts = value == "none"         ? ContactKinds::none
                           : value == "continuous" ? ContactKinds::continuous
                                                   : ContactKinds::intersection;
    else if (option == "--colliding-vertices")
      arguments.colliding_vertices = number != 0;
    else if (option == "--frames-between-flushes")
      arguments.frames_between_flushes = static_cast<std::uint64_t>(number);
    else if (option == "--copies")
      arguments.copies = static_cast<std::uint64_t>(number);
    else if (option == "--pause")
      arguments.pause = static_cast<std::uint64_t>(number);
    else if (option == "--log")
      log_file = open_log(words[i + 1]);
    else if (option == "--fail-at")
      fail_at = number;
    else
      std::exit(2);
  }
  return arguments;
}

/// A sphere that moves along x through a static box, and a cloth that folds into itself.
class Motion {
 public:
  explicit Motion(const Arguments& arguments)
      : scene_({.contacts = arguments.contacts,
                .threads = 1,
                .comparison = {.colliding_vertices = arguments.colliding_vertices}}) {
    header_.time_step = 0.0078125;
    header_.scene = scene_.options();
    header_.scene_file = "# drawn up by record_motion\n";
    for (std::uint64_t copy = 0; copy < arguments.copies; ++copy) {
      ObjectOptions with_lines, fixed, folding;
      with_lines.edges = {{0, 20}, {20, 21}};
      with_lines.points = {5};
      fixed.is_static = true;
      folding.self_collision = true;
      add(make_icosphere(2), "sphere", with_lines);
      add(make_box({1, 1, 1}, 2), "box", fixed);
      add(make_cloth(4, 4), "cloth \xc3\xa9", folding);
    }
  }
  const RecordingHeader& header() const { return header_; }

  /// Moves all objects to their positions in a frame and detects.
  const DetectResult& step(std::uint64_t frame) {
    for (std::size_t i = 0; i < header_.objects.size(); ++i) {
      const RecordedObject& object = header_.objects[i];
      if (object.options.is_static) continue;
      const std::vector<Vec3d> from = positions_[i];
      for (std::size_t v = 0; v < from.size(); ++v) positions_[i][v] = moved(object.rest_positions[v], frame);
      if (scene_.options().contacts == ContactKinds::continuous)
        scene_.set_motion(object.id, from, positions_[i]);
      else
        scene_.set_positions(object.id, positions_[i]);
    }
    return scene_.detect();
  }
  std::vector<std::span<const Vec3d>> positions() const { return {positions_.begin(), positions_.end()}; }

 private:
  /// Exact in double precision, because offsets and scales are multiples of 1/64.
  static Vec3d moved(Vec3d rest, std::uint64_t frame) {
    const double place = static_cast<double>(frame % 64) / 64;
    return {rest.x + place, rest.y * (1 - place), rest.z};
  }
  void add(const TriangleMesh& mesh, const char* name, ObjectOptions options) {
    options.name = name;
    header_.objects.push_back({scene_.add(mesh, options), options, mesh.positions, mesh.triangles});
    positions_.push_back(mesh.positions);
  }

  Scene scene_;
  RecordingHeader header_;
  std::vector<std::vector<Vec3d>> positions_;
};

void run(const Arguments& arguments) {
  Motion motion(arguments);
  Recorder recorder(arguments.path, motion.header());
  note(2, 0, 0, 0);
  for (std::uint64_t frame = 0; frame < arguments.frames; ++frame) {
    const DetectResult& result = motion.step(frame);
    const auto positions = motion.positions();
    recorder.add(static_cast<double>(frame) * motion.header().time_step, positions, result);
    if (arguments.frames_between_flushes > 0 && (frame + 1) % arguments.frames_between_flushes == 0) {
      recorder.flush();
      note(2, static_cast<std::int64_t>(frame + 1), 0, 0);
      std::printf("%llu\n", static_cast<unsigned long long>(frame + 1));
      std::fflush(stdout);
    }
    if (arguments.pause > 0) usleep(static_cast<useconds_t>(arguments.pause));
  }
  recorder.close();
  if (log_file && std::fclose(log_file) != 0) throw std::runtime_error("the log cannot be written");
}

}  // namespace

int main(int count, char** words) {
  try {
    supple::use_comparison_methods();
    run(parse(count, words));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
