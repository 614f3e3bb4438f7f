#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <exception>
#include <span>
#include <string>
#include <vector>

#include "hdf5/handles.hpp"
#include "layout.hpp"

namespace supple {

/// A failed HDF5 call. The code that catches it knows the file and writes the message.
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
/// A link to the item of the same path in another file of the same folder.
void create_external_link(hid_t file, const std::string& path, const std::string& other_file);
void write_attribute(hid_t file, const std::string& group, const char* name, double value);
void write_attribute(hid_t file, const std::string& group, const char* name, std::span<const double> values);
void write_attribute(hid_t file, const std::string& group, const char* name, std::uint32_t value);
void write_attribute(hid_t file, const std::string& group, const char* name, bool value);  // 0 or 1, uint8
void write_attribute(hid_t file, const std::string& group, const char* name, const std::string& value);
void write_text(hid_t file, const std::string& path, const std::string& text);
/// Writes a dataset of fixed size; with `width` 0 it has rank 1.
void write_rows(hid_t file, const std::string& path, ScalarType type, std::size_t rows, std::size_t width,
                const void* values);

/// A dataset with appended rows, which stay in memory until `write_pending`.
class ColumnWriter {
 public:
  ColumnWriter(hid_t file, const std::string& path, ScalarType type, std::size_t width,
               std::size_t rows_in_chunk);

  /// Returns memory for more rows, which the caller must fill immediately.
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

/// The vertex positions of an object, one chunk per frame, written immediately.
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
