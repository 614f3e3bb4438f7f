"""The claims about Table 1 of the paper, and what they need of the runs of the experiments table1 and sensitivity."""

import math

import numpy as np

from judge import paper
from judge.estimates import Estimate, Test, counted, mean_of, quotient, ratio_of_sums
from judge.tables import MissingTable
from judge.verdicts import claim, scene_in_words

SIMULATED, DETECTION, PROGRAM = "in simulated time", "by the clock of the detection", "by the clock of the program"


def collisions(row, phase, clock):
    """Those of a run in simulated time, or in ten minutes of a clock."""
    if clock == SIMULATED:
        return row[phase]
    seconds = row["detection_seconds"] + (row["motion_seconds"] if clock == PROGRAM else row.get("bounds_seconds") or 0)
    return paper.RUN_SECONDS * row[phase] / seconds


def runs(tables, clock=SIMULATED, **wanted):
    """Runs that did not break off, in the first size of their scene. The program has runs of its own by its clock."""
    rows = []
    for name in ("table1_program_runs", "table1_runs"):
        if name in tables and (clock == PROGRAM or name == "table1_runs"):
            of_table = tables.rows(name, **wanted)
            known = {row["scene"] for row in rows}
            rows += [row for row in of_table if row["scene"] not in known]
    if not {"table1_runs", "table1_program_runs"} & set(tables.paths):
        raise MissingTable("table1_runs")
    first_edge = {}
    for row in rows:
        first_edge.setdefault(row["scene"], row["edge"])
    return [row for row in rows if row["edge"] == first_edge[row["scene"]] and not row["failure"]]


def scenes(tables, clock=SIMULATED):
    return list(dict.fromkeys(row["scene"] for row in runs(tables, clock)))


def objects_of(scene):
    """The number of pawns, fish and rabbits in a scene of Table 1; None for others."""
    number = scene.removeprefix("table1_")
    return int(number) if number != scene and number.isdigit() else None


def mixed(tables, clock=SIMULATED):
    return sorted(filter(None, map(objects_of, scenes(tables, clock))))


def ratio(tables, scene, phase, clock):
    """Collisions with spheres for each with boxes."""
    numbers = {}
    for row in runs(tables, clock, scene=scene):
        numbers.setdefault(row["volume"], {})[row["seed"]] = collisions(row, phase, clock)
    boxes, spheres = numbers.get("aabb", {}), numbers.get("sphere", {})
    seeds = [seed for seed in boxes if seed in spheres]
    return ratio_of_sums([spheres[seed] for seed in seeds], [boxes[seed] for seed in seeds])


def paper_ratio(objects, phase):
    return quotient(mean_of(paper.runs(objects, "sphere", phase)), mean_of(paper.runs(objects, "aabb", phase)))


def more_with_boxes(clock):
    def measure(tables):
        for objects in mixed(tables, clock):
            yield Test(ratio(tables, f"table1_{objects}", "broad", clock), high=1, when=f"there are {objects} objects")

    return measure


for short, clock in (("simulated", SIMULATED), ("detection", DETECTION), ("program", PROGRAM)):
    claim(f"more-with-boxes-{short}", "7, 1", f"Boxes have more collisions than spheres, {clock}.",
          "collisions with spheres / with boxes, broad phase")(more_with_boxes(clock))


@claim("proof-of-cost", "7, 1", "More collisions with boxes prove that their test costs less.",
       "% of the runs in simulated time in which the volumes have different numbers", "Without an influence of cost, the numbers are equal.",
       "In simulated time the cost of a test has no influence: the shapes alone make the numbers differ.")
def _(tables):
    broad = {}
    for row in runs(tables):
        broad.setdefault((row["scene"], row["seed"]), []).append(row["broad"])
    if broad:
        yield Test(counted(round(100 * np.mean([len(set(of_run)) > 1 for of_run in broad.values()]))), high=0)


@claim("narrow-is-fewer", "7, 2", "The narrow phase has fewer collisions than the broad phase.",
       "collisions of a run, broad phase − narrow phase")
def _(tables):
    for scene in scenes(tables):
        yield Test(mean_of([row["broad"] - row["narrow"] for row in runs(tables, scene=scene)]), low=0, when=f"there are {scene_in_words(scene)}")


@claim("time-explains-fewer", "7, 2", "The time of the narrow phase explains its smaller number.",
       "collisions of a run in simulated time, broad phase − narrow phase", "Where time has no influence, the numbers are equal.",
       "Volumes of objects can overlap while no leaves do, so a pair counts in the broad phase alone.")
def _(tables):
    differences = [row["broad"] - row["narrow"] for row in runs(tables)]
    if differences:
        yield Test(mean_of(differences), high=0)


@claim("ratio-nears-one", "7, 5", "With more objects the numbers with boxes and with spheres become similar.",
       "distance of the ratio from 1 with 3 objects − with 9 objects, broad phase")
def _(tables):
    for clock in (SIMULATED, DETECTION, PROGRAM):
        if not {3, 9} <= set(mixed(tables, clock)):
            continue
        few, many = (ratio(tables, f"table1_{objects}", "broad", clock) for objects in (3, 9))
        yield Test(Estimate(abs(few.mean - 1) - abs(many.mean - 1), math.hypot(few.standard_error, many.standard_error), min(few.freedom, many.freedom)),
                   low=0, when=f"they are counted {clock}")


