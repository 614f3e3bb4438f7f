#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "base/progress.hpp"
#include "session/scene_view.hpp"
#include "supple/recording.hpp"

namespace supple::cli {

/// The frames of a recording. All objects move except static ones.
class RecordedFrames : public viewer::Frames {
 public:
  /// Reads times, statistics and events of all frames. With `is_growing`, `refresh` looks for more of them in
  /// the file; nobody else may then keep the recording.
  RecordedFrames(std::string path, std::shared_ptr<const Recording> recording, bool is_growing);

  /// Frames that were added are counted when their series has been read.
  std::uint64_t count() const override { return count_; }
  void read(std::uint64_t frame, std::size_t object, std::span<Vec3d> positions) const override;
  const viewer::Series& series() const override { return series_; }
  bool is_growing() const override { return is_growing_; }
  bool refresh() override;

 private:
  using FileState = std::pair<std::filesystem::file_time_type, std::uintmax_t>;  // last change, size

  /// Id, name, vertices and triangles.
  using Object = std::tuple<ObjectId, std::string, std::size_t, std::size_t>;

  FileState state_of_file() const;
  static std::vector<Object> objects_of(const Recording& recording);
  const Recording& recording() const;
  void read_series(Progress* progress);

  std::string path_;
  /// Null when it could not be opened again. HDF5 reads a file again only when nobody has it open.
  mutable std::shared_ptr<const Recording> recording_;
  std::vector<Object> objects_;
  std::map<ObjectId, std::uint32_t> places_;
  std::uint64_t count_ = 0;
  viewer::Series series_;
  bool is_growing_;
  FileState file_;
};

/// Two recordings, frame by frame: the objects of the first, then those of the second. The one that ends
/// first stays at its last frame. The series has the columns of the first, then those of the second with
/// names that end with `_b`.
class ComparedFrames : public viewer::Frames {
 public:
  ComparedFrames(std::shared_ptr<const viewer::Frames> a, std::shared_ptr<const viewer::Frames> b,
                 std::size_t objects_of_a);

  std::uint64_t count() const override { return count_; }
  void read(std::uint64_t frame, std::size_t object, std::span<Vec3d> positions) const override;
  const viewer::Series& series() const override { return series_; }

 private:
  std::shared_ptr<const viewer::Frames> a_, b_;
  std::size_t objects_of_a_;
  std::uint64_t count_;
  viewer::Series series_;
};

}  // namespace supple::cli
