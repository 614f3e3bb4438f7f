#include "server/access.hpp"

#include <gtest/gtest.h>

#include <set>

namespace supple::viewer {
namespace {

TEST(Access, TokensAreLongAndNeverTheSame) {
  std::set<std::string> tokens;
  for (int i = 0; i < 1000; ++i) {
    const std::string token = make_token();
    EXPECT_EQ(token.size(), 32u);
    EXPECT_EQ(token.find_first_not_of("0123456789abcdef"), std::string::npos);
    tokens.insert(token);
  }
  EXPECT_EQ(tokens.size(), 1000u);
}

TEST(Access, FindsTheTokenOfATarget) {
  const auto expect = [](std::string_view target, std::string_view path, std::string_view token) {
    EXPECT_EQ(parse_target(target).path, path) << target;
    EXPECT_EQ(parse_target(target).token, token) << target;
  };
  expect("/", "/", "");
  expect("/?token=abc", "/", "abc");
  expect("/session?token=abc&x=1", "/session", "abc");
  expect("/session?x=1&token=abc", "/session", "abc");
  expect("/?x&&token=abc", "/", "abc");
  expect("/?nottoken=abc", "/", "");
  expect("/?token", "/", "");
  expect("/?", "/", "");
  expect("", "", "");
}

TEST(Access, OnlyTheWholeTokenWillDo) {
  const std::string token = make_token();
  const Access access("127.0.0.1", 8080, token);
  EXPECT_TRUE(access.knows_token(token));
  EXPECT_FALSE(access.knows_token(""));
  EXPECT_FALSE(access.knows_token(token.substr(1)));
  EXPECT_FALSE(access.knows_token(token + "0"));
  for (std::size_t i = 0; i < token.size(); ++i) {
    std::string other = token;
    other[i] = other[i] == '0' ? '1' : '0';
    EXPECT_FALSE(access.knows_token(other)) << i;
  }
}

TEST(Access, KnowsItselfByAddressAndPort) {
  const Access access("127.0.0.1", 8080, "t");
  EXPECT_EQ(access.host(), "127.0.0.1:8080");
  for (const char* const host : {"127.0.0.1:8080", "localhost:8080"})
    EXPECT_TRUE(access.knows_host(host)) << host;
  for (const char* const host :
       {"", "127.0.0.1", "127.0.0.1:80", "127.0.0.1:80800", "127.0.0.2:8080", "localhost",
        "evil.example:8080", "127.0.0.1.evil.example:8080", "evil.example", ":8080"})
    EXPECT_FALSE(access.knows_host(host)) << host;
}

TEST(Access, AtAllAddressesAnyAddressWillDoButNoForeignName) {
  const Access access("0.0.0.0", 8080, "t");
  EXPECT_EQ(access.host(), "127.0.0.1:8080");
  for (const char* const host : {"127.0.0.1:8080", "localhost:8080", "10.1.2.3:8080", "[fe80::1]:8080"})
    EXPECT_TRUE(access.knows_host(host)) << host;
  for (const char* const host : {"10.1.2.3", "10.1.2.3:80", "evil.example:8080", "1.evil.example:8080",
                                 "evil.example1:8080", ":8080", "[:8080", ""})
    EXPECT_FALSE(access.knows_host(host)) << host;
}

TEST(Access, WritesAddressesOfVersion6InBrackets) {
  EXPECT_EQ(Access("::1", 8080, "t").host(), "[::1]:8080");
  EXPECT_TRUE(Access("::1", 8080, "t").knows_host("[::1]:8080"));
  EXPECT_EQ(Access("::", 8080, "t").host(), "[::1]:8080");
}

TEST(Access, BrowsersLeaveOutPort80) {
  EXPECT_EQ(Access("127.0.0.1", 80, "t").host(), "127.0.0.1");
  EXPECT_TRUE(Access("127.0.0.1", 80, "t").knows_host("localhost"));
}

TEST(Access, PagesOfOtherSitesAreTold) {
  EXPECT_TRUE(Access::is_own_origin("http://127.0.0.1:8080", "127.0.0.1:8080"));
  EXPECT_TRUE(Access::is_own_origin("", "127.0.0.1:8080"));
  for (const char* const origin :
       {"null", "http://evil.example", "https://127.0.0.1:8080", "http://127.0.0.1:3000",
        "http://localhost:8080", "http://127.0.0.1:8080/", "http://", "file://"})
    EXPECT_FALSE(Access::is_own_origin(origin, "127.0.0.1:8080")) << origin;
}

}  // namespace
}  // namespace supple::viewer
