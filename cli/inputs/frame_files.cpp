#include "inputs/frame_files.hpp"

#include <algorithm>
#include <cctype>
#include <utility>

#include "base/text.hpp"

namespace supple::cli {

std::string lower_case_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

MeshFile read_mesh(const std::filesystem::path& path, const CoordinateConversion& conversion) {
  if (!std::filesystem::exists(path))
    fail("{}: there is no such file; check the folder and the spelling", path.string());
  MeshFile file = is_read_by_assimp(path) ? read_in_child(path) : read_mesh_file(path);
  convert(file.mesh.positions, file.frame, conversion);
  return file;
}

namespace {

/// Whether vertices keep their ids in frames of this format. Readers of other formats join corners at one
/// place, so a frame in which vertices meet has fewer.
bool stores_vertex_ids(const std::filesystem::path& path) {
  return lower_case_extension(path) != ".stl" && !is_read_by_assimp(path);
}

}  // namespace

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
  TriangleMesh mesh = read_mesh(file, sequence_.conversion).mesh;
  if (sequence_.placement && sequence_.placement->mirrors()) turn_over(mesh.triangles);
  const auto check_count = [&](const char* what, std::size_t given, std::size_t expected) {
    if (given == expected) return;
    fail("{}: has {} {}, but {} has {}; {}", name, given, what, first, expected, advice);
  };
  const bool has_ids = stores_vertex_ids(file);
  if (has_ids) check_count("vertices", mesh.positions.size(), vertex_count_);
  const auto check_elements = [&](const char* one, const char* several, const auto& given,
                                  const auto& expected) {
    check_count(several, given.size(), expected.size());
    if (!has_ids) return;
    const auto difference = std::mismatch(given.begin(), given.end(), expected.begin()).first;
    if (difference != given.end())
      fail("{}: {} {} has different vertices than in {}; {}", name, one, difference - given.begin(), first,
           advice);
  };
  check_elements("triangle", "triangles", mesh.triangles, triangles_);
  check_elements("line", "lines", mesh.edges, edges_);
  check_elements("point", "points", mesh.points, points_);
  if (has_ids) {
    std::copy(mesh.positions.begin(), mesh.positions.end(), positions.begin());
  } else if (const auto parted = place_by_corners(mesh, positions)) {
    fail(
        "{}: corners of vertex {} part, which are at one place in {}; save the frames in a "
        "format with vertex ids, such as PLY",
        name, *parted, first);
  }
  if (sequence_.placement) place(positions, *sequence_.placement);
}

std::optional<std::uint32_t> FrameFiles::place_by_corners(const TriangleMesh& mesh,
                                                          std::span<Vec3d> positions) const {
  std::vector<bool> is_placed(vertex_count_);
  const auto find_parted = [&](const auto& elements,
                               const auto& first_elements) -> std::optional<std::uint32_t> {
    for (std::size_t i = 0; i < elements.size(); ++i) {
      for (std::size_t corner = 0; corner < elements[i].size(); ++corner) {
        const std::uint32_t vertex = first_elements[i][corner];
        const Vec3d& place = mesh.positions[elements[i][corner]];
        if (is_placed[vertex] && place == place && positions[vertex] != place) return vertex;
        positions[vertex] = place;
        is_placed[vertex] = true;
      }
    }
    return std::nullopt;
  };
  for (std::size_t i = 0; i < points_.size(); ++i) positions[points_[i]] = mesh.positions[mesh.points[i]];
  const auto parted = find_parted(mesh.triangles, triangles_);
  return parted ? parted : find_parted(mesh.edges, edges_);
}

}  // namespace supple::cli
