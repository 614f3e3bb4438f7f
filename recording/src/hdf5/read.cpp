#include "hdf5/read.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <system_error>

#include "hdf5/write.hpp"
#include "supple/error.hpp"
#include "text.hpp"

namespace supple {
namespace {

constexpr std::size_t block_bytes = std::size_t{1} << 16;

/// Reads the text of an attribute or of a dataset with one string. `read` fills memory of the given type.
template <class Read>
std::string read_text(hid_t type, hid_t space, std::uint64_t file_size, Read read) {
  if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) != 0 ||
      H5Sget_simple_extent_npoints(space) != 1 || H5Tget_size(type) > file_size)
    throw Hdf5Failure();
  std::string result(H5Tget_size(type), '\0');
  check(read(type, result.data()));
  result.resize(std::min(result.find('\0'), result.size()));
  return result;
}

bool is_number(hid_t type) {
  const H5T_class_t kind = H5Tget_class(type);
  return kind == H5T_INTEGER || kind == H5T_FLOAT || kind == H5T_ENUM;
}

std::string shape_text(const std::vector<hsize_t>& row_shape) {
  std::string text = "(rows";
  for (const hsize_t size : row_shape) text += ", " + std::to_string(size);
  return text + ")";
}

FileHandle open_for_reading(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error))
    throw Error(path + ": there is no such file; check the folder and the spelling");
  if (std::filesystem::is_directory(path, error))
    throw Error(path + ": is a folder; give the recording's .h5 file");
  if (std::filesystem::exists(path, error) && !std::filesystem::is_regular_file(path, error))
    throw Error(path + ": is a pipe or a device; give the recording's .h5 file");
  if (const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
      !file)
    throw Error(path + ": cannot read: " + std::generic_category().message(errno) +
                "; check who may read it");
  const PropertyListHandle access(check(H5Pcreate(H5P_FILE_ACCESS)));
  check(H5Pset_fclose_degree(access.id(), H5F_CLOSE_STRONG));
  check(H5Pset_file_locking(access.id(), false, true));  // the file may still be recorded
  FileHandle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.id()));
  if (file) return file;
  if (H5Fis_hdf5(path.c_str()) > 0)
    throw Error(path + ": is damaged or cut short; copy it again in full, or record again");
  throw Error(path + ": is no recording (not an HDF5 file); make one with supple simulate --record");
}

struct OtherLinks {
  bool may_link = false;  ///< from objects to other files
  std::string name;       ///< of the first one that may not be
};

/// Stops at the first link that leads elsewhere, and copies its name.
herr_t find_other_link(hid_t, const char* name, const H5L_info_t* link, void* found) {
  auto& links = *static_cast<OtherLinks*>(found);
  if (link->type == H5L_TYPE_HARD) return 0;
  const std::filesystem::path path(name);
  if (links.may_link && link->type == H5L_TYPE_EXTERNAL && path.parent_path() == "objects") return 0;
  links.name = name;
  return 1;
}

bool is_compressed(const DatasetHandle& dataset) {
  const PropertyListHandle creation(check(H5Dget_create_plist(dataset.id())));
  return H5Pget_nfilters(creation.id()) != 0;
}

/// Whether all data of a dataset are in its own file, compressed by nothing but deflate.
bool is_stored_plainly(const DatasetHandle& dataset) {
  const PropertyListHandle creation(check(H5Dget_create_plist(dataset.id())));
  const H5D_layout_t layout = H5Pget_layout(creation.id());
  if (layout != H5D_COMPACT && layout != H5D_CONTIGUOUS && layout != H5D_CHUNKED) return false;
  if (H5Pget_external_count(creation.id()) != 0) return false;
  const int filters = H5Pget_nfilters(creation.id());
  for (int i = 0; i < filters; ++i) {
    unsigned flags = 0;
    std::size_t values = 0;
    if (H5Pget_filter2(creation.id(), static_cast<unsigned>(i), &flags, &values, nullptr, 0, nullptr,
                       nullptr) != H5Z_FILTER_DEFLATE)
      return false;
  }
  return true;
}

}  // namespace

InputFile::InputFile(const std::string& path, bool may_link) : path_(path), file_(open_for_reading(path)) {
  size_ = size_now();
  // A link could lead to any file of the user.
  OtherLinks other{may_link, {}};
  if (H5Lvisit(id(), H5_INDEX_NAME, H5_ITER_NATIVE, find_other_link, &other) != 0)
    fail(other.name, other.name.empty()
                         ? "the file is damaged, copy it again or record again"
                         : "is a soft or an external link, which recordings do not have here; record again");
}

std::uint64_t InputFile::size_now() const {
  void* descriptor = nullptr;
  check(H5Fget_vfd_handle(id(), H5P_DEFAULT, &descriptor));
  struct stat file {};
  return fstat(*static_cast<const int*>(descriptor), &file) == 0 ? static_cast<std::uint64_t>(file.st_size)
                                                                 : 0;
}

