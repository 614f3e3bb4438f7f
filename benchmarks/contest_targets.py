"""What a contest measured, against the targets of the project."""

import math
import re
import statistics

FIELDS = ["u1", "u8", "clu", "cl8"]
BASELINES = {"baseline sweep", "baseline grid"}


def quartiles(values):
    """The three quartiles."""
    if len(values) < 2:
        return [values[0]] * 3
    return statistics.quantiles(values, n=4, method="inclusive")


def summarised(cells):
    """The cells with quartiles in place of the times of all frames, and stages that are shares of the median frame."""
    results = []
    for cell in cells:
        contestants = []
        for c in cell["contestants"]:
            share = statistics.median(c["cpu_ms"]) / statistics.mean(c["cpu_ms"])
            contestants.append({"name": c["name"], "threads": c["threads"], "pairs": c["pairs"], "frames": len(c["cpu_ms"]),
                                "cpu_ms": quartiles(c["cpu_ms"]), "wall_ms": quartiles(c["wall_ms"]),
                                "stage_ms": {stage: share * ms for stage, ms in c["mean_stage_ms"].items()}})
        results.append({"cell": cell["cell"], "skipped": cell["skipped"], "values": cell["values"],
                        "contestants": contestants})
    return results


class Judge:
    """Rows of the table: the result of each cell and its target."""

    def __init__(self, cells):
        self.cells = {cell["cell"]: cell for cell in cells if not cell["skipped"]}
        self.rows = []

    def median(self, cell, name, clock="cpu_ms"):
        for contestant in self.cells.get(cell, {"contestants": []})["contestants"]:
            if contestant["name"] == name:
                return contestant[clock][1]
        return None

    def best(self, cell, names):
        """The time and name of the fastest contestant that is present."""
        times = [(self.median(cell, name), name) for name in names]
        return min((pair for pair in times if pair[0] is not None), default=(None, None))

    def add(self, row, cell, against, value, reach, aim, smaller_is_better=False):
        if value is None:
            return
        sign = -1 if smaller_is_better else 1
        met = "aim" if sign * value >= sign * aim else "reach" if sign * value >= sign * reach else "missed"
        self.rows.append({"row": row, "cell": cell, "against": against, "ratio": value, "reach": reach, "aim": aim,
                          "smaller_is_better": smaller_is_better, "met": met})

    def add_faster(self, row, cell, names, reach, aim, supple="Supple"):
        """Adds the ratio of the best other contestant's time to Supple's time."""
        best, name = self.best(cell, names)
        own = self.median(cell, supple)
        if best is not None and own:
            self.add(row, cell, name, best / own, reach, aim)

    def libraries(self, cell):
        """The other libraries in their fastest form: without contact points."""
        return [c["name"] for c in self.cells[cell]["contestants"]
                if c["name"] not in BASELINES and not c["name"].startswith("Supple")
                and not c["name"].endswith(", contact points")]

    def matching(self, pattern):
        return [name for name in self.cells if re.fullmatch(pattern, name)]


def exponent(points):
    """The exponent of a power law, fitted by least squares of logarithms."""
    xs, ys = [math.log(x) for x, _ in points], [math.log(y) for _, y in points]
    x_mean, y_mean = statistics.mean(xs), statistics.mean(ys)
    return (sum((x - x_mean) * (y - y_mean) for x, y in zip(xs, ys))
            / sum((x - x_mean) ** 2 for x in xs))


def growth_points(judge):
    """The name and the (size, milliseconds) of each series that shows growth."""
    series = []
    for field in FIELDS:
        points = [(int(cell.split("/")[2]), judge.median(cell, "Supple"))
                  for cell in judge.matching(f"A/{field}/[0-9]+")]
        series.append((f"objects, {field}", sorted(points)))
    points = [(judge.cells[cell]["values"]["triangles"], judge.median(cell, "Supple"))
              for cell in judge.matching("growth/.*")]
    series.append(("triangles, two spheres", sorted(points)))
    return [(name, points) for name, points in series if len(points) >= 3]


