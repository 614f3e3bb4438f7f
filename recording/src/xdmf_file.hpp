#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "supple/recording.hpp"

namespace supple {

/// The XDMF file of a recording: one grid per object and frame, which refers to the numbers in the HDF5 file.
/// It is complete XML after every system call, each of which overwrites the closing tags with new frames.
class XdmfFile {
 public:
  XdmfFile(const std::filesystem::path& path, const std::filesystem::path& recording,
           const RecordingHeader& header);
  ~XdmfFile();
  XdmfFile(const XdmfFile&) = delete;
  XdmfFile& operator=(const XdmfFile&) = delete;

  void add_frame(double time) { pending_.push_back(time); }
  /// Writes the frames since the last call. The first call replaces the file. Throws `Error` when it cannot
  /// be written.
  void write();

 private:
  struct Grid {
    std::string before_frame, before_frame_count, rest;  ///< the text of a grid, split where numbers go
    bool moves = true;
  };

  void append_text(std::uint64_t frame, double time);
  void write_text();

  std::filesystem::path path_;
  int descriptor_ = -1;
  std::vector<Grid> grids_;
  std::uint64_t frames_ = 0;     ///< in the file
  std::uint64_t end_ = 0;        ///< position of the closing tags
  std::vector<double> pending_;  ///< times of the frames that are not in the file yet
  std::string text_;             ///< scratch memory of `write`
};

}  // namespace supple
