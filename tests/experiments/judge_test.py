"""The statistics that judge the paper's claims, against numbers from elsewhere, and verdicts on made-up runs."""

import math
import pathlib
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "experiments"))
from judge.pages import try_debians_python  # noqa: E402

try:
    from judge import claims, paper, table1, verdicts  # noqa: F401: claims fills the register
    from judge.estimates import Estimate, Test, counted, exponent_of, mean_of, quotient, ratio_of, ratio_of_sums, set_levels, text_of
    from judge.tables import MissingTable, Tables
except ImportError:
    try_debians_python()
    print("skipped: there is no scipy (apt-get install python3-scipy)")
    sys.exit(77)

COLUMNS = ("setting", "scene", "edge", "volume", "seed", "objects", "broad", "narrow", "exact", "steps", "bounds_seconds",
           "detection_seconds", "motion_seconds", "mean_strain", "largest_strain", "failure")


class Estimates(unittest.TestCase):
    def test_intervals_are_those_of_student(self):
        low, high = mean_of([1, 2, 3, 4, 5]).interval()
        # t of 4 degrees of freedom is 2.7764 at 97.5 %, and the standard error sqrt(2.5 / 5).
        self.assertAlmostEqual(high - 3, 2.7764451 * math.sqrt(0.5), 6)
        self.assertAlmostEqual(3 - low, high - 3)
        self.assertEqual(counted(7).interval(), (7, 7))
        self.assertEqual(mean_of([3]).interval(), (-math.inf, math.inf))
        self.assertAlmostEqual(mean_of([1, 2, 3, 4, 5]).chance(0), 0.0132356, 6)  # t = 4.2426

    def test_ratios(self):
        ratio = ratio_of([2, 8], [1, 1])
        self.assertAlmostEqual(ratio.mean, 4)
        low, high = ratio.interval()
        self.assertAlmostEqual(low * high, 16)
        sums = ratio_of_sums([2, 4, 6], [1, 2, 3])
        self.assertEqual(sums.mean, 2)
        self.assertFalse(math.isfinite(sums.error), "equal ratios say nothing about other runs")
        # Without one pair each: 7/5, 5/4, 4/3.
        sums = ratio_of_sums([1, 3, 4], [1, 2, 3])
        without = [math.log(ratio) for ratio in (7 / 5, 5 / 4, 4 / 3)]
        mean = sum(without) / 3
        self.assertAlmostEqual(sums.error, math.sqrt(2 / 3 * sum((value - mean) ** 2 for value in without)))
        self.assertGreater(ratio_of_sums([1, 9, 1], [9, 1, 1]).interval()[0], 0)
        self.assertFalse(ratio_of_sums([0, 2, 0], [1, 1, 1]).of_logarithm, "without one run nothing is left")
        self.assertTrue(math.isnan(ratio_of_sums([1], [0]).mean))
        self.assertTrue(math.isnan(quotient(mean_of([1, 2]), mean_of([0, 0])).mean))
        self.assertAlmostEqual(quotient(Estimate(0, 0.6, 4), Estimate(3, 0.3, 4)).error, 0.2)
        self.assertTrue(math.isfinite(ratio_of([0, 1e-6], [1e-6, 0]).mean), "a clock may say 0")
        self.assertAlmostEqual(quotient(Estimate(6, 0.6, 4), Estimate(3, 0.3, 4)).error, 2 * math.hypot(0.1, 0.1))

    def test_exponents(self):
        sizes = [1, 10, 100, 1000]
        self.assertAlmostEqual(exponent_of(sizes, [3 * n**1.5 for n in sizes]).mean, 1.5)
        self.assertEqual(exponent_of(sizes[:2], [1, 2]).interval(), (-math.inf, math.inf))

    def test_a_number_is_undecided_when_its_interval_has_the_limit(self):
        number = mean_of([1, 2, 3, 4, 5])
        low, high = number.interval()
        self.assertTrue(Test(number, low=low - 1e-9).outcome())
        self.assertIsNone(Test(number, low=low + 1e-9).outcome())
        self.assertFalse(Test(number, low=high + 1e-9).outcome())
        self.assertTrue(Test(number, 0, 6).outcome())
        self.assertIsNone(Test(number, 2, 6).outcome())
        self.assertIsNone(Test(Estimate(math.nan, math.inf, 1), high=1).outcome())

    def test_many_are_judged_by_holm(self):
        # Chances 0.01, 0.02, 0.03 and 0.2: the first passes 0.05 / 4, the second does not pass 0.05 / 3.
        from scipy import stats
        tests = [Test(Estimate(stats.norm.isf(chance / 2), 1), low=0) for chance in (0.03, 0.01, 0.2, 0.02)] + [Test(counted(1), low=0)]
        set_levels(tests)
        self.assertEqual([test.outcome() for test in tests], [None, True, None, None, True])
        alone = Test(Estimate(stats.norm.isf(0.015), 1), low=0)
        set_levels([alone])
        self.assertTrue(alone.outcome())

    def test_texts(self):
        self.assertEqual(text_of(counted(4096)), "4,096")
        self.assertEqual(text_of(counted(0.5)), "0.500")
        self.assertTrue(text_of(mean_of([1, 2, 3, 4, 5])).startswith("3.00 [1.04, 4.96]"))


