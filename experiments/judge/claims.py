"""The claims of the paper and our own, and what is measured for each.

A claim says in our words what the paper says, and at which place. Each function below yields the numbers that decide
it, from the tables of the experiments. Tests with the same `when` decide together.
"""

import math

import numpy as np

from judge import table1  # noqa: F401: its claims come first
from judge.estimates import Estimate, Test, counted, exponent_of, mean_of, ratio_of, ratio_of_sums
from judge.verdicts import claim, scene_in_words

# Exponents may be above that of a formula by this: counts; and times, which caches and fixed costs change.
OF_COUNTS, OF_TIMES = 0.1, 0.25

# --- scaling ---


def step_seconds(tables, method, boxes, moving="all", is_first=False):
    """Seconds of a step in each round."""
    return [row["seconds"] for row in tables.rows("scaling_broad_phase", method=method, boxes=boxes, moving=moving)
            if (row["round"] == 0) == is_first]


def box_counts(tables, method, moving="all"):
    return sorted(set(tables.column("scaling_broad_phase", "boxes", method=method, moving=moving)))


def step_ratio(tables, a, b, boxes, moving="all"):
    return ratio_of(step_seconds(tables, a, boxes, moving), step_seconds(tables, b, boxes, moving))


def growth(tables, method, what, least=1000):
    """The exponent by which the seconds of a step, those of the first, or the tests of the last grow from `least` boxes on."""
    sizes, numbers = [], []
    for boxes in box_counts(tables, method):
        if boxes >= least:
            sizes.append(boxes)
            rows = tables.rows("scaling_broad_phase", method=method, boxes=boxes, moving="all")
            numbers.append(rows[-1]["tests"] if what == "tests" else min(step_seconds(tables, method, boxes, is_first=what == "first")))
    return exponent_of(sizes, numbers) if len(sizes) > 2 else None, sizes


def grows_as(found, formula, tolerance, when=""):
    exponent, sizes = found
    if exponent is not None:
        yield Test(exponent, high=exponent_of(sizes, [formula(size) for size in sizes]).mean + tolerance, when=when)


def n_log_n(n):
    return n * math.log(n)


@claim("better-than-brute", "7, 8", "The broad phase is better than brute force.", "time of brute force / of the octree of 2007, all boxes in motion",
       "As plain programs of 2007: scalar code, level-allowed 2.")
def _(tables):
    for boxes in box_counts(tables, "plain octree"):
        if boxes <= 1000:
            yield Test(step_ratio(tables, "plain brute force", "plain octree", boxes), low=1, when=f"there are {boxes:,.0f} objects")


@claim("better-than-brute-many", "", "Today's octree is better than today's brute force from 1,000 objects on.", "time of brute force / of the octree")
def _(tables):
    for boxes in box_counts(tables, "brute force"):
        if boxes >= 1000:
            yield Test(step_ratio(tables, "brute force", "octree", boxes), low=1, when=f"there are {boxes:,.0f} objects")


@claim("like-sweep", "7, 8", "The broad phase is comparable with sweep and prune.", "time of sweep and prune [Bar92] / of the octree of 2007",
       "As plain programs of 2007, with lists on three axes: within a factor of two.")
def _(tables):
    for boxes in box_counts(tables, "plain octree"):
        if boxes <= 1000:
            yield Test(step_ratio(tables, "plain sweep3", "plain octree", boxes), 0.5, 2, f"there are {boxes:,.0f} objects")


@claim("brute-force", "5, 1", "Brute force takes O(n²).", "exponent of the tests")
def _(tables):
    exponent, _ = growth(tables, "plain brute force", "tests", 3)
    if exponent:
        yield Test(exponent, 1.9, 2.1)


@claim("sweep", "5, 1", "Sweep and prune [Bar92], with lists on three axes, takes O(n log n).", "exponent of the exchanges and of the time",
       "At constant density, all boxes in motion.", "Each list holds the ends of all boxes, however far apart along the other axes.")
def _(tables):
    yield from grows_as(growth(tables, "plain sweep3", "tests", 100), n_log_n, OF_COUNTS, "the exchanges count")
    yield from grows_as(growth(tables, "plain sweep3", "step", 100), n_log_n, OF_TIMES, "the time counts")


