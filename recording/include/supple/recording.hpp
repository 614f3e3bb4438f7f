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

/// The rank that records an object, and the size of the object.
struct RecordedElsewhere {
  std::uint32_t rank = 0;
  std::uint64_t vertices = 0, triangles = 0;
};

/// The constant data of an object. An object with `is_static` must not move while it is recorded.
struct RecordedObject {
  ObjectId id;  ///< its id in the results
  ObjectOptions options{};
  std::vector<Vec3d> rest_positions{};
  std::vector<Triangle> triangles{};
  /// Set it for a `Recorder` when another rank records the object. The recorder then reads only the id and
  /// the options `name` and `is_static`. A `Recording` leaves it empty.
  std::optional<RecordedElsewhere> elsewhere{};
};

/// The constant data of a recording.
struct RecordingHeader {
  std::vector<RecordedObject> objects{};
  double time_step = 0.01;   ///< s
  SceneOptions scene{};      ///< without the number of threads
  std::string scene_file{};  ///< text of the simulated scene file; empty when there is none
  std::uint32_t ranks = 1;   ///< processes that find the contacts together: counts of work depend on it
};

/// One of several processes that write a recording together.
struct RecordingRank {
  std::uint32_t rank = 0;
  std::uint32_t run = 0;  ///< a number that all ranks have; choose one at random for each run
};

/// The object pairs that begin and end in a frame, as in `PairEvents`.
struct RecordedEvents {
  std::vector<ObjectPair> begin{}, end{};
};

/// All data of one frame: the lists of `DetectResult`. Its lists of groups follow from the records.
struct RecordedFrame {
  double time = 0;
  std::vector<ObjectPair> object_pairs{};
  std::vector<Contact> contacts{};
  std::vector<ContactPoint> contact_points{};
  std::vector<ContinuousContact> continuous_contacts{};
  std::vector<ProximityPair> proximity_pairs{};
  std::vector<PenetrationGroup> penetration_groups{};
  std::vector<Penetration> penetrations{};
  std::vector<std::uint32_t> vertices_on_surface{};
  std::vector<ContainedPart> contained_parts{};
  std::vector<IntersectionCurve> curves{};
  std::vector<std::uint32_t> curve_contacts{};
  std::vector<Vec3d> curve_points{};
  std::vector<std::uint32_t> enclosed_vertices{};
  std::vector<Manifold> manifolds{};
  std::vector<ManifoldPoint> manifold_points{};
  std::vector<CollidingVertices> colliding_vertex_groups{};
  std::vector<std::uint32_t> colliding_vertices{};
  RecordedEvents volume_events{}, narrow_phase_events{}, contact_events{}, proximity_events{},
      penetration_events{};
  StepStats stats{};
};

/// Writes a recording (docs/recording.md): an HDF5 file, and an XDMF file with the same stem for ParaView.
///
/// The file is readable at any time up to the last flush, also after the process was killed: between flushes,
/// the recorder never overwrites data that the file refers to. `add` flushes once per second, when 32 MiB
/// wait in memory, and when the number of frames has grown by more than an eighth since the last flush. The
/// destructor flushes at the end.
///
/// Several ranks can write one recording together. Rank 0 writes the recording itself. Each other rank writes
/// the objects that it has to a file beside it, `run.rank1.h5` of rank 1, to which the recording links. Then
/// only `flush` and `close` write frames, and only frames that all ranks have flushed are part of the
/// recording. So rank 0 must call them when the others have returned:
///
///  1. All ranks make their recorders.
///  2. The others call `flush`, then rank 0 does. The first flush replaces the files of an earlier recording.
///  3. All ranks call `add` for each frame. When `needs_flush` is true on rank 0, they flush as in step 2.
///  4. The others call `close`, then rank 0 does.
class Recorder {
 public:
  /// Replaces existing files once the new recording has its header. Throws `Error` when the files cannot be
  /// written, or the header is inconsistent. All ranks give the same path, and all objects in the same order.
  Recorder(const std::filesystem::path& path, const RecordingHeader& header, const RecordingRank& rank = {});
  /// Closes without throwing. Call `close` to see errors. A rank of several drops what it has not flushed.
  ~Recorder();
  Recorder(Recorder&&) noexcept;
  Recorder& operator=(Recorder&&) noexcept;

  /// Adds a frame: the positions of each object, in the order of the header. Throws `Error` when a size
  /// differs, or when the disk is full; flushed frames stay readable. When memory runs out in a function of
  /// the recorder, the recording ends after the flushed frames, too. Objects that are elsewhere have no
  /// positions; only rank 0 reads the time and the result.
  void add(double time, std::span<const std::span<const Vec3d>> positions, const DetectResult& result);
  /// Writes all frames to the file. Throws `Error` when the disk is full.
  void flush();
  /// Whether frames of several ranks have waited long enough for a call of `flush`. One process need not ask.
  bool needs_flush() const;
  /// Flushes and closes both files. Throws `Error` when the disk is full.
  void close();

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// Reads a recording, of several ranks with the files to which it links. When the file is still being
/// written, it has the frames that were flushed before it was opened. Calls on one recording must not
/// overlap, not even calls of const functions, nor overlap other uses of HDF5 unless HDF5 was built for
/// threads.
class Recording {
 public:
  /// Throws `Error` when the file is not a recording, has an unknown version, or is damaged, or when a file
  /// of a rank is missing, damaged or of another run. When a read fails because a file is written meanwhile,
  /// this and all functions open the files again; they throw `Error` after 50 attempts in vain.
  explicit Recording(const std::filesystem::path& path);
  ~Recording();
  Recording(Recording&&) noexcept;
  Recording& operator=(Recording&&) noexcept;

  const RecordingHeader& header() const;
  std::uint64_t frame_count() const;
  /// Throws `Error` when there is no such frame, or its data refer to objects, triangles, vertices or
  /// rows that do not exist. Sequential reading is fastest.
  RecordedFrame frame(std::uint64_t number) const;
  /// As `frame`, but only time, events and statistics, in a fraction of the time.
  RecordedFrame summary(std::uint64_t number) const;
  /// The positions of one object, by its index in the header.
  std::vector<Vec3d> positions(std::uint64_t frame, std::size_t object) const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// The first place in which two recordings differ.
struct RecordingDifference {
  std::optional<std::uint64_t> frame;  ///< empty: the headers or the numbers of frames differ
  std::string what;                    ///< one line: the item, its index and both values
};

/// Compares two recordings, without measured times and file-specific text, and without counts of work when
/// their numbers of ranks differ. Returns nothing when they are equal. Positions and other lengths may differ
/// by `tolerance` ≥ 0 in each coordinate; 0 compares bits.
std::optional<RecordingDifference> find_first_difference(const Recording& a, const Recording& b,
                                                         double tolerance = 0);

}  // namespace supple
