#pragma once

#include <cstdint>
#include <string>

namespace supple::cli {

/// Names of files with the number of a frame: in `out_%04d.png`, `%04d` is the number with at least four
/// digits, `%d` the number alone, and `%%` a percent sign.
class PictureNames {
 public:
  /// Throws `Error` for any other use of the percent sign.
  explicit PictureNames(const std::string& pattern);

  /// Whether frames of different numbers have different names.
  bool has_number() const { return has_number_; }
  std::string of(std::uint64_t frame) const;

 private:
  std::string before_, after_;
  int digits_ = 0;
  bool has_number_ = false;
};

}  // namespace supple::cli