@claim("three-axes", "", "Lists on three axes [Bar92] are faster than to sort along one axis in each step.", "time of three axes / of one")
def _(tables):
    for moving in ("all", "1 %"):
        for boxes in box_counts(tables, "sweep3", moving):
            if boxes >= 100:
                yield Test(step_ratio(tables, "sweep3", "sweep", boxes, moving), high=1, when=f"{moving} boxes move" if moving == "all" else f"{moving} of the boxes move")


@claim("region-tests", "7, 8", "The tests of regions and volumes take O(n log n).", "exponent of the time of the first step")
def _(tables):
    yield from grows_as(growth(tables, "octree of 2007", "first", 100), n_log_n, OF_TIMES, "level-allowed is 2")
    yield from grows_as(growth(tables, "octree of 2007, level-allowed grows", "first"), n_log_n, OF_TIMES, "level-allowed grows with the objects")


@claim("below-quadratic", "8, 3", "The broad phase takes less than O(n²).", "exponent of the time of a step",
       remark="When all objects overlap, there are n² pairs to report.")
def _(tables):
    for method, when in (("octree of 2007", "level-allowed is 2"), ("octree of 2007, level-allowed grows", "level-allowed grows with the objects")):
        exponent, _ = growth(tables, method, "step")
        if exponent:
            yield Test(exponent, high=2, when=when)


@claim("same-pairs", "", "All broad phases report the same pairs.", "methods and sizes with another number of pairs")
def _(tables):
    pairs = {}
    for row in tables.rows("scaling_broad_phase"):
        pairs.setdefault((row["boxes"], row["moving"], row["round"]), set()).add(row["pairs"])
    yield Test(counted(sum(len(found) > 1 for found in pairs.values())), high=0)


@claim("narrow-phase", "6, 8", "The narrow phase takes O(4^(log n) log n), the logarithm of base 8.", "exponent of the tests", "This is n^(2/3) log n.",
       "Surfaces that coincide need at least n tests with every hierarchy: every leaf collides with another.")
def _(tables):
    for pose in ("crossing", "coinciding"):
        sizes, tests = tables.column("scaling_vertices", "vertices", pose=pose), tables.column("scaling_vertices", "tests", pose=pose)
        yield from grows_as((exponent_of(sizes, tests), sizes), lambda n: n ** (2 / 3) * math.log(n), OF_COUNTS,
                            "the surfaces cross" if pose == "crossing" else "they coincide")


def vertices_growth(tables, quantity):
    seconds = tables.by("scaling_vertices_times", "vertices", "seconds", quantity=quantity)
    return exponent_of(list(seconds), [min(of_size) for of_size in seconds.values()]), list(seconds)


@claim("box-refit", "5.1, 2", "To refit the boxes takes O(V).", "exponent of the triangles read and of the time")
def _(tables):
    sizes = tables.column("scaling_vertices", "vertices", pose="crossing")
    read = exponent_of(sizes, tables.column("scaling_vertices", "triangles_refitted", pose="crossing"))
    yield from grows_as((read, sizes), lambda n: n, OF_COUNTS)
    yield from grows_as(vertices_growth(tables, "refit, boxes"), lambda n: n, OF_TIMES)


@claim("sphere-refit", "5.1, 3", "To refit a sphere by eq. 5 reads all vertices of the object, so it takes O(V).",
       "exponent of the time; reads of a vertex, largest mesh / smallest")
def _(tables):
    yield from grows_as(vertices_growth(tables, "refit, the sphere of the object"), lambda n: n, OF_TIMES,
                        "it is the sphere of the object, as the paper describes")
    reads = [row["sphere_reads"] / row["vertices"] for row in tables.rows("scaling_vertices", pose="crossing")]
    yield Test(counted(reads[-1] / reads[0]), high=1.1, when="each node has a sphere")


@claim("build", "6, 4", "To build the octree of an object takes O(n log n).", "exponent of the time")
def _(tables):
    yield from grows_as(vertices_growth(tables, "build"), n_log_n, OF_TIMES)


# --- claims ---


@claim("test-cost", "5.2, 4", "A test of two spheres costs more than one of two boxes.", "time of a test of boxes / of spheres",
       remark="The paper counts 11 operations for spheres and 15 for boxes; six comparisons are enough for boxes.")