DatasetHandle InputFile::open_dataset(const std::string& path, hid_t access) const {
  DatasetHandle dataset(H5Dopen2(id(), path.c_str(), access));
  if (!dataset) fail(path, "is missing; the file is damaged or not a whole recording, record again");
  if (!is_stored_plainly(dataset))
    fail(path, "is not stored plainly in this file; only deflate and no external or virtual storage is read");
  return dataset;
}

void InputFile::fail(const std::string& item, const std::string& what) const {
  std::string message = path_ + ": /" + item + ": " + what;
  // Words of the file may contain any character, but a message is one line.
  std::ranges::replace_if(
      message, [](unsigned char c) { return c < 0x20 || c == 0x7f; }, '?');
  throw Error(message);
}

bool InputFile::has_attribute(const std::string& group, const char* name) const {
  return H5Aexists_by_name(id(), group.c_str(), name, H5P_DEFAULT) > 0;
}

bool InputFile::has_item(const std::string& path) const {
  return H5Lexists(id(), path.c_str(), H5P_DEFAULT) > 0;
}

bool InputFile::has_text(const std::string& group, const char* name) const {
  const AttributeHandle attribute(H5Aopen_by_name(id(), group.c_str(), name, H5P_DEFAULT, H5P_DEFAULT));
  if (!attribute) return false;
  const DatatypeHandle type(H5Aget_type(attribute.id()));
  return H5Tget_class(type.id()) == H5T_STRING;
}

std::size_t InputFile::count_links(const std::string& group) const {
  H5G_info_t info{};
  if (H5Gget_info_by_name(id(), group.c_str(), &info, H5P_DEFAULT) < 0)
    fail(group, "is missing; the file is damaged or not a whole recording, record again");
  return info.nlinks;
}

std::string InputFile::linked_file(const std::string& object) const {
  H5L_info_t link{};
  if (H5Lget_info(id(), object.c_str(), &link, H5P_DEFAULT) < 0 || link.type != H5L_TYPE_EXTERNAL) return "";
  std::vector<char> target(link.u.val_size);
  const char *file = nullptr, *item = nullptr;
  check(H5Lget_val(id(), object.c_str(), target.data(), target.size(), H5P_DEFAULT));
  check(H5Lunpack_elink_val(target.data(), target.size(), nullptr, &file, &item));
  const std::string name = file;
  if (item != "/" + object || name.empty() || name.find('/') != std::string::npos)
    fail(object, "is a link to another place than this object in a file of the same folder; record again");
  return name;
}

bool is_file_of_rank(const std::string& path) {
  try {
    const InputFile file(path);
    return file.has_text("/", "format") && file.text("/", "format") == format_name_of_rank;
  } catch (const Error&) {
    return false;
  }
}

AttributeHandle InputFile::open_attribute(const std::string& group, const char* name) const {
  AttributeHandle attribute(H5Aopen_by_name(id(), group.c_str(), name, H5P_DEFAULT, H5P_DEFAULT));
  if (!attribute)
    fail(group == "/" ? "" : group,
         std::string("attribute ") + name +
             " is missing; the file is damaged or not a whole recording, record again");
  return attribute;
}

double InputFile::number(const std::string& group, const char* name) const {
  double value = 0;
  numbers(group, name, {&value, 1});
  return value;
}

void InputFile::numbers(const std::string& group, const char* name, std::span<double> values) const {
  const AttributeHandle attribute = open_attribute(group, name);
  const DatatypeHandle type(H5Aget_type(attribute.id()));
  const DataspaceHandle space(H5Aget_space(attribute.id()));
  const auto count = static_cast<hssize_t>(values.size());
  if (!is_number(type.id()) || H5Sget_simple_extent_npoints(space.id()) != count ||
      H5Aread(attribute.id(), H5T_NATIVE_DOUBLE, values.data()) < 0)
    fail(group == "/" ? "" : group,
         std::string("attribute ") + name + " is no " +
             (count == 1 ? "single number" : "list of " + std::to_string(count) + " numbers") +
             "; record again");
}

std::uint32_t InputFile::count(const std::string& group, const char* name, std::uint32_t largest) const {
  const double value = number(group, name);
  if (!(value >= 0 && value <= largest) || value != std::floor(value))
    fail(group == "/" ? "" : group, std::string("attribute ") + name + " is " + to_text(value) +
                                        ", not a whole number from 0 to " + std::to_string(largest) +
                                        "; record again");
  return static_cast<std::uint32_t>(value);
}

std::string InputFile::text(const std::string& group, const char* name) const {
  const AttributeHandle attribute = open_attribute(group, name);
  const DatatypeHandle type(H5Aget_type(attribute.id()));
  const DataspaceHandle space(H5Aget_space(attribute.id()));
  try {
    return read_text(type.id(), space.id(), size_,
                     [&](hid_t memory, void* to) { return H5Aread(attribute.id(), memory, to); });
  } catch (const Hdf5Failure&) {
    fail(group == "/" ? "" : group, std::string("attribute ") + name + " is no text; record again");
  }
}

