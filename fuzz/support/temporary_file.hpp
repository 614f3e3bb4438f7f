#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>

namespace supple::fuzz {

/// A file for readers that take a path, in memory where the system has such a folder. Removed at the end.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& extension) {
    const std::filesystem::path memory = "/dev/shm";
    const auto folder = is_directory(memory) ? memory : std::filesystem::temp_directory_path();
    path_ = folder / ("supple_fuzz_" + std::to_string(getpid()) + extension);
  }
  ~TemporaryFile() {
    std::error_code ignored;
    remove(path_, ignored);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  void write(std::string_view bytes) const {
    std::ofstream(path_, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  }

 private:
  std::filesystem::path path_;
};

}  // namespace supple::fuzz
