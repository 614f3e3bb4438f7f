"""Run by mpirun: the distributed scene finds what one scene finds. Each function is a test of all ranks."""

import functools
import gc
import pathlib
import shutil
import tempfile
import threading
import weakref

import numpy as np
from mpi4py import MPI

import supple

WORLD = MPI.COMM_WORLD
KINDS = ("intersection", "continuous", "proximity", "penetration")
SHAPES = (
    ("make_icosphere", 4),
    ("make_torus", 10, 6),
    ("make_cloth", 8, 8),
    ("make_box", (0.6, 0.7, 0.8), 2),
)


def assert_equal(found, wanted, name):
    """Both have the same bytes, also where they are NaN; bytes between the columns do not count."""
    assert found.dtype == wanted.dtype and len(found) == len(wanted), (name, len(found), len(wanted))
    for column in wanted.dtype.names or (...,):
        assert np.array(found[column]).tobytes() == np.array(wanted[column]).tobytes(), (name, column)


def assert_same_record(found, wanted):
    assert (found is None) == (wanted is None) and (found is None or found == wanted), (found, wanted)


class Twin:
    """A random object in one scene, which all ranks have, and in the distributed one."""

    def __init__(self, scene, distributed, random):
        self.distributed, self.random = distributed, random
        shape, *sizes = SHAPES[random.integers(len(SHAPES))]
        self.mesh = getattr(supple, shape)(*sizes)
        self.dtype = np.float32 if random.random() < 0.3 else np.float64
        self.options = {
            "name": "twin",
            "self_collision": bool(random.random() < 0.4),
            "margin": float(random.uniform(0, 0.1)),
            "min_separation": float(random.choice([0, 0.01])),
            "static": bool(random.random() < 0.1),
            "solid": shape != "make_cloth" and bool(random.random() < 0.6),
            "group": int(random.choice([1, 2])),
            "mask": int(random.choice([3, 7, 2])),
        }
        if random.random() < 0.2:
            self.options |= {"edges": [[0, 2], [1, 3]], "points": [1, 4]}
        self.place = random.uniform(-0.8, 0.8, 3)
        self.now = self.moved()
        self.one = scene.add(self.now, self.mesh.triangles, **self.options)
        self.settle()

    def moved(self):
        shape = np.asarray(self.mesh.positions) * self.random.uniform(0.7, 1.3, 3)
        return (shape + self.place + self.random.normal(0, 0.003, shape.shape)).astype(self.dtype)

    def settle(self):
        """Gives the object, or parts of it, to ranks."""
        triangles = np.asarray(self.mesh.triangles)
        ranks = np.full(len(triangles), self.random.integers(WORLD.size))
        in_parts = self.random.random() < 0.5 and "edges" not in self.options
        if in_parts:
            ranks = np.arange(len(triangles)) * WORLD.size // len(triangles)
        mine = np.flatnonzero(ranks == WORLD.rank)
        self.mine = None
        if not len(mine):
            return
        name = {"id": self.one.index, "generation": self.one.generation}
        if in_parts:
            self.vertices, corners = np.unique(triangles[mine], return_inverse=True)
            self.mine = self.distributed.add_part(
                self.now[self.vertices], corners.reshape(-1, 3), self.vertices, mine, **name, **self.options
            )
        else:
            self.vertices = np.arange(len(self.now))
            self.mine = self.distributed.add(self.now, triangles, **name, **self.options)

    def each(self, function, *values):
        """Calls a function of the object in both scenes."""
        getattr(self.one, function)(*values)
        if self.mine is not None:
            getattr(self.mine, function)(*values)

    def change(self, may_have_vertex_groups):
        random = self.random
        self.each("set_static", False)
        before, self.place = self.now, self.place + random.uniform(-0.2, 0.2, 3)
        self.now = self.moved()
        if random.random() < 0.15:
            self.now[random.integers(len(self.now)), 1] = random.choice([np.nan, np.inf])
        if random.random() < 0.5:
            self.one.set_motion(before, self.now)
            if self.mine is not None:
                self.mine.set_motion(before[self.vertices], self.now[self.vertices])
        else:
            self.one.positions = self.now
            if self.mine is not None:
                self.mine.positions = self.now[self.vertices]
        what = random.integers(10)
        if what == 0:
            self.each("set_margin", float(random.uniform(0, 0.1)))
        elif what == 1:
            self.each("set_group", int(random.choice([1, 2])))
        elif what == 2:
            self.each("set_self_collision", bool(random.random() < 0.5))
        elif what == 3:
            self.each("set_min_separation", 0.02)
        elif what == 4:
            self.each("set_static", True)
        elif what == 5 and may_have_vertex_groups:
            groups = random.integers(1, 4, len(self.now))
            masks = random.integers(0, 8, len(self.now))
            self.one.set_vertex_groups(groups, masks)
            if self.mine is not None:
                self.mine.set_vertex_groups(groups[self.vertices], masks[self.vertices])

    def remove(self):
        self.each("remove")

    def go_on_in(self, loaded):
        """Takes the object of a scene that was loaded, where it is on other ranks."""
        self.distributed = loaded
        name = self.one.index, self.one.generation
        self.mine = next((each for each in loaded.objects if (each.index, each.generation) == name), None)
        if self.mine is not None:
            self.vertices = self.mine.part_vertices
            if not len(self.vertices):
                self.vertices = np.arange(len(self.now))
            assert np.array_equal(self.mine.positions, self.now[self.vertices], equal_nan=True)