@claim("almost-the-same", "7, 5", "The numbers are almost the same in the broad phase from 10 objects on, in the narrow phase from 20 on.",
       "collisions with spheres / with boxes", "They differ by at most 10 %.",
       "The paper counts by a clock, of which it does not say whether it stops during the motion.")
def _(tables):
    for clock in (SIMULATED, DETECTION, PROGRAM):
        for phase, least in (("broad", 10), ("narrow", 20)):
            for objects in mixed(tables, clock):
                if objects >= least:
                    yield Test(ratio(tables, f"table1_{objects}", phase, clock), 0.9, 1.1, f"the {phase} phase is counted {clock}")


@claim("more-objects", "7, 5", "With more objects a collision comes sooner.", "collisions of a run / with the next smaller number of objects")
def _(tables):
    numbers = {objects: mean_of([row["broad"] for row in runs(tables, scene=f"table1_{objects}", volume="aabb")]) for objects in mixed(tables)}
    sizes = list(numbers)
    for few, many in zip(sizes, sizes[1:]):
        yield Test(quotient(numbers[many], numbers[few]), low=1)


@claim("smaller-scene", "7, 1", "In a smaller scene there are more collisions.", "collisions in the small cube / in the large one")
def _(tables):
    of_scene = {}
    for row in tables.rows("table1_runs"):
        of_scene.setdefault((row["scene"], row["volume"]), {}).setdefault(row["edge"], []).append(row["broad"])
    for by_edge in of_scene.values():
        edges = sorted(by_edge)
        for small, large in zip(edges, edges[1:]):
            yield Test(quotient(mean_of(by_edge[small]), mean_of(by_edge[large])), low=1)


@claim("complex-humans", "7, 6", "Three humans have about the same collisions with both volumes.", "collisions with spheres / with boxes, broad phase",
       "They differ by at most 10 %.")
def _(tables):
    if "three_humans" in scenes(tables):
        for clock in (SIMULATED, DETECTION, PROGRAM):
            yield Test(ratio(tables, "three_humans", "broad", clock), 0.9, 1.1, f"they are counted {clock}")


@claim("complex-bikes", "7, 6", "Three bikes have one or two collisions more with boxes than with spheres.",
       "collisions of a run with boxes − with spheres, broad phase", "In simulated time, 0 to 2.5 more in the mean.")
def _(tables):
    numbers = {}
    for row in runs(tables, scene="three_bikes"):
        numbers.setdefault(row["seed"], {})[row["volume"]] = row["broad"]
    if numbers:
        yield Test(mean_of([of_run["aabb"] - of_run["sphere"] for of_run in numbers.values()]), 0, 2.5)


@claim("interactive", "8, 3", "All contacts are computed at interactive rates.", "milliseconds of a step",
       "Motion and detection of a step take less than 1/30 s.", "On a machine of today.")
def _(tables):
    for scene in scenes(tables):
        milliseconds = [1e3 * (row["detection_seconds"] + row["motion_seconds"]) / row["steps"] for row in runs(tables, scene=scene)]
        yield Test(mean_of(milliseconds), high=1e3 / 30, when=f"there are {scene_in_words(scene)}")


@claim("exact-counts-equal", "", "Exact contacts are the same with all volumes.", "runs with another number than with the first volume")
def _(tables):
    exact = {}
    for row in tables.rows("table1_runs"):
        exact.setdefault((row["scene"], row["edge"], row["seed"]), []).append(row["exact"])
    yield Test(counted(sum(len(set(of_run)) > 1 for of_run in exact.values())), high=0)


@claim("averages", "7, 2", "The averages of the text are those of Table 1.", "averages that differ by more than the last digit")
def _(tables):
    if "table1_runs" in tables:
        yield Test(counted(sum(how == "differs" for *_, how in paper.averages())), high=0)


@claim("convergence", "7, 5", "The ratio of spheres to boxes nears 1 from 3 to 9 objects: 0.50, 0.82 and 0.91; in the narrow phase 0.42, 0.74 and 0.71.",
       "settings and clocks that give all six ratios", "Some setting that the paper does not state gives its ratios.",
       "A ratio is given when ours and that of the paper do not differ at the level of 5 %, and ours is known to 0.3.")
def _(tables):
    yield Test(counted(len(settings_like_the_paper(tables))), low=1)


def sensitivity_ratios(tables):
    """(setting, clock, phase): the ratios by number of objects."""
    numbers = {}
    for row in tables.rows("sensitivity"):
        if not row["failure"]:
            for clock in (SIMULATED, DETECTION, PROGRAM):
                for phase in paper.PHASES:
                    of_case = numbers.setdefault((row["setting"], clock, phase), {}).setdefault(int(row["objects"]), {})
                    of_case.setdefault(row["volume"], []).append(collisions(row, phase, clock))
    return {key: {objects: ratio_of_sums(volumes["sphere"], volumes["aabb"]) for objects, volumes in of_case.items()}
            for key, of_case in numbers.items()}


def settings_like_the_paper(tables):
    ratios = sensitivity_ratios(tables)

    def is_like(key, phase):
        for objects, ours in ratios[*key, phase].items():
            theirs = paper_ratio(objects, phase)
            difference = Estimate(ours.mean - theirs.mean, math.hypot(ours.standard_error, theirs.error), min(ours.freedom, theirs.freedom))
            low, high = ours.interval()
            if not (difference.chance(0) > 0.05 and high - low < 0.6):
                return False
        return True

    return [key for key in dict.fromkeys(key[:2] for key in ratios) if all(is_like(key, phase) for phase in paper.PHASES)]
