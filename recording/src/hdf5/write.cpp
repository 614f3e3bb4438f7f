#include "hdf5/write.hpp"

#include <algorithm>
#include <array>

namespace supple {
namespace {

/// Omits the creation time, so that equal recordings are equal files.
PropertyListHandle timeless(hid_t kind) {
  PropertyListHandle properties(check(H5Pcreate(kind)));
  check(H5Pset_obj_track_times(properties.id(), false));
  return properties;
}

PropertyListHandle chunked(std::span<const hsize_t> chunk) {
  PropertyListHandle properties = timeless(H5P_DATASET_CREATE);
  check(H5Pset_chunk(properties.id(), static_cast<int>(chunk.size()), chunk.data()));
  return properties;
}

DataspaceHandle space_of(std::span<const hsize_t> size, const hsize_t* largest = nullptr) {
  return DataspaceHandle(check(H5Screate_simple(static_cast<int>(size.size()), size.data(), largest)));
}

/// Caches exactly one chunk, the one that is being filled.
PropertyListHandle one_chunk_in_memory(std::size_t bytes) {
  PropertyListHandle properties(check(H5Pcreate(H5P_DATASET_ACCESS)));
  check(H5Pset_chunk_cache(properties.id(), 5, bytes, 1.0));
  return properties;
}

/// Text of fixed size. HDF5 does not validate its heap for variable-size text and may crash on a damaged
/// file.
DatatypeHandle text_type(const std::string& text) {
  DatatypeHandle type(check(H5Tcopy(H5T_C_S1)));
  check(H5Tset_size(type.id(), std::max<std::size_t>(text.size(), 1)));
  check(H5Tset_strpad(type.id(), H5T_STR_NULLPAD));
  check(H5Tset_cset(type.id(), H5T_CSET_UTF8));
  return type;
}

void write_attribute(hid_t file, const std::string& group, const char* name, hid_t type, const void* value) {
  const DataspaceHandle scalar(check(H5Screate(H5S_SCALAR)));
  const AttributeHandle attribute(check(H5Acreate_by_name(file, group.c_str(), name, type, scalar.id(),
                                                          H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT)));
  check(H5Awrite(attribute.id(), type, value));
}

}  // namespace

hid_t native_type(ScalarType type) {
  switch (type) {
    case ScalarType::boolean:
    case ScalarType::uint8:
      return H5T_NATIVE_UINT8;
    case ScalarType::uint32:
      return H5T_NATIVE_UINT32;
    case ScalarType::uint64:
      return H5T_NATIVE_UINT64;
    case ScalarType::float64:
      break;
  }
  return H5T_NATIVE_DOUBLE;
}

void create_group(hid_t file, const std::string& path) {
  const PropertyListHandle properties = timeless(H5P_GROUP_CREATE);
  const GroupHandle group(check(H5Gcreate2(file, path.c_str(), H5P_DEFAULT, properties.id(), H5P_DEFAULT)));
}

void create_external_link(hid_t file, const std::string& path, const std::string& other_file) {
  check(H5Lcreate_external(other_file.c_str(), ("/" + path).c_str(), file, path.c_str(), H5P_DEFAULT,
                           H5P_DEFAULT));
}

void write_attribute(hid_t file, const std::string& group, const char* name, double value) {
  write_attribute(file, group, name, H5T_NATIVE_DOUBLE, &value);
}

void write_attribute(hid_t file, const std::string& group, const char* name, std::span<const double> values) {
  const hsize_t count = values.size();
  const DataspaceHandle space(check(H5Screate_simple(1, &count, nullptr)));
  const AttributeHandle attribute(check(H5Acreate_by_name(
      file, group.c_str(), name, H5T_NATIVE_DOUBLE, space.id(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT)));
  check(H5Awrite(attribute.id(), H5T_NATIVE_DOUBLE, values.data()));
}

void write_attribute(hid_t file, const std::string& group, const char* name, std::uint32_t value) {
  write_attribute(file, group, name, H5T_NATIVE_UINT32, &value);
}

void write_attribute(hid_t file, const std::string& group, const char* name, bool value) {
  const std::uint8_t byte = value ? 1 : 0;
  write_attribute(file, group, name, H5T_NATIVE_UINT8, &byte);
}

void write_attribute(hid_t file, const std::string& group, const char* name, const std::string& value) {
  write_attribute(file, group, name, text_type(value).id(), static_cast<const void*>(value.c_str()));
}

void write_text(hid_t file, const std::string& path, const std::string& text) {
  const DataspaceHandle scalar(check(H5Screate(H5S_SCALAR)));
  const DatatypeHandle type = text_type(text);
  const PropertyListHandle properties = timeless(H5P_DATASET_CREATE);
  const DatasetHandle dataset(check(
      H5Dcreate2(file, path.c_str(), type.id(), scalar.id(), H5P_DEFAULT, properties.id(), H5P_DEFAULT)));
  check(H5Dwrite(dataset.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, text.c_str()));
}

void write_rows(hid_t file, const std::string& path, ScalarType type, std::size_t rows, std::size_t width,
                const void* values) {
  const std::array<hsize_t, 2> size{rows, width};
  const DataspaceHandle space = space_of(std::span(size).first(width == 0 ? 1 : 2));
  const PropertyListHandle properties = timeless(H5P_DATASET_CREATE);
  const DatasetHandle dataset(check(H5Dcreate2(file, path.c_str(), native_type(type), space.id(), H5P_DEFAULT,
                                               properties.id(), H5P_DEFAULT)));
  if (rows > 0) check(H5Dwrite(dataset.id(), native_type(type), H5S_ALL, H5S_ALL, H5P_DEFAULT, values));
}

ColumnWriter::ColumnWriter(hid_t file, const std::string& path, ScalarType type, std::size_t width,
                           std::size_t rows_in_chunk)
    : type_(type), width_(width), row_bytes_(size_of(type) * width) {
  const std::size_t rank = width == 1 ? 1 : 2;
  const std::array<hsize_t, 2> size{0, width}, largest{H5S_UNLIMITED, width}, chunk{rows_in_chunk, width};
  const DataspaceHandle space = space_of(std::span(size).first(rank), largest.data());
  const PropertyListHandle properties = chunked(std::span(chunk).first(rank));
  const PropertyListHandle access = one_chunk_in_memory(rows_in_chunk * row_bytes_);
  dataset_ = DatasetHandle(check(H5Dcreate2(file, path.c_str(), native_type(type), space.id(), H5P_DEFAULT,
                                            properties.id(), access.id())));
}

std::byte* ColumnWriter::append(std::size_t rows) {
  const std::size_t used = pending_.size();
  pending_.resize(used + rows * row_bytes_);
  return pending_.data() + used;
}

void ColumnWriter::write_pending() {
  if (pending_.empty()) return;
  const std::size_t rank = width_ == 1 ? 1 : 2;
  const std::array<hsize_t, 2> first{rows_, 0}, count{pending_.size() / row_bytes_, width_};
  const std::array<hsize_t, 2> size{rows_ + count[0], width_};
  check(H5Dset_extent(dataset_.id(), size.data()));
  const DataspaceHandle in_file(check(H5Dget_space(dataset_.id())));
  check(H5Sselect_hyperslab(in_file.id(), H5S_SELECT_SET, first.data(), nullptr, count.data(), nullptr));
  const DataspaceHandle in_memory = space_of(std::span(count).first(rank));
  check(H5Dwrite(dataset_.id(), native_type(type_), in_memory.id(), in_file.id(), H5P_DEFAULT,
                 pending_.data()));
  rows_ = size[0];
  pending_.clear();
}

PositionsWriter::PositionsWriter(hid_t file, const std::string& path, std::size_t vertices)
    : vertices_(vertices) {
  const std::array<hsize_t, 3> size{0, vertices_, 3}, largest{H5S_UNLIMITED, vertices_, 3};
  const std::array<hsize_t, 3> chunk{1, std::max<hsize_t>(vertices_, 1), 3};
  const DataspaceHandle space = space_of(size, largest.data());
  const PropertyListHandle properties = chunked(chunk);
  const PropertyListHandle access = one_chunk_in_memory(0);
  dataset_ = DatasetHandle(check(H5Dcreate2(file, path.c_str(), H5T_NATIVE_DOUBLE, space.id(), H5P_DEFAULT,
                                            properties.id(), access.id())));
}

void PositionsWriter::append(std::span<const Vec3d> positions) {
  const std::array<hsize_t, 3> size{frames_ + 1, vertices_, 3}, first{frames_, 0, 0};
  check(H5Dset_extent(dataset_.id(), size.data()));
  if (!positions.empty())
    check(H5Dwrite_chunk(dataset_.id(), H5P_DEFAULT, 0, first.data(), positions.size_bytes(),
                         positions.data()));
  ++frames_;
}

}  // namespace supple