def random_scenes():
    found = 0
    file = WORLD.bcast(tempfile.mkdtemp() if WORLD.rank == 0 else None) + "/scene"
    for seed in range(6):
        random = np.random.default_rng(seed)
        options = {
            "contacts": (KINDS, ("continuous",), ("intersection", "penetration"))[seed % 3],
            "cluster_triangles": (16, 100, 2048)[seed % 3],
        }
        distributed = supple.DistributedScene(WORLD, threads=1, **options)
        one = supple.Scene(threads=1, contacts=options["contacts"])
        twins = [Twin(one, distributed, random) for _ in range(8)]
        last = []
        for step in range(5):
            if step == 3:
                twins.pop(2).remove()
                twins.append(Twin(one, distributed, random))
            if step == 4:
                for each in one, distributed:
                    each.set_pair_filter(lambda a, b: (a.index + b.index) % 3 != 0)
            if step:
                for each in twins:
                    each.change("penetration" not in options["contacts"])
            result = distributed.detect()
            if WORLD.rank == 0:
                wanted = one.detect()
                assert result.step == wanted.step == step
                for name in wanted._names():
                    assert_equal(result._list(name), wanted._list(name), name)
                found += len(result)
                last.append((result, {name: result._list(name).tobytes() for name in result._names()}))
                if step == 0:  # neither has events or ids of earlier steps
                    assert all(
                        result._list(name).tobytes() == wanted._list(name).tobytes()
                        for name in wanted._names()
                    ), "bytes between the columns"
            else:
                assert len(result) == 0 and len(result.events["volume_begin"]) == 0
            report = distributed.verify()
            assert report and sum(report.checked.values()), report
            if WORLD.rank == 0:
                assert report.checked == one.verify().checked, report
            points = random.uniform(-1, 1, (WORLD.size, 3, 3))[WORLD.rank]
            assert_equal(distributed.closest(points), one.closest(points), "closest")
            both = distributed.earliest_impact(), one.earliest_impact()
            assert_same_record(*both)
            for name in "max_step", "collision_free_step":
                step_, limit, stopped = getattr(distributed, name)()
                assert step_ == getattr(one, name)().step, name
                assert not stopped
                assert_same_record(limit, getattr(one, name)().limit)
            for most in (0.5,), ():
                distances = distributed.distances(*most)
                if WORLD.rank == 0:
                    assert_equal(distances, one.distances(*most), "distances")
            if step == 2 and seed % 2 == 0:
                distributed.save(file)
                distributed = supple.DistributedScene(WORLD, threads=1, **options)
                distributed.load(pathlib.Path(file))
                for each in twins:
                    each.go_on_in(distributed)
        # Results that are held stay as they are.
        assert all(
            result._list(name).tobytes() == rows for result, lists in last for name, rows in lists.items()
        )
    expect_on_all("scene", lambda: distributed.load(file + "s"))
    if WORLD.rank == 0:
        shutil.rmtree(pathlib.Path(file).parent)
        assert found > 1000, found


def placements():
    """Each contact is on one rank."""
    random = np.random.default_rng(7)
    one = supple.Scene(threads=1)
    owner = supple.DistributedScene(WORLD, threads=1, results="owner")
    spread = supple.DistributedScene(WORLD, threads=1, results=supple.ResultPlacement.spread)
    mesh = supple.make_icosphere(6)
    for i in range(9):
        positions = np.asarray(mesh.positions) + random.uniform(-1, 1, 3)
        one.add(positions, mesh.triangles)
        if i % WORLD.size == WORLD.rank:
            for each in owner, spread:
                each.add(positions, mesh.triangles, id=i)

    def rows_of(contacts):
        return np.stack(
            [contacts[name] for name in ("object_a", "object_b", "triangle_a", "triangle_b")], axis=1
        ).tolist()

    wanted = rows_of(one.detect().contacts)
    for each in owner, spread:
        parts = WORLD.allgather(rows_of(each.detect().contacts))
        assert sorted(sum(parts, [])) == wanted and len(wanted) > 100
        assert sum(map(bool, parts)) > 1 or WORLD.size == 1
        assert WORLD.allreduce(each.stats["bytes_sent"]) > 0 or WORLD.size == 1
        if each is owner:
            assert all(row[0] % WORLD.size == rank for rank in range(WORLD.size) for row in parts[rank])


