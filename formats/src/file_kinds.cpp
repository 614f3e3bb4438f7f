#include "file_kinds.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <initializer_list>
#include <iterator>

#include "core/error.hpp"
#include "core/quotes.hpp"
#include "files/file_access.hpp"
#include "files/text_scanner.hpp"

namespace supple {
namespace {

// What to do with files that no reader supports.
constexpr std::string_view from_modellers = "export it as glTF (.glb), FBX, OBJ or PLY";
constexpr std::string_view from_animation = "export it as glTF (.glb) or FBX, or each frame as OBJ or PLY";
constexpr std::string_view from_cad = "export its tessellated surface as 3MF, STL, OBJ or PLY";
// Only for what meshio reads. It takes .msh for a file of Fluent unless an option names the format.
constexpr std::string_view from_meshio =
    "convert it to VTK's format, for example by: meshio convert FILE out.vtu";
constexpr std::string_view from_simulation =
    "export it as VTK (.vtu or .vtk) or as Gmsh's .msh from the program that made it";
constexpr std::string_view from_fluent =
    "convert it by: meshio convert FILE out.vtu; for Gmsh's .msh, add --output-format gmsh";
constexpr std::string_view from_vtk =
    "save its data as .vtu or .vtp, or as legacy .vtk (in ParaView: Save Data)";
constexpr std::string_view from_points =
    "it has points but no triangles; reconstruct a surface and save it as PLY";
constexpr std::string_view from_voxels = "extract a surface and save it as PLY";
constexpr std::string_view from_archives = "unpack it, and give the mesh file inside";

struct Unsupported {
  std::string_view extension, name, advice;
};
constexpr Unsupported unsupported[] = {
    {".abc", "Alembic", from_animation},
    {".usd", "USD", from_animation},
    {".usda", "USD", from_animation},
    {".usdc", "USD", from_animation},
    {".usdz", "USD", from_animation},
    {".blend", "this version of Blender's files", from_animation},
    {".max", "a 3ds Max scene", from_animation},
    {".ma", "a Maya scene", from_animation},
    {".mb", "a Maya scene", from_animation},
    {".c4d", "a Cinema 4D scene", from_animation},
    {".hip", "a Houdini scene", from_animation},
    {".hiplc", "a Houdini scene", from_animation},
    {".bgeo", "Houdini's geometry", from_animation},
    {".vrm", "VRM", from_animation},
    {".skp", "a SketchUp model", from_modellers},
    {".3dm", "a Rhino model", from_modellers},
    {".ztl", "a ZBrush tool", from_modellers},
    {".wrl", "VRML", from_modellers},
    {".vrml", "VRML", from_modellers},
    {".u3d", "U3D", from_modellers},
    {".drc", "Draco", from_modellers},
    {".ctm", "OpenCTM", from_modellers},
    {".pdf", "PDF", from_modellers},
    {".dwg", "an AutoCAD drawing", from_cad},
    {".step", "STEP", from_cad},
    {".stp", "STEP", from_cad},
    {".iges", "IGES", from_cad},
    {".igs", "IGES", from_cad},
    {".brep", "BREP", from_cad},
    {".fcstd", "a FreeCAD document", from_cad},
    {".f3d", "a Fusion 360 design", from_cad},
    {".sldprt", "a SolidWorks part", from_cad},
    {".sldasm", "a SolidWorks assembly", from_cad},
    {".ipt", "an Inventor part", from_cad},
    {".iam", "an Inventor assembly", from_cad},
    {".prt", "a CAD part (NX or Creo)", from_cad},
    {".catpart", "a CATIA part", from_cad},
    {".catproduct", "a CATIA product", from_cad},
    {".x_t", "Parasolid", from_cad},
    {".x_b", "Parasolid", from_cad},
    {".sat", "ACIS", from_cad},
    {".jt", "JT", from_cad},
    {".scad", "an OpenSCAD program", from_cad},
    {".vtm", "a list of VTK's files", from_vtk},
    {".pvd", "a list of VTK's files", from_vtk},
    {".pvtu", "a list of VTK's files", from_vtk},
    {".pvtp", "a list of VTK's files", from_vtk},
    {".vts", "a structured grid of VTK", from_vtk},
    {".vtr", "a structured grid of VTK", from_vtk},
    {".vtkhdf", "VTK's HDF5 format", from_vtk},
    {".vti", "an image of VTK", from_voxels},
    {".vdb", "OpenVDB", from_voxels},
    {".nrrd", "an image of voxels", from_voxels},
    {".nii", "an image of voxels", from_voxels},
    {".mha", "an image of voxels", from_voxels},
    {".xdmf", "XDMF", from_meshio},
    {".xmf", "XDMF", from_meshio},
    {".exo", "Exodus", from_meshio},
    {".e", "Exodus", from_meshio},
    {".cgns", "CGNS", from_meshio},
    {".med", "MED of Salome", from_meshio},
    {".unv", "I-deas UNV", from_simulation},
    {".inp", "an Abaqus model", from_meshio},
    {".bdf", "Nastran", from_meshio},
    {".nas", "Nastran", from_meshio},
    {".fem", "Nastran", from_meshio},
    {".k", "an LS-DYNA model", from_simulation},
    {".key", "an LS-DYNA model", from_simulation},
    {".cdb", "an Ansys model", from_simulation},
    {".feb", "a FEBio model", from_simulation},
    {".su2", "SU2", from_meshio},
    {".ugrid", "UGRID", from_meshio},
    {".vol", "a Netgen mesh", from_meshio},
    {".poly", "an input of TetGen", "give the .node file of TetGen's output"},
    {".smesh", "an input of TetGen", "give the .node file of TetGen's output"},
    {".edge", "TetGen's list of edges", "give the .node file, next to its .ele and .face files"},
    {".neigh", "TetGen's list of neighbours", "give the .node file, next to its .ele and .face files"},
    {".pcd", "a point cloud", from_points},
    {".xyz", "a point cloud", from_points},
    {".pts", "a point cloud", from_points},
    {".las", "a point cloud", from_points},
    {".laz", "a point cloud", from_points},
    {".e57", "a point cloud", from_points},
    {".gz", "a compressed file", from_archives},
    {".bz2", "a compressed file", from_archives},
    {".xz", "a compressed file", from_archives},
    {".zst", "a compressed file", from_archives},
    {".zip", "an archive", from_archives},
    {".7z", "an archive", from_archives},
    {".rar", "an archive", from_archives},
    {".tar", "an archive", from_archives},
    {".tgz", "an archive", from_archives},
    {".mtl", "a list of OBJ's materials", "give the .obj file"},
    {".bin", "the buffer of a glTF file", "give the .gltf file"},
};

/// A format that the first bytes of a file show. `extensions` are those of files with this content, the usual
/// one first; without any, no reader supports it. Without advice, the file only needs another extension.
struct Kind {
  std::string_view name;
  bool (*matches)(std::string_view start);
  std::array<std::string_view, 5> extensions;
  std::string_view advice;
};

bool starts_with_word(std::string_view start, std::initializer_list<std::string_view> words) {
  return std::ranges::any_of(words, [&](std::string_view word) {
    return start.starts_with(word) && start.size() > word.size() && start[word.size()] <= ' ';
  });
}

// Whether it is XML whose first element has this name, in lower case.
bool is_xml(std::string_view start, std::string_view element) {
  start.remove_prefix(std::min(start.find_first_not_of("\xEF\xBB\xBF \t\r\n"), start.size()));
  for (std::size_t tag = start.starts_with('<') ? 0 : std::string_view::npos; tag != std::string_view::npos;
       tag = start.find('<', tag + 1)) {
    const std::string_view rest = start.substr(tag + 1);
    if (rest.starts_with('?') || rest.starts_with('!')) continue;
    const auto same = [](char a, char b) { return (a | ' ') == (b | ' '); };
    return rest.size() > element.size() && std::equal(element.begin(), element.end(), rest.begin(), same) &&
           std::string_view(" \t\r\n>/").find(rest[element.size()]) != std::string_view::npos;
  }
  return false;
}

// OFF with letters for what its vertices have.
bool is_off(std::string_view start) {
  const std::size_t keyword = start.find_first_not_of("STCN4n");
  return keyword <= 6 && starts_with_word(start.substr(keyword), {"OFF"});
}

// Whether a line has a vertex and all lines before it have words of OBJ.
bool is_obj(std::string_view start) {
  if (is_utf16(start)) return false;
  TextScanner scanner(start, "", {.hash_comments = true});
  while (scanner.skip_to_word()) {
    const std::string_view word = scanner.word();
    if (word == "v") {
      std::string_view rest = start.substr(scanner.offset());
      rest = rest.substr(0, rest.find_first_of("\r\n"));
      return rest.find_first_not_of("0123456789+-.eE \t") == std::string_view::npos &&
             std::ranges::count_if(rest, [](char c) { return c >= '0' && c <= '9'; }) >= 3;
    }
    if (word != "vt" && word != "vn" && word != "o" && word != "g" && word != "s" && word != "mtllib" &&
        word != "usemtl")
      return false;
    scanner.skip_line();
  }
  return false;
}

// IFC, which Assimp reads, has the syntax of STEP; its header names the schema.
bool is_cad_step(std::string_view start) {
  const std::size_t schema = start.find("FILE_SCHEMA");
  return start.starts_with("ISO-10303-21") && schema != std::string_view::npos &&
         start.substr(schema, 60).find("IFC") == std::string_view::npos;
}

constexpr Kind kinds[] = {
    {"a pointer of Git LFS",
     [](std::string_view s) { return s.starts_with("version https://git-lfs"); },
     {},
     "fetch the file itself with 'git lfs pull'"},
    {"a page of HTML",
     [](std::string_view s) { return s.substr(0, 15) == "<!DOCTYPE html>" || is_xml(s, "html"); },
     {},
     "download the file itself"},
    {"PLY", [](std::string_view s) { return starts_with_word(s, {"ply"}); }, {".ply"}, {}},
    {"OFF", is_off, {".off"}, {}},
    {"STL",
     [](std::string_view s) {
       return starts_with_word(s, {"solid"}) && s.find("facet") != std::string_view::npos;
     },
     {".stl"},
     {}},
    {"OBJ", is_obj, {".obj"}, {}},
    {"binary glTF", [](std::string_view s) { return s.starts_with("glTF"); }, {".glb", ".gltf"}, {}},
    {"FBX",
     [](std::string_view s) { return s.starts_with("Kaydara FBX Binary") || s.starts_with("; FBX "); },
     {".fbx"},
     {}},
    {"a Gmsh mesh",
     [](std::string_view s) {
       return starts_with_word(s, {"$MeshFormat", "$NOD"});
     },
     {".msh"},
     {}},
    {"legacy VTK", [](std::string_view s) { return s.starts_with("# vtk DataFile"); }, {".vtk"}, {}},
    {"a Medit mesh",
     [](std::string_view s) { return starts_with_word(s, {"MeshVersionFormatted"}); },
     {".mesh"},
     {}},
    {"an Ogre mesh", is_ogre_mesh, {".mesh"}, {}},
    {"COLLADA", [](std::string_view s) { return is_xml(s, "collada"); }, {".dae"}, {}},
    {"X3D", [](std::string_view s) { return is_xml(s, "x3d"); }, {".x3d", ".xml"}, {}},
    {"AMF", [](std::string_view s) { return is_xml(s, "amf"); }, {".amf"}, {}},
    {"VTK's XML format",
     [](std::string_view s) { return is_xml(s, "vtkfile"); },
     {".vtu", ".vtp"},
     "give its name the extension of its type, .vtu or .vtp"},
    {"a FEBio model", [](std::string_view s) { return is_xml(s, "febio_spec"); }, {}, from_simulation},
    {"XDMF", [](std::string_view s) { return is_xml(s, "xdmf"); }, {}, from_meshio},
    {"an MFEM mesh", [](std::string_view s) { return s.starts_with("MFEM "); }, {".mesh"}, {}},
    {"a mesh of ANSYS Fluent",
     [](std::string_view s) {
       return s.starts_with("(0 \"") || s.starts_with("(1 \"") || s.starts_with("(2 3)") ||
              s.starts_with("(2 2)");
     },
     {},
     from_fluent},
    {"a Netgen mesh", [](std::string_view s) { return starts_with_word(s, {"mesh3d"}); }, {}, from_meshio},
    {"VRML", [](std::string_view s) { return s.starts_with("#VRML"); }, {}, from_modellers},
    {"a Blender file", [](std::string_view s) { return s.starts_with("BLENDER"); }, {".blend"}, {}},
    {"STEP", is_cad_step, {}, from_cad},
    {"IFC", [](std::string_view s) { return s.starts_with("ISO-10303-21"); }, {".ifc", ".step", ".stp"}, {}},
    {"Alembic", [](std::string_view s) { return s.starts_with("Ogawa"); }, {}, from_animation},
    {"USD",
     [](std::string_view s) { return s.starts_with("PXR-USDC") || s.starts_with("#usda"); },
     {},
     from_animation},
    {"an HDF5 file", [](std::string_view s) { return s.starts_with("\x89HDF\r\n"); }, {}, from_simulation},
    {"a PDF", [](std::string_view s) { return s.starts_with("%PDF-"); }, {}, from_modellers},
    {"an image",
     [](std::string_view s) { return s.starts_with("\x89PNG") || s.starts_with("\xFF\xD8\xFF"); },
     {},
     "give a mesh file"},
    {"a zip archive",
     [](std::string_view s) { return s.starts_with("PK\x03\x04"); },
     {".3mf", ".amf", ".zae", ".ifczip", ".pk3"},
     from_archives},
    {"a compressed file",
     [](std::string_view s) {
       return s.starts_with("\x1F\x8B") || s.starts_with("BZh9") ||
              s.starts_with(
                  "\xFD"
                  "7zXZ") ||
              s.starts_with("\x28\xB5\x2F\xFD");
     },
     {".blend", ".zgl", ".x3db"},
     from_archives},
};

const Kind* kind_of(std::string_view start) {
  std::string narrow;
  if (is_utf16(start)) {
    std::ranges::copy_if(start.substr(2), std::back_inserter(narrow), [](char c) { return c != '\0'; });
    start = narrow;
  }
  const auto kind =
      std::ranges::find_if(kinds, [&](const Kind& candidate) { return candidate.matches(start); });
  return kind == std::end(kinds) ? nullptr : &*kind;
}

// A binary STL file begins with 80 bytes that may be anything, and then tells its size.
bool is_binary_stl(const std::filesystem::path& path, std::string_view start) {
  if (start.size() < 84) return false;
  std::uint64_t triangles = 0;
  for (std::size_t i = 84; i-- > 80;) triangles = triangles << 8 | static_cast<unsigned char>(start[i]);
  std::error_code unknown;
  return std::filesystem::file_size(path, unknown) == 84 + 50 * triangles;
}

/// What a .geo file is, which programs of three kinds write.
std::string advice_on_geo(std::string_view start) {
  TextScanner scanner(is_utf16(start) ? std::string_view{} : start, "", {.hash_comments = true});
  scanner.skip_to_word();
  const std::string_view word = scanner.word();
  if (word == "algebraic3d" || word == "algebraic2d" || word.starts_with("splinecurves"))
    return "a geometry of Netgen is not supported; mesh it in Netgen, and export it in Gmsh's format, as "
           ".msh";
  if (word == "PGEOMETRY" || word.starts_with('[') || word.starts_with("\x7fNSJb"))
    return "Houdini's geometry is not supported; " + std::string(from_animation);
  return "a script of Gmsh is not a mesh; mesh it by: gmsh -3 FILE.geo -o out.msh, and give the .msh file";
}

}  // namespace

bool is_ogre_mesh(std::string_view start) {
  return start.substr(0, 40).find("[MeshSerializer_v") == 2;
}

std::string read_start(const std::filesystem::path& path) {
  std::error_code unknown;
  if (!std::filesystem::is_regular_file(path, unknown)) return {};
  std::string start(4096, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(start.data(), static_cast<std::streamsize>(start.size()));
  start.resize(static_cast<std::size_t>(file.gcount()));
  return start;
}

void check_kind(const std::filesystem::path& path, std::string_view start) {
  const Kind* kind = kind_of(start);
  if (kind == nullptr) return;
  const std::string extension = lower_case_extension(path);
  if (!extension.empty() && std::ranges::find(kind->extensions, extension) != kind->extensions.end()) return;
  if (extension == ".stl" && is_binary_stl(path, start)) return;
  // Blender compresses its files in a way that Assimp does not read.
  if (extension == ".blend" && kind->name == "a compressed file") fail_unsupported(path, {});
  const bool is_supported = !kind->extensions[0].empty();
  fail("cannot read " + shown(path) + ": its content is " + std::string(kind->name) +
       (is_supported ? ", which the extension " + in_quotes(extension) + " does not say; "
                     : ", which is not supported; ") +
       (kind->advice.empty() ? "rename it to end in " + std::string(kind->extensions[0])
                             : std::string(kind->advice)));
}

std::string advice_on_extension(std::string_view extension) {
  for (const Unsupported& format : unsupported) {
    if (format.extension == extension)
      return std::string(format.name) + " is not supported; " + std::string(format.advice);
  }
  return {};
}

void fail_unsupported(const std::filesystem::path& path, std::string_view start) {
  const std::string extension = lower_case_extension(path);
  const std::string problem = "cannot read " + shown(path) + ": ";
  // A pointer or a page may have any name.
  const Kind* kind = kind_of(start);
  if (kind == &kinds[0] || kind == &kinds[1]) check_kind(path, start);
  if (extension == ".geo") fail(problem + advice_on_geo(start));
  if (const std::string advice = advice_on_extension(extension); !advice.empty()) fail(problem + advice);
  check_kind(path, start);
  fail(problem +
       (extension.empty() ? "the file has no extension" : "unknown extension " + in_quotes(extension)) +
       "; .obj, .off, .ply, .stl, .gltf, .glb, .fbx, .dae, .3ds, .3mf, .msh, .vtk and more are supported");
}

}  // namespace supple