def _(tables):
    cases = (("scalar", "boxes", "one by one, and the first comparison that fails ends a test of boxes"),
             ("scalar", "boxes without branches", "one by one without branches"), ("vectors", "boxes", "many at once, with vectors"))
    for code, boxes, when in cases:
        of_boxes, of_spheres = (tables.column("claims_tests", "seconds", code=code, volume=volume) for volume in (boxes, "spheres"))
        yield Test(ratio_of(of_boxes, of_spheres), high=1, when=f"tests are made {when}")


@claim("grown-box", "5.1, 4", "The grown box is easier to test than Arvo's closest point.", "time with the grown box / with Arvo's test",
       remark="The grown box places spheres in more regions, near edges and corners.")
def _(tables):
    for column, when in (("fresh_seconds", "the octree is new"), ("step_seconds", "it is a step that follows another")):
        grown, arvo = (tables.column("claims_regions", column, test=test) for test in ("grown_box", "arvo"))
        yield Test(ratio_of(grown, arvo), high=1, when=when)


def depth_growth(tables, surface):
    return mean_of(np.diff(tables.column("claims_depths", "mean_depth", surface=surface)))


@claim("smaller-primitives", "7, 7", "Smaller triangles mean a deeper octree.", "levels more for triangles of half the size")
def _(tables):
    yield Test(depth_growth(tables, "sphere"), low=0.5)


@claim("more-primitives", "7, 7", "More triangles of the same size do not mean a large depth.", "levels more for four times as many triangles",
       remark="The depth follows the size of the object divided by that of its triangles.")
def _(tables):
    deeper = depth_growth(tables, "sheet")
    yield Test(deeper, high=1.1, when="it grows as the logarithm")
    yield Test(deeper, high=0.1, when="it does not grow")


@claim("regions-of-an-object", "5, 3", "An object is in one, two or four regions.", "% of the boxes in eight regions",
       remark="Boxes as large as a region or smaller; one around a corner is in eight.")
def _(tables):
    boxes = {row["regions"]: row["boxes"] for row in tables.rows("claims_object_regions")}
    share, count = boxes[8] / sum(boxes.values()), sum(boxes.values())
    yield Test(Estimate(100 * share, 100 * math.sqrt(share * (1 - share) / count)), high=0)


@claim("levels", "5, 5", "level-allowed is 4 with 512 leaves.", "leaves of a full octree of level 4", remark="512 leaves are those of level 3.")
def _(tables):
    if "claims_depths" in tables:
        yield Test(counted(8**4), 512, 512)


@claim("large-spheres", "5.1, 3", "The sphere of eq. 3 and 4 is too large; that of eq. 5 is more accurate.", "radius of eq. 4 / of eq. 5, mean of five models",
       "Its radius is larger than that of eq. 5.", "Half of the longest edge of the box is too small at the corners: vertices are outside.")
def _(tables):
    yield Test(mean_of([row["radius_box"] / row["radius_vertices"] for row in tables.rows("claims_spheres")]), low=1)


@claim("translation", "5.2, 5", "To add the translation to the volume is quick.", "time of a translation / of a refit", "Less than a tenth of a refit.")
def _(tables):
    moved, refitted = (tables.column("claims_translation", "seconds", update=update) for update in ("translation", "refit"))
    yield Test(ratio_of(moved, refitted), high=0.1)


@claim("one-loop", "5.2, 6", "To make the boxes in the loop of the motion is better than a loop of their own.", "time of a step with two loops / with one",
       "Nine objects of Table 1, motion and detection.")
def _(tables):
    one, two = (tables.column("claims_loops", "seconds", loops=loops) for loops in (1, 2))
    yield Test(ratio_of(two, one), low=1)


@claim("slower-motion", "7, 6", "With more primitives the motion is slower.", "exponent of the time of a step, by vertices")
def _(tables):
    seconds = tables.by("claims_motion", "vertices", "seconds")
    yield Test(exponent_of(list(seconds), [min(of_model) for of_model in seconds.values()]), low=0.5)


@claim("verlet", "4, 7", "Verlet integration is more stable and realistic than backward Euler.",
       "longest step that stays bounded, Verlet / backward Euler; error of the energy, the same")
