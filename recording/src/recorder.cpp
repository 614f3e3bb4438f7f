#include <dirent.h>
#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <memory>
#include <new>
#include <optional>
#include <set>
#include <system_error>

#include "datasets.hpp"
#include "hdf5/commit_driver.hpp"
#include "hdf5/read.hpp"
#include "supple/error.hpp"
#include "supple/recording.hpp"
#include "xdmf_file.hpp"

namespace supple {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr auto flush_interval = std::chrono::seconds(1);
/// The maximum number of bytes that wait for a flush.
constexpr std::size_t most_pending_bytes = std::size_t{32} << 20;
/// The bytes of a column that wait for more rows. The memory of a recording then depends neither on the
/// number of contacts nor on how many frames a second has.
constexpr std::size_t most_pending_bytes_of_column = std::size_t{128} << 10;

void check_writes(hid_t file) {
  if (write_error(file) != 0) throw Hdf5Failure();
}

void flush_file(hid_t file) {
  check(H5Fflush(file, H5F_SCOPE_LOCAL));
  check_writes(file);
}

[[noreturn]] void fail_to_create(const fs::path& path, int error) {
  throw Error(path.string() + ": cannot write: " + std::strerror(error) +
              "; choose a file in a folder that exists and is yours");
}

/// Follows symbolic links, so that a link stays a link.
fs::path final_path(const fs::path& path) {
  std::error_code error;
  if (!fs::exists(path, error)) return path;
  if (!fs::is_regular_file(path, error)) throw Error(path.string() + ": is no regular file; record to one");
  return fs::is_symlink(path, error) ? fs::canonical(path) : path;
}

fs::path xdmf_path(const fs::path& path) {
  fs::path result = path;
  result.replace_extension(".xdmf");
  if (result == path)
    throw Error(path.string() +
                ": the XDMF file of the recording would have the same name; use a name that ends in .h5");
  return result;
}

/// Removes the files of ranks that an earlier recording of this name had and the new one does not have.
void remove_files_of_old_ranks(const fs::path& path, const std::set<std::uint32_t>& ranks) {
  std::set<fs::path> used;
  for (const std::uint32_t rank : ranks) used.insert(file_of_rank(path, rank).filename());
  const std::string start = path.stem().string() + ".rank";
  // `std::filesystem::directory_iterator` ends the program when memory runs out.
  struct Close {
    void operator()(DIR* folder) const { closedir(folder); }
  };
  const fs::path parent = path.has_parent_path() ? path.parent_path() : ".";
  const std::unique_ptr<DIR, Close> folder(opendir(parent.c_str()));
  while (const dirent* const entry = folder ? readdir(folder.get()) : nullptr) {
    const std::string name = entry->d_name;
    const fs::path file = parent / name;
    if (name.starts_with(start) && !used.contains(name) && is_file_of_rank(file.string()))
      unlink(file.c_str());
  }
}

}  // namespace

class Recorder::Implementation {
 public:
  Implementation(const fs::path& path, const RecordingHeader& header, const RecordingRank& rank);
  ~Implementation();
  Implementation(const Implementation&) = delete;
  Implementation& operator=(const Implementation&) = delete;

  void add(double time, std::span<const std::span<const Vec3d>> positions, const DetectResult& result);
  void flush();
  void close();
  bool needs_flush() { return is_shared_ && datasets_ && flush_is_due(); }

 private:
  struct Object {
    std::size_t vertices = 0;
    bool is_static = false;
    std::vector<Vec3d> first_positions;  ///< of a static object
  };

  void create(const RecordingHeader& header);
  void check_open() const;
  void check_positions(std::span<const std::span<const Vec3d>> positions) const;
  void append(double time, std::span<const std::span<const Vec3d>> positions, std::span<const ListRows> lists,
              const StepStats& stats);
  bool flush_is_due();
  std::size_t pending_bytes();
  void write_long_columns();
  void write_out();
  void replace_old_files();
  void abandon();
  [[noreturn]] void stop();

  RecordingRank rank_;
  bool is_shared_;                       ///< by several ranks
  std::set<std::uint32_t> other_ranks_;  ///< that have objects
  fs::path path_, draft_;                ///< the draft is empty when the file has its name
  Places place_of_;
  std::vector<Object> objects_;
  FileHandle file_;
  std::optional<Datasets> datasets_;
  std::optional<XdmfFile> xdmf_;
  std::uint64_t frames_ = 0, flushed_frames_ = 0;
  Clock::time_point last_flush_ = Clock::now();
  std::string failure_;  ///< why recording stopped; empty while it works
  bool closed_ = false;
};

