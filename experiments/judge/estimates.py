"""Measured numbers with intervals, and whether they are within limits.

Intervals are those of Student's t. Where many numbers are judged together, Holm's method (1979) gives each its level,
so that all verdicts together are wrong in at most 5 % of such experiments.
"""

import dataclasses
import math

import numpy as np
from scipy import stats

from judge.text import rounded

LEVEL = 0.05
SHORTEST = 1e-9  # seconds: a clock may say 0


@dataclasses.dataclass(frozen=True)
class Estimate:
    """A number and its standard error; 0: it was counted. `of_logarithm`: the error is that of the logarithm."""

    mean: float
    error: float = 0.0
    freedom: float = math.inf  # degrees of freedom of the error
    of_logarithm: bool = False

    def interval(self, level=LEVEL):
        if self.error == 0:
            return self.mean, self.mean
        reach = stats.t.ppf(1 - level / 2, self.freedom) * self.error if math.isfinite(self.error) else math.inf
        if self.of_logarithm:
            return self.mean * math.exp(-reach), self.mean * math.exp(min(reach, 700))
        return self.mean - reach, self.mean + reach

    @property
    def standard_error(self):
        return self.mean * self.error if self.of_logarithm else self.error

    def chance(self, limit):
        """The probability of such a distance from the limit if the number were the limit; two-sided."""
        if self.error == 0 or not math.isfinite(self.error):
            return 0.0 if self.error == 0 and self.mean != limit else 1.0
        if self.of_logarithm and limit <= 0:
            return 0.0
        distance = math.log(self.mean / limit) if self.of_logarithm else self.mean - limit
        return 2 * stats.t.sf(abs(distance) / self.error, self.freedom)


def counted(number):
    return Estimate(float(number))


def mean_of(values):
    values = np.asarray(values, float)
    if len(values) < 2:
        return Estimate(float(values.mean()) if len(values) else math.nan, math.inf, 1)
    return Estimate(float(values.mean()), float(values.std(ddof=1) / math.sqrt(len(values))), len(values) - 1)


def ratio_of(a, b):
    """The geometric mean of a / b over rounds in which both were measured in turn."""
    of = mean_of(np.log(np.maximum(a, SHORTEST) / np.maximum(b, SHORTEST)))
    return Estimate(math.exp(of.mean), of.error, of.freedom, of_logarithm=True)


def ratio_of_sums(a, b):
    """sum(a) / sum(b) of runs that saw the same motion, with the error of its logarithm by the jackknife (Tukey 1958)."""
    a, b = np.asarray(a, float), np.asarray(b, float)
    if b.sum() == 0:
        return Estimate(math.nan, math.inf, 1)
    ratio = a.sum() / b.sum()
    if len(a) < 2 or (b.sum() - b).min() <= 0:
        return Estimate(ratio, math.inf, 1)
    without = (a.sum() - a) / (b.sum() - b)
    of_logarithm = without.min() > 0  # so that no interval of a positive ratio reaches below 0
    numbers = np.log(without) if of_logarithm else without
    error = math.sqrt((len(a) - 1) / len(a) * ((numbers - numbers.mean()) ** 2).sum())
    return Estimate(ratio, error if error > 1e-12 else math.inf, len(a) - 1, of_logarithm)  # equal runs say nothing about others


def quotient(a, b):
    """The quotient of two independent means."""
    if b.mean == 0:
        return Estimate(math.nan, math.inf, 1)
    mean = a.mean / b.mean
    parts = (a.error / b.mean, a.freedom), (mean * b.error / b.mean, b.freedom)
    variance = sum(part**2 for part, _ in parts)
    if variance == 0 or not math.isfinite(variance):
        return Estimate(mean, math.sqrt(variance), 1)
    # Welch and Satterthwaite.
    return Estimate(mean, math.sqrt(variance), variance**2 / sum(part**4 / degrees for part, degrees in parts))


def exponent_of(sizes, numbers):
    """The exponent of the power of the sizes that fits the numbers best: least squares on logarithms."""
    x, y = np.log(np.asarray(sizes, float)), np.log(np.asarray(numbers, float))
    fit = stats.linregress(x, y)
    freedom = len(x) - 2
    return Estimate(float(fit.slope), float(fit.stderr) if freedom > 0 else math.inf, max(freedom, 1))


@dataclasses.dataclass
class Test:
    """A number that a claim needs within limits. `when`: the case of the claim, in words."""

    number: Estimate
    low: float = -math.inf
    high: float = math.inf
    when: str = ""
    level: float = LEVEL

    def chance(self):
        """That of the limit which decides."""
        chances = [self.number.chance(limit) for limit in (self.low, self.high) if math.isfinite(limit)]
        return max(chances) if self.low <= self.number.mean <= self.high else min(chances)

    def outcome(self):
        """True: within the limits; False: outside; None: the interval has a limit in it."""
        low, high = self.number.interval(self.level)
        if math.isnan(low) or math.isnan(high):
            return None
        if low >= self.low and high <= self.high:
            return True
        return False if high < self.low or low > self.high else None


def set_levels(tests):
    """Gives each measured number its level by Holm's method."""
    measured = sorted((test for test in tests if test.number.error > 0), key=Test.chance)
    level, is_rejecting = LEVEL, True
    for rank, test in enumerate(measured):
        if is_rejecting:
            level = LEVEL / (len(measured) - rank)
            is_rejecting = test.chance() <= level
        test.level = level


def text_of(number, level=LEVEL, digits=3):
    """`0.87 [0.80, 0.94]`"""
    if number.error == 0:
        return f"{number.mean:,.0f}" if number.mean == int(number.mean) else rounded(number.mean, digits)
    low, high = number.interval(level)
    return f"{rounded(number.mean, digits)} [{rounded(low, digits)}, {rounded(high, digits)}]"