std::string InputFile::text_dataset(const std::string& path) const {
  const DatasetHandle dataset = open_dataset(path);
  const DatatypeHandle type(H5Dget_type(dataset.id()));
  const DataspaceHandle space(H5Dget_space(dataset.id()));
  try {
    return read_text(type.id(), space.id(), size_, [&](hid_t memory, void* to) {
      return H5Dread(dataset.id(), memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, to);
    });
  } catch (const Hdf5Failure&) {
    fail(path, "is no text; record again");
  }
}

ColumnReader::ColumnReader(const InputFile& file, std::string path, ScalarType type,
                           std::vector<hsize_t> row_shape)
    : file_(&file),
      path_(std::move(path)),
      type_(type),
      row_shape_(std::move(row_shape)),
      row_bytes_(size_of(type)) {
  const PropertyListHandle access(check(H5Pcreate(H5P_DATASET_ACCESS)));
  check(H5Pset_chunk_cache(access.id(), 5, 4 * block_bytes, 1.0));
  dataset_ = file.open_dataset(path_, access.id());
  const DatatypeHandle stored(H5Dget_type(dataset_.id()));
  const DataspaceHandle space(H5Dget_space(dataset_.id()));
  const int rank = H5Sget_simple_extent_ndims(space.id());
  std::vector<hsize_t> size(rank > 0 ? static_cast<std::size_t>(rank) : 1);
  if (rank > 0) H5Sget_simple_extent_dims(space.id(), size.data(), nullptr);
  if (!is_number(stored.id()) || rank != static_cast<int>(row_shape_.size()) + 1 ||
      !std::equal(row_shape_.begin(), row_shape_.end(), size.begin() + 1))
    file.fail(path_, "does not hold numbers of the shape " + shape_text(row_shape_) + "; record again");
  rows_ = size[0];
  for (const hsize_t n : row_shape_) row_bytes_ *= n;
  // HDF5 reads missing data as zeros, and a damaged row count could request any amount of memory.
  const std::uint64_t stored_row_bytes = row_bytes_ / size_of(type_) * H5Tget_size(stored.id());
  constexpr std::uint64_t best_deflate = 1032;
  const std::uint64_t storage = H5Dget_storage_size(dataset_.id());
  const std::uint64_t most_bytes = is_compressed(dataset_) ? best_deflate * storage : storage;
  if (storage > file.size() || (stored_row_bytes > 0 && rows_ > most_bytes / stored_row_bytes))
    file.fail(path_, "has " + std::to_string(rows_) +
                         " rows, which are not all in the file; it is damaged or cut short, copy it again or "
                         "record again");
}

void ColumnReader::read(std::uint64_t first, std::size_t count, std::byte* to) {
  if (first > rows_ || count > rows_ - first) file_->fail(path_, "has too few rows; record again");
  if (count == 0 || row_bytes_ == 0) return;
  const std::uint64_t block_rows = std::max<std::uint64_t>(block_bytes / row_bytes_, 1);
  if (count >= block_rows) {
    read_from_file(first, count, to);
    return;
  }
  if (first < block_first_ || first + count > block_first_ + block_count_) {
    block_first_ = first;
    block_count_ = 0;  // invalid until the block is read
    const std::uint64_t rows = std::min(block_rows, rows_ - first);
    block_.resize(rows * row_bytes_);
    read_from_file(first, rows, block_.data());
    block_count_ = rows;
  }
  std::copy_n(block_.data() + (first - block_first_) * row_bytes_, count * row_bytes_, to);
}

void ColumnReader::read_from_file(std::uint64_t first, std::size_t count, std::byte* to) const {
  std::vector<hsize_t> start(row_shape_.size() + 1), size(row_shape_.size() + 1);
  start[0] = first;
  size[0] = count;
  std::copy(row_shape_.begin(), row_shape_.end(), size.begin() + 1);
  const DataspaceHandle in_file(H5Dget_space(dataset_.id()));
  const DataspaceHandle in_memory(H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr));
  if (H5Sselect_hyperslab(in_file.id(), H5S_SELECT_SET, start.data(), nullptr, size.data(), nullptr) < 0 ||
      H5Dread(dataset_.id(), native_type(type_), in_memory.id(), in_file.id(), H5P_DEFAULT, to) < 0)
    file_->fail(path_, "cannot be read from row " + std::to_string(first) +
                           "; the file is damaged or cut short, copy it again or record again");
  // HDF5 reads zeros behind the end of a file.
  if (file_->size_now() < file_->size())
    file_->fail(path_, "was overwritten while it was read; open it again");
}

}  // namespace supple