Recorder::Implementation::Implementation(const fs::path& path, const RecordingHeader& header,
                                         const RecordingRank& rank)
    : rank_(rank),
      is_shared_(rank.rank != 0 || is_of_several_ranks(header)),
      path_(file_of_rank(final_path(path), rank.rank)),
      place_of_(header.objects) {
  check_header(header);
  for (const RecordedObject& object : header.objects)
    objects_.push_back({object.elsewhere ? 0 : object.rest_positions.size(), object.options.is_static, {}});
  for (const RecordedObject& object : header.objects) {
    if (object.elsewhere) other_ranks_.insert(object.elsewhere->rank);
  }
  const fs::path xdmf = xdmf_path(path_);
  if (rank.rank == 0) xdmf_.emplace(xdmf, path_, header);
  const QuietErrors quiet;
  create(header);
  if (!is_shared_) replace_old_files();
}

Recorder::Implementation::~Implementation() {
  try {
    if (is_shared_) {
      // Other ranks may not have flushed the last frames.
      const QuietErrors quiet;
      abandon();
    } else {
      close();
    }
  } catch (const std::exception&) {
  }
  if (!draft_.empty()) unlink(draft_.c_str());
}

void Recorder::Implementation::create(const RecordingHeader& header) {
  // The file has another name until its header is complete. Then it replaces the old file atomically. Several
  // ranks wait until the headers of all of them are complete: that is the first flush.
  const fs::path draft = path_.string() + ".part";
  const int descriptor = open(draft.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor < 0) fail_to_create(path_, errno);
  ::close(descriptor);
  std::error_code error;
  try {
    file_ = create_committed_file(draft);
    if (!file_) throw Hdf5Failure();
    datasets_.emplace(file_.id(), path_, header, rank_);
    flush_file(file_.id());
    draft_ = draft;
  } catch (const Hdf5Failure&) {
    error = std::error_code(file_ ? write_error(file_.id()) : ENOMEM, std::generic_category());
    if (!error) error = std::error_code(EIO, std::generic_category());
  } catch (const std::bad_alloc&) {
    abandon();
    unlink(draft.c_str());
    throw;
  }
  if (!error) return;
  abandon();
  unlink(draft.c_str());
  fail_to_create(path_, error.value());
}

void Recorder::Implementation::check_open() const {
  if (!failure_.empty()) throw Error(failure_);
  if (!datasets_ && !closed_) {
    throw Error(path_.string() + ": the memory was used up; the recording ends after its first " +
                std::to_string(flushed_frames_) + " frames, record again with more memory");
  }
  if (closed_) throw Error(path_.string() + ": the recording is closed; add frames before close()");
}

void Recorder::Implementation::check_positions(std::span<const std::span<const Vec3d>> positions) const {
  if (positions.size() != objects_.size())
    throw Error(path_.string() + ": frame " + std::to_string(frames_) + " has positions of " +
                std::to_string(positions.size()) + " objects, the recording has " +
                std::to_string(objects_.size()) + "; give those of each object of the header, in its order");
  for (std::size_t place = 0; place < objects_.size(); ++place) {
    const Object& object = objects_[place];
    if (positions[place].size() != object.vertices)
      throw Error(path_.string() + ": frame " + std::to_string(frames_) + " has " +
                  std::to_string(positions[place].size()) + " positions of object " + std::to_string(place) +
                  ", which has " + std::to_string(object.vertices) +
                  " vertices; give one position per vertex");
    if (object.is_static && frames_ > 0 && object.vertices > 0 &&
        std::memcmp(positions[place].data(), object.first_positions.data(), positions[place].size_bytes()) !=
            0)
      throw Error(path_.string() + ": object " + std::to_string(place) + " moves in frame " +
                  std::to_string(frames_) + ", and is static in the header; record it with is_static off");
  }
}

void Recorder::Implementation::add(double time, std::span<const std::span<const Vec3d>> positions,
                                   const DetectResult& result) {
  check_open();
  check_positions(positions);
  const std::vector<ListRows> lists = checked_rows(result, place_of_);
  const QuietErrors quiet;
  try {
    append(time, positions, lists, result.stats);
    ++frames_;
    write_long_columns();
    if (!is_shared_ && flush_is_due()) write_out();
  } catch (const Hdf5Failure&) {
    stop();
  } catch (const std::bad_alloc&) {
    abandon();  // a part of the frame may be in memory
    throw;
  }
}