def _(tables):
    longest, error = {}, {}
    for row in tables.rows("claims_integrators"):
        if row["energy_kept"] != "unstable":
            longest[row["integrator"]] = row["of_stable_step"]
            error.setdefault(row["integrator"], abs(row["energy_kept"] - 1))
    yield Test(counted(error["verlet"] / error["backward_euler"]), high=1, when="realistic means that a body without damping keeps its energy")
    yield Test(counted(longest["verlet"] / longest["backward_euler"]), low=1, when="stable means that long steps stay bounded")


@claim("areas", "4, 1", "The area of each triangle is preserved.", "mean change of the area of a triangle, % of it", "It changes by less than 5 % in the mean.")
def _(tables):
    for row in tables.rows("claims_areas", preserved="yes"):
        yield Test(counted(100 * row["mean_area_error"]), high=5, when=f"there are {scene_in_words(row['scene'])}")


@claim("limits", "4, 3", "The shape stays within limits.", "largest strain of an edge, %", "No edge is strained by more than 15 %.")
def _(tables):
    for row in tables.rows("claims_areas", preserved="yes"):
        of_runs = tables.column("table1_runs", "largest_strain", scene=row["scene"]) if "table1_runs" in tables else []
        yield Test(counted(100 * max([row["largest_strain"], *of_runs])), high=15, when=f"there are {scene_in_words(row['scene'])}")


# --- arity ---


def of_arity(tables, number, arity, leaf_size):
    """A number of each case."""
    return [number(row) for row in tables.rows("arity_objects", arity=arity, leaf_size=leaf_size)]


@claim("four-and-eight", "2, 3", "For bodies that bend, trees of four or eight children are better than binary ones [LAM01].",
       "volumes tested and refitted, the better of four and eight / two", "At least 5 % fewer volumes are tested and refitted.")
def _(tables):
    sizes = sorted(set(tables.column("arity_objects", "leaf_size")))
    for leaf_size in sizes:
        work = {arity: of_arity(tables, lambda row: row["tests"] + row["nodes"] * row["children_per_node"], arity, leaf_size) for arity in (2, 4, 8)}
        best = min((ratio_of(work[arity], work[2]) for arity in (4, 8)), key=lambda ratio: ratio.mean)
        yield Test(best, high=0.95, when="leaves have one triangle" if leaf_size == 1 else f"leaves have up to {leaf_size:.0f} triangles")


@claim("log-k", "7, 8", "With k-ary trees in the broad phase the complexity changes in the logarithm of base k.",
       "levels of the tree of the scene, two or four children / eight", "Three times as many levels with two children as with eight, 1.5 times with four; ± 20 %.")
def _(tables):
    for boxes in sorted(set(tables.column("arity_scene", "boxes"))):
        depth = {row["arity"]: row["depth"] for row in tables.rows("arity_scene", boxes=boxes)}
        yield Test(counted(depth[2] / depth[8]), 2.4, 3.6)
        yield Test(counted(depth[4] / depth[8]), 1.2, 1.8)


@claim("colliding-children", "6, 7", "At most half of the children of a node collide: 4 of 8, 2 of 4, 1 of 2.", "children of a node that collide, at most")
def _(tables):
    for arity, most in tables.by("arity_colliding_children", "arity", "most").items():
        yield Test(counted(max(most)), high=arity / 2, when=f"nodes have {arity:.0f} children")


@claim("steps-of-a-level", "7, 9", "A pair of nodes takes at most 8 (4 + 1) steps.", "tests of a pair of nodes, at most")
def _(tables):
    yield Test(counted(8 + 8 * max(tables.column("arity_colliding_children", "most", arity=8))), high=40)


@claim("k-ary-scene", "7, 8", "The broad phase can have k-ary trees.", "scenes with other pairs than with eight children", "All find the same pairs.")
def _(tables):
    pairs = tables.by("arity_scene", "boxes", "pairs")
    yield Test(counted(sum(len(set(of_scene)) > 1 for of_scene in pairs.values())), high=0)


# --- volumes ---


