// Mesh files that Assimp reads. The first byte chooses the extension.

#include <algorithm>
#include <array>
#include <map>
#include <string_view>
#include <vector>

#include "supple/error.hpp"
#include "supple/formats.hpp"
#include "support/byte_reader.hpp"
#include "support/check.hpp"
#include "support/temporary_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace supple;
  static const std::vector<std::string_view> extensions = [] {
    constexpr std::array<std::string_view, 4> own = {".obj", ".off", ".ply", ".stl"};
    std::vector<std::string_view> others(supported_extensions().begin(), supported_extensions().end());
    std::erase_if(others,
                  [&](std::string_view e) { return std::find(own.begin(), own.end(), e) != own.end(); });
    return others;
  }();
  fuzz::ByteReader bytes(data, size);
  const std::size_t choice = bytes.byte() % extensions.size();
  const fuzz::TemporaryFile file{std::string(extensions[choice])};
  file.write(bytes.text());
  try {
    check_mesh(load_any_mesh(file.path()));
  } catch (const Error& error) {
    fuzz::check_message(error.what(), "");
  }
  return 0;
}
