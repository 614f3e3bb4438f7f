#include <gtest/gtest.h>

#include <string>

#include "supple/formats.hpp"
#include "unit/files/mesh_files.hpp"

namespace supple::file_kinds_test {

TEST(FileKinds, ExtensionsWithoutAReader) {
  EXPECT_EQ(error_of([] { load_any_mesh("a.abc"); }),
            "cannot read a.abc: Alembic is not supported; export it as glTF (.glb) or FBX, or each frame as "
            "OBJ or PLY");
  EXPECT_EQ(
      error_of([] { load_any_mesh("a.PVTU"); }),
      "cannot read a.PVTU: a list of VTK's files is not supported; save its data as .vtu or .vtp, or as "
      "legacy .vtk (in ParaView: Save Data)");
  // meshio reads one of these, and writes another format than Gmsh's to .msh.
  EXPECT_EQ(
      error_of([] { load_any_mesh("a.inp"); }),
      "cannot read a.inp: an Abaqus model is not supported; convert it to VTK's format, for example by: "
      "meshio convert FILE out.vtu");
  EXPECT_EQ(error_of([] { load_any_mesh("a.feb"); }),
            "cannot read a.feb: a FEBio model is not supported; export it as VTK (.vtu or .vtk) or as Gmsh's "
            ".msh from the program that made it");
  for (const char* name : {"a.usdz", "a.iges", "a.max", "a.ma", "a.mb", "a.c4d", "a.skp", "a.dwg", "a.inp",
                           "a.vdb", "a.pcd", "a.obj.gz"}) {
    const std::string message = error_of([&] { load_any_mesh(name); });
    EXPECT_NE(message.find(" is not supported; "), std::string::npos) << message;
  }
}

struct Content {
  const char* name;
  std::string bytes;
  const char* says;
};

TEST(FileKinds, TheContentTellsAnotherFormat) {
  const TemporaryFolder folder;
  const std::string obj = "# Blender\nmtllib a.mtl\no Cube\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  const Content contents[] = {
      {"a", obj, ": its content is OBJ, which the extension '' does not say; rename it to end in .obj"},
      {"a.data", obj,
       ": its content is OBJ, which the extension '.data' does not say; rename it to end in .obj"},
      {"a.mesh", obj,
       ": its content is OBJ, which the extension '.mesh' does not say; rename it to end in .obj"},
      {"a.fbx", obj,
       ": its content is OBJ, which the extension '.fbx' does not say; rename it to end in .obj"},
      {"a.obj", "ply\nformat ascii 1.0\n",
       ": its content is PLY, which the extension '.obj' does not say; rename it to end in .ply"},
      {"a.ply", "solid a\n facet normal 0 0 1\n",
       ": its content is STL, which the extension '.ply' does not say; rename it to end in .stl"},
      {"b.obj", "version https://git-lfs.github.com/spec/v1\noid sha256:0\n",
       ": its content is a pointer of Git LFS, which is not supported; fetch the file itself with 'git lfs "
       "pull'"},
      {"b.glb", "<!DOCTYPE html>\n<html>",
       ": its content is a page of HTML, which is not supported; download the file itself"},
      {"c.obj", "\x1F\x8B\x08",
       ": its content is a compressed file, which the extension '.obj' does not say; unpack it, and give the "
       "mesh file inside"},
      {"d.msh", "(0 \"Fluent\")\n(2 3)\n",
       ": its content is a mesh of ANSYS Fluent, which is not supported; convert it by: meshio convert FILE "
       "out.vtu; for Gmsh's .msh, add --output-format gmsh"},
      {"e.msh", "(1 \"meshio 5.3.5\")\n(2 3)\n",
       ": its content is a mesh of ANSYS Fluent, which is not supported; convert it by"},
      {"d.data", "MFEM mesh v1.0\n",
       ": its content is an MFEM mesh, which the extension '.data' does not say; rename it to end in .mesh"},
      {"d.vtk", "<?xml version=\"1.0\"?>\n<!-- x -->\n<VTKFile type=\"PolyData\">",
       ": its content is VTK's XML format, which the extension '.vtk' does not say; give its name"},
      {"b.abc", "version https://git-lfs.github.com/spec/v1\noid sha256:0\n",
       ": its content is a pointer of Git LFS, which is not supported; fetch"},
      {"b.geo", "version https://git-lfs.github.com/spec/v1\noid sha256:0\n",
       ": its content is a pointer of Git LFS, which is not supported; fetch"},
      {"c.geo", "// Gmsh\nPoint(1) = {0, 0, 0, 1};\n",
       ": a script of Gmsh is not a mesh; mesh it by: gmsh -3 FILE.geo"},
      {"d.geo", "# a cube\nalgebraic3d\nsolid a = sphere (0, 0, 0; 1);\n",
       ": a geometry of Netgen is not supported; mesh it in Netgen"},
      {"e.geo", "PGEOMETRY V5\n", ": Houdini's geometry is not supported; export it as glTF"},
      {"f.geo", "[\n\"fileversion\",\"18.0\",\n", ": Houdini's geometry is not supported; export it as glTF"},
      {"e.ply", "NCOFF\n3 1 0\n",
       ": its content is OFF, which the extension '.ply' does not say; rename it to end in .off"},
      {"f.obj", std::string("\xFF\xFE<\0?\0x\0m\0l\0?\0>\0<\0a\0m\0f\0>\0", 26),
       ": its content is AMF, which the extension '.obj' does not say; rename it to end in .amf"},
      {"a.step", "ISO-10303-21;\nHEADER;\nFILE_SCHEMA (('AUTOMOTIVE_DESIGN'));\n",
       ": its content is STEP, which is not supported; export its tessellated surface as"},
      {"d.xyz1", "PXR-USDC", ": its content is USD, which is not supported; export it"},
  };
  for (const Content& content : contents) {
    const std::string path = folder.write(content.name, content.bytes);
    const std::string message = error_of([&] { load_any_mesh(path); });
    EXPECT_TRUE(message.starts_with("cannot read " + path + content.says)) << message;
  }
  EXPECT_EQ(error_of([] { load_any_mesh("nothing"); }),
            "cannot read nothing: the file has no extension; .obj, .off, .ply, .stl, .gltf, .glb, .fbx, "
            ".dae, .3ds, .3mf, .msh, "
            ".vtk and more are supported");
}

