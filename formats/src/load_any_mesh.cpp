#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "animation/model_readers.hpp"
#include "file_kinds.hpp"
#include "files/file_access.hpp"
#include "own_formats.hpp"
#include "supple/formats.hpp"
#include "supple/mesh_file.hpp"

namespace supple {
namespace {

constexpr std::array<std::string_view, 4> native_extensions = {".obj", ".off", ".ply", ".stl"};

bool is_native(std::string_view extension) {
  return std::find(native_extensions.begin(), native_extensions.end(), extension) != native_extensions.end();
}

bool is_read_by_ufbx([[maybe_unused]] std::string_view extension) {
#ifdef SUPPLE_UFBX
  return extension == ".fbx";
#else
  return false;
#endif
}

bool is_gltf(std::string_view extension) {
  return extension == ".gltf" || extension == ".glb";
}

// Parses Assimp's own list, which has the form "*.3d;*.3ds;...".
std::vector<std::string> list_extensions() {
  std::vector<std::string> result(native_extensions.begin(), native_extensions.end());
  result.insert(result.end(), own_extensions().begin(), own_extensions().end());
  aiString list;
  Assimp::Importer().GetExtensionList(list);
  std::string_view rest = list.C_Str();
  while (!rest.empty()) {
    const std::string_view pattern = rest.substr(0, rest.find(';'));
    if (pattern.starts_with("*.")) result.emplace_back(pattern.substr(1));
    rest.remove_prefix(std::min(rest.size(), pattern.size() + 1));
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

}  // namespace

std::span<const std::string_view> supported_extensions() {
  static const std::vector<std::string> names = list_extensions();
  static const std::vector<std::string_view> views(names.begin(), names.end());
  return views;
}

bool is_read_by_assimp(const std::filesystem::path& path) {
  const std::string extension = lower_case_extension(path);
  const std::span<const std::string_view> known = supported_extensions();
  return !is_native(extension) && !is_gltf(extension) && !is_read_by_ufbx(extension) &&
         !has_own_reader(path) && std::binary_search(known.begin(), known.end(), extension);
}

AnimatedModel read_model(const std::filesystem::path& path) {
  const std::string extension = lower_case_extension(path);
  const std::string start = read_start(path);
  if (!std::ranges::binary_search(supported_extensions(), extension)) fail_unsupported(path, start);
  check_kind(path, start);
  AnimatedModel model;
  if (is_native(extension)) {
    model.mesh = load_mesh(path);
  } else if (is_gltf(extension)) {
    model = read_gltf(path);
  } else if (has_own_reader(path)) {
    MeshFile file = read_own_format(path);
    model.mesh = std::move(file.mesh);
    model.frame = file.frame;
#ifdef SUPPLE_UFBX
  } else if (is_read_by_ufbx(extension)) {
    model = read_fbx(path);
#endif
  } else {
    model = read_with_assimp(path);
  }
  model.mesh.name = path.stem().string();
  return model;
}

MeshFile read_mesh_file(const std::filesystem::path& path) {
  AnimatedModel model = read_model(path);
  MeshFile file{std::move(model.mesh), model.frame, {}};
  for (AnimationClip& clip : model.clips) file.clips.push_back(std::move(clip.name));
  return file;
}

TriangleMesh load_any_mesh(const std::filesystem::path& path) {
  return read_mesh_file(path).mesh;
}

}  // namespace supple
