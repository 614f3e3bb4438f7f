#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "supple/mesh.hpp"
#include "supple/options.hpp"
#include "supple/result.hpp"
#include "supple/types.hpp"

namespace supple {

/// What a recording says of an object once. An object with `is_static` must not move while it is recorded.
struct RecordedObject {
  ObjectId id;  ///< by which results name it
  ObjectOptions options{};
  std::vector<Vec3d> rest_positions{};
  std::vector<Triangle> triangles{};
};

/// What a recording says once.
struct RecordingHeader {
  std::vector<RecordedObject> objects{};
  double time_step = 0.01;   ///< s
  SceneOptions scene{};      ///< threads are not kept
  std::string scene_file{};  ///< text of the scene file that was simulated; empty when there is none
};

/// Everything of one frame, as `DetectResult` has it.
struct RecordedFrame {
  double time = 0;
  std::vector<ObjectPair> object_pairs{};
  std::vector<Contact> contacts{};
  std::vector<ContactPoint> contact_points{};
  std::vector<ContinuousContact> continuous_contacts{};
  std::vector<ObjectPair> volume_begin{}, volume_end{}, contact_begin{}, contact_end{};
  StepStats stats{};
};

/// Writes a recording (docs/recording.md), an HDF5 file, and beside it an XDMF file of the same stem that
/// ParaView opens.
///
/// The file is readable at any time up to the last flush, also after the process is killed: between flushes
/// nothing is written over what the file already refers to. `add` flushes once a second, the destructor at
/// the end.
class Recorder {
 public:
  /// Replaces the files; the old recording stays until the new one has its header. Throws `Error` when they
  /// cannot be written, or the header does not fit together.
  Recorder(const std::filesystem::path& path, const RecordingHeader& header);
  /// Closes without throwing; call `close` to know of errors.
  ~Recorder();
  Recorder(Recorder&&) noexcept;
  Recorder& operator=(Recorder&&) noexcept;

  /// A frame: positions of each object in the header's order. Throws `Error` when a size differs, or the disk
  /// is full: what was flushed stays readable.
  void add(double time, std::span<const std::span<const Vec3d>> positions, const DetectResult& result);
  void flush();
  void close();

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// Reads a recording, also one that is being written: the frames that were flushed when it was opened. Calls
/// on one recording must not overlap, constant or not, nor with any other use of HDF5 unless that was built
/// for threads.
class Recording {
 public:
  /// Throws `Error` when it is no recording, of a version not known, or damaged; it says which.
  explicit Recording(const std::filesystem::path& path);
  ~Recording();
  Recording(Recording&&) noexcept;
  Recording& operator=(Recording&&) noexcept;

  const RecordingHeader& header() const;
  std::uint64_t frame_count() const;
  /// Throws `Error` when there is no such frame, or what is stored of it names what does not exist. Frames in
  /// a row are read fastest.
  RecordedFrame frame(std::uint64_t number) const;
  /// Likewise, without pairs and contacts: time, events and statistics, which take a fraction of the time.
  RecordedFrame summary(std::uint64_t number) const;
  /// Of one object, by its place in the header.
  std::vector<Vec3d> positions(std::uint64_t frame, std::size_t object) const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// The first place in which two recordings differ.
struct RecordingDifference {
  std::optional<std::uint64_t> frame;  ///< none: in what they say once, or in their number of frames
  std::string what;                    ///< one line: the item, its number and both values
};

/// Compares all but times measured and file-specific text; nothing when they are equal. Positions and other
/// lengths may differ by `tolerance` ≥ 0 in each coordinate; 0 compares bits.
std::optional<RecordingDifference> find_first_difference(const Recording& a, const Recording& b,
                                                         double tolerance = 0);

}  // namespace supple
