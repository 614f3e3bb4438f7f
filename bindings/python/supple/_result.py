"""The result of a detection."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Collection, Iterator, NamedTuple

from . import _core
from ._core import Error
from ._tables import Table, dtypes, table

if TYPE_CHECKING:
    from .typing import Contact, ContinuousContact, ObjectPair, ProximityPair, ResultLists, StepStats
else:
    ResultLists = object

_LISTS: dict[str, tuple[str, str, str, str]] = _core.lists()
#: Short names of lists.
SHORT = {kind: name for name, (_, _, kind, _) in _LISTS.items() if kind}
ANSWERS = tuple(SHORT.values())
#: The lists of groups by the lists of their contacts.
_GROUPS = {name: groups for name, (_, _, _, groups) in _LISTS.items() if groups}
_NAMES: dict[str, int] = _core.Result().counts()


class PairContacts(NamedTuple):
    """All that two objects, or one with itself, have in common."""

    object_a: int
    object_b: int
    contacts: Table[Contact]
    continuous_contacts: Table[ContinuousContact]
    proximity_pairs: Table[ProximityPair]


class _Lists(ResultLists):
    """Lists by name: of a result, or of a frame of a recording."""

    def _list(self, name: str) -> Any:
        raise NotImplementedError

    def _names(self) -> Collection[str]:
        raise NotImplementedError

    if not TYPE_CHECKING:  # which knows the lists

        def __getattr__(self, name: str) -> Any:
            if name.startswith("_"):
                raise AttributeError(name)
            found = SHORT.get(name, name)
            if found not in self._names():
                raise AttributeError(f"there is no list '{name}'; there are {', '.join(self._names())}")
            return self._list(found)

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *(name for name in self._names() if "/" not in name), *SHORT]

    @property
    def events(self) -> dict[str, Table[ObjectPair]]:
        """Pairs of objects that begin, stay and end, by `volume_begin`, `contact_end` and so on."""
        return {name.split("/")[1]: self._list(name) for name in self._names() if "/" in name}

    def _counts(self) -> dict[str, int]:
        return {name: len(self._list(name)) for name in self._names()}

    def __len__(self) -> int:
        """The number of contacts of all kinds."""
        counts = self._counts()
        return sum(counts.get(name, 0) for name in ANSWERS)

    def __iter__(self) -> Iterator[PairContacts]:
        parts: dict[tuple[int, int], dict[str, Table]] = {}
        if "groups" not in self._names():
            raise Error(
                "only a result of detect has the pairs of objects; its lists have the columns object_a and object_b"
            )
        names = [name for name in PairContacts._fields if name in _GROUPS]
        for name in names:
            for group in self._list(_GROUPS[name]):
                rows = self._list(name)[group.first_contact : group.first_contact + group.contact_count]
                parts.setdefault((int(group.a), int(group.b)), {})[name] = rows
        nothing = {name: self._list(name)[:0] for name in names}
        for (a, b), found in sorted(parts.items()):
            yield PairContacts(a, b, **{**nothing, **found})

    def to_pandas(self) -> dict[str, Any]:
        """A pandas.DataFrame for each list of records that is not empty."""
        lists = {name: self._list(name) for name in self._names() if "/" not in name}
        return {
            name: each.to_pandas() for name, each in lists.items() if isinstance(each, Table) and len(each)
        }

    def _summary(self) -> str:
        counts = self._counts()
        found = [
            f"{counts[name]} {_LISTS[name][0]}{'s' if counts[name] != 1 else ''}"
            for name in ANSWERS
            if counts.get(name)
        ]
        pairs = counts.get("object_pairs", 0)
        return f"{', '.join(found) or 'no contacts'}; {pairs} object pair{'s' if pairs != 1 else ''} overlap"


class Result(_Lists):
    """What `Scene.detect` found.

    Its lists are attributes: `contacts`, `contact_points`, `continuous_contacts` (also `continuous`),
    `proximity_pairs` (also `proximity`), `penetrations`, `contained_parts`, `curves`, `manifolds`,
    `object_pairs`, ... Each is a `Table`: a read-only structured array without a copy, which stays valid as
    long as you hold it, also after the next detection. `len(result)` is the number of contacts; iteration
    gives a `PairContacts` for each two objects that have some.
    """

    def __init__(self, core: Any, scene: Any) -> None:
        self._core = core
        self._scene = scene
        self._cache: dict[str, Any] = {}

    def _list(self, name: str) -> Any:
        if name not in self._cache:
            self._cache[name] = table(self._core.table(name), self._scene)
        return self._cache[name]

    def _names(self) -> Collection[str]:
        return _NAMES

    def _counts(self) -> dict[str, int]:
        return dict(self._core.counts())

    @property
    def step(self) -> int:
        """The number of this detection; the first one is 0."""
        return int(self._core.step)

    @property
    def truncated(self) -> bool:
        """A kind has more contacts than `max_contacts`."""
        return bool(self._core.truncated)

    @property
    def stopped(self) -> bool:
        """The call was stopped; all lists are empty."""
        return bool(self._core.stopped)

    @property
    def stats(self) -> StepStats:
        """Seconds and counts of the stages."""
        return self._core.stats()

    @property
    def untested(self) -> dict[str, str]:
        """The kinds of contacts for which there was nothing to test, with the reason."""
        return dict(self._core.untested())

    def __repr__(self) -> str:
        untested = "".join(f"; {kind}: nothing to test ({reason})" for kind, reason in self.untested.items())
        state = " (stopped)" if self.stopped else " (truncated)" if self.truncated else ""
        return (
            f"<supple.Result of step {self.step}{state}: {self._summary()}; "
            f"{1e3 * self.stats['total_seconds']:.3g} ms{untested}>"
        )

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><td>{name}</td><td>{count}</td><td>{_LISTS.get(name, ('', '', '', ''))[1]}</td></tr>"
            for name, count in self._counts().items()
            if count and "/" not in name
        )
        return f"<p>Step {self.step}: {self._summary()}</p><table><tr><th>list</th><th>rows</th><th></th></tr>{rows}</table>"

    def __reduce__(self) -> Any:
        lists = {name: self._list(name) for name in self._names()}
        return SavedResult, (
            lists,
            {
                "step": self.step,
                "truncated": self.truncated,
                "stopped": self.stopped,
                "stats": self.stats,
                "untested": self.untested,
            },
        )


class SavedResult(_Lists):
    """A result that was pickled, or that a search returned: its lists are copies. That of a search has no
    `step`, `stats` and `untested`."""

    step: int
    truncated: bool
    stopped: bool
    stats: StepStats
    untested: dict[str, str]

    def __init__(self, lists: dict[str, Any], facts: dict[str, Any]) -> None:
        self._saved = lists
        self.__dict__.update(facts)
        self._facts = facts

    def _list(self, name: str) -> Any:
        return self._saved[name]

    def _names(self) -> list[str]:
        return list(self.__dict__.get("_saved", ()))

    def __reduce__(self) -> Any:
        return SavedResult, (self._saved, self._facts)

    def __repr__(self) -> str:
        state = " (stopped)" if self._facts.get("stopped") else ""
        return f"<supple.SavedResult{state}: {self._summary()}>"


__all__ = ["PairContacts", "Result", "SavedResult", "Table", "dtypes"]
