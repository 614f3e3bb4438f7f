#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "files/text_scanner.hpp"

namespace supple {

enum class Scalar { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };

std::size_t size_of(Scalar type);
inline bool is_integer(Scalar type) {
  return type < Scalar::float32;
}

enum class Encoding { text, little_endian, big_endian };

/// Reads the numbers of a file that is text, or text with blocks of binary numbers. In text, a number may
/// follow on a later line. Keeps a view of the bytes.
class ScalarReader {
 public:
  ScalarReader(std::string_view bytes, const std::string& file, TextSyntax syntax)
      : text(bytes, file, syntax), bytes_(bytes), file_(file) {}

  /// Fails, with `what` in the message, when there is no such number.
  double number(Scalar type, const char* what);
  std::int64_t integer(Scalar type, const char* what);
  /// An integer that is not negative.
  std::uint64_t count(Scalar type, const char* what);
  void skip(Scalar type, std::uint64_t count, const char* what);

  /// Fails unless the rest of the file can hold `count` times `values` numbers of at least the size of
  /// `type`. After this, `count` may determine an allocation or a loop.
  void expect(std::uint64_t count, std::uint64_t values, Scalar type, const char* what) const;

  /// Fails with the place: the line of a text, the byte of a binary file.
  [[noreturn]] void fail_here(const std::string& message) const;

  Encoding encoding() const { return encoding_; }
  /// Numbers are binary from here on. The last call decides.
  void set_binary(Encoding encoding) {
    encoding_ = encoding;
    text.keep_padding();
  }

  TextScanner text;

 private:
  template <class Stored>
  Stored load(const char* what);
  void skip_to_value(const char* what);

  Encoding encoding_ = Encoding::text;
  std::string_view bytes_;
  std::string file_;
  std::size_t last_value_ = 0;  // for messages: the start of the binary number that was read last
};

}  // namespace supple