TEST(FileKinds, BlenderFilesThatAssimpDoesNotRead) {
  const TemporaryFolder folder;
  for (const std::string& bytes : {std::string("BLENDER-v402"), std::string("\x28\xB5\x2F\xFD")}) {
    const std::string path = folder.write("a.blend", bytes);
    const std::string message = error_of([&] { load_any_mesh(path); });
    EXPECT_TRUE(
        message.starts_with("cannot read " + path +
                            ": this version of Blender's files is not supported; export it as glTF (.glb) or "
                            "FBX, or each frame as OBJ or PLY"))
        << message;
  }
}

// The first 80 bytes of a binary STL file may be anything.
TEST(FileKinds, BinaryStlMayBeginLikeAnotherFormat) {
  const TemporaryFolder folder;
  std::string bytes = "ply is what this was made from";
  bytes.resize(80, ' ');
  bytes.append("\1\0\0\0", 4).append(50, '\0');
  EXPECT_EQ(load_any_mesh(folder.write("a.stl", bytes)).triangles.size(), 1u);
}

TEST(FileKinds, MeditAndOgreShareAnExtension) {
  const TemporaryFolder folder;
  const auto medit = folder.write("a.mesh",
                                  "MeshVersionFormatted 2\nDimension 3\nVertices 3\n0 0 0 0\n1 0 0 0\n0 1 0 "
                                  "0\nTriangles 1\n1 2 3 0\nEnd\n");
  EXPECT_FALSE(is_read_by_assimp(medit));
  EXPECT_EQ(load_any_mesh(medit).triangles.size(), 1u);
  const auto ogre = folder.write("b.mesh", std::string("\x00\x10[MeshSerializer_v1.8]\n", 24));
  EXPECT_TRUE(is_read_by_assimp(ogre));
  EXPECT_FALSE(is_read_by_assimp("missing.mesh"));
}

}  // namespace supple::file_kinds_test
