"""Compares the poses of animated characters with those of Blender, within 1e-6 of their size.

Needs the Python packages bpy, h5py and numpy; skips without them. The test makes two characters: a tube that a
chain of joints bends, and a sphere with two morph targets. Rotations have a key at each frame, because Blender
interpolates them between keys in another way than glTF asks for.
"""

import base64
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

try:
    import bpy
    import h5py
    import numpy as np
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("SUPPLE_PROGRAM", str(ROOT / "build/release/bin/supple"))
RATE, FRAMES = 24, 25


class Gltf:
    def __init__(self):
        self.data = b""
        self.json = {"asset": {"version": "2.0"}, "scene": 0, "bufferViews": [], "accessors": []}

    def add(self, kind, numbers, dtype=np.float32):
        numbers = np.ascontiguousarray(numbers, dtype)
        width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4, "MAT4": 16}[kind]
        component = {np.float32: 5126, np.uint16: 5123, np.uint32: 5125}[dtype]
        self.json["bufferViews"].append({"buffer": 0, "byteOffset": len(self.data), "byteLength": numbers.nbytes})
        self.data += numbers.tobytes() + b"\0" * (-numbers.nbytes % 4)
        rows = numbers.reshape(-1, width)
        self.json["accessors"].append({
            "bufferView": len(self.json["bufferViews"]) - 1, "componentType": component, "count": len(rows), "type": kind,
            "min": rows.min(0).tolist(), "max": rows.max(0).tolist()})
        return len(self.json["accessors"]) - 1

    def animate(self, channels):
        """Channels are (node, path, type, values), with a value for each frame."""
        times = self.add("SCALAR", np.arange(FRAMES) / RATE)
        samplers = [{"input": times, "output": self.add(kind, values)} for _, _, kind, values in channels]
        self.json["animations"] = [{"name": "move", "samplers": samplers, "channels": [
            {"sampler": i, "target": {"node": node, "path": path}} for i, (node, path, _, _) in enumerate(channels)]}]

    def write(self, path):
        self.json["buffers"] = [{"byteLength": len(self.data), "uri": "data:application/octet-stream;base64," + base64.b64encode(self.data).decode()}]
        path.write_text(json.dumps(self.json))


def turns(axis, angles):
    return np.hstack([np.outer(np.sin(angles / 2), axis), np.cos(angles / 2)[:, None]])


def grid(columns, rows):
    """The triangles of a tube of rings."""
    quads = [(r * columns + c, r * columns + (c + 1) % columns, (r + 1) * columns + c, (r + 1) * columns + (c + 1) % columns)
             for r in range(rows - 1) for c in range(columns)]
    return [t for a, b, c, d in quads for t in ((a, b, c), (b, d, c))]


def bent_tube():
    """A tube along y that a chain of four joints bends and twists."""
    gltf, columns, rows = Gltf(), 12, 25
    angle, height = np.meshgrid(np.arange(columns) * 2 * np.pi / columns, np.linspace(0, 4, rows))
    # No two points are equal or symmetric.
    radius = 0.5 + 0.05 * np.sin(3 * angle + height)
    points = np.stack([radius * np.cos(angle), height, radius * np.sin(angle)], -1).reshape(-1, 3)
    place = np.clip(points[:, 1] - 0.5, 0, 2.999)
    joints = np.zeros((len(points), 4), int)
    joints[:, 0], joints[:, 1] = place.astype(int), place.astype(int) + 1
    weights = np.zeros((len(points), 4))
    weights[:, 1] = place % 1
    weights[:, 0] = 1 - weights[:, 1]
    inverse = [np.array([[1, 0, 0, 0], [0, 1, 0, -i], [0, 0, 1, 0], [0, 0, 0, 1]]).T for i in range(4)]
    gltf.json["meshes"] = [{"primitives": [{"indices": gltf.add("SCALAR", grid(columns, rows), np.uint32), "attributes": {
        "POSITION": gltf.add("VEC3", points), "JOINTS_0": gltf.add("VEC4", joints, np.uint16), "WEIGHTS_0": gltf.add("VEC4", weights)}}]}]
    gltf.json["skins"] = [{"joints": [1, 2, 3, 4], "inverseBindMatrices": gltf.add("MAT4", inverse)}]
    gltf.json["nodes"] = [{"mesh": 0, "skin": 0}, {"name": "j0", "children": [2]}] + [
        {"name": f"j{i}", "translation": [0, 1, 0], **({"children": [i + 2]} if i < 3 else {})} for i in (1, 2, 3)]
    gltf.json["scenes"] = [{"nodes": [0, 1]}]
    t = np.arange(FRAMES) / RATE
    gltf.animate([
        (1, "translation", "VEC3", np.stack([t, 0.3 * t * t, -t], -1)),
        (2, "rotation", "VEC4", turns([0, 0, 1], 1.2 * t)),
        (3, "rotation", "VEC4", turns([0.6, 0, 0.8], -1.5 * t)),
        (4, "rotation", "VEC4", turns([0, 1, 0], 2 * t)),
        (3, "scale", "VEC3", np.stack([1 + 0.2 * t, 1 + 0.2 * t, 1 + 0.2 * t], -1)),
    ])
    return gltf


