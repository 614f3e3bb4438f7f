"""Lists of a result: structured arrays of NumPy with columns, text and conversions."""

from __future__ import annotations

import html
from typing import TYPE_CHECKING, Any, Generic, Iterator, SupportsIndex, overload

import numpy as np
import numpy.typing as npt

from . import _core
from ._core import Error

if TYPE_CHECKING:
    from typing_extensions import TypeVar

    Row = TypeVar("Row", bound="Record", covariant=True, default="Record")
else:
    from typing import TypeVar

    Row = TypeVar("Row")


def _dtype(layout: tuple[int, list[Any]]) -> np.dtype[Any]:
    size, members = layout
    formats = [(code, (count,)) if count else code for _, code, count, *_ in members]
    return np.dtype(
        {
            "names": [member[0] for member in members],
            "formats": formats,
            "offsets": [member[3] for member in members],
            "itemsize": size,
        }
    )


#: The type of each record, by its name.
dtypes: dict[str, np.dtype[Any]] = {name: _dtype(layout) for name, layout in _core.layouts().items()}
_words: dict[str, dict[str, tuple[str, ...]]] = {
    name: {member[0]: member[4] for member in members if member[4] is not None}
    for name, (_, members) in _core.layouts().items()
}
_fields = {
    name: {member[0]: (member[5], member[6]) for member in members}
    for name, (_, members) in _core.layouts().items()
}
#: Records with an element of each side, whose vertices a scene knows.
_WITH_VERTICES = tuple(_core.records_with_vertices())
_SIDES = ("barycentric", "element", "object", "point", "triangle", "kind", "feature_kind")


class Record:
    """One row of a table; its columns are attributes: `contact.normal`, `pair.vertices`. `supple.typing` has
    the columns of each record for annotations."""

    __slots__ = ("_row",)

    def __init__(self, row: Table) -> None:
        self._row = row

    if not TYPE_CHECKING:  # which knows the columns of each record

        def __getattr__(self, name: str) -> Any:
            if name.startswith("__"):
                raise AttributeError(name)
            try:
                value = self._row[name][0]
            except (KeyError, ValueError):
                raise AttributeError(
                    f"a {self._row.record} has no '{name}'; it has {', '.join(self._row.columns)}"
                ) from None
            words = _words.get(self._row.record, {}).get(name)
            return words[int(value)] if words else value

    def __getitem__(self, name: str) -> Any:
        return getattr(self, name)

    def __dir__(self) -> list[str]:
        return self._row.columns

    def __eq__(self, other: object) -> bool:
        return (
            isinstance(other, Record)
            and self._row.record == other._row.record
            and all(
                np.array_equal(self._row[name], other._row[name])
                for name in dtypes[self._row.record].names or ()
            )
        )

    __hash__ = None  # type: ignore[assignment]

    def __reduce__(self) -> Any:
        return Record, (self._row,)

    def __repr__(self) -> str:
        names = list(dtypes[self._row.record].names or ())
        return f"{self._row.record}({', '.join(f'{name}={_text(getattr(self, name))}' for name in names)})"


