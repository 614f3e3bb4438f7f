#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <system_error>

#include "core/error.hpp"
#include "mesh/mesh_formats.hpp"
#include "mesh/text_scanner.hpp"
#include "supple/mesh.hpp"

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

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

std::string reason() {
  return std::generic_category().message(errno);
}

// For messages, which are one line whatever the file is called.
std::string shown(const std::filesystem::path& path) {
  std::string name = path.string();
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return c < 32 || c == 127; }, '?');
  return name;
}

const MeshFormat* find_format(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  for (const MeshFormat& format : mesh_formats) {
    if (format.extension == extension) return &format;
  }
  return nullptr;
}

std::string read_file(const std::filesystem::path& path) {
  const std::string name = shown(path);
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) fail("cannot open " + name + ": it is a directory");
  const File file(std::fopen(path.string().c_str(), "rb"));
  if (!file) fail("cannot open " + name + ": " + reason());

  std::string bytes;
  const auto expected_size = std::filesystem::file_size(path, ignored);
  // One byte more than expected, so that the end is seen without growing.
  std::size_t chunk = ignored ? 65536 : static_cast<std::size_t>(expected_size) + 1;
  for (std::size_t size = 0;; chunk = std::max(chunk, size)) {
    bytes.resize(size + chunk);
    const std::size_t count = std::fread(bytes.data() + size, 1, chunk, file.get());
    size += count;
    if (count < chunk) {
      if (std::ferror(file.get())) fail("cannot read " + name + ": " + reason());
      bytes.resize(size);
      return bytes;
    }
  }
}

void write_file(const std::filesystem::path& path, const std::string& bytes) {
  const std::string name = shown(path);
  File file(std::fopen(path.string().c_str(), "wb"));
  if (!file) fail("cannot write " + name + ": " + reason());
  const bool written = std::fwrite(bytes.data(), 1, bytes.size(), file.get()) == bytes.size();
  // Closing may be what first finds the disk full.
  if (!written || std::fclose(file.release()) != 0) fail("cannot write " + name + ": " + reason());
}

}  // namespace

TriangleMesh load_mesh(const std::filesystem::path& path) {
  const MeshFormat* format = find_format(path);
  if (format == nullptr) {
    fail("cannot read " + shown(path) + ": the extension " + in_quotes(path.extension().string()) +
         " is none of .obj, .off, .ply and .stl; supple::formats reads more");
  }
  TriangleMesh mesh = format->read(read_file(path), shown(path));
  mesh.name = path.stem().string();
  constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max();
  if (mesh.positions.size() > most || mesh.triangles.size() > most) {
    fail(shown(path) + ": more vertices or triangles than the " + std::to_string(most) +
         " that ids can tell");
  }
  return mesh;
}

void save_mesh(const TriangleMesh& mesh, const std::filesystem::path& path) {
  const MeshFormat* format = find_format(path);
  if (format == nullptr) {
    fail("cannot write " + shown(path) + ": the extension " + in_quotes(path.extension().string()) +
         " is none of .obj, .off, .ply and .stl");
  }
  check_mesh(mesh);
  write_file(path, format->write(mesh));
}

void check_mesh(const TriangleMesh& mesh) {
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (const std::uint32_t id : mesh.triangles[i]) {
      if (id < mesh.positions.size()) continue;
      fail("mesh " + in_quotes(mesh.name) + ": triangle " + std::to_string(i) + " uses vertex " +
           std::to_string(id) + "; the mesh has " + std::to_string(mesh.positions.size()) +
           " vertices, counted from 0");
    }
  }
}

}  // namespace supple
