#include "own_formats.hpp"

#include <algorithm>
#include <array>
#include <string>

#include "core/error.hpp"
#include "file_kinds.hpp"
#include "files/file_access.hpp"
#include "readers.hpp"

namespace supple {
namespace {

constexpr std::array<std::string_view, 11> extensions = {".3mf", ".amf",  ".ele", ".face", ".mesh", ".meshb",
                                                         ".msh", ".node", ".vtk", ".vtp",  ".vtu"};

// The files of TetGen have one name and several extensions.
TriangleMesh read_tetgen_files(const std::filesystem::path& given) {
  struct Part {
    std::string bytes, name;
    TetgenFile file() const { return {bytes, name}; }
  };
  const auto read_part = [&](const char* extension, bool must_exist) {
    const bool is_given = lower_case_extension(given) == extension;
    std::filesystem::path path = given;
    if (!is_given) path.replace_extension(extension);
    std::error_code unknown;
    if (!must_exist && !is_given && !std::filesystem::exists(path, unknown)) return Part{};
    return Part{read_file(path), shown(path)};
  };
  const Part elements = read_part(".ele", false);
  const Part faces = read_part(".face", false);
  const Part nodes = read_part(".node", true);
  if (elements.name.empty() && faces.name.empty())
    fail(nodes.name + ": there is neither an .ele nor a .face file of this name next to it; add one of them");
  return read_tetgen(nodes.file(), elements.file(), faces.file());
}

}  // namespace

std::span<const std::string_view> own_extensions() {
  return extensions;
}

bool has_own_reader(const std::filesystem::path& path) {
  const std::string extension = lower_case_extension(path);
  if (std::ranges::find(extensions, extension) == extensions.end()) return false;
  return extension != ".mesh" || !is_ogre_mesh(read_start(path));
}

MeshFile read_own_format(const std::filesystem::path& path) {
  const std::string extension = lower_case_extension(path);
  if (extension == ".node" || extension == ".ele" || extension == ".face") return {read_tetgen_files(path)};
  const std::string bytes = read_file(path);
  const std::string file = shown(path);
  if (extension == ".3mf") return read_3mf(bytes, file);
  if (extension == ".amf") return read_amf(bytes, file);
  if (extension == ".vtu" || extension == ".vtp") return {read_vtk_xml(bytes, file)};
  if (extension == ".mesh" && bytes.starts_with("MFEM ")) return {read_mfem(bytes, file)};
  if (extension == ".msh") return {read_gmsh(bytes, file)};
  if (extension == ".vtk") return {read_vtk(bytes, file)};
  return {extension == ".mesh" ? read_medit(bytes, file) : read_medit_binary(bytes, file)};
}

}  // namespace supple
