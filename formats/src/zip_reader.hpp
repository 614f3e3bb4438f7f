#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>

struct zip;

namespace supple {

/// Reads the files inside a zip archive in memory. Keeps a view of its bytes.
class ZipReader {
 public:
  /// Fails with the name of the archive when it is no zip archive.
  ZipReader(std::string_view bytes, const std::string& archive);

  bool contains(const std::string& name) const { return indices_.contains(lower_case(name)); }
  /// The first file, by name in lower case, whose name ends like this. Fails when there is none.
  std::string name_ending_with(const std::string& ending) const;
  /// The content of the file; the case of its name does not matter. Fails when it does not exist or is
  /// damaged, and when the files read so far expand to more than 16 MiB and 200 times the size of the
  /// archive.
  std::string read(const std::string& name);

 private:
  struct Close {
    void operator()(zip* archive) const;
  };

  static std::string lower_case(std::string name);

  std::string archive_name_;
  std::uint64_t most_bytes_;
  std::unique_ptr<zip, Close> archive_;
  std::map<std::string, std::uint64_t, std::less<>> indices_;
};

}  // namespace supple