class Table(np.ndarray, Generic[Row]):
    """A list of records: a structured array of NumPy without a copy, read-only, valid as long as it is held.

    `table["distance"]` is a column without a copy. Further columns are made from these: `vertices`, the
    vertex ids of both elements, (n, 2, 3), where an element with fewer vertices repeats its first one, with
    the weight 0; and both sides of a column in one, (n, 2, ...): `barycentric` of `barycentric_a` and
    `barycentric_b`, `element`, `object`, `point`, `triangle`, `kind`. `table[i]` is a row with its columns
    as attributes, and `table[mask]` a table.
    """

    record: str = ""
    _scene: Any = None
    _vertices: npt.NDArray[np.uint32] | None = None

    def __array_finalize__(self, base: Any) -> None:
        if isinstance(base, Table) and self.dtype == base.dtype:
            self.record, self._scene = base.record, base._scene

    @property
    def columns(self) -> list[str]:
        """The names of all columns, those that are made last."""
        names = list(self.dtype.names or ())
        names += [name for name in _SIDES if f"{name}_a" in names and f"{name}_b" in names]
        return names + (["vertices"] if self.record in _WITH_VERTICES else [])

    @overload  # type: ignore[override]
    def __getitem__(self, key: str) -> npt.NDArray[Any]: ...

    @overload
    def __getitem__(self, key: slice | npt.NDArray[Any] | list[int] | list[bool]) -> Table[Row]: ...  # type: ignore[overload-overlap]

    @overload
    def __getitem__(self, key: SupportsIndex) -> Row: ...

    def __getitem__(self, key: Any) -> Any:
        if not isinstance(key, str):
            chosen = super().__getitem__(key)
            if isinstance(chosen, np.void):
                at = int(key) if not isinstance(key, tuple) else int(key[0])
                return Record(self[at : at + 1 or None])
            if isinstance(chosen, Table) and self._vertices is not None and chosen.record:
                chosen._vertices = self._vertices[key]
            return chosen
        if self.ndim != 1 and key not in (self.dtype.names or ()):
            raise Error(f"the column '{key}' needs a table of one dimension; this one has {self.ndim}")
        if key == "vertices" and self.record in _WITH_VERTICES:
            return self._vertices_of_elements()
        names = self.dtype.names or ()
        if key in names:
            return np.ndarray.view(self, np.ndarray)[key]
        if key in _SIDES and f"{key}_a" in names and f"{key}_b" in names:
            return self._both_sides(key)
        raise KeyError(f"a table of {self.record} has no column '{key}'; it has {', '.join(self.columns)}")

    def _both_sides(self, key: str) -> npt.NDArray[Any]:
        (kind, at), (_, behind) = (self.dtype.fields[f"{key}_{side}"][:2] for side in "ab")  # type: ignore[index]
        strides = (self.strides[0], behind - at, *(kind.base.itemsize for _ in kind.shape))
        shape = (len(self), 2, *kind.shape)
        if not len(self):
            return np.empty(shape, kind.base)
        plain = np.ndarray.view(self, np.ndarray)
        if not plain.flags.c_contiguous:
            plain = np.ascontiguousarray(plain)
            strides = (plain.strides[0], *strides[1:])
        return np.ndarray(shape, kind.base, plain.view(np.uint8), at, strides)

    def _vertices_of_elements(self) -> npt.NDArray[np.uint32]:
        if self._vertices is None:
            if self._scene is None:
                raise Error(
                    "the vertices of this table need its scene; take them before the table is pickled or copied "
                    "out of the scene; a distributed scene has none"
                )
            plain = np.ascontiguousarray(np.ndarray.view(self, np.ndarray))
            self._vertices = self._scene.vertices_of(self.record, plain.view(np.uint8).reshape(-1))
        return self._vertices

    def words(self, column: str) -> npt.NDArray[np.str_]:
        """The words of an enumeration, such as `contacts.words("kind")`: `segment`, `polygon`."""
        words = _words.get(self.record, {}).get(column)
        if words is None:
            raise KeyError(
                f"the column '{column}' has no words; {', '.join(_words.get(self.record, {})) or 'none'} have"
            )
        return np.array(words)[self[column]]

    def describe(self) -> dict[str, tuple[str, str]]:
        """What each column is, and its unit."""
        return dict(_fields.get(self.record, {}))

    def __iter__(self) -> Iterator[Row]:  # type: ignore[override]
        return (self[i] for i in range(len(self)))

    def __reduce__(self) -> Any:
        vertices = (
            self._vertices_of_elements() if self._scene and "vertices" in self.columns else self._vertices
        )
        return _restore, (self.record, np.ascontiguousarray(np.ndarray.view(self, np.ndarray)), vertices)

    def to_pandas(self) -> Any:
        """A pandas.DataFrame with one column for each number; enumerations become words."""
        import pandas

        columns: dict[str, Any] = {}
        for name in self.dtype.names or ():
            values = self.words(name) if name in _words.get(self.record, {}) else self[name]
            if values.ndim == 1:
                columns[name] = values
            else:
                axes = "xyz" if values.shape[1] == 3 and "barycentric" not in name else "012345"
                for i in range(values.shape[1]):
                    columns[f"{name}_{axes[i]}"] = values[:, i]
        return pandas.DataFrame(columns)

    def __repr__(self) -> str:
        if not self.record:
            return np.ndarray.__repr__(np.ndarray.view(self, np.ndarray))
        rows = "".join(f"\n  {self[i]!r}" for i in range(min(len(self), 3)))
        more = f"\n  … {len(self) - 3} more" if len(self) > 3 else ""
        return f"Table of {len(self)} {self.record}{rows}{more}"

    __str__ = __repr__

    def _repr_html_(self) -> str:
        names = self.dtype.names or ()
        units = {name: self.describe().get(name, ("", ""))[1] for name in names}
        head = "".join(
            f"<th title='{html.escape(self.describe().get(name, ('', ''))[0], quote=True)}'>{html.escape(name)}"
            + (f"<br>({html.escape(units[name])})" if units[name] else "")
            + "</th>"
            for name in names
        )
        body = "".join(
            "<tr>"
            + "".join(f"<td>{html.escape(_text(getattr(self[i], name)))}</td>" for name in names)
            + "</tr>"
            for i in range(min(len(self), 10))
        )
        return f"<p>{len(self)} {html.escape(self.record)}</p><table><tr>{head}</tr>{body}</table>" + (
            f"<p>… {len(self) - 10} more</p>" if len(self) > 10 else ""
        )


def _text(value: Any) -> str:
    if isinstance(value, np.ndarray):
        return "(" + ", ".join(_text(each) for each in value.tolist()) + ")"
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def _restore(record: str, array: npt.NDArray[Any], vertices: Any) -> Table:
    table = array.view(Table)
    table.record, table._vertices = record, vertices
    return table


def table(raw: tuple[str | None, npt.NDArray[Any]], scene: Any = None) -> Any:
    """The table of (name of its records, bytes), or the array of plain numbers."""
    record, memory = raw
    if record is None:
        return memory
    dtype = dtypes[record]
    made = np.ndarray.__new__(Table, len(memory) // dtype.itemsize, dtype, memory)
    made.record, made._scene = record, scene
    return made


def record(raw: tuple[str | None, npt.NDArray[Any]] | None, scene: Any = None) -> Any:
    """The only row of a table, or None."""
    return None if raw is None else Record(table(raw, scene))