void Recorder::Implementation::append(double time, std::span<const std::span<const Vec3d>> positions,
                                      std::span<const ListRows> lists, const StepStats& stats) {
  for (std::size_t place = 0; place < objects_.size(); ++place) {
    Object& object = objects_[place];
    if (!datasets_->positions[place] || (object.is_static && frames_ > 0)) continue;
    if (object.is_static) object.first_positions.assign(positions[place].begin(), positions[place].end());
    datasets_->positions[place]->append(positions[place]);
  }
  check_writes(file_.id());
  if (rank_.rank != 0) return;
  for (std::size_t i = 0; i < lists.size(); ++i) datasets_->lists[i].append(lists[i], place_of_);
  for (std::size_t i = 0; i < datasets_->statistics.size(); ++i)
    datasets_->statistics[i].append_value(reinterpret_cast<const std::byte*>(&stats) +
                                          columns_of_statistics()[i].offset);
  datasets_->time->append_value(&time);
  xdmf_->add_frame(time);
  check_writes(file_.id());
}

bool Recorder::Implementation::flush_is_due() {
  // The first frames are flushed early, so that a recording that fills a small disk keeps most of them.
  return frames_ - flushed_frames_ > flushed_frames_ / 8 || pending_bytes() >= most_pending_bytes ||
         Clock::now() - last_flush_ >= flush_interval;
}

std::size_t Recorder::Implementation::pending_bytes() {
  std::size_t bytes = 0;
  datasets_->for_each_column([&](const ColumnWriter& column) { bytes += column.pending_bytes(); });
  return bytes;
}

/// Until the flush, the file has no header that counts these rows.
void Recorder::Implementation::write_long_columns() {
  datasets_->for_each_column([](ColumnWriter& column) {
    if (column.pending_bytes() >= most_pending_bytes_of_column) column.write_pending();
  });
  check_writes(file_.id());
}

void Recorder::Implementation::write_out() {
  datasets_->for_each_column([](ColumnWriter& column) { column.write_pending(); });
  flush_file(file_.id());
  if (!draft_.empty()) replace_old_files();
  flushed_frames_ = frames_;
  last_flush_ = Clock::now();
  // The XDMF file refers to the data, so it is written last.
  if (xdmf_) xdmf_->write();
}

void Recorder::Implementation::replace_old_files() {
  std::error_code error;
  fs::rename(draft_, path_, error);
  if (error) {
    abandon();
    unlink(draft_.c_str());
    fail_to_create(path_, error.value());
  }
  draft_.clear();
  if (rank_.rank != 0) return;
  remove_files_of_old_ranks(path_, other_ranks_);
  xdmf_->write();
}

void Recorder::Implementation::stop() {
  const int error = write_error(file_.id());
  failure_ = path_.string() + ": writing failed: " + (error != 0 ? std::strerror(error) : "HDF5 refused") +
             "; the recording ends after its first " + std::to_string(flushed_frames_) +
             " frames, make room and record again";
  abandon();
  throw Error(failure_);
}

/// Leaves the file as the last flush left it.
void Recorder::Implementation::abandon() {
  if (file_) discard_writes(file_.id());
  datasets_.reset();
  file_.reset();
}

void Recorder::Implementation::flush() {
  check_open();
  const QuietErrors quiet;
  try {
    write_out();
  } catch (const Hdf5Failure&) {
    stop();
  } catch (const std::bad_alloc&) {
    abandon();
    throw;
  }
}

void Recorder::Implementation::close() {
  if (closed_) return;
  flush();
  closed_ = true;
  const QuietErrors quiet;
  datasets_.reset();
  // Everything is flushed already; this only reports errors of closing.
  if (!file_.reset()) throw Error(path_.string() + ": closing failed; check the disk and record again");
  xdmf_.reset();
}

Recorder::Recorder(const std::filesystem::path& path, const RecordingHeader& header,
                   const RecordingRank& rank)
    : implementation_(std::make_unique<Implementation>(path, header, rank)) {}
Recorder::~Recorder() = default;
Recorder::Recorder(Recorder&&) noexcept = default;
Recorder& Recorder::operator=(Recorder&&) noexcept = default;

void Recorder::add(double time, std::span<const std::span<const Vec3d>> positions,
                   const DetectResult& result) {
  implementation_->add(time, positions, result);
}
void Recorder::flush() {
  implementation_->flush();
}
bool Recorder::needs_flush() const {
  return implementation_->needs_flush();
}
void Recorder::close() {
  implementation_->close();
}

}  // namespace supple
