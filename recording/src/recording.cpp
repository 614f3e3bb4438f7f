#include "supple/recording.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <map>
#include <memory>
#include <new>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <thread>
#include <type_traits>
#include <utility>

#include "hdf5/read.hpp"
#include "hdf5/write.hpp"
#include "layout.hpp"
#include "ragged_reader.hpp"
#include "recording_header.hpp"
#include "reference_check.hpp"
#include "supple/error.hpp"
#include "supple/result_descriptions.hpp"
#include "text.hpp"

namespace supple {
namespace {

namespace fs = std::filesystem;

/// The file of a rank is beside the recording.
fs::path path_of_rank(const InputFile& recording, const std::string& name) {
  std::error_code error;
  fs::path path = fs::path(recording.path()).replace_filename(name);
  if (!fs::exists(path, error) && fs::is_symlink(recording.path(), error))
    path = fs::canonical(recording.path(), error).replace_filename(name);
  return path;
}

InputFile open_file_of_rank(const InputFile& recording, const fs::path& path) {
  std::error_code error;
  if (!fs::exists(path, error))
    throw Error(path.string() + ": is missing, and has objects of " + recording.path() +
                "; put all files of the recording into one folder");
  InputFile file(path.string());
  if (!file.has_text("/", "format") || file.text("/", "format") != format_name_of_rank ||
      file.count("/", "run") != recording.count("/", "run"))
    throw Error(path.string() + ": does not belong to " + recording.path() +
                ", but to another run; put the files of one run into one folder, or record again");
  return file;
}

/// Turns errors of HDF5 and of the system into an `Error` that names the file.
template <class Function>
auto with_errors_of(const std::string& path, Function function) {
  const QuietErrors quiet;
  try {
    return function();
  } catch (const Hdf5Failure&) {
    throw Error(path + ": cannot be read; it is damaged, copy it again or record again");
  } catch (const std::bad_alloc&) {
    throw Error(path + ": does not fit into memory, or is damaged; copy it again or record again");
  } catch (const std::length_error&) {
    throw Error(path + ": is damaged; copy it again or record again");
  }
}

/// A file as it was before it was opened.
struct SeenFile {
  explicit SeenFile(fs::path name) : path(std::move(name)) { look(time, size); }
  bool has_changed() const {
    fs::file_time_type time_now;
    std::uintmax_t size_now = 0;
    look(time_now, size_now);
    return time != time_now || size != size_now;
  }
  void look(fs::file_time_type& time_now, std::uintmax_t& size_now) const {
    std::error_code error;  // a file that is gone has changed
    time_now = fs::last_write_time(path, error);
    size_now = fs::file_size(path, error);
  }

  fs::path path;
  fs::file_time_type time;
  std::uintmax_t size = 0;
};

/// The files of a recording, opened once: what they gain afterwards is not read.
class OpenFiles {
 public:
  /// Adds each file to `seen` before it opens it.
  OpenFiles(const std::string& path, std::vector<SeenFile>& seen);

  RecordedFrame frame(std::uint64_t number);
  RecordedFrame summary(std::uint64_t number);
  std::vector<Vec3d> positions(std::uint64_t frame, std::size_t object);
  const RecordingHeader& header() const { return header_; }
  std::uint64_t frame_count() const { return time_.rows(); }

 private:
  const InputFile& file_of(std::size_t object);
  void read_lists(std::uint64_t number, RecordedFrame& frame, bool with_records);
  StepStats stats(std::uint64_t frame);

