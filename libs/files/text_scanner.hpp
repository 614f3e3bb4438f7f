#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/quotes.hpp"
#include "supple/types.hpp"

namespace supple {

/// The syntax of a text format besides words, blanks and line ends.
struct TextSyntax {
  bool hash_comments = false;        ///< '#' starts a comment that lasts to the end of its line
  bool backslash_continues = false;  ///< a backslash as the last character joins the next line to this one
};

/// Whether the text starts with a byte order mark of UTF-16.
bool is_utf16(std::string_view text);
/// The text without zero bytes and end-of-file characters (Ctrl-Z), mixed with blanks, at its end: some
/// programs fill the last block of a file with them.
std::string_view without_padding(std::string_view text);

/// Reads words and numbers, line by line, from a text file in memory, and tracks the line for messages. Lines
/// end with LF, CR LF or CR. Skips a byte order mark at the start, and padding at the end. Fails when the
/// text is UTF-16. Keeps a view of the text.
class TextScanner {
 public:
  TextScanner(std::string_view text, std::string file, TextSyntax syntax);

  /// Skips blanks. Returns true when only a comment, or nothing, is left on this line.
  bool at_line_end();
  /// Moves to the next line and ignores the rest of this line.
  void skip_line();
  /// Moves to the next word, on this line or a later one. False at the end of the file.
  bool skip_to_word();
  /// Moves past `literal` if it comes next.
  bool accept(std::string_view literal);
  /// Counts the padding at the end as part of the file: its last numbers are binary.
  void keep_padding() { end_ = padded_end_; }
  /// Moves over bytes that are no text, at most `remaining()`. Their line ends do not count.
  void skip_bytes(std::size_t count) { position_ += count; }
  /// The next word of this line; empty at its end.
  std::string_view word();

  /// The next number of this line. Fails, with `what` in the message, when there is none.
  double number(const char* what);
  /// The next three numbers of this line.
  Vec3d point() { return {number("x"), number("y"), number("z")}; }
  /// The next integer of this line. With `word_may_go_on`, a '/' may follow it; the scanner then skips the
  /// rest of the word.
  std::int64_t integer(const char* what, bool word_may_go_on = false);

  std::size_t offset() const { return static_cast<std::size_t>(position_ - begin_); }
  std::size_t remaining() const { return static_cast<std::size_t>(end_ - position_); }
  std::size_t line() const { return line_; }

  [[noreturn]] void fail_here(const std::string& message) const { fail_at(line_, message); }
  [[noreturn]] void fail_at(std::size_t line, const std::string& message) const;
  /// Fails with the message that `what` was expected instead of `found`, the word just read.
  [[noreturn]] void fail_expected(const std::string& what, std::string_view found);

 private:
  void skip_blanks();
  void skip_line_break();
  bool is_continuation(const char* place) const;
  bool ends_word(const char* place) const;

  const char* begin_;
  const char* position_;
  const char* end_;
  const char* padded_end_;
  std::size_t line_ = 1;
  std::string file_;
  TextSyntax syntax_;
};

/// The text with small letters in place of the capitals of ASCII.
inline std::string lower_case(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return result;
}
inline bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}
inline bool is_line_break(char c) {
  return c == '\n' || c == '\r';
}

}  // namespace supple
