#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "supple/recording.hpp"

namespace supple {

/// The XDMF file of a recording: one grid per object and frame, which refers to the numbers in the HDF5 file.
/// It is complete XML after every `write`: one system call overwrites the closing tags with the new frames.
class XdmfFile {
 public:
  /// Replaces the file. Throws `Error` when it cannot be written.
  XdmfFile(const std::filesystem::path& path, const std::filesystem::path& recording,
           const RecordingHeader& header);
  ~XdmfFile();
  XdmfFile(const XdmfFile&) = delete;
  XdmfFile& operator=(const XdmfFile&) = delete;

  void add_frame(double time);
  /// Adds the frames since the last call. Throws `Error`.
  void write();
  std::size_t pending_bytes() const { return pending_.size(); }

 private:
  struct Grid {
    std::string before_frame, before_frame_count, rest;  ///< the text of a grid, split where numbers go
    bool moves = true;
  };

  std::filesystem::path path_;
  int descriptor_ = -1;
  std::vector<Grid> grids_;
  std::uint64_t frames_ = 0;
  std::uint64_t end_ = 0;  ///< position of the closing tags
  std::string pending_;
};

}  // namespace supple