def judge_refit(judge, cell):
    """Compares the refit with two ideals: one with as many leaf boxes, so a shallower tree is no advantage,
    and one with four triangles per box."""
    own = next((c for c in judge.cells[cell]["contestants"] if c["name"] == "Supple"), None)
    for row, ideal in (("refit alone, leaves as wide", "ideal, leaves as wide"),
                       ("refit alone, 4 triangles a box", "ideal, 4 per slot")):
        limit = judge.median(cell, ideal)
        if own and limit:
            judge.add(row, cell, ideal, own["stage_ms"]["refit alone"] / limit, 2, 1.3, True)


def judged(cells):
    judge = Judge(cells)
    copies = [("B 69,620 × 64, contact points, against pairs", "B/69620x64", 5, 8),
              ("B 18,000 × 9 and × 64, contact points, against pairs", "B/18000x(9|64)", 4.5, 7),
              ("B 980 × 64 and × 512, contact points, against pairs", "B/980x(64|512)", 4, 6),
              ("B bunny × 9, contact points, against pairs", "B/bunnyx9", 6, 9),
              ("B with 90 % of the objects at rest, contact points, against pairs", "B/.*-rest", 10, 30)]
    for row, pattern, reach, aim in copies:
        for cell in judge.matching(pattern):
            judge.add_faster(row, cell, judge.libraries(cell), reach, aim)
    for cell in judge.matching("B/.*"):
        judge.add_faster("B, contact points in both", cell, ["Embree, contact points"], 4, 6)
    for cell in judge.matching("B/.*"):
        points, pairs = judge.median(cell, "Supple"), judge.median(cell, "Supple, pairs only")
        if points and pairs:
            judge.add("B, cost of contact points and normals", cell, "Supple, pairs only", points / pairs, 1.15, 1.05,
                      True)
    for cell in judge.matching("limits/refit/.*"):
        judge_refit(judge, cell)
    boxes = judge.matching("A/[a-z0-9]+/[0-9]+")
    for cell in boxes:
        judge.add_faster("A, the best library", cell, judge.libraries(cell), 4, 6)
    for cell in boxes:
        judge.add_faster("A, the baselines", cell, BASELINES, 0.85, 1)
    for cell in judge.matching("A/[a-z0-9]+/100000"):
        judge.add_faster("A, the octree against Embree", cell, ["Embree"], 2.5, 3.8, "Supple octree")
    for cell in judge.matching("A/.*/drift"):
        drifted, fresh = judge.median(cell, "Supple, drifted"), judge.median(cell, "Supple, fresh")
        judge.add("A after 500 frames of drift", cell, "Supple, fresh", drifted / fresh, 1.1, 1, True)
    for cell in judge.matching("A/.*/one-percent"):
        judge.add_faster("A with 1 % of the boxes moving", cell, ["Supple, all move"], 3, 6,
                         "Supple, one percent moves")
        judge.add_faster("A with 1 % of the boxes moving, dirty list", cell, ["Supple, all move"], 3, 6,
                         "Supple, one percent moves, dirty list")
    for cell in judge.matching("C/.*"):
        judge.add_faster("C, candidates and verdicts, against Embree's candidates", cell, ["Embree"], 2.5, 4)
    for cell in judge.matching("E/.*"):
        judge.add_faster("E, element boxes by kinds, against the best library", cell, judge.libraries(cell), 1.5, 2)
    for cell in judge.matching("P/.*"):
        judge.add_faster("P, proximity by features, against Embree with plain distances", cell, ["Embree"], 1.5, 2)
    for cell in judge.matching("Q/(closest|rays)/.*"):
        reach = 0.5 if "rays" in cell else 1
        judge.add_faster(f"Q, {cell.split('/')[1]}, against Embree", cell, ["Embree"], reach, 2 * reach)
    for cell in judge.matching("Q/(closest|inside|penetration)/.*"):
        judge.add_faster(f"Q, {cell.split('/')[1]}, against CGAL", cell, ["CGAL"], 20, 30)
    for cell in judge.matching("Q/distance/.*"):
        judge.add_faster("Q, distance, against FCL", cell, ["FCL"], 10, 20)
    for cell in judge.matching("step/.*"):
        values = judge.cells[cell]["values"]
        judge.add("safe step", cell, "Supple, detect", values["milliseconds"] / values["milliseconds of detect"], 0.5,
                  0.3, True)
    for clock in ("build", "frame"):
        points = [(cell["values"]["triangles"], cell["values"][f"milliseconds, {clock}"])
                  for cell in map(judge.cells.get, judge.matching("scale/.*"))]
        if len(points) > 1:
            judge.add(f"growth of the {clock}, exponent", "one sphere with itself", "linear", exponent(points), 1.05, 1, True)
    for cell in judge.matching("build/.*"):
        values = judge.cells[cell]["values"]
        balanced = values["milliseconds, balanced"]
        judge.add("build of a balanced octree", cell, "Supple, regular", balanced / values["milliseconds, regular"], 1.1,
                  1, True)
        judge.add("build on two threads", cell, "Supple, 1 thread",
                  balanced / values["milliseconds, balanced, 2 threads"], 1.7, 1.9)
    for cell in judge.matching("first/.*"):
        judge.add_faster("first frame of a process", cell, ["Embree"], 1, 2)
    for cell in judge.matching("frames/.*"):
        values = judge.cells[cell]["values"]
        judge.add("99.9th percentile of frames", cell, "median",
                  values["milliseconds, 99.9th percentile"] / values["milliseconds, median"], 2, 1.3, True)
    for cell in judge.matching("frames/surgery"):
        for with_curves, reach in (("", 1.0), (", with curves", 1.5)):
            judge.add("99th percentile of frames with penetration" + with_curves + ", milliseconds", cell, "",
                      judge.cells[cell]["values"]["milliseconds, 99th percentile" + with_curves], reach, 0.8 * reach,
                      True)
    for cell in judge.matching("edit/.*"):
        values = judge.cells[cell]["values"]
        for what, reach in (("an edit", 0.05), ("a frame with an edit", 1.0)):
            judge.add(f"99th percentile of {what}, milliseconds", cell, "",
                      values[f"milliseconds, 99th percentile of {what}"], reach, 0.8 * reach, True)
        judge.add("frame with an edit", cell, "remove and add", values["milliseconds, median of a frame with remove and add"]
                  / values["milliseconds, median of a frame with an edit"], 5, 10)
        judge.add("queries after all edits", cell, "a fresh octree", values["milliseconds of queries, edited"]
                  / values["milliseconds of queries, fresh"], 1.15, 1.05, True)
    for cell in judge.matching("game/.*"):
        values = judge.cells[cell]["values"]
        judge.add("manifolds", cell, "a plain loop",
                  values["milliseconds of manifolds"] / values["milliseconds of a plain loop"], 1.5, 1, True)
    for cell in judge.matching("process/.*"):
        judge.add_faster("whole process supple detect", cell, ["CGAL"], 2, 4)
    for cell in judge.matching("threads/.*"):
        one, two = judge.median(cell, "Supple", "wall_ms"), judge.median(cell, "Supple, 2 threads", "wall_ms")
        judge.add("two threads", cell, "Supple, 1 thread", one / two, 1.8, 1.95)
    for name, points in growth_points(judge):
        judge.add("growth, exponent", name, "linear", exponent(points), 1.1, 1.05, True)
    for cell in judge.matching("memory/[^/]*"):
        judge.add("memory besides the mesh, bytes a triangle", cell, "", judge.cells[cell]["values"]
                  ["heap bytes a triangle"], 64, 40, True)
    for cell in judge.matching("memory/moving/.*"):
        judge.add("memory of moving objects, bytes a triangle", cell, "", judge.cells[cell]["values"]
                  ["heap bytes a triangle"], 110, 80, True)
    return judge
