#include "base/files.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "base/text.hpp"

namespace supple::cli {
namespace {

namespace fs = std::filesystem;

/// Whether both are one regular file, or will be one. Devices such as /dev/null can be shared.
bool are_one_file(const fs::path& a, const fs::path& b) {
  std::error_code fault;
  if (fs::exists(a, fault) && fs::exists(b, fault))
    return fs::is_regular_file(a, fault) && fs::equivalent(a, b, fault);
  const fs::path path_a = fs::weakly_canonical(fs::absolute(a, fault), fault);
  const fs::path path_b = fs::weakly_canonical(fs::absolute(b, fault), fault);
  return !path_a.empty() && path_a == path_b;
}

}  // namespace

std::ifstream open_input(const fs::path& path) {
  const std::string name = one_line(path.string());
  std::error_code fault;
  const fs::file_status kind = fs::status(path, fault);
  if (kind.type() == fs::file_type::not_found)
    fail("{}: there is no such file; check the folder and the spelling", name);
  // A pipe of the shell is in no folder. Other pipes can wait for a writer forever.
  const bool is_of_shell = fs::is_fifo(kind) && fs::canonical(path, fault).empty();
  if (fs::status_known(kind) && !fs::is_regular_file(kind) && !is_of_shell)
    fail("{}: is not a regular file but {}; give a file", name,
         fs::is_directory(kind) ? "a folder"
         : fs::is_fifo(kind)    ? "a named pipe"
                                : "a device");
  std::ifstream stream(path, std::ios::binary);
  if (!stream) fail("{}: cannot read: {}; check the path and who may read it", name, std::strerror(errno));
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
  if (stream.bad()) fail("{}: cannot be read to its end; check the disk", one_line(path.string()));
  return text;
}

OutputFile::OutputFile(const std::string& name, Mode mode) : name_(name == "-" ? "standard output" : name) {
  stream_ = name == "-" ? stdout : std::fopen(name.c_str(), mode == Mode::append ? "ab" : "wb");
  if (!stream_)
    fail("{}: cannot write: {}; choose a file in a folder that exists and is yours", name_,
         std::strerror(errno));
}

OutputFile::~OutputFile() {
  if (stream_ && stream_ != stdout) std::fclose(stream_);
}

void OutputFile::check() const {
  if (std::ferror(stream_)) fail("{}: writing failed; is the disk full?", name_);
}

void OutputFile::close() {
  const bool flushed = std::fflush(stream_) == 0;
  const bool written = !std::ferror(stream_) && flushed;
  const bool closed = stream_ == stdout || std::fclose(stream_) == 0;
  stream_ = nullptr;
  if (!written || !closed) fail("{}: writing failed; is the disk full?", name_);
}

void check_output_names(std::initializer_list<OutputName> outputs, std::span<const fs::path> inputs) {
  for (const OutputName& output : outputs) {
    if (output.name.empty() || output.name == "-") continue;
    if (std::any_of(inputs.begin(), inputs.end(),
                    [&](const fs::path& input) { return are_one_file(input, output.name); }))
      fail("{}: {} is an input; choose another file", output.option, output.name);
    for (const OutputName& other : outputs) {
      if (&other == &output) break;
      if (!other.name.empty() && other.name != "-" && are_one_file(other.name, output.name))
        fail("{}: {} already writes {}; choose another file", output.option, other.option, output.name);
    }
  }
}

}  // namespace supple::cli
