#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <span>
#include <string>
#include <vector>

#include "hdf5_handles.hpp"
#include "layout.hpp"

namespace supple {

/// A call of HDF5 that failed; who catches it knows the file and says what to do.
struct Hdf5Failure : std::exception {
  const char* what() const noexcept override { return "HDF5 failed"; }
};

template <class Status>
Status check(Status status) {
  if (status < 0) throw Hdf5Failure();
  return status;
}

hid_t native_type(ScalarType type);

void create_group(hid_t file, const std::string& path);
void write_attribute(hid_t file, const std::string& group, const char* name, double value);
void write_attribute(hid_t file, const std::string& group, const char* name, std::uint32_t value);
void write_attribute(hid_t file, const std::string& group, const char* name, bool value);  // 0 or 1, uint8
void write_attribute(hid_t file, const std::string& group, const char* name, const std::string& value);
void write_text(hid_t file, const std::string& path, const std::string& text);
/// A dataset of fixed size; `width` 0 makes it of rank 1.
void write_rows(hid_t file, const std::string& path, ScalarType type, std::size_t rows, std::size_t width,
                const void* values);

/// A dataset to which rows are appended: kept in memory until `write_pending`.
class ColumnWriter {
 public:
  ColumnWriter(hid_t file, const std::string& path, ScalarType type, std::size_t width,
               std::size_t rows_in_chunk);

  /// Room for more rows, to be filled at once.
  std::byte* append(std::size_t rows);
  void append_value(const void* value) { std::memcpy(append(1), value, row_bytes_); }
  std::size_t pending_bytes() const { return pending_.size(); }
  void write_pending();

 private:
  DatasetHandle dataset_;
  ScalarType type_;
  std::size_t width_;
  std::size_t row_bytes_;
  hsize_t rows_ = 0;  ///< in the dataset
  std::vector<std::byte> pending_;
};

/// Where the vertices of an object are, a chunk a frame, written as they come.
class PositionsWriter {
 public:
  PositionsWriter(hid_t file, const std::string& path, std::size_t vertices);
  void append(std::span<const Vec3d> positions);

 private:
  DatasetHandle dataset_;
  hsize_t vertices_;
  hsize_t frames_ = 0;
};

}  // namespace supple
