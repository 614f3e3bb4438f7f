#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "hdf5/handles.hpp"
#include "layout.hpp"

namespace supple {

/// An open file, with its name for messages. All members throw `Error` when an item is missing, has another
/// type or shape, or cannot be read.
class InputFile {
 public:
  /// Throws an `Error` with the reason when HDF5 cannot open the file. Links to other files are errors,
  /// except from objects when `may_link`.
  explicit InputFile(const std::string& path, bool may_link = false);

  hid_t id() const { return file_.id(); }
  const std::string& path() const { return path_; }
  /// When it was opened.
  std::uint64_t size() const { return size_; }
  /// Also when another file has its name now.
  std::uint64_t size_now() const;

  bool has_attribute(const std::string& group, const char* name) const;
  bool has_item(const std::string& path) const;
  bool has_text(const std::string& group, const char* name) const;
  std::size_t count_links(const std::string& group) const;
  /// The file of the same folder that has this object; empty when this file has it.
  std::string linked_file(const std::string& object) const;
  double number(const std::string& group, const char* name) const;
  /// Fills `values`.
  void numbers(const std::string& group, const char* name, std::span<double> values) const;
  /// Reads a whole number from 0 to `largest`.
  std::uint32_t count(const std::string& group, const char* name,
                      std::uint32_t largest = ~std::uint32_t{0}) const;
  std::string text(const std::string& group, const char* name) const;
  std::string text_dataset(const std::string& path) const;

  /// The data must be in this file itself, without filters other than deflate.
  DatasetHandle open_dataset(const std::string& path, hid_t access = H5P_DEFAULT) const;

  [[noreturn]] void fail(const std::string& item, const std::string& what) const;

 private:
  AttributeHandle open_attribute(const std::string& group, const char* name) const;

  std::string path_;
  FileHandle file_;
  std::uint64_t size_ = 0;
};

/// Whether this is the file of a rank of a recording of several ranks.
bool is_file_of_rank(const std::string& path);

/// Reads rows of a numeric dataset.
class ColumnReader {
 public:
  /// `row_shape` is the shape of one row: {} for a number, {3} for a point, {n, 3} for n points. `file` must
  /// outlive this object.
  ColumnReader(const InputFile& file, std::string path, ScalarType type, std::vector<hsize_t> row_shape);

  std::uint64_t rows() const { return rows_; }
  const std::string& path() const { return path_; }
  [[noreturn]] void fail(const std::string& what) const { file_->fail(path_, what); }
  /// Copies rows, which must exist. Small reads come from a cached block, so reading consecutive frames is
  /// fast.
  void read(std::uint64_t first, std::size_t count, std::byte* to);

 private:
  void read_from_file(std::uint64_t first, std::size_t count, std::byte* to) const;

  const InputFile* file_;
  std::string path_;
  ScalarType type_;
  std::vector<hsize_t> row_shape_;
  std::size_t row_bytes_;
  DatasetHandle dataset_;
  std::uint64_t rows_ = 0;
  std::vector<std::byte> block_;
  std::uint64_t block_first_ = 0, block_count_ = 0;
};

}  // namespace supple
