#include "packed/packed_scene.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <utility>

#include "failure.hpp"
#include "packed/archive.hpp"
#include "packed/packed_fields.hpp"
#include "packed/packed_frames.hpp"
#include "sources/extent.hpp"
#include "supple/version.hpp"

namespace supple::viewer {
namespace {

/// Precedes the packed data.
struct Header {
  std::array<char, 8> magic{'S', 'U', 'P', 'L', 'S', 'H', 'O', 'W'};
  std::array<char, 16> version{};  // of the library, padded with zeros
  std::uint64_t checksum = 0;      // of everything after the header

  constexpr bool operator==(const Header&) const = default;
};

std::array<char, 16> own_version() {
  std::array<char, 16> version{};
  static_assert(sizeof(SUPPLE_VERSION) <= sizeof(version));
  std::memcpy(version.data(), SUPPLE_VERSION, sizeof(SUPPLE_VERSION));
  return version;
}

/// FNV-1a over words of eight bytes; the last word is padded with zeros.
std::uint64_t checksum_of(std::span<const std::byte> bytes) {
  std::uint64_t hash = 0xcbf29ce484222325u ^ bytes.size();
  for (std::size_t i = 0; i < bytes.size(); i += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + i, std::min<std::size_t>(8, bytes.size() - i));
    hash = (hash ^ word) * 0x100000001b3u;
    hash ^= hash >> 32;
  }
  return hash;
}

void check_header(const Header& header, std::span<const std::byte> content) {
  if (header.magic != Header{}.magic) fail("this is not a packed scene; export the page again");
  if (header.version != own_version()) {
    const std::string version(header.version.begin(),
                              std::find(header.version.begin(), header.version.end(), '\0'));
    fail("this scene was packed by version " + version + " of Supple, and this is " + SUPPLE_VERSION +
         "; export the page again");
  }
  if (header.checksum != checksum_of(content)) fail("the packed scene is damaged; export the page again");
}

}  // namespace

std::vector<std::byte> pack(const SceneView& show) {
  Packer packer;
  const bool has_frames = show.frames != nullptr;
  packer(show.title, show.simulation, show.objects, has_frames);
  if (has_frames) packer(PackedFrames(*show.frames, show.objects, extent_of(show).center()));
  return with_header(packer.take());
}

std::vector<std::byte> with_header(std::span<const std::byte> content) {
  const Header header{.version = own_version(), .checksum = checksum_of(content)};
  std::vector<std::byte> bytes(sizeof(header) + content.size());
  std::memcpy(bytes.data(), &header, sizeof(header));
  if (!content.empty()) std::memcpy(bytes.data() + sizeof(header), content.data(), content.size());
  return bytes;
}

SceneView unpack(std::span<const std::byte> bytes) {
  Header header;
  if (bytes.size() < sizeof(header)) fail("this is not a packed scene; export the page again");
  std::memcpy(&header, bytes.data(), sizeof(header));
  const auto content = bytes.subspan(sizeof(header));
  check_header(header, content);

  Unpacker unpacker(content);
  SceneView show;
  bool has_frames = false;
  unpacker(show.title, show.simulation, show.objects, has_frames);
  if (has_frames) {
    auto frames = std::make_shared<PackedFrames>();
    unpacker(*frames);
    if (!frames->fit_to(show.objects)) unpacker.fail();
    show.frames = std::move(frames);
  }
  if (!unpacker.good() || !unpacker.at_end()) fail("the packed scene is damaged; export the page again");
  return show;
}

}  // namespace supple::viewer