def expect(message, call):
    """The call raises an error with this message; none for an empty one."""
    try:
        call()
    except (supple.Error, TypeError) as error:
        text = f"{type(error).__name__}: {error}"
    else:
        text = ""
    assert message in text and bool(message) == bool(text), (message, text)
    return text


def expect_on_all(message, call):
    """The same for a collective call, whose errors are equal on all ranks."""
    assert len(set(WORLD.allgather(expect(message, call)))) == 1


def errors_are_those_of_all_ranks():
    last = WORLD.size - 1
    scene = supple.DistributedScene(WORLD, threads=1, contacts="penetration")
    sail = supple.make_cloth(4, 4)
    if scene.rank == last:
        part = range(len(sail.positions)), range(len(sail.triangles))
        scene.add_part(sail.positions, sail.triangles, *part, id=1, name="sail", solid=True)
        scene.add(supple.make_icosphere(3), id=0)
    expect_on_all("Error: rank ", scene.detect)
    expect_on_all("sail is no solid", scene.detect)
    expect_on_all("", lambda: scene.detect(contacts="intersection"))

    points = [[0, 0]] if scene.rank == last else [[0, 0, 0]]
    expect_on_all(f"rank {last}: points have the shape (1, 2)", lambda: scene.closest(points))
    expect_on_all("", lambda: scene.closest([[0, 0, 0]]))

    def refuse(a, b):
        assert (int(a), b) == (0, 1)
        raise OSError("the filter's own")

    scene.set_pair_filter(refuse)
    expect_on_all("OSError: the filter's own", lambda: scene.detect(contacts="intersection"))
    scene.set_pair_filter(lambda a, b: 3)
    expect_on_all("must return True or False", lambda: scene.detect(contacts="intersection"))
    scene.set_pair_filter(None)
    expect_on_all("", lambda: scene.detect(contacts="intersection"))

    expect_on_all(
        "manifolds are made from penetration", lambda: scene.detect(contacts="intersection", manifolds=True)
    )
    expect_on_all("max_distance", lambda: scene.distances(-1.0))
    expect_on_all("object 1000", lambda: scene.closest([[0, 0, 0]], object=1000))
    for keywords, message in (
        ({"results": "all"}, "results is 'all'; it must be one of gathered, owner, spread"),
        ({"results": 3}, "results is 3"),
        ({"cluster_triangles": 0}, "cluster_triangles is 0"),
        ({"max_imbalance": 0.5}, "imbalance"),
        ({"max_imbalance": "much"}, "max_imbalance is 'much'; it must be a number"),
        ({"bounding_volume": "sphere"}, "the bounding volume is the box"),
        ({"speed": 3}, "TypeError: DistributedScene: there is no option 'speed'"),
    ):
        expect_on_all(message, functools.partial(supple.DistributedScene, WORLD, **keywords))


def wrong_input():
    freed = WORLD.Dup()
    freed.Free()
    for each in 3, None, "world", MPI.COMM_NULL, freed, MPI.GROUP_EMPTY:
        expect("it must be one of mpi4py with ranks", functools.partial(supple.DistributedScene, each))
    version = MPI.Get_library_version
    MPI.Get_library_version = lambda: "MPICH Version: 4.0"
    expect(
        "mpi4py uses MPICH Version: 4.0, and supple was built with", lambda: supple.DistributedScene(WORLD)
    )
    MPI.Get_library_version = version

    scene = supple.DistributedScene(WORLD, threads=1)
    mesh = supple.make_icosphere(2)
    mine = scene.add(mesh, id=scene.rank)
    assert mine == scene.rank and mine.generation == 0
    assert repr(mine) == f"<supple.DistributedObject {scene.rank}>"
    triangle = np.zeros((3, 3)), [[0, 1, 2]]
    expect("id is -1", lambda: scene.add(mesh, id=-1))
    expect("id is 'ball'", lambda: scene.add(mesh, id="ball"))
    expect("there is no option 'speed'", lambda: scene.add(mesh, id=9, speed=1))
    expect("weld", lambda: scene.add(mesh, id=9, weld=True))
    expect("is on this rank already", lambda: scene.add(mesh, id=scene.rank))
    expect("positions have the shape (3, 2)", lambda: scene.add(np.zeros((3, 2)), [[0, 1, 2]], id=9))
    expect("number 2 is 1 after 2", lambda: scene.add_part(*triangle, [0, 2, 1], [0], id=9))
    expect("vertex_numbers are float64", lambda: scene.add_part(*triangle, [0.5, 1, 2], [0], id=9))
    expect("3 positions for icosphere", lambda: mine.set_positions(np.zeros((3, 3))))
    expect("is not on this rank", lambda: scene.remove(1000))
    expect("a distributed scene has none", lambda: scene.detect().contacts["vertices"])
    mine.remove()
    returned = scene.add(mesh, id=scene.rank, generation=1)
    expect("(generation 0) is not on this rank", lambda: scene.remove(scene.rank))
    scene.remove(returned)
    result = scene.detect(contacts=KINDS)
    assert len(result) == 0 and scene.objects == []
    if scene.rank == 0:
        assert len(result.untested) == 4 and result.untested == supple.Scene(contacts=KINDS).detect().untested


