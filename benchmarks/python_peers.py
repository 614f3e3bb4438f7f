#!/usr/bin/env python3
"""The Python package against other Python packages, as far as they are installed, in one run.

usage: python_peers.py [--rounds N] [--only NAME]... [--save MACHINE]

Each contestant does the same work on one thread where it lets choose, in turn; the table has medians of
wall-clock times, and the ratio to the package with the lowest and the highest of the rounds. Run it with
PYTHONPATH=build/release/python. SUPPLE_DATA names the folder of the cloths. --save writes
benchmarks/results/<date>-MACHINE-python.csv.

    overhead   the time of a frame outside of `Scene::detect`: 9 spheres of 18,000 and of 69,620 triangles, and
               an empty scene
    threads    two scenes in two threads against one after the other
    frames     9 deforming spheres of 18,000 triangles: all intersecting pairs of triangles of each frame
    proximity  cloth-ball: all pairs within a distance; and the safe step between two frames
    managers   collision managers of trimesh: an arm of 8 links among 20 objects, the time of one call
    closest    closest points and signed distances of many points to a sphere of 69,620 triangles
    self       losses of a batch of 16 bodies of 13,776 triangles that cut themselves
"""

import argparse
import csv
import datetime
import importlib.metadata
import os
import pathlib
import statistics
import sys
import time

import numpy as np

import supple
from contest import git, processor

ROOT = pathlib.Path(__file__).resolve().parent.parent
DATA = pathlib.Path(os.environ.get("SUPPLE_DATA", ROOT.parent / "shared/data"))


def package(name):
    """A package, or None."""
    try:
        return __import__(name)
    except ImportError:
        return None


def timed(work):
    begin = time.perf_counter()
    answer = work()
    return 1e3 * (time.perf_counter() - begin), answer


def race(contestants, rounds):
    """Runs all in turn; returns the milliseconds of each round and the last answer by name."""
    times, answers = {name: [] for name in contestants}, {}
    for turn in range(rounds + 1):
        for name, work in contestants.items():
            milliseconds, answers[name] = timed(work)
            if turn:  # the first round warms up
                times[name].append(milliseconds)
    return times, answers


def rows_of(work, times, note=""):
    """One row for each contestant: work, name, median, and the ratio to the first contestant by rounds."""
    ours = next(iter(times.values()))
    for name, values in times.items():
        ratios = sorted(b / a for a, b in zip(ours, values))
        yield [work, name, f"{statistics.median(values):.4g}",
               f"{statistics.median(ratios):.2f} ({ratios[0]:.2f} – {ratios[-1]:.2f})", note if name == next(iter(times)) else ""]


