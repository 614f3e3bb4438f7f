#pragma once

#include <cstdio>
#include <string>

namespace supple::cli {

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

}  // namespace supple::cli