def same_contacts(name, variant, left_out=()):
    def measure(tables):
        hashes = {}
        for row in tables.rows(name):
            if row[variant] not in left_out:
                hashes.setdefault(row["case"], set()).add(row["hash_of_contacts"])
        yield Test(counted(sum(len(of_case) > 1 for of_case in hashes.values())), high=0)

    return measure


claim("same-contacts-volumes", "", "All volumes that enclose their triangles give the same contacts.", "cases with different contacts",
      remark="Spheres of eq. 3 and 4 do not enclose them, and miss contacts.")(same_contacts("volumes", "volume", ("sphere (box)",)))
claim("same-contacts-builds", "", "All ways to build an octree give the same contacts.", "cases with different contacts")(
    same_contacts("volumes_builds", "build"))


@claim("tighter-nodes", "8, 4", "Tighter nodes, by a method like that of [BO04], are worth a study.", "tests with one tight sphere in each node / with others",
       "One tight sphere in each node needs fewer tests than spheres of eq. 5, and than boxes.",
       "A medial sphere has its centre on the medial axis at rest; the smallest one is the tightest that encloses the vertices.")
def _(tables):
    tests = tables.by("volumes", "volume", "tests")
    for tight, kind in (("sphere (medial)", "medial"), ("sphere (minimal)", "smallest")):
        for other, others in (("sphere (vertices)", "spheres of eq. 5"), ("aabb", "boxes")):
            both = [(a, b) for a, b in zip(tests.get(tight, ()), tests[other]) if a and b]
            if both:
                yield Test(ratio_of(*zip(*both)), high=1, when=f"{kind} spheres replace {others}")


# --- trials ---


def trial_ratio(tables, scene, trial):
    return ratio_of(*(tables.column("trials", "seconds", scene=scene, trial=name) for name in (trial, "the hierarchy")))


def slower_trial(trial):
    def measure(tables):
        for scene in dict.fromkeys(tables.column("trials", "scene")):
            yield Test(trial_ratio(tables, scene, trial), low=1, when=f"there are {scene_in_words(scene)}")

    return measure


claim("scene-octree", "6, 1", "To search the regions of the scene's octree is too expensive.", "time of the trial / of the hierarchy")(
    slower_trial("regions of the scene octree"))
claim("common-region", "6, 2", "To search the common region of two boxes needs more computation.", "time of the trial / of the hierarchy")(
    slower_trial("the common region"))


@claim("neighbours", "6, 1", "The neighbours of a vertex are not enough: parts that are far apart can be near in the next step.", "% of the contacts missed",
       "Two rings around the pairs of the step before miss contacts.")
def _(tables):
    for scene in dict.fromkeys(tables.column("trials", "scene")):
        rows = tables.rows("trials", scene=scene, trial="neighbours of a vertex")
        if rows[0]["contacts"]:
            yield Test(counted(100 * rows[0]["missed"] / rows[0]["contacts"]), low=0.01)


@claim("fewer-vertices", "6, 3", "With a hierarchy fewer vertices are checked.", "vertices that the refit of the parts that collide reads / all vertices")
def _(tables):
    for row in tables.rows("trials_corners"):
        read = tables.column("trials", "vertices", scene=row["scene"], trial="the hierarchy")[0]
        yield Test(counted(read / row["all"]), high=1, when=f"there are {scene_in_words(row['scene'])}")


@claim("octree-of-spheres", "5.1, 3", "An octree of spheres for the scene is less accurate than one of cubes.", "pairs of objects that share a region, spheres / cubes")
def _(tables):
    yield Test(ratio_of_sums(tables.column("trials_spheres", "pairs_in_spheres"), tables.column("trials_spheres", "pairs_in_cubes")), low=1)


# --- ablation ---


def program_seconds(tables, scene, place):
    return tables.column("ablation", "total_seconds", scene=scene, place=place)


@claim("today-is-faster", "", "Today's defaults, which also decide all contacts exactly, are faster than the program of 2007.", "time of the program of 2007 / of today")
def _(tables):
    for scene in dict.fromkeys(tables.column("ablation", "scene")):
        last = max(tables.column("ablation", "place", scene=scene))
        yield Test(ratio_of(program_seconds(tables, scene, 0), program_seconds(tables, scene, last)), low=1, when=f"there are {scene_in_words(scene)}")
