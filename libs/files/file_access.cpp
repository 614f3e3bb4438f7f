#include "files/file_access.hpp"

#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>

#include "core/error.hpp"
#include "core/quotes.hpp"
#include "files/text_scanner.hpp"

namespace supple {
namespace {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

std::string reason() {
  return std::generic_category().message(errno);
}

File open_for_reading(const std::filesystem::path& path) {
  std::error_code ignored;
  const std::filesystem::file_status kind = std::filesystem::status(path, ignored);
  if (is_directory(kind)) fail("cannot open " + shown(path) + ": it is a directory");
  // A pipe can wait for a writer forever, and a device can be endless.
  if (is_other(kind))
    fail("cannot open " + shown(path) + ": it is not a regular file but a pipe or a device; give a file");
  File file(std::fopen(path.string().c_str(), "rb"));
  if (!file) fail("cannot open " + shown(path) + ": " + reason());
  return file;
}

}  // namespace

std::string shown(const std::filesystem::path& path) {
  return one_line(path.string(), '?');
}

std::string lower_case_extension(const std::filesystem::path& path) {
  return lower_case(path.extension().string());
}

void check_readable(const std::filesystem::path& path) {
  open_for_reading(path);
}

std::string read_file(const std::filesystem::path& path) {
  const File file = open_for_reading(path);
  std::error_code unknown_size;
  const auto expected_size = std::filesystem::file_size(path, unknown_size);
  // One byte more than expected, so that the end of the file shows without growing the buffer.
  std::string bytes(unknown_size ? 65536 : static_cast<std::size_t>(expected_size) + 1, 0);
  for (std::size_t size = 0;; bytes.resize(2 * size)) {
    size += std::fread(bytes.data() + size, 1, bytes.size() - size, file.get());
    if (size == bytes.size()) continue;
    if (std::ferror(file.get())) fail("cannot read " + shown(path) + ": " + reason());
    bytes.resize(size);
    return bytes;
  }
}

void write_file(const std::filesystem::path& path, const std::string& bytes) {
  File file(std::fopen(path.string().c_str(), "wb"));
  if (!file) fail("cannot write " + shown(path) + ": " + reason());
  const bool written = std::fwrite(bytes.data(), 1, bytes.size(), file.get()) == bytes.size();
  // Closing may be the first call that notices a full disk.
  if (!written || std::fclose(file.release()) != 0) fail("cannot write " + shown(path) + ": " + reason());
}

}  // namespace supple
