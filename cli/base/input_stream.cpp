#include "base/input_stream.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>

#include "base/text.hpp"
#include "supple/error.hpp"

namespace supple::cli {

namespace fs = std::filesystem;

std::ifstream open_input(const fs::path& path) {
  const std::string name = one_line(path.string());
  std::error_code fault;
  const fs::file_status kind = fs::status(path, fault);
  if (kind.type() == fs::file_type::not_found)
    throw Error(fmt::format("{}: there is no such file; check the folder and the spelling", name));
  // A pipe of the shell is in no folder. Other pipes can wait for a writer forever.
  const bool is_of_shell = fs::is_fifo(kind) && fs::canonical(path, fault).empty();
  if (fs::status_known(kind) && !fs::is_regular_file(kind) && !is_of_shell)
    throw Error(fmt::format("{}: is not a regular file but {}; give a file", name,
                            fs::is_directory(kind) ? "a folder"
                            : fs::is_fifo(kind)    ? "a named pipe"
                                                   : "a device"));
  std::ifstream stream(path, std::ios::binary);
  if (!stream)
    throw Error(
        fmt::format("{}: cannot read: {}; check the path and who may read it", name, std::strerror(errno)));
  return stream;
}

std::string read_text(const fs::path& path, std::size_t most) {
  std::ifstream stream = open_input(path);
  std::string text;
  std::array<char, 65536> part;
  while (stream && text.size() < most) {
    stream.read(part.data(), static_cast<std::streamsize>(std::min(part.size(), most - text.size())));
    text.append(part.data(), static_cast<std::size_t>(stream.gcount()));
  }
  if (stream.bad())
    throw Error(fmt::format("{}: cannot be read to its end; check the disk", one_line(path.string())));
  return text;
}

}  // namespace supple::cli
