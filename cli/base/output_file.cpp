#include "base/output_file.hpp"

#include <fmt/core.h>

#include <cerrno>
#include <cstring>

#include "supple/error.hpp"

namespace supple::cli {

OutputFile::OutputFile(const std::string& name, Mode mode) : name_(name == "-" ? "standard output" : name) {
  stream_ = name == "-" ? stdout : std::fopen(name.c_str(), mode == Mode::append ? "ab" : "wb");
  if (!stream_)
    throw Error(fmt::format("{}: cannot write: {}; choose a file in a folder that exists and is yours", name_,
                            std::strerror(errno)));
}

OutputFile::~OutputFile() {
  if (stream_ && stream_ != stdout) std::fclose(stream_);
}

void OutputFile::check() const {
  if (std::ferror(stream_)) throw Error(fmt::format("{}: writing failed; is the disk full?", name_));
}

void OutputFile::close() {
  const bool flushed = std::fflush(stream_) == 0;
  const bool written = !std::ferror(stream_) && flushed;
  const bool closed = stream_ == stdout || std::fclose(stream_) == 0;
  stream_ = nullptr;
  if (!written || !closed) throw Error(fmt::format("{}: writing failed; is the disk full?", name_));
}

}  // namespace supple::cli
