#include "server/access.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <ifaddrs.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include "supple/error.hpp"

namespace supple::viewer::access_test {

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

/// A path in a folder of its own.
class TokenFile : public testing::Test {
 protected:
  TokenFile() { std::filesystem::create_directories(folder_); }
  ~TokenFile() override { std::filesystem::remove_all(folder_); }
  const std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("supple_token_" + std::to_string(getpid()));
  const std::string file_ = (folder_ / "token").string();
};

TEST_F(TokenFile, IsMadeOnceAndOnlyForTheUser) {
  const std::string token = token_of_file(file_);
  EXPECT_EQ(token.size(), 32u);
  EXPECT_EQ(token_of_file(file_), token);
  using std::filesystem::perms;
  EXPECT_EQ(std::filesystem::status(file_).permissions(), perms::owner_read | perms::owner_write);
}

TEST_F(TokenFile, IsRefusedWhenOthersCanReadItOrItHasNoToken) {
  const auto failure = [&](const std::string& path) -> std::string {
    try {
      token_of_file(path);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  token_of_file(file_);
  std::filesystem::permissions(file_, std::filesystem::perms::group_read, std::filesystem::perm_options::add);
  EXPECT_NE(failure(file_).find("other users can read it"), std::string::npos);
  std::filesystem::permissions(file_, std::filesystem::perms::group_read,
                               std::filesystem::perm_options::remove);
  for (const char* const text :
       {"", "secret", "0123456789abcdef0123456789abcdef0", "0123456789abcdef0123456789ABCDEF"}) {
    std::ofstream(file_) << text;
    EXPECT_NE(failure(file_).find("no token"), std::string::npos) << text;
  }
  EXPECT_NE(failure((folder_ / "none" / "token").string()).find("cannot be written"), std::string::npos);
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

/// The IPv4 addresses of this machine.
std::vector<std::string> own_addresses() {
  std::vector<std::string> addresses;
  ifaddrs* list = nullptr;
  EXPECT_EQ(getifaddrs(&list), 0);
  for (const ifaddrs* entry = list; entry != nullptr; entry = entry->ifa_next) {
    if (entry->ifa_addr == nullptr || entry->ifa_addr->sa_family != AF_INET) continue;
    std::array<char, INET_ADDRSTRLEN> text{};
    const auto* const address = reinterpret_cast<const sockaddr_in*>(entry->ifa_addr);
    addresses.emplace_back(inet_ntop(AF_INET, &address->sin_addr, text.data(), text.size()));
  }
  freeifaddrs(list);
  return addresses;
}

TEST(Access, AtAllAddressesAnyAddressWillDoButNoForeignName) {
  const Access access("0.0.0.0", 8080, "t");
  const std::vector<std::string> own = own_addresses();
  const std::string named = access.host();
  EXPECT_EQ(std::count(own.begin(), own.end(), named.substr(0, named.find(':'))), 1) << named;
  EXPECT_TRUE(access.knows_host(named));
  // A machine with no other address is only reached from itself.
  if (own == std::vector<std::string>{"127.0.0.1"}) {
    EXPECT_EQ(named, "127.0.0.1:8080");
  }
  for (const char* const host : {"127.0.0.1:8080", "localhost:8080", "10.1.2.3:8080", "[fe80::1]:8080"})
    EXPECT_TRUE(access.knows_host(host)) << host;
  for (const char* const host : {"10.1.2.3", "10.1.2.3:80", "evil.example:8080", "1.evil.example:8080",
                                 "evil.example1:8080", ":8080", "[:8080", ""})
    EXPECT_FALSE(access.knows_host(host)) << host;
}

TEST(Access, WritesAddressesOfVersion6InBrackets) {
  EXPECT_EQ(Access("::1", 8080, "t").host(), "[::1]:8080");
  EXPECT_TRUE(Access("::1", 8080, "t").knows_host("[::1]:8080"));
  const std::string host = Access("::", 8080, "t").host();
  EXPECT_TRUE(host.starts_with("[") && host.ends_with("]:8080") && host != "[::]:8080") << host;
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

}  // namespace supple::viewer::access_test