  std::vector<SeenFile>* seen_;
  InputFile file_;
  std::uint32_t version_;
  ColumnReader time_;  ///< opened before the files of ranks, which have all frames that it has
  std::map<std::string, InputFile> files_of_ranks_;
  RecordingHeader header_;
  std::vector<RaggedReader> lists_;  ///< in the order of `list_infos`
  std::vector<std::optional<ColumnReader>>
      statistics_;  ///< in the order of `StepStats`; empty if the file lacks it
  std::vector<ColumnReader> positions_;
};

OpenFiles::OpenFiles(const std::string& path, std::vector<SeenFile>& seen)
    : seen_(&seen),
      file_((seen.emplace_back(path), path), true),
      version_(check_format(file_)),
      time_(file_, "time", ScalarType::float64, {}),
      header_(read_header(file_, version_,
                          [&](std::size_t object) -> const InputFile& { return file_of(object); })) {
  for (const ListLayout& layout : list_layouts()) lists_.emplace_back(file_, version_, layout, frame_count());
  const auto check_frames = [this](const ColumnReader& column, std::uint64_t needed) {
    if (column.rows() < needed)
      column.fail("has " + std::to_string(column.rows()) + " frames, the recording has " +
                  std::to_string(frame_count()) + damaged);
  };
  for (const Column& column : columns_of_statistics()) {
    const std::string dataset =
        std::string(statistics_group) + "/" + column_in_version(column.name, version_);
    statistics_.emplace_back();
    if (!file_.has_item(dataset)) continue;  // files of earlier programs lack it
    statistics_.back().emplace(file_, dataset, column.type, std::vector<hsize_t>{});
    check_frames(*statistics_.back(), frame_count());
  }
  for (std::size_t place = 0; place < header_.objects.size(); ++place) {
    const RecordedObject& object = header_.objects[place];
    positions_.emplace_back(file_of(place), object_path(place) + "/positions", ScalarType::float64,
                            std::vector<hsize_t>{object.rest_positions.size(), 3});
    check_frames(positions_.back(),
                 object.options.is_static ? std::min<std::uint64_t>(frame_count(), 1) : frame_count());
  }
}

const InputFile& OpenFiles::file_of(std::size_t object) {
  const std::string name = file_.linked_file(object_path(object));
  if (name.empty()) return file_;
  const auto found = files_of_ranks_.find(name);
  if (found != files_of_ranks_.end()) return found->second;
  const fs::path path = path_of_rank(file_, name);
  seen_->emplace_back(path);
  return files_of_ranks_.emplace(name, open_file_of_rank(file_, path)).first->second;
}

StepStats OpenFiles::stats(std::uint64_t frame) {
  StepStats stats;
  for (std::size_t c = 0; c < statistics_.size(); ++c) {
    if (!statistics_[c]) continue;
    std::array<std::byte, 8> bytes{};
    statistics_[c]->read(frame, 1, bytes.data());
    load(columns_of_statistics()[c], bytes.data(), &stats);
  }
  for_each_leaf(
      [&](const auto& field, const auto& value) {
        if constexpr (Worded<std::remove_cvref_t<decltype(value)>>) {
          if (word_of(value) == nullptr)
            file_.fail(std::string(statistics_group) + "/" + field.key,
                       "row " + std::to_string(frame) + " is " +
                           std::to_string(static_cast<unsigned>(value)) + ", not below " +
                           std::to_string(words<std::remove_cvref_t<decltype(value)>>.size()) + damaged);
        }
      },
      stats);
  return stats;
}

RecordedFrame OpenFiles::summary(std::uint64_t number) {
  RecordedFrame frame;
  time_.read(number, 1, reinterpret_cast<std::byte*>(&frame.time));
  read_lists(number, frame, false);
  frame.stats = stats(number);
  return frame;
}

RecordedFrame OpenFiles::frame(std::uint64_t number) {
  RecordedFrame frame = summary(number);
  read_lists(number, frame, true);
  return frame;
}

/// Reads the events, or the other lists. Records have ids of objects when all that they refer to is checked.
void OpenFiles::read_lists(std::uint64_t number, RecordedFrame& frame, bool with_records) {
  const auto for_each = [&](auto visit) {
    std::size_t place = 0;
    for_each_list([&]<class Row>(const ResultList<Row>& list, auto member) {
      const bool is_event = std::string_view(list.name).starts_with("events/");
      if (is_event != with_records) visit(place, member(frame));
      ++place;
    });
  };
  for_each([&]<class Row>(std::size_t place, std::vector<Row>& rows) {
    rows.resize(lists_[place].count(number));
    lists_[place].read(number, reinterpret_cast<std::byte*>(rows.data()));
  });
  const ReferenceCheck check(header_.objects, frame, [&](const BadReference& bad) {
    lists_[place_of_list(bad.list)].fail(number, bad);
  });
  for_each([&](std::size_t place, const auto&) { check.list(place); });
  for_each([&]<class Row>(std::size_t place, std::vector<Row>& rows) {
    for (const FieldInfo& field : list_infos()[place].record.fields) {
      for (std::size_t i = 0; field.kind == FieldInfo::Kind::object && i < rows.size(); ++i) {
        std::byte* const row = reinterpret_cast<std::byte*>(&rows[i]);
        const ObjectId id = header_.objects[number_of(field, row)].id;
        std::memcpy(row + field.offset, &id, sizeof id);
      }
    }
  });
}

std::vector<Vec3d> OpenFiles::positions(std::uint64_t frame, std::size_t object) {
  std::vector<Vec3d> positions(header_.objects[object].rest_positions.size());
  const std::uint64_t row = header_.objects[object].options.is_static ? 0 : frame;
  positions_[object].read(row, 1, reinterpret_cast<std::byte*>(positions.data()));
  return positions;
}

}  // namespace

/// Reads a recording that may still grow. A run changes its files between two reads of HDF5; HDF5 then finds
/// parts of its index behind the end of the file that it knows, and fails. `read` opens the files again and
/// repeats what failed, as long as the files change.
class Recording::Implementation {
 public:
  explicit Implementation(std::string path) : path_(std::move(path)) {
    read([&](OpenFiles& files) {
      header_ = files.header();
      frame_count_ = files.frame_count();
      has_header_ = true;
    });
  }

