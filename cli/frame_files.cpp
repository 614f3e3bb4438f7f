#include "frame_files.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "child_reader.hpp"
#include "supple/error.hpp"
#include "supple/formats.hpp"
#include "text.hpp"

namespace supple::cli {

TriangleMesh read_mesh(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path))
    throw Error(
        one_line(fmt::format("{}: there is no such file; check the folder and the spelling", path.string())));
  return is_read_by_assimp(path) ? load_in_child(path) : load_any_mesh(path);
}

const std::filesystem::path& FrameSequence::file_at(std::uint64_t frame) const {
  const std::uint64_t count = files.size();
  return files[loop ? frame % count : std::min(frame, count - 1)];
}

FrameFiles::FrameFiles(FrameSequence sequence, const TriangleMesh& mesh)
    : sequence_(std::move(sequence)),
      vertex_count_(mesh.positions.size()),
      triangles_(mesh.triangles),
      edges_(mesh.edges),
      points_(mesh.points) {}

void FrameFiles::read(std::uint64_t step, std::span<Vec3d> positions) const {
  constexpr const char* advice =
      "all frames of a sequence must show the same object; for several objects, write a scene file in which "
      "each has motion = { kind = \"frames\", files = \"...\" }";
  const std::filesystem::path& file = sequence_.file_at(step);
  const std::string name = file.string();
  const std::string first = sequence_.files.front().string();
  TriangleMesh mesh = read_mesh(file);
  const auto check_count = [&](const char* what, std::size_t given, std::size_t expected) {
    if (given == expected) return;
    throw Error(fmt::format("{}: has {} {}, but {} has {}; {}", name, given, what, first, expected, advice));
  };
  check_count("vertices", mesh.positions.size(), vertex_count_);
  const auto check_elements = [&](const char* one, const char* several, const auto& given,
                                  const auto& expected) {
    check_count(several, given.size(), expected.size());
    const auto difference = std::mismatch(given.begin(), given.end(), expected.begin()).first;
    if (difference != given.end())
      throw Error(fmt::format("{}: {} {} has different vertices than in {}; {}", name, one,
                              difference - given.begin(), first, advice));
  };
  check_elements("triangle", "triangles", mesh.triangles, triangles_);
  check_elements("line", "lines", mesh.edges, edges_);
  check_elements("point", "points", mesh.points, points_);
  if (sequence_.placement) place(mesh.positions, *sequence_.placement);
  std::copy(mesh.positions.begin(), mesh.positions.end(), positions.begin());
}

}  // namespace supple::cli
