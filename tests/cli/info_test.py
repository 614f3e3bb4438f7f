"""Tests `supple info`: the properties of a mesh as text and as JSON."""

import json
import unittest

from program import TRIANGLE, ProgramTest


NO_POLYGONS = {"quads": 0, "larger": 0, "concave": 0, "crossing": 0, "bent": 0}


class Info(ProgramTest):
    maxDiff = None

    def info(self, *arguments):
        done = self.run_here("info", *arguments, "--json", "-")
        self.assertEqual((done.status, done.error), (0, ""))
        return json.loads(done.out)["objects"]

    def test_open_mesh_with_blemishes(self):
        self.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 5 5\nv nan 0 0\nf 1 2 3\nf 1 1 2\n")
        (mesh,) = self.info("a.obj")
        octree = mesh.pop("octree")
        self.assertEqual(
            mesh,
            {
                "name": "a", "vertices": 5, "triangles": 2, "edges": 3, "polygons": NO_POLYGONS, "lines": 0, "points": 0, "closed": False, "boundary_edges": 3, "odd_edges": 3, "open_at_seams": False, "inward_triangles": 0,
                "non_manifold_edges": 0, "components": 1, "euler_characteristic": 1, "unused_vertices": 2,
                "degenerate_triangles": 1, "non_finite_vertices": 1, "bounds": [[0.0, 0.0, 0.0], [5.0, 5.0, 5.0]],
            },
        )
        self.assertEqual(
            set(octree),
            {"nodes", "leaves", "depth", "largest_leaf", "mean_leaf_size", "mean_node_width", "bytes",
             "bytes_per_triangle", "leaves_by_level", "cost", "degradation", "rebuilds",
             "triangles", "vertices"},
        )

    def test_lines_and_points(self):
        self.write("rod.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 0 0\nl 1 2 3\np 4 1\n")
        (mesh,) = self.info("rod.obj")
        self.assertEqual((mesh["triangles"], mesh["edges"], mesh["lines"], mesh["points"]), (0, 0, 2, 2))
        self.assertIn("\n  lines        2 edges, and 2 points\n", self.run_here("info", "rod.obj").out)

    def test_polygons(self):
        corners = "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 1\nv 1 1 0\nv 0 4 0\n"
        self.write("a.obj", corners + "f 1 2 3\nf 1 2 3 6\nf 1 2 3 4\nf 1 2 5 6\nf 1 3 2 6\nf 1 2 3 6 5\n")
        (mesh,) = self.info("a.obj")
        self.assertEqual(mesh["polygons"], {"quads": 4, "larger": 1, "concave": 2, "crossing": 1, "bent": 1})
        self.assertEqual(mesh["triangles"], 12)
        text = "\n  polygons     4 quads, 1 of more than 4 corners, 2 concave, 1 crosses itself, 1 not flat\n"
        self.assertIn(text, self.run_here("info", "a.obj").out)

    def test_files_that_make_assimp_crash(self):
        self.write("a.lws", "}abcdefg")  # a null pointer
        done = self.run_here("info", "a.lws")
        self.assertEqual((done.status, done.out), (2, ""))
        self.assertRegex(done.error, r"\Asupple: a.lws: Assimp, the library that reads this format, crashed. The file may be fine;.*\n\Z")

    def test_inside_out(self):
        self.write("in.toml", '[[object]]\nmodel = "box"\n[[object]]\nmodel = "box"\nscale = -1\n')
        self.assertEqual([mesh["inward_triangles"] for mesh in self.info("in.toml")], [0, 0])
        self.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 4 2\nf 2 4 3\nf 3 4 1\n")
        (mesh,) = self.info("a.obj")
        self.assertEqual((mesh["closed"], mesh["inward_triangles"]), (True, 4))
        self.assertIn("\n               4 triangles face inwards; a solid takes them as if they faced outwards\n", self.run_here("info", "a.obj").out)

    def test_scene_file(self):
        self.write("scene.toml", '[[object]]\nname = "ring"\nmodel = "torus"\ntranslate = [1, 0, 0]\n[[object]]\nmodel = "box"\n')
        ring, box = self.info("scene.toml")
        self.assertEqual((ring["name"], ring["closed"], ring["euler_characteristic"]), ("ring", True, 0))
        self.assertEqual((box["name"], box["closed"], box["euler_characteristic"]), ("box", True, 2))
        self.assertAlmostEqual(ring["bounds"][1][0], 1.7)

    def test_octree_options(self):
        self.write("scene.toml", '[[object]]\nmodel = "icosphere"\n')
        shallow = self.info("scene.toml", "--max-level", "2")[0]["octree"]
        small_leaves = self.info("scene.toml", "--leaf-size", "1")[0]["octree"]
        large_leaves = self.info("scene.toml", "--leaf-size", "64")[0]["octree"]
        self.assertLessEqual(shallow["depth"], 2)
        self.assertGreater(small_leaves["leaves"], large_leaves["leaves"])
        self.assertLessEqual(large_leaves["largest_leaf"], 64)
        self.assertEqual(sum(large_leaves["leaves_by_level"]), large_leaves["leaves"])

    def test_bounding_volume(self):
        self.write("scene.toml", '[[object]]\nmodel = "rabbit"\n')
        boxes = self.info("scene.toml")[0]["octree"]
        spheres = self.info("scene.toml", "--bounding-volume", "sphere")[0]["octree"]
        fitted = self.info("scene.toml", "--bounding-volume", "sphere", "--sphere-fit", "box")[0]["octree"]
        self.assertGreater(spheres["bytes"], boxes["bytes"])
        self.assertEqual(spheres["nodes"], boxes["nodes"])
        self.assertEqual(len({boxes["cost"], spheres["cost"], fitted["cost"]}), 3)
        refused = self.run_here("info", "scene.toml", "--sphere-fit", "box")
        self.assertEqual(refused.status, 2)
        self.assertIn("--bounding-volume sphere", refused.error)

    def test_object_octree(self):
        self.write("scene.toml", '[[object]]\nmodel = "human"\nobject_octree = "bottom_up"\n')
        builds = {build: self.info("scene.toml", "--object-octree", build)[0]["octree"] for build in ("balanced", "regular", "bottom-up")}
        self.assertEqual(len({octree["leaves"] for octree in builds.values()}), 3)
        for octree in builds.values():
            self.assertEqual(octree["triangles"], 2500)
            self.assertLessEqual(octree["largest_leaf"], 64)
        self.assertEqual(self.info("scene.toml")[0]["octree"], builds["bottom-up"])
        halves = self.info("scene.toml", "--tree-arity", "2")[0]["octree"]
        self.assertEqual(halves["mean_node_width"], 2)
        self.assertEqual(halves["leaves"], builds["bottom-up"]["leaves"])
        self.assertLessEqual(self.info("scene.toml", "--max-level", "1", "--leaf-size", "1")[0]["octree"]["depth"], 1)
        self.assert_one_line_error(self.run_here("info", "scene.toml", "--object-octree", "upward"), "--object-octree", "bottom-up")

    def test_sphere_fit(self):
        self.write("scene.toml", '[[object]]\nmodel = "human"\n')
        def cost(fit):
            return self.info("scene.toml", "--bounding-volume", "sphere", "--sphere-fit", fit)[0]["octree"]["cost"]
        self.assertLess(cost("minimal"), cost("medial"))
        self.assertLess(cost("medial"), cost("vertices"))

    def test_text(self):
        self.write("a.obj", TRIANGLE)
        done = self.run_here("info", "a.obj")
        self.assertEqual((done.status, done.error), (0, ""))
        for part in ("a\n", "vertices     3", "triangles    1", "open, 3 boundary edges", "(0, 0, 0) to (1, 1, 0)"):
            self.assertIn(part, done.out)

    def test_mesh_of_nothing(self):
        self.write("points.obj", "v 0 0 0\n")
        (mesh,) = self.info("points.obj")
        self.assertEqual((mesh["triangles"], mesh["closed"], mesh["bounds"]), (0, False, [[0.0] * 3, [0.0] * 3]))
        done = self.run_here("info", "points.obj")
        self.assertIn("no triangles", done.out)

    def test_no_finite_vertex(self):
        self.write("nan.obj", "v nan 0 0\nv 0 inf 0\nv 0 0 nan\nf 1 2 3\n")
        (mesh,) = self.info("nan.obj")
        self.assertIsNone(mesh["bounds"])
        self.assertEqual(mesh["non_finite_vertices"], 3)


if __name__ == "__main__":
    unittest.main()
