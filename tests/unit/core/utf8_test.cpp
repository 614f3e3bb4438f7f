#include "supple/utf8.hpp"

#include <gtest/gtest.h>

#include <string>

#include "supple/error.hpp"

namespace supple::utf8_test {

constexpr const char* replacement = "\xef\xbf\xbd";

TEST(Utf8, KeepsValidText) {
  // One to four bytes, and the first and last code points of each length.
  for (const char* text : {"", "rabbit.obj", "caf\xc3\xa9", "\xe5\x85\x94", "\xf0\x9f\x90\x87", "\xc2\x80",
                           "\xdf\xbf", "\xe0\xa0\x80", "\xed\x9f\xbf", "\xee\x80\x80", "\xef\xbf\xbf",
                           "\xf0\x90\x80\x80", "\xf4\x8f\xbf\xbf"})
    EXPECT_EQ(valid_utf8(text), text);
  EXPECT_EQ(valid_utf8(std::string("a\0b", 3)), std::string("a\0b", 3));
}

TEST(Utf8, ReplacesEveryOtherByte) {
  // Not the start of a character, too short, too long for the code point, surrogates, beyond U+10FFFF.
  for (const std::string bytes :
       {"\x80", "\xbf", "\xff", "\xc3", "\xe2\x82", "\xf0\x9f\x90", "\xc0\xaf", "\xc1\xbf", "\xe0\x9f\xbf",
        "\xf0\x8f\xbf\xbf", "\xed\xa0\x80", "\xed\xbf\xbf", "\xf4\x90\x80\x80", "\xf8\x88\x80\x80\x80"}) {
    std::string expected;
    for (std::size_t i = 0; i < bytes.size(); ++i) expected += replacement;
    EXPECT_EQ(valid_utf8(bytes), expected);
    EXPECT_EQ(valid_utf8("a" + bytes + "b"), "a" + expected + "b");
  }
  EXPECT_EQ(valid_utf8("\xc3\xc3\xa9"), std::string(replacement) + "\xc3\xa9");
}

TEST(Utf8, OneLineHasNoControlCharacters) {
  EXPECT_EQ(one_line("a\nb\r\tc\x1b[2J\x7f"), "a b  c [2J");
  // Control characters and line separators of Unicode.
  EXPECT_EQ(one_line("a\xc2\x9b"
                     "b\xc2\x85"
                     "c\xe2\x80\xa8"
                     "d\xe2\x80\xa9"
                     "e"),
            "a b c d e");
  EXPECT_EQ(one_line("a\nb", '?'), "a?b");
  EXPECT_EQ(one_line("a  "), "a");
  EXPECT_EQ(one_line("\n"), "");
}

TEST(Utf8, ErrorsAreOneLineOfValidText) {
  EXPECT_STREQ(Error("a\xff\nb").what(), "a\xef\xbf\xbd b");
}

}  // namespace supple::utf8_test