def morphed_ball():
    """A ball with two morph targets at a node that moves and turns."""
    gltf, columns, rows = Gltf(), 16, 12
    angle, height = np.meshgrid(np.arange(columns) * 2 * np.pi / columns, np.linspace(-1.4, 1.4, rows))
    points = np.stack([np.cos(height) * np.cos(angle), np.sin(height), np.cos(height) * np.sin(angle)], -1).reshape(-1, 3)
    points *= 1 + 0.03 * np.sin(5 * points[:, :1] + 3 * points[:, 1:2])
    targets = [np.stack([0 * points[:, 0], points[:, 0] ** 2, 0 * points[:, 0]], -1), points * np.sin(4 * points[:, 1:2])]
    gltf.json["meshes"] = [{"weights": [0, 0], "primitives": [{
        "indices": gltf.add("SCALAR", grid(columns, rows), np.uint32), "attributes": {"POSITION": gltf.add("VEC3", points)},
        "targets": [{"POSITION": gltf.add("VEC3", target)} for target in targets]}]}]
    gltf.json["nodes"] = [{"mesh": 0, "scale": [2, 2, 2]}]
    gltf.json["scenes"] = [{"nodes": [0]}]
    t = np.arange(FRAMES) / RATE
    gltf.animate([
        (0, "weights", "SCALAR", np.stack([t, 0.5 * (1 - t)], -1)),
        (0, "rotation", "VEC4", turns([0.6, 0.8, 0], 2 * t)),
        (0, "translation", "VEC3", np.stack([t, t, 3 * t], -1)),
    ])
    return gltf


def poses_of_blender(path):
    """The points of each frame, with y up as in glTF."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.context.scene.render.fps = RATE
    bpy.ops.import_scene.gltf(filepath=str(path))
    poses = []
    for frame in range(FRAMES):
        bpy.context.scene.frame_set(frame)
        graph = bpy.context.evaluated_depsgraph_get()
        # The importer adds shapes for joints, which are in no collection of the scene.
        (thing,) = [o for o in bpy.context.scene.objects if o.type == "MESH" and len(o.data.vertices) > 100]
        evaluated = thing.evaluated_get(graph)
        mesh = evaluated.to_mesh()
        points = np.array([evaluated.matrix_world @ v.co for v in mesh.vertices])
        evaluated.to_mesh_clear()
        poses.append(np.stack([points[:, 0], points[:, 2], -points[:, 1]], -1))
    return poses


def poses_of_supple(path):
    scene = path.with_suffix(".toml")
    scene.write_text(f'[scene]\ntime_step = {1 / RATE!r}\n[[object]]\nmesh = "{path.name}"\nmotion = {{ kind = "clip" }}\n')
    recording = path.with_suffix(".h5")
    subprocess.run([PROGRAM, "simulate", scene, "--frames", str(FRAMES), "--record", recording, "--quiet"], check=True)
    with h5py.File(recording) as file:
        found = []
        file.visititems(lambda name, item: found.append(item[:]) if name.endswith("/positions") and isinstance(item, h5py.Dataset) else None)
    (positions,) = found
    return positions.reshape(FRAMES, -1, 3)


class Comparison(unittest.TestCase):
    def compare(self, gltf):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "character.gltf"
            gltf.write(path)
            expected, given = poses_of_blender(path), poses_of_supple(path)
        size = np.ptp(expected[0], axis=0).max()
        # The order of the vertices differs; the first frame tells which is which.
        distance = np.linalg.norm(expected[0][:, None] - given[0][None], axis=-1)
        order = distance.argmin(1)
        self.assertEqual(sorted(order), list(range(given.shape[1])))
        worst = max(np.abs(expected[i] - given[i][order]).max() for i in range(FRAMES))
        moved = np.abs(expected[-1] - expected[0]).max()
        print(f"largest difference {worst / size:.2e} of the size; the character moves by {moved / size:.2f} of it")
        self.assertGreater(moved, 0.5 * size)
        self.assertLess(worst, 1e-6 * size)

    def test_skin(self):
        self.compare(bent_tube())

    def test_morph_targets(self):
        self.compare(morphed_ball())


if __name__ == "__main__":
    result = unittest.main(exit=False).result
    sys.stdout.flush()
    os._exit(0 if result.wasSuccessful() and result.testsRun > 0 else 1)  # Blender may crash when Python ends
