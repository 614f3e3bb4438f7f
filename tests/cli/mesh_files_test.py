"""Tests the mesh files that the library reads itself, as the program sees them, and what it says about others."""

import gzip
import unittest
import zipfile

from program import ProgramTest, obj

MODEL = """<?xml version="1.0" encoding="UTF-8"?>
<model unit="millimeter" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"><resources>
<object id="1" type="model"><mesh><vertices><vertex x="0" y="0" z="0"/><vertex x="1" y="0" z="0"/>
<vertex x="0" y="1" z="0"/><vertex x="0" y="0" z="1"/></vertices><triangles><triangle v1="0" v2="2" v3="1"/>
<triangle v1="0" v2="1" v3="3"/><triangle v1="1" v2="2" v3="3"/><triangle v1="2" v2="0" v3="3"/></triangles></mesh>
</object></resources><build><item objectid="1"/></build></model>"""
TETRAHEDRON = """MeshVersionFormatted 1
Dimension 3
Vertices 4
0 0 0 0
1 0 0 0
0 1 0 0
0 0 1 0
Tetrahedra 1
1 2 3 4 0
End
"""


class MeshFiles(ProgramTest):
    def check_tetrahedron(self, name):
        (mesh,) = self.detect("--self", name)["objects"]
        self.assertEqual((mesh["vertices"], mesh["triangles"]), (4, 4))

    def test_archives_of_3mf(self):
        for force_zip64 in (False, True):
            for compression in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
                with zipfile.ZipFile(self.folder / "a.3mf", "w", compression) as archive:
                    with archive.open("3D/3dmodel.model", "w", force_zip64=force_zip64) as part:
                        part.write(MODEL.encode())
                    archive.writestr("Metadata/thumbnail.png", b"\x89PNG\r\n")
                self.check_tetrahedron("a.3mf")

    def test_volume_meshes(self):
        self.write("a.mesh", TETRAHEDRON)
        self.check_tetrahedron("a.mesh")
        self.write("b.node", "4 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n")
        self.write("b.ele", "1 4 0\n1 1 2 3 4\n")
        self.check_tetrahedron("b.ele")

    def test_files_without_a_reader(self):
        self.assert_one_line_error(self.run_here("info", self.write("a.usda", "#usda 1.0\n")), "USD is not supported; export it as")
        self.assert_one_line_error(self.run_here("info", self.write("a.mesh", obj(((0, 0, 0), (1, 0, 0), (0, 1, 0)), ((0, 1, 2),)))),
                                   "its content is OBJ, ", "rename it to end in .obj")
        (self.folder / "a.obj").write_bytes(gzip.compress(b"v 0 0 0\n"))
        self.assert_one_line_error(self.run_here("info", "a.obj"), "its content is a compressed file, ")


if __name__ == "__main__":
    unittest.main()