class Claims(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def judged(self, rows):
        """The claims by name that runs decide: (scene, volume, numbers of the seeds, more columns)."""
        lines = [",".join(COLUMNS)]
        for scene, volume, numbers, more in rows:
            for seed, number in enumerate(numbers):
                row = dict.fromkeys(COLUMNS, "0") | {
                    "setting": "", "scene": scene, "edge": "6", "volume": volume, "seed": str(seed), "objects": scene.split("_")[1], "broad": str(number),
                    "narrow": str(number), "steps": "100", "detection_seconds": "1", "motion_seconds": "1", "failure": ""} | more
                lines.append(",".join(row[column] for column in COLUMNS))
        (self.folder / "table1_runs.csv").write_text("\n".join(["# commit: 0", *lines, ""]))
        return {claim.name: claim for claim in verdicts.judged(Tables(self.folder))}

    def test_a_verdict_names_the_cases_in_which_it_holds(self):
        found = self.judged([("table1_3", "aabb", (10, 11, 12, 11, 10), {}), ("table1_3", "sphere", (5, 6, 5, 5, 6), {}),
                             ("table1_9", "aabb", (100, 110, 105, 108, 102), {}), ("table1_9", "sphere", (150, 160, 152, 171, 149), {})])
        self.assertEqual(found["more-with-boxes-simulated"].verdict, "Holds if there are 3 objects")
        self.assertEqual(list(found["more-with-boxes-simulated"].cases().values()), [True, False])
        found_more = self.judged([("table1_3", "aabb", (9, 2, 5, 3, 9), {}), ("table1_3", "sphere", (5, 6, 5, 5, 6), {}),
                                  ("table1_9", "aabb", (100, 110, 105, 108, 102), {}), ("table1_9", "sphere", (150, 160, 152, 171, 149), {})])
        self.assertEqual(found_more["more-with-boxes-simulated"].verdict, "Does not hold if there are 9 objects")
        self.assertEqual(found["more-objects"].verdict, "Holds")
        self.assertEqual(found["averages"].verdict, "Does not hold")
        self.assertNotIn("test-cost", found, "its table is missing")

    def test_equal_times_of_the_clock_change_the_ratio(self):
        slow = {"detection_seconds": "3", "bounds_seconds": "1"}
        found = self.judged([("table1_9", "aabb", (100, 110, 105, 108, 102), {}), ("table1_9", "sphere", (150, 160, 152, 171, 149), slow)])
        self.assertEqual(found["more-with-boxes-simulated"].verdict, "Does not hold")
        self.assertEqual(found["more-with-boxes-detection"].verdict, "Holds")
        # By the program: 1.5 / (4 / 2).
        self.assertAlmostEqual(found["more-with-boxes-program"].tests[0].number.mean, 782 / 525 / 2)

    def test_noise_is_undecided_and_runs_that_broke_off_do_not_count(self):
        broken = ("table1_9", "sphere", (0,), {"failure": "blew up", "seed": "9"})
        found = self.judged([("table1_9", "aabb", (100, 50, 120, 80, 110), {}), ("table1_9", "sphere", (60, 110, 90, 130, 70), {}), broken])
        self.assertEqual(found["more-with-boxes-simulated"].verdict, "Undecided")
        self.assertEqual(len(found["more-with-boxes-simulated"].tests), 1)

    def test_smaller_scenes(self):
        small = {"edge": "4"}
        large = ("table1_9", "aabb", (10, 11, 12), {})
        self.assertEqual(self.judged([large, ("table1_9", "aabb", (30, 31, 32), small)])["smaller-scene"].verdict, "Holds")
        self.assertEqual(self.judged([large, ("table1_9", "aabb", (2, 3, 4), small)])["smaller-scene"].verdict, "Does not hold")
        self.assertEqual(self.judged([large, ("table1_9", "aabb", (11, 12, 13), small)])["smaller-scene"].verdict, "Undecided")

    def test_the_paper_has_one_average_that_differs(self):
        compared = {(objects, volume, phase): how for objects, volume, phase, *_, how in paper.averages()}
        self.assertEqual(compared[3, "aabb", "broad"], "agrees")  # 600 / 24.6 = 24.390
        self.assertEqual(compared[3, "sphere", "broad"], "cut off")  # 600 / 12.4 = 48.387, the text has 48.38
        self.assertEqual([case for case, how in compared.items() if how == "differs"], [(9, "aabb", "broad")])
        self.assertAlmostEqual(table1.paper_ratio(3, "broad").mean, 12.4 / 24.6)

    def test_each_claim_has_a_name_of_its_own_and_a_quantity(self):
        names = [claim.name for claim, _ in verdicts.CLAIMS]
        self.assertEqual(len(names), len(set(names)))
        for claim, _ in verdicts.CLAIMS:
            self.assertTrue(claim.text.endswith(".") and claim.quantity, claim.name)

    def test_a_missing_table_is_no_error_and_a_missing_column_is(self):
        self.assertEqual(verdicts.judged(Tables(self.folder)), [])
        with self.assertRaises(MissingTable):
            Tables(self.folder).rows("table1_runs")
        (self.folder / "claims_depths.csv").write_text("surface\nsphere\n")
        with self.assertRaises(KeyError):
            verdicts.judged(Tables(self.folder))


if __name__ == "__main__":
    unittest.main()
