"""Table 1 of the paper: collisions in five runs of 600 s, and the seconds for a collision that the text states."""

RUN_SECONDS = 600
# objects, volume: broad phase, narrow phase, seconds for one in the broad and in the narrow phase
TABLE1 = {
    (3, "aabb"): ([18, 35, 32, 17, 21], [14, 22, 18, 10, 9], 24.39, 41.09),
    (3, "sphere"): ([12, 18, 10, 15, 7], [7, 8, 7, 4, 5], 48.38, 96.77),
    (6, "aabb"): ([85, 69, 53, 43, 45], [51, 45, 37, 29, 29], 10.16, 15.70),
    (6, "sphere"): ([46, 53, 53, 49, 42], [31, 29, 32, 30, 19], 12.34, 21.27),
    (9, "aabb"): ([109, 78, 72, 66, 91], [64, 42, 51, 45, 42], 7.20, 12.29),
    (9, "sphere"): ([61, 84, 85, 86, 64], [24, 37, 45, 44, 24], 7.89, 17.24),
}
PHASES = ("broad", "narrow")


def runs(objects, volume, phase):
    return TABLE1[objects, volume][PHASES.index(phase)]


def averages():
    """Each average of the text: (objects, volume, phase, seconds by the table, in the text, how they compare)."""
    for (objects, volume), numbers in TABLE1.items():
        for i, phase in enumerate(PHASES):
            by_table = RUN_SECONDS * len(numbers[i]) / sum(numbers[i])
            text = numbers[2 + i]
            agrees = abs(round(by_table, 2) - text) < 0.001
            cut = abs(int(by_table * 100) / 100 - text) < 0.001
            yield objects, volume, phase, by_table, text, "agrees" if agrees else "cut off" if cut else "differs"
