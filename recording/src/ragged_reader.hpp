#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hdf5/read.hpp"
#include "layout.hpp"
#include "reference_check.hpp"

namespace supple {

inline constexpr const char* damaged = "; the file is damaged, record again";

/// Stores the value of a column in a row.
inline void load(const Column& column, const std::byte* from, void* row) {
  std::byte* const field = static_cast<std::byte*>(row) + column.offset;
  std::memcpy(field, from, column.bytes());
  if (column.is_truth) *field = std::byte{*from != std::byte{}};
}

/// Whether recordings of all versions have the group.
inline bool is_in_every_version(const std::string& group) {
  static constexpr std::string_view groups[] = {
      "object_pairs",        "contacts",          "contact_points",       "continuous_contacts",
      "events/volume_begin", "events/volume_end", "events/contact_begin", "events/contact_end"};
  return std::find(std::begin(groups), std::end(groups), group) != std::end(groups);
}

/// The rows of one frame in a group with any number of rows per frame.
class RaggedReader {
 public:
  /// A group that the file lacks because an earlier program wrote it has no rows.
  RaggedReader(const InputFile& file, std::uint32_t version, const ListLayout& layout, std::uint64_t frames)
      : file_(&file), row_bytes_(layout.row_bytes) {
    if (!is_in_every_version(layout.group) && !file.has_item(layout.group)) return;
    end_.emplace(file, layout.group + "/end", ScalarType::uint64, std::vector<hsize_t>{});
    for (const Column& column : layout.columns) {
      std::vector<hsize_t> row_shape;
      if (column.width > 1) row_shape.push_back(column.width);
      const std::string path = layout.group + "/" + column_in_version(column.name, version);
      if (version < format_version && !file.has_item(path)) continue;
      columns_.push_back({&column, ColumnReader(file, path, column.type, std::move(row_shape))});
    }
    check_ends(frames);
  }

  std::size_t count(std::uint64_t frame) { return end_ ? end_of(frame) - begin_of(frame) : 0; }
  /// Reads the rows of a frame; objects have their index in the file.
  void read(std::uint64_t frame, std::byte* rows) {
    const std::size_t total = count(frame);
    for (auto& [column, reader] : columns_) {
      const std::size_t bytes = column->bytes();
      bytes_.resize(total * bytes);
      reader.read(begin_of(frame), total, bytes_.data());
      for (std::size_t i = 0; i < total; ++i) load(*column, bytes_.data() + i * bytes, rows + i * row_bytes_);
    }
  }

  /// Reports a bad value in a row of the frame.
  [[noreturn]] void fail(std::uint64_t frame, const BadReference& bad) const {
    for (const auto& [of, reader] : columns_) {
      if (!reader.path().ends_with("/" + bad.column)) continue;
      file_->fail(reader.path(), "row " + std::to_string(bad.row) + " of frame " + std::to_string(frame) +
                                     " is " + std::to_string(bad.value) + ", not below " +
                                     std::to_string(bad.allowed) + damaged);
    }
    file_->fail(end_->path(), "is damaged; record again");
  }

 private:
  std::uint64_t begin_of(std::uint64_t frame) { return frame == 0 ? 0 : end_of(frame - 1); }
  std::uint64_t end_of(std::uint64_t frame) {
    std::uint64_t end = 0;
    end_->read(frame, 1, reinterpret_cast<std::byte*>(&end));
    return end;
  }

  void check_ends(std::uint64_t frames) {
    std::uint64_t last = 0;
    for (std::uint64_t frame = 0; frame < frames; ++frame) {
      const std::uint64_t end = end_of(frame);
      if (end < last)
        file_->fail(end_->path(), "frame " + std::to_string(frame) + " ends at row " + std::to_string(end) +
                                      ", before the frame before it, which ends at " + std::to_string(last) +
                                      damaged);
      last = end;
    }
    for (const auto& [of, reader] : columns_) {
      if (reader.rows() < last)
        file_->fail(reader.path(), "has " + std::to_string(reader.rows()) + " rows, the frames name " +
                                       std::to_string(last) + damaged);
    }
  }

  const InputFile* file_;
  std::size_t row_bytes_;
  std::optional<ColumnReader> end_;  ///< empty: the file lacks the group
  struct ColumnInFile {
    const Column* of;
    ColumnReader reader;
  };
  std::vector<ColumnInFile> columns_;  ///< the columns that the file has
  std::vector<std::byte> bytes_;
};

}  // namespace supple
