"""Claims, how they are judged, and their register, which judge/claims.py fills."""

import dataclasses
import re

from judge.estimates import set_levels, text_of
from judge.tables import MissingTable

HOLDS, FAILS, UNDECIDED = "Holds", "Does not hold", "Undecided"
SCENES = {"nine": "nine objects close together", "three_humans": "three humans", "three_bikes": "three bikes"}


@dataclasses.dataclass
class Claim:
    name: str
    where: str  # section and paragraph; empty: our own claim
    text: str
    quantity: str
    reading: str = ""
    remark: str = ""  # why, or what else there is to know
    tests: list = dataclasses.field(default_factory=list)

    def cases(self):
        """The outcome for each `when`, in the order of the tests."""
        outcomes = {}
        for test in self.tests:
            outcomes.setdefault(test.when, []).append(test.outcome())
        return {when: False if False in of_case else None if None in of_case else True for when, of_case in outcomes.items()}

    @property
    def verdict(self):
        cases = self.cases()
        for verdict, decided in ((HOLDS, True), (FAILS, False)):
            found = [when for when, outcome in cases.items() if outcome is decided]
            if found:
                return verdict if len(found) == len(cases) else f"{verdict} if {in_one(found)}"
        return UNDECIDED

    @property
    def numbers(self):
        """All numbers with their intervals and cases."""
        return "; ".join(text_of(test.number, test.level) + (f" if {test.when}" if test.when else "") for test in self.tests)


def in_one(cases):
    """Cases that begin and end alike in one: `there are 200 or 500 objects`."""
    parts = [re.fullmatch(r"(there are )(.*)( objects)", case) for case in cases]
    if len(cases) < 2 or not all(parts):
        return "; ".join(cases)
    numbers = [part[2] for part in parts]
    return f"there are {', '.join(numbers[:-1])} or {numbers[-1]} objects"


CLAIMS = []


def claim(name, where, text, quantity, reading="", remark=""):
    def add(measure):
        CLAIMS.append((Claim(name, where, text, quantity, reading, remark), measure))
        return measure

    return add


def judged(tables):
    """The claims that these tables decide, in the order of the register."""
    found = []
    for blank, measure in CLAIMS:
        try:
            tests = list(measure(tables))
        except MissingTable:
            continue
        if tests:
            found.append(dataclasses.replace(blank, tests=tests))
    set_levels([test for each in found for test in each.tests])
    return found


def scene_in_words(name):
    return SCENES.get(name) or re.sub(r"^table1_(\d+)$", r"\1 objects", name)