def other_communicators():
    """A scene over some of the ranks; a result that rank 0 sends to all."""
    some = WORLD.Split(WORLD.rank % 2)
    scene = supple.DistributedScene(some, threads=1)
    some.Free()
    assert scene.rank == WORLD.rank // 2 and scene.rank_count == (WORLD.size + 1 - WORLD.rank % 2) // 2
    mesh = supple.make_icosphere(3)
    if scene.rank == 0:
        for i in range(2):
            scene.add(np.asarray(mesh.positions) + [i, 0, 0], mesh.triangles, id=i)
    result = WORLD.bcast(scene.detect())
    assert len(result.contacts) > 10 and result.contacts["normal"].shape == (len(result.contacts), 3)


def a_stop_on_one_rank_stops_all():
    scene = supple.DistributedScene(WORLD, threads=1)
    mesh = supple.make_icosphere(3)
    scene.add(mesh.positions, mesh.triangles, id=WORLD.rank)
    stop = supple.Stop()
    if WORLD.rank == WORLD.size - 1:
        stop.request()
    assert scene.detect(stop=stop).stopped
    expect_on_all(
        f"rank {WORLD.size - 1}: distances: it was stopped, so there is no answer",
        lambda: scene.distances(1, stop=stop),
    )
    result = scene.detect()
    assert not result.stopped and result.step == 0


def other_calls_on_one_rank():
    """They are an error on all ranks, which says what differs; before, the answers were partial."""
    if WORLD.size == 1:
        return
    last = WORLD.size - 1
    is_last = WORLD.rank == last
    scene = supple.DistributedScene(WORLD, threads=1 + is_last)
    mesh = supple.make_icosphere(3)
    scene.add(mesh, id=WORLD.rank)
    for call, difference in (
        (lambda: scene.detect(contacts="proximity" if is_last else "intersection"), "contacts is proximity"),
        (lambda: scene.distances(2 if is_last else 1), "max_distance is 2"),
        (lambda: scene.closest([[0, 0, 0]], mask=1 + is_last), "mask is 2"),
        (lambda: scene.max_step() if is_last else scene.detect(), "call is max_step"),
        (lambda: supple.DistributedScene(WORLD, cluster_triangles=100 + is_last), "cluster_triangles is 101"),
    ):
        expect_on_all(f"; on rank {last}, {difference}; give all ranks the same", call)
    expect_on_all("", scene.detect)


def a_filter_that_reaches_its_scene_is_freed():
    class Owner:
        def __init__(self):
            self.scene = supple.DistributedScene(WORLD, threads=1)
            self.scene.set_pair_filter(self.accepts)

        def accepts(self, a, b):
            return True

    owner = Owner()
    owner.scene.detect()
    expect("it must be a function of two objects", lambda: owner.scene.set_pair_filter(3))
    alive = weakref.ref(owner)
    del owner
    gc.collect()
    assert alive() is None


def calls_release_the_gil():
    """While one thread of rank 0 waits in `detect` for the other ranks, the main thread lets them go."""
    scene = supple.DistributedScene(WORLD, threads=1)
    if WORLD.rank == 0:
        entered = threading.Event()

        def detect():
            entered.set()
            scene.detect()

        thread = threading.Thread(target=detect)
        thread.start()
        entered.wait()
        for rank in range(1, WORLD.size):
            WORLD.send(None, rank)
        thread.join()
    else:
        WORLD.recv(source=0)
        scene.detect()


if __name__ == "__main__":
    for test in (
        random_scenes,
        placements,
        errors_are_those_of_all_ranks,
        wrong_input,
        other_communicators,
        a_stop_on_one_rank_stops_all,
        other_calls_on_one_rank,
        a_filter_that_reaches_its_scene_is_freed,
        calls_release_the_gil,
    ):
        test()
        if WORLD.rank == 0:
            print(test.__name__, flush=True)
