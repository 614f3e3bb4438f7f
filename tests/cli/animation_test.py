"""Tests files with animations, point caches, and the axes and units of files."""

import base64
import json
import struct
import unittest

from program import CROSSED, FLOOR, TRIANGLE, ProgramTest


def gltf(clips, points=((1.0, 1.0, 1.0), (1.25, 1.0, 5.0), (1.0, 1.25, 5.0))):
    """A triangle that moves along z: clips are (name, times, heights)."""
    data = b"".join(struct.pack("<3f", *p) for p in points)
    views = [(0, len(data))]
    accessors = [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}]
    animations = []
    for name, times, heights in clips:
        for kind, numbers in (("SCALAR", times), ("VEC3", [c for h in heights for c in (0.0, 0.0, h)])):
            packed = struct.pack(f"<{len(numbers)}f", *numbers)
            views.append((len(data), len(packed)))
            data += packed
            accessors.append({"bufferView": len(views) - 1, "componentType": 5126, "count": len(times), "type": kind})
        sampler = {"input": len(accessors) - 2, "output": len(accessors) - 1}
        animations.append({"name": name, "samplers": [sampler],
                           "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]})
    return json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "accessors": accessors,
        "bufferViews": [{"buffer": 0, "byteOffset": begin, "byteLength": size} for begin, size in views],
        "buffers": [{"byteLength": len(data), "uri": "data:;base64," + base64.b64encode(data).decode()}],
        **({"animations": animations} if animations else {}),
    })


# It falls through the floor at 3/4 of the first clip, and never in the second.
FALL = [("fall", [0.0, 1.0], [0.0, -4 / 3]), ("rise", [0.0, 2.0], [0.0, 1.0])]


