#include <algorithm>
#include <filesystem>
#include <limits>
#include <string>

#include "core/error.hpp"
#include "files/file_access.hpp"
#include "files/mesh_formats.hpp"
#include "files/text_scanner.hpp"
#include "supple/mesh_file.hpp"

namespace supple {
namespace {

struct MeshFormat {
  std::string_view extension;
  TriangleMesh (*read)(std::string_view bytes, const std::string& file);
  std::string (*write)(const TriangleMesh& mesh);
};
constexpr MeshFormat mesh_formats[] = {{".obj", read_obj, write_obj},
                                       {".off", read_off, write_off},
                                       {".ply", read_ply, write_ply},
                                       {".stl", read_stl, write_stl}};

const MeshFormat* find_format(const std::filesystem::path& path) {
  const std::string extension = lower_case_extension(path);
  for (const MeshFormat& format : mesh_formats) {
    if (format.extension == extension) return &format;
  }
  return nullptr;
}

}  // namespace

TriangleMesh load_mesh(const std::string& file) {
  const std::filesystem::path path = file;
  const MeshFormat* format = find_format(path);
  if (format == nullptr) {
    fail("cannot read " + shown(path) + ": the extension " + in_quotes(path.extension().string()) +
         " is none of .obj, .off, .ply and .stl; supple::formats reads more");
  }
  TriangleMesh mesh = format->read(read_file(path), shown(path));
  mesh.name = path.stem().string();
  constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max();
  if (std::max({mesh.positions.size(), mesh.triangles.size(), mesh.edges.size(), mesh.points.size()}) >
      most) {
    fail(shown(path) + ": more vertices, triangles, lines or points than the " + std::to_string(most) +
         " that ids can tell");
  }
  return mesh;
}

void save_mesh(const TriangleMesh& mesh, const std::string& file) {
  const std::filesystem::path path = file;
  const MeshFormat* format = find_format(path);
  if (format == nullptr) {
    fail("cannot write " + shown(path) + ": the extension " + in_quotes(path.extension().string()) +
         " is none of .obj, .off, .ply and .stl");
  }
  check_mesh(mesh);
  if (format->write != write_obj && !(mesh.edges.empty() && mesh.points.empty())) {
    fail("cannot write " + shown(path) + ": mesh " + in_quotes(mesh.name) +
         " has edges or points of no triangle, which only .obj files hold");
  }
  write_file(path, format->write(mesh));
}

}  // namespace supple
