#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace supple {

/// A value of a glTF file with its place, such as `accessors[3].count`. Every function fails with the file
/// and the place when the value is of another kind than the caller expects.
class GltfValue {
 public:
  /// `value` is null when the file does not have the value. `file` must outlive this object.
  GltfValue(const nlohmann::json* value, const std::string& file, std::string place)
      : value_(value), file_(&file), place_(std::move(place)) {}

  explicit operator bool() const { return value_ != nullptr; }
  /// The member of an object; absent when the object is absent or has no such member.
  GltfValue operator[](const char* key) const;
  /// The element of an array; fails when it is out of range.
  GltfValue at(std::uint64_t index) const;
  /// The number of elements of an array; 0 when it is absent.
  std::uint64_t size() const;
  /// The names of the members of an object.
  std::vector<std::string> keys() const;

  std::uint64_t whole() const;
  std::uint64_t whole_or(std::uint64_t absent) const { return value_ ? whole() : absent; }
  /// A whole number below `limit`, the number of `what`.
  std::uint32_t index(std::uint64_t limit, const char* what) const;
  double number() const;
  bool boolean_or(bool absent) const;
  std::string text() const;
  std::string text_or(std::string absent) const { return value_ ? text() : std::move(absent); }
  /// An array of so many numbers.
  std::vector<double> numbers(std::uint64_t count) const;

  [[noreturn]] void fail_here(const std::string& message) const;

 private:
  const nlohmann::json& required(const char* kind) const;

  const nlohmann::json* value_;
  const std::string* file_;
  std::string place_;
};

/// A glTF or GLB file of version 2: its JSON and the bytes of its buffers.
class GltfFile {
 public:
  /// Fails when the file, or a buffer that it names, cannot be read, or when the file requires an extension
  /// that this reader does not know.
  explicit GltfFile(const std::filesystem::path& path);

  const std::string& name() const { return name_; }
  GltfValue root() const { return {document_.get(), name_, ""}; }
  /// The bytes of a buffer view, decompressed.
  std::string_view view(std::uint64_t index);
  /// The bytes of all buffers together, which bound what a file can hold.
  std::uint64_t bytes() const { return bytes_; }

 private:
  void check_version() const;
  void check_extensions() const;
  std::string_view buffer(std::uint64_t index);
  std::string read_uri(const GltfValue& uri) const;
  std::string decompressed(const GltfValue& view, const GltfValue& extension);
  std::string_view bytes_in(const GltfValue& place);

  std::filesystem::path path_;
  std::string name_;
  std::string binary_;  ///< of a GLB file
  std::shared_ptr<const nlohmann::json> document_;
  std::vector<std::optional<std::string>> buffers_, views_;
  std::uint64_t bytes_ = 0;
};

/// Numbers of the file: `count` elements of `width` numbers each.
struct GltfNumbers {
  std::uint64_t count = 0;
  std::size_t width = 1;
  std::vector<double> values;
};

/// Reads an accessor: integers as they are or, when normalized, as fractions. `type` is SCALAR, VEC3, ...
GltfNumbers read_accessor(GltfFile& file, const GltfValue& index, std::string_view type);

}  // namespace supple
