#pragma once

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <span>
#include <string>

namespace supple::cli {

/// Opens a file of text, or a pipe of the shell such as <(command). Throws `Error` for folders, devices and
/// named pipes, which may never end, and when the file cannot be opened.
std::ifstream open_input(const std::filesystem::path& path);

/// Reads such a file, at most `most` bytes.
std::string read_text(const std::filesystem::path& path, std::size_t most = ~std::size_t{0});

/// A file that is written from start to end; `-` is standard output. Throws `Error` when it cannot be opened.
class OutputFile {
 public:
  enum class Mode { replace, append };
  explicit OutputFile(const std::string& name, Mode mode = Mode::replace);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  std::FILE* stream() const { return stream_; }
  /// Throws when data written so far was lost, for example because the disk is full.
  void check() const;
  /// Flushes and closes the file. Throws when that fails.
  void close();

 private:
  std::string name_;
  std::FILE* stream_ = nullptr;
};

/// A file that an option names for output; an empty name is no file, and `-` is standard output.
struct OutputName {
  const char* option;
  std::string name;
};

/// Throws `Error` when an output is one of the inputs, or the output of two options.
void check_output_names(std::initializer_list<OutputName> outputs,
                        std::span<const std::filesystem::path> inputs);

}  // namespace supple::cli
