#pragma once

#include <cstdio>
#include <string>

namespace supple::cli {

/// A file that is written from start to end; `-` is standard output. Throws `Error` when it cannot be.
class OutputFile {
 public:
  explicit OutputFile(const std::string& name);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  std::FILE* stream() const { return stream_; }
  /// Throws when anything written so far was lost, e.g. because the disk is full.
  void check() const;
  /// Everything is on its way to the disk afterwards.
  void close();

 private:
  std::string name_;
  std::FILE* stream_ = nullptr;
};

}  // namespace supple::cli