class Animation(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("floor.obj", FLOOR)
        self.write("fall.gltf", gltf(FALL))

    def frames(self, *arguments):
        done = self.run_here("detect", *arguments, "--json", "-")
        self.assertEqual(done.status, 0, done.error)
        return json.loads(done.out)["frames"], done.error

    def test_frames_divide_the_clip(self):
        frames, note = self.frames("fall.gltf", "floor.obj", "--frames", "9")
        self.assertEqual([bool(frame["triangle_pairs"]) for frame in frames], [False] * 6 + [True] * 3)
        self.assertEqual(note, "supple: note: fall.gltf: plays 'fall', the first of 2 clips; --clip NAME chooses one of fall, rise\n")

    def test_the_rate(self):
        frames, note = self.frames("fall.gltf", "floor.obj", "--fps", "8", "--clip", "fall")
        self.assertEqual([bool(frame["triangle_pairs"]) for frame in frames], [False] * 6 + [True] * 3)
        self.assertEqual(note, "")
        self.assertEqual(len(self.frames("fall.gltf", "floor.obj", "--clip", "rise")[0]), 51)
        self.assertEqual(len(self.frames("fall.gltf", "floor.obj", "--clip", "rise", "--fps", "10", "--frames", "5")[0]), 5)

    def test_continuous(self):
        frames, _ = self.frames("fall.gltf", "floor.obj", "--frames", "2", "--contacts", "continuous", "--clip", "fall")
        (pair,) = frames[0]["continuous"]
        self.assertEqual(len(pair["vf"]), 1)
        self.assertAlmostEqual(pair["vf"][0][2], 0.75, delta=1e-5)

    def test_a_clip_that_does_not_play_is_named(self):
        frames, note = self.frames("fall.gltf", "floor.obj")
        self.assertEqual(len(frames), 1)
        self.assertEqual(note, "supple: note: fall.gltf: has 2 clips: fall, rise; --frames N plays one\n")

    def test_errors(self):
        for arguments, text in (
            (("fall.gltf", "--clip", "walk"), "fall.gltf: has no clip 'walk'; choose one of fall, rise"),
            (("floor.obj", "--clip", "walk"), "--clip: no file has an animation"),
            (("fall.gltf", "--clip", "fall", "--fps", "2", "--frames", "4"), "--frames: fall.gltf has 3 frames"),
            (("scene.toml", "--clip", "fall"), "--clip applies to mesh files only"),
        ):
            self.write("scene.toml", '[[object]]\nmesh = "fall.gltf"\n')
            done = self.run_here("detect", *arguments)
            self.assertEqual(done.status, 2, arguments)
            self.assertIn(text, done.error)

    def test_scene(self):
        self.write("scene.toml", '[scene]\ntime_step = 0.125\n[[object]]\nmesh = "floor.obj"\nstatic = true\n[[object]]\n'
                                 'mesh = "fall.gltf"\nmotion = { kind = "clip", clip = "fall", speed = 2, loop = true }\n')
        # At speed 2 the clip takes 4 steps; 3/4 of it are reached at step 3, and at step 4 it starts again.
        frames, _ = self.frames("scene.toml", "--frames", "8")
        touches = [bool(frame["triangle_pairs"]) for frame in frames]
        self.assertEqual(touches, [False, False, False, True, False, False, False, True])
        simulated = self.run_here("simulate", "scene.toml", "--frames", "8", "--json", "-", "--no-stats")
        self.assertEqual([bool(frame["triangle_pairs"]) for frame in json.loads(simulated.out)["frames"]], touches)
        self.write("bad.toml", '[[object]]\nmodel = "box"\nmotion = { kind = "clip" }\n')
        self.assertIn("needs mesh", self.run_here("detect", "bad.toml").error)

    def test_point_caches(self):
        points = [[(x, y, z - h) for x, y, z in ((1, 1, 1), (1.25, 1, 5), (1, 1.25, 5))] for h in (0, 0.5, 1.5)]
        numbers = [c for frame in points for p in frame for c in p]
        self.write("spike.obj", ([tuple(map(float, p)) for p in points[0]], [(0, 1, 2)]))
        (self.folder / "spike.pc2").write_bytes(b"POINTCACHE2\0" + struct.pack("<iiffi27f", 1, 3, 0, 1, 3, *numbers))
        (self.folder / "spike.mdd").write_bytes(struct.pack(">ii3f27f", 3, 3, 0, 1, 2, *numbers))
        both = '[[object]]\nmesh = "floor.obj"\n[[object]]\nmesh = "spike.obj"\nmotion = {{ kind = "cache", file = "{}" }}\n'
        for name in ("spike.pc2", "spike.mdd"):
            self.write("scene.toml", both.format(name))
            frames, _ = self.frames("scene.toml")
            self.assertEqual([bool(frame["triangle_pairs"]) for frame in frames], [False, False, True])
            frames, _ = self.frames("spike.obj", "--cache", name)
            self.assertEqual(len(frames), 3)
        self.write("two.obj", CROSSED)
        self.assertIn("spike.pc2: has 3 vertices, but the mesh has 6", self.run_here("detect", "two.obj", "--cache", "spike.pc2").error)


COLLADA = """<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="centimeter" meter="0.01"/><up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="s"><float_array id="a" count="9">0 0 5 1 0 5 0 1 5</float_array>
<technique_common><accessor source="#a" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#s"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="w"><node><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#w"/></scene>
</COLLADA>"""


class Coordinates(ProgramTest):
    def bounds(self, *arguments):
        done = self.run_here("info", *arguments, "--json", "-")
        self.assertEqual(done.status, 0, done.error)
        return json.loads(done.out)["objects"][0]["bounds"]

    def test_conversion(self):
        self.write("a.dae", COLLADA)
        self.assertEqual(self.bounds("a.dae"), [[0, 0, 5], [1, 1, 5]])
        self.assertEqual(self.bounds("a.dae", "--up", "y"), [[0, 5, -1], [1, 5, 0]])
        self.assertEqual(self.bounds("a.dae", "--unit", "mm"), [[0, 0, 50], [10, 10, 50]])
        self.write("scene.toml", '[[object]]\nmesh = "a.dae"\nup = "y"\nunit = "mm"\ntranslate = [1, 0, 0]\n')
        self.assertEqual(self.bounds("scene.toml"), [[1, 50, -10], [11, 50, 0]])

    def test_files_that_do_not_state_their_axes(self):
        self.write("a.obj", TRIANGLE)
        self.write("a.dae", COLLADA)
        self.assertIn("--up: no file states which axis points up", self.run_here("info", "a.obj", "--up", "z").error)
        self.assertIn("--unit: no file states its unit", self.run_here("detect", "a.obj", "--unit", "m").error)
        # Another file states it, and this one stays.
        self.assertEqual(self.bounds("a.obj", "a.dae", "--up", "y"), [[0, 0, 0], [1, 1, 0]])
        self.write("scene.toml", '[[object]]\nmesh = "a.obj"\nup = "y"\n')
        self.assertIn("up: the mesh file does not state its own", self.run_here("detect", "scene.toml").error)


if __name__ == "__main__":
    unittest.main()
