#include "export/page_file.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "export/embedded.hpp"
#include "supple/error.hpp"
#include "support/random.hpp"

namespace supple::viewer::page_file_test {

namespace fs = std::filesystem;

/// Random bytes.
std::vector<std::byte> noise(std::size_t count, unsigned seed) {
  std::vector<std::byte> bytes(count);
  RandomNumbers random(seed);
  for (std::byte& byte : bytes) byte = static_cast<std::byte>(random.below(256));
  return bytes;
}

std::string from_base64(std::string_view text) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  EXPECT_EQ(text.size() % 4, 0u);
  std::string bytes;
  unsigned bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    const std::size_t digit = digits.find(c);
    EXPECT_NE(digit, std::string_view::npos) << c;
    bits = bits << 6 | static_cast<unsigned>(digit);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count & 255);
  }
  return bytes;
}

std::vector<std::byte> gunzip(std::string packed, std::size_t expected) {
  z_stream stream{};
  EXPECT_EQ(inflateInit2(&stream, 15 + 16), Z_OK);
  std::vector<std::byte> bytes(expected + 1);
  stream.next_in = reinterpret_cast<unsigned char*>(packed.data());
  stream.avail_in = static_cast<uInt>(packed.size());
  stream.next_out = reinterpret_cast<unsigned char*>(bytes.data());
  stream.avail_out = static_cast<uInt>(bytes.size());
  EXPECT_EQ(inflate(&stream, Z_FINISH), Z_STREAM_END);
  EXPECT_EQ(stream.avail_in, 0u);
  bytes.resize(stream.total_out);
  inflateEnd(&stream);
  return bytes;
}

/// The decoded data in an element of the page.
std::vector<std::byte> cargo(const std::string& page, const std::string& id, std::size_t expected) {
  const std::string start = "<script type=\"application/octet-stream;base64\" id=\"" + id + "\">";
  const std::size_t first = page.find(start);
  if (first == std::string::npos) {
    ADD_FAILURE() << "no element " << id;
    return {};
  }
  const std::size_t from = first + start.size();
  return gunzip(from_base64(std::string_view(page).substr(from, page.find('<', from) - from)), expected);
}

TEST(PageFile, HoldsShowAndModuleByteForByte) {
  const std::string page = "<p>\"<!--supple-cargo-->\"</p><body>x<!--supple-cargo--></body>";
  for (const std::size_t size : {0u, 1u, 2u, 3u, 4u, 1000u, 3'000'001u}) {
    const std::vector<std::byte> show = noise(size, 1), module = noise(size / 2, 2);
    const std::string whole = page_with_cargo(page, show, module);
    EXPECT_EQ(cargo(whole, "supple-scene", show.size()), show);
    EXPECT_EQ(cargo(whole, "supple-wasm", module.size()), module);
    // The data replaces the last such comment: a script may contain an earlier one.
    const std::size_t place = page.rfind("<!--");
    EXPECT_EQ(whole.substr(0, place), page.substr(0, place));
    EXPECT_EQ(whole.substr(whole.size() - 7), "</body>");
    EXPECT_EQ(whole, page_with_cargo(page, show, module)) << "a second call gives another page";
  }
}

TEST(PageFile, NeedsAPlaceForCargo) {
  EXPECT_THROW(page_with_cargo("<body></body>", {}, {}), Error);
}

#ifdef SUPPLE_VIEWER_PAGE
TEST(PageFile, WhatIsEmbeddedIsWhatWasBuilt) {
  const auto content = [](const char* name) {
    std::ifstream stream(name, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(stream), {});
  };
  EXPECT_EQ(embedded_page(), content(SUPPLE_VIEWER_PAGE));
  const std::string_view module(reinterpret_cast<const char*>(embedded_module().data()),
                                embedded_module().size());
  EXPECT_EQ(module, content(SUPPLE_VIEWER_MODULE));
  EXPECT_NO_THROW(page_with_cargo(embedded_page(), {}, {}));
}
#else
TEST(PageFile, NothingIsEmbeddedWithoutTheViewer) {
  EXPECT_TRUE(embedded_page().empty());
  EXPECT_TRUE(embedded_module().empty());
}
#endif

class ReplaceFile : public testing::Test {
 protected:
  ReplaceFile() { fs::create_directories(folder_); }
  ~ReplaceFile() override { fs::remove_all(folder_); }

  std::string read(const fs::path& path) const {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  std::size_t count_files() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

  fs::path folder_ = fs::path(testing::TempDir()) / ("replace_file_" + std::to_string(::getpid()));
};

TEST_F(ReplaceFile, WritesAndReplaces) {
  const fs::path path = folder_ / "page.html";
  replace_file(path, "one");
  EXPECT_EQ(read(path), "one");
  replace_file(path, std::string(3'000'000, 'x'));
  EXPECT_EQ(read(path), std::string(3'000'000, 'x'));
  EXPECT_EQ(count_files(), 1u) << "a temporary file is left";
  EXPECT_NE(fs::status(path).permissions() & fs::perms::owner_write, fs::perms::none);
}

TEST_F(ReplaceFile, LeavesNothingWhereItCannotWrite) {
  const auto error_of = [](const fs::path& path) -> std::string {
    try {
      replace_file(path, "x");
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(error_of(folder_ / "no" / "page.html").find("page.html: cannot write: No such file"),
            std::string::npos);
  EXPECT_NE(error_of(folder_).find("directory"), std::string::npos);
  EXPECT_NE(error_of("/dev/null").find("/dev/null: cannot write"), std::string::npos);
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  EXPECT_EQ(count_files(), 0u);
}

}  // namespace supple::viewer::page_file_test