  template <class Read>
  std::invoke_result_t<Read, OpenFiles&> read(Read read) {
    return with_errors_of(path_, [&] {
      for (int attempt = 1;; ++attempt) {
        try {
          if (!files_) {
            seen_.clear();
            files_ = std::make_unique<OpenFiles>(path_, seen_);
            if (has_header_) check_same();
          }
          return read(*files_);
        } catch (...) {
          if (std::ranges::none_of(seen_, &SeenFile::has_changed)) throw;
          files_.reset();
          if (attempt == most_attempts)
            throw Error(path_ +
                        ": changes while it is read; read it again when the run that records it has ended");
          std::this_thread::sleep_for(std::chrono::milliseconds(attempt));
        }
      }
    });
  }

  void check_frame(std::uint64_t number) const { check("frame", number, frame_count_); }
  void check_object(std::size_t object) const { check("object", object, header_.objects.size()); }
  const RecordingHeader& header() const { return header_; }
  std::uint64_t frame_count() const { return frame_count_; }

 private:
  void check(const char* noun, std::uint64_t number, std::uint64_t count) const {
    if (number >= count)
      throw Error(path_ + ": there is no " + noun + " " + std::to_string(number) + "; the recording has " +
                  std::to_string(count) + ", counted from 0");
  }

  /// The files may now be those of another run.
  void check_same() {
    const auto sizes = [](const RecordedObject& object) {
      return std::pair(object.rest_positions.size(), object.triangles.size());
    };
    if (files_->frame_count() >= frame_count_ &&
        std::ranges::equal(files_->header().objects, header_.objects, {}, sizes, sizes))
      return;
    files_.reset();
    throw Error(path_ + ": was recorded again; open it again");
  }

  static constexpr int most_attempts = 50;  // a second and some more

  std::string path_;
  std::vector<SeenFile> seen_;
  std::unique_ptr<OpenFiles> files_;
  bool has_header_ = false;
  RecordingHeader header_;
  std::uint64_t frame_count_ = 0;
};

Recording::Recording(const std::filesystem::path& path)
    : implementation_(std::make_unique<Implementation>(path.string())) {}
Recording::~Recording() = default;
Recording::Recording(Recording&&) noexcept = default;
Recording& Recording::operator=(Recording&&) noexcept = default;

const RecordingHeader& Recording::header() const {
  return implementation_->header();
}
std::uint64_t Recording::frame_count() const {
  return implementation_->frame_count();
}
RecordedFrame Recording::frame(std::uint64_t number) const {
  implementation_->check_frame(number);
  return implementation_->read([&](OpenFiles& files) { return files.frame(number); });
}
RecordedFrame Recording::summary(std::uint64_t number) const {
  implementation_->check_frame(number);
  return implementation_->read([&](OpenFiles& files) { return files.summary(number); });
}
std::vector<Vec3d> Recording::positions(std::uint64_t frame, std::size_t object) const {
  implementation_->check_frame(frame);
  implementation_->check_object(object);
  return implementation_->read([&](OpenFiles& files) { return files.positions(frame, object); });
}

}  // namespace supple
