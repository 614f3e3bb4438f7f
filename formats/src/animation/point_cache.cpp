#include "supple/point_cache.hpp"

#include <bit>
#include <string>
#include <utility>

#include "core/error.hpp"
#include "core/quotes.hpp"
#include "files/byte_order.hpp"
#include "files/file_access.hpp"

namespace supple {

struct PointCache::Content {
  std::string file, bytes;
  std::endian order;
  std::uint64_t vertices, frames, first;  ///< `first`: offset of the first frame in bytes
};

PointCache::PointCache(const std::filesystem::path& path) {
  const std::string file = shown(path), extension = lower_case_extension(path);
  const bool is_pc2 = extension == ".pc2";
  if (!is_pc2 && extension != ".mdd")
    fail("cannot read " + file + ": a point cache has the extension .pc2 or .mdd, not " +
         in_quotes(extension));
  std::string bytes = read_file(path);
  constexpr std::string_view pc2_magic("POINTCACHE2\0", 12);
  if (is_pc2 && !bytes.starts_with(pc2_magic))
    fail(file + ": does not start with POINTCACHE2; is it another file?");
  // PC2: magic, version, vertices, first frame, sample rate, frames; little-endian.
  // MDD: frames, vertices, a time for each frame; big-endian.
  const std::endian order = is_pc2 ? std::endian::little : std::endian::big;
  std::uint64_t first = is_pc2 ? 32 : 8;
  if (bytes.size() < first) fail(file + ": the file ends within its header");
  const auto number = [&](std::size_t place) {
    return load_scalar<std::uint32_t>(bytes.data() + place, order);
  };
  const std::uint64_t vertices = number(is_pc2 ? 16 : 4), frames = number(is_pc2 ? 28 : 0);
  if (!is_pc2) first += 4 * frames;
  if (frames == 0) fail(file + ": has no frames");
  if (bytes.size() < first || (vertices > 0 && (bytes.size() - first) / (12 * vertices) < frames))
    fail(file + ": announces " + std::to_string(frames) + " frames of " + std::to_string(vertices) +
         " vertices, but has only " + std::to_string(bytes.size()) + " bytes; was it written completely?");
  content_ = std::make_shared<const Content>(Content{file, std::move(bytes), order, vertices, frames, first});
}

std::uint64_t PointCache::frame_count() const {
  return content_->frames;
}

std::size_t PointCache::vertex_count() const {
  return content_->vertices;
}

void PointCache::positions(std::uint64_t frame, std::span<Vec3d> positions) const {
  const Content& content = *content_;
  if (frame >= content.frames)
    fail(content.file + ": there is no frame " + std::to_string(frame) + "; the file has " +
         std::to_string(content.frames) + ", counted from 0");
  if (positions.size() != content.vertices)
    fail(content.file + ": " + std::to_string(positions.size()) + " positions given for " +
         std::to_string(content.vertices) + " vertices");
  const char* place = content.bytes.data() + content.first + 12 * content.vertices * frame;
  for (Vec3d& position : positions) {
    for (int axis = 0; axis < 3; ++axis, place += 4)
      position[axis] = static_cast<double>(load_scalar<float>(place, content.order));
  }
}

}  // namespace supple