def spheres(frames, frequency=30):
    """The positions of 9 deforming spheres of 20 frequency² triangles in each frame, and their triangles."""
    ball = supple.make_icosphere(frequency)
    x, faces = np.asarray(ball.positions), np.asarray(ball.triangles).astype(np.int64)
    places = np.array([[i % 3, i // 3, 0] for i in range(9)]) * [1.85, 1.85, 0]
    wave = [[x * (1 + 0.05 * np.sin(3 * x[:, :1] + 0.7 * i + 0.3 * f)) + places[i] for i in range(9)] for f in range(frames)]
    return wave, faces


def overhead(rounds):
    for frequency in (30, 59):
        yield from overhead_of_spheres(rounds, frequency)
    empty = supple.Scene(threads=1)
    calls = 2000
    microseconds = [1e3 * timed(lambda: [empty.detect() for _ in range(calls)])[0] / calls for _ in range(rounds)]
    yield ["an empty detect, µs", "supple", f"{statistics.median(microseconds):.3g}", "", f"of {calls} calls"]


def overhead_of_spheres(rounds, frequency):
    wave, faces = spheres(8, frequency)
    scene = supple.Scene(threads=1)
    objects = [scene.add(x, faces) for x in wave[0]]
    scene.detect()

    def frame(positions):
        for each, x in zip(objects, positions):
            each.share_positions(x)
        result = scene.detect()
        result.contacts["normal"], result.contacts["triangle"]
        return result

    whole, inside = [], []
    for _ in range(rounds):
        for positions in wave:
            milliseconds, result = timed(lambda: frame(positions))
            whole.append(milliseconds)
            inside.append(1e3 * result.stats["total_seconds"])
    share = sorted((a - b) / b for a, b in zip(whole, inside))
    yield [f"a frame of 9 × {len(faces):,}", "supple", f"{statistics.median(whole):.4g}",
           f"{100 * statistics.median(share):.2f} % ({100 * share[len(share) // 10]:.2f} – {100 * share[-1 - len(share) // 10]:.2f})",
           "time outside of Scene::detect, of it; 10th to 90th percentile"]


def threads(rounds):
    from concurrent.futures import ThreadPoolExecutor

    wave, faces = spheres(4)
    scenes = [supple.Scene(threads=1) for _ in range(2)]
    for scene in scenes:
        for x in wave[0]:
            scene.add(x, faces)

    def run(scene):
        for _ in range(10):
            for positions in wave:
                for each, x in zip(scene.objects, positions):
                    each.share_positions(x)
                scene.detect()

    with ThreadPoolExecutor(2) as pool:
        times, _ = race({"two threads": lambda: list(pool.map(run, scenes)),
                         "one after the other": lambda: [run(scene) for scene in scenes]}, rounds)
    yield from rows_of("40 frames of two scenes of 9 × 18,000", times)


def frames(rounds):
    wave, faces = spheres(4)
    scene = supple.Scene(threads=1, contact_points=False)
    objects = [scene.add(x, faces) for x in wave[0]]

    def ours():
        count = 0
        for positions in wave:
            for each, x in zip(objects, positions):
                each.positions = x
            count += len(scene.detect().contacts)
        return count

    contestants = {"supple": ours}
    if fcl := package("fcl"):
        def theirs_fcl():
            count = 0
            for positions in wave:
                manager = fcl.DynamicAABBTreeCollisionManager()
                parts = []
                for x in positions:
                    model = fcl.BVHModel()
                    model.beginModel(len(x), len(faces))
                    model.addSubModel(x, faces)
                    model.endModel()
                    parts.append(fcl.CollisionObject(model, fcl.Transform()))
                manager.registerObjects(parts)
                manager.setup()
                data = fcl.CollisionData(fcl.CollisionRequest(num_max_contacts=10**6, enable_contact=False))

                def collide(a, b, cdata):
                    fcl.collide(a, b, request=cdata.request, result=cdata.result)
                    return False

                manager.collide(data, collide)
                count += len(data.result.contacts)
            return count
        contestants["python-fcl, trees built again"] = theirs_fcl
    if warp := package("warp"):
        contestants["warp on the processor"] = warp_frames(warp, wave, faces)
    times, answers = race(contestants, rounds)
    yield from rows_of("4 frames of 9 × 18,000, intersecting pairs", times, f"pairs found: {answers}")


def warp_frames(wp, wave, faces):
    """Refit, boxes of triangles against the tree of the other mesh, then a test of triangles in single
    precision."""
    wp.config.quiet = True
    wp.init()

    @wp.kernel
    def count_pairs(a: wp.uint64, b: wp.uint64, total: wp.array(dtype=wp.int32)):
        t = wp.tid()
        p, q, r = wp.mesh_eval_position(a, t, 1.0, 0.0), wp.mesh_eval_position(a, t, 0.0, 1.0), wp.mesh_eval_position(a, t, 0.0, 0.0)
        query = wp.mesh_query_aabb(b, wp.min(wp.min(p, q), r), wp.max(wp.max(p, q), r))
        other = wp.int32(0)
        while wp.mesh_query_aabb_next(query, other):
            u, v = wp.mesh_eval_position(b, other, 1.0, 0.0), wp.mesh_eval_position(b, other, 0.0, 1.0)
            w = wp.mesh_eval_position(b, other, 0.0, 0.0)
            if wp.intersect_tri_tri(p, q, r, u, v, w) != 0:
                wp.atomic_add(total, 0, 1)

    indices = wp.array(faces.astype(np.int32).ravel(), dtype=wp.int32, device="cpu")
    points = [wp.array(x.astype(np.float32), dtype=wp.vec3, device="cpu") for x in wave[0]]
    meshes = [wp.Mesh(points=p, indices=indices) for p in points]

    def work():
        total = wp.zeros(1, dtype=wp.int32, device="cpu")
        for positions in wave:
            boxes = [(x.min(axis=0), x.max(axis=0)) for x in positions]
            for mesh, x in zip(meshes, positions):
                mesh.points.assign(x.astype(np.float32))
                mesh.refit()
            for i in range(9):
                for j in range(i + 1, 9):
                    if (boxes[i][0] <= boxes[j][1]).all() and (boxes[j][0] <= boxes[i][1]).all():
                        wp.launch(count_pairs, dim=len(faces), inputs=[meshes[i].id, meshes[j].id, total], device="cpu")
        return int(total.numpy()[0])

    return work


def proximity(rounds):
    ipctk = package("ipctk")
    folder = DATA / "scalable-ccd/cloth-ball/frames"
    if not folder.exists():
        print(f"left out: {folder} is missing", file=sys.stderr)
        return
    first, last = (supple.load_mesh(folder / f"cloth_ball{i}.ply") for i in (92, 93))
    start, end, faces = first.positions, last.positions, np.asarray(first.triangles).astype(np.int64)
    from supple.compat.ipctk import CollisionMesh

    mesh = CollisionMesh(start, faces=faces)
    mesh._scene = mesh_on_one_thread(mesh, start, faces)
    size = float(np.ptp(start, axis=0).max())
    dhat = 1e-3 * size
    near = {"supple": lambda: len(mesh.collisions(start, dhat))}
    steps = {"supple": lambda: mesh.collision_free_step(start, end, keep=0.1)}
    if ipctk:
        ipctk.set_num_threads(1)
        ipctk.set_logger_level(ipctk.LoggerLevel.error)
        other = ipctk.CollisionMesh(start, ipctk.edges(faces), faces)

        def theirs_near():
            collisions = ipctk.NormalCollisions()
            collisions.build(other, start, dhat)
            return len(collisions)

        def theirs_step():
            candidates = ipctk.Candidates()
            candidates.build(other, start, end, 0, ipctk.LBVH())
            return candidates.compute_collision_free_stepsize(other, start, end, 0, ipctk.AdditiveCCD())

        near["ipctk"], steps["ipctk"] = theirs_near, theirs_step
    for work, contestants in (("cloth-ball, pairs within 1/1000 of its size", near), ("cloth-ball, safe step", steps)):
        times, answers = race(contestants, rounds)
        yield from rows_of(work, times, f"answers: {answers}")


def mesh_on_one_thread(mesh, positions, faces):
    scene = supple.Scene(contacts="proximity", contact_points=False, threads=1)
    mesh._object = scene.add(positions, faces, self_collision=True)
    return scene


def managers(rounds):
    """The managers of trimesh.collision: an arm of 8 links among 20 objects, in 25 poses."""
    trimesh, fcl = package("trimesh"), package("fcl")
    if not trimesh or not fcl:
        print("left out: managers needs trimesh and python-fcl", file=sys.stderr)
        return
    import trimesh.collision
    from supple.compat.trimesh import CollisionManager

    shapes = [trimesh.creation.torus(0.4, 0.15), trimesh.creation.icosphere(subdivisions=3, radius=0.4),
              trimesh.creation.capsule(height=0.6, radius=0.25), trimesh.creation.box((0.6, 0.5, 0.7)).subdivide().subdivide()]
    rng = np.random.default_rng(5)

    def placed(place):
        matrix = trimesh.transformations.random_rotation_matrix(rng.random(3))
        matrix[:3, 3] = place
        return matrix

    around = [(shapes[i % 4], placed([2.2 * np.cos(0.31 * i), 2.2 * np.sin(0.31 * i), 0.4 * (i % 5) - 0.8])) for i in range(20)]
    link = trimesh.creation.cylinder(radius=0.12, height=0.5, sections=48).subdivide()

    def arm(angle, bend):
        return [placed([0.24 * i * np.cos(angle + bend * i), 0.24 * i * np.sin(angle + bend * i), 0.05 * i]) for i in range(8)]

    poses = [arm(0.25 * i, 0.1 * (i % 5 - 2)) for i in range(25)]
    triangles = sum(len(mesh.faces) for mesh, _ in around) + 8 * len(link.faces)

    def prepared(kind):
        own, other = kind(), kind()
        for i, (mesh, matrix) in enumerate(around):
            own.add_object(f"object {i}", mesh, matrix)
        for i, matrix in enumerate(poses[0]):
            other.add_object(f"link {i}", link, matrix)
        return own, other

    both = {"supple.compat.trimesh": prepared(CollisionManager), "trimesh, python-fcl": prepared(trimesh.collision.CollisionManager)}

    def moving(call):
        def of(own, other):
            answers = []
            for pose in poses:
                for i, matrix in enumerate(pose):
                    other.set_transform(f"link {i}", matrix)
                answers.append(call(own, other))
            return answers
        return of

    def still(call):
        return lambda own, other: [call(own, other) for _ in poses]

    works = {
        "in_collision_other, moving": moving(lambda own, other: own.in_collision_other(other)),
        "in_collision_other, still": still(lambda own, other: own.in_collision_other(other)),
        "in_collision_other, names, moving": moving(lambda own, other: own.in_collision_other(other, return_names=True)[0]),
        "min_distance_other, moving": moving(lambda own, other: max(own.min_distance_other(other), 0)),
        "min_distance_other, still": still(lambda own, other: max(own.min_distance_other(other), 0)),
        "in_collision_single": lambda own, other: [own.in_collision_single(link, pose[7]) for pose in poses],
        "min_distance_single": lambda own, other: [max(own.min_distance_single(link, pose[7]), 0) for pose in poses],
        "in_collision_internal": lambda own, other: [own.in_collision_internal() for _ in poses],
        "min_distance_internal": lambda own, other: [max(own.min_distance_internal(), 0) for _ in poses],
    }
    for name, work in works.items():
        times, answers = race({who: lambda of=of, work=work: work(*of) for who, of in both.items()}, rounds)
        ours, theirs = (np.array(answers[who], float) for who in both)
        note = f"25 calls, {triangles:,} triangles; answers differ by at most {np.abs(ours - theirs).max():.2g}, mean {ours.mean():.3g}"
        yield from rows_of(name, {who: [each / 25 for each in values] for who, values in times.items()}, note)


def closest(rounds):
    ball = supple.make_icosphere(59)
    x, faces = np.asarray(ball.positions), np.asarray(ball.triangles)
    rng = np.random.default_rng(1)
    for count, place in ((10**6, "near"), (10**5, "far")):
        points = rng.normal(size=(count, 3))
        points /= np.linalg.norm(points, axis=1)[:, None]
        points *= rng.uniform(0.95, 1.05, (count, 1)) if place == "near" else rng.uniform(0.1, 3, (count, 1))
        scene = supple.Scene(threads=1)
        scene.add(ball)
        nearest = {"supple": lambda p=points: scene.closest(p)["distance"]}
        signed = {"supple": lambda p=points: scene.closest(p, signed=True)["distance"]}
        if o3d := package("open3d"):
            rays = o3d.t.geometry.RaycastingScene(nthreads=1)
            rays.add_triangles(x.astype(np.float32), faces.astype(np.uint32))
            nearest["open3d, single precision"] = lambda p=points.astype(np.float32): rays.compute_distance(p, nthreads=1).numpy()
            signed["open3d, single precision"] = \
                lambda p=points.astype(np.float32): rays.compute_signed_distance(p, nthreads=1).numpy()
        if igl := package("igl"):
            nearest["libigl"] = lambda p=points: np.sqrt(igl.point_mesh_squared_distance(p, x, faces.astype(np.int64))[0])
        for work, contestants in ((f"{count:,} closest points, {place}", nearest), (f"{count:,} signed distances, {place}", signed)):
            times, answers = race(contestants, min(rounds, 3))
            worst = {name: float(np.abs(np.abs(answer) - np.abs(answers["supple"])).max()) for name, answer in answers.items()}
            yield from rows_of(work, times, f"largest difference: {worst}")


def self_contacts(rounds):
    torch = package("torch")
    if not torch:
        print("left out: self needs torch", file=sys.stderr)
        return
    from supple import torch as losses

    rings, sides = 246, 28
    u, v = np.meshgrid(np.linspace(0, 2 * np.pi, rings, endpoint=False), np.linspace(0, 2 * np.pi, sides, endpoint=False), indexing="ij")
    ids = np.arange(rings * sides).reshape(rings, sides)
    a, b, c, d = ids, np.roll(ids, -1, 0), np.roll(ids, -1, 1), np.roll(np.roll(ids, -1, 0), -1, 1)
    faces = np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([c, b, d], -1).reshape(-1, 3)])
    tube = 0.22
    bodies = []
    for i in range(16):
        r = 1 + 0.45 * np.cos((3 + i % 2) * u)
        bodies.append(np.stack([(r + tube * np.cos(v)) * np.cos(2 * u), (r + tube * np.cos(v)) * np.sin(2 * u),
                                0.15 * np.sin((3 + i % 2) * u) + tube * np.sin(v)], -1).reshape(-1, 3))
    batch = torch.tensor(np.stack(bodies), requires_grad=True)
    pairs = losses.Pairs((faces,))

    def ours():
        loss = pairs.self_penetration(batch)
        loss.sum().backward()
        return len(loss)

    times, _ = race({"supple": ours}, rounds)
    count = sum(len(scene.result.contacts) for scene in pairs._scenes)
    yield from rows_of(f"16 bodies of {len(faces):,} triangles: loss and gradient", times, f"{count} intersecting pairs")


PACKAGES = ("numpy", "python-fcl", "trimesh", "ipctk", "open3d", "libigl", "warp-lang", "torch")
WORK = {"overhead": overhead, "threads": threads, "frames": frames, "proximity": proximity, "managers": managers, "closest": closest, "self": self_contacts}


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("usage: ")[1].split("\n\n")[0])
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--only", action="append", choices=WORK, default=[])
    parser.add_argument("--save", metavar="MACHINE")
    arguments = parser.parse_args()
    table = [["work", "package", "ms", "ratio (lowest – highest)", "note"]]
    for name in arguments.only or WORK:
        for row in WORK[name](arguments.rounds):
            table.append(row)
            print(" | ".join(row), flush=True)
    if arguments.save:
        versions = [f"{name} {importlib.metadata.version(name)}" for name in PACKAGES if has_version(name)]
        path = ROOT / f"benchmarks/results/{datetime.date.today()}-{arguments.save}-python.csv"
        with path.open("w", newline="", encoding="utf-8") as file:
            for key, value in {"date": datetime.date.today(), "commit": git("rev-parse", "--short", "HEAD"),
                               "machine": processor(), "compiler": "g++ 12, Debian 12, Release",
                               "command": "benchmarks/python_peers.py " + " ".join(sys.argv[1:]),
                               "packages": f"Python {sys.version.split()[0]}, " + ", ".join(versions)}.items():
                file.write(f"# {key}: {value}\n")
            csv.writer(file, lineterminator="\n").writerows(table)
    return 0


def has_version(name):
    try:
        importlib.metadata.version(name)
    except importlib.metadata.PackageNotFoundError:
        return False
    return True


if __name__ == "__main__":
    sys.exit(main())
