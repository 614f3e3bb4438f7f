#include "files/text_scanner.hpp"

#include <utility>

#include "core/error.hpp"
#include "files/number_text.hpp"

namespace supple {

bool is_utf16(std::string_view text) {
  return text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF");
}

std::string_view without_padding(std::string_view text) {
  constexpr std::string_view padding("\0\x1a", 2), blanks_and_padding("\0\x1a \t\v\f\r\n", 8);
  const std::size_t end = text.find_last_not_of(blanks_and_padding) + 1;
  return text.substr(0, text.find_first_of(padding, end));
}

TextScanner::TextScanner(std::string_view text, std::string file, TextSyntax syntax)
    : begin_(text.data()),
      position_(begin_),
      end_(begin_ + without_padding(text).size()),
      padded_end_(begin_ + text.size()),
      file_(std::move(file)),
      syntax_(syntax) {
  if (text.starts_with("\xEF\xBB\xBF")) position_ += 3;
  if (is_utf16(text)) fail_here("the text is UTF-16; save the file as UTF-8 or ASCII");
}

bool TextScanner::is_continuation(const char* place) const {
  return syntax_.backslash_continues && *place == '\\' && place + 1 != end_ && is_line_break(place[1]);
}

bool TextScanner::ends_word(const char* place) const {
  return place == end_ || is_blank(*place) || is_line_break(*place) ||
         (syntax_.hash_comments && *place == '#') || is_continuation(place);
}

void TextScanner::skip_line_break() {
  const bool two_characters = *position_ == '\r' && position_ + 1 != end_ && position_[1] == '\n';
  position_ += two_characters ? 2 : 1;
  ++line_;
}

void TextScanner::skip_blanks() {
  while (position_ != end_) {
    if (is_blank(*position_)) {
      ++position_;
    } else if (is_continuation(position_)) {
      ++position_;
      skip_line_break();
    } else {
      return;
    }
  }
}

bool TextScanner::at_line_end() {
  skip_blanks();
  return position_ == end_ || is_line_break(*position_) || (syntax_.hash_comments && *position_ == '#');
}

void TextScanner::skip_line() {
  bool in_comment = false;
  while (position_ != end_ && !is_line_break(*position_)) {
    in_comment = in_comment || (syntax_.hash_comments && *position_ == '#');
    const bool joins_next = !in_comment && is_continuation(position_);
    ++position_;
    if (joins_next) skip_line_break();
  }
  if (position_ != end_) skip_line_break();
}

bool TextScanner::skip_to_word() {
  while (at_line_end()) {
    if (position_ == end_) return false;
    skip_line();
  }
  return true;
}

bool TextScanner::accept(std::string_view literal) {
  if (!std::string_view(position_, remaining()).starts_with(literal)) return false;
  position_ += literal.size();
  return true;
}

std::string_view TextScanner::word() {
  if (at_line_end()) return {};
  const char* first = position_;
  while (!ends_word(position_)) ++position_;
  return {first, static_cast<std::size_t>(position_ - first)};
}

double TextScanner::number(const char* what) {
  skip_blanks();
  double value = 0;
  const char* next = parse_double(position_, end_, value);
  if (next == nullptr || !ends_word(next)) fail_expected(std::string("a number for ") + what, word());
  position_ = next;
  return value;
}

std::int64_t TextScanner::integer(const char* what, bool word_may_go_on) {
  skip_blanks();
  std::int64_t value = 0;
  const char* next = parse_integer(position_, end_, value);
  if (next != nullptr && word_may_go_on && next != end_ && *next == '/') {
    while (!ends_word(next)) ++next;
  }
  if (next == nullptr || !ends_word(next)) fail_expected(std::string("an integer for ") + what, word());
  position_ = next;
  return value;
}

void TextScanner::fail_at(std::size_t line, const std::string& message) const {
  fail(file_ + ":" + std::to_string(line) + ": " + message);
}

void TextScanner::fail_expected(const std::string& what, std::string_view found) {
  const char* end = position_ == end_ ? "the end of the file" : "the end of the line";
  fail_here("expected " + what + ", found " + (found.empty() ? std::string(end) : in_quotes(found)));
}

}  // namespace supple
