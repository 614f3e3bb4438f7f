#!/usr/bin/env python3
"""Writes what the Python package takes from docs/api.json: _generated.py and typing.py in bindings/python/supple.

usage: make_python.py [--check] [ROOT]

`_generated.py` has the enumerations as `enum.IntEnum`, with their values and comments, and the comments of all
functions and methods. `typing.py` has the types of options, statistics, records and lists of results: their
members are those of docs/api.json; the names for users, words and sentences are those of the descriptions in
the headers. With --check it writes nothing and fails when a file is out of date.
"""

import argparse
import json
import pathlib
import re

# Enumerations that only the programs of this repository use.
LEFT_OUT = {"Names", "ScalarType", "FieldInfo::Kind", "MatrixItems", "UpAxis", "LengthUnit", "ContactSide", "SearchedShape", "viewer::FieldElement"}

# Classes of C++ that are in Python as they are.
CLASSES = {"Error", "MotionError"}


def python_text(doc):
    return re.sub(r"`(\w+)::(\w+)`", r"`\1.\2`", doc)


def enumeration(entity):
    base = "enum.IntFlag" if entity["name"] == "ContactKinds" else "enum.IntEnum"
    name = entity["name"].replace("::", "")
    lines = [f"class {name}({base}):", f"    {python_text(entity.get('doc', name))!r}", ""]
    for each in entity["values"]:
        lines.append(f"    {each['name']} = {each['value']}")
        if "doc" in each:
            lines.append(f"    {python_text(each['doc'])!r}")
    return "\n".join(lines)


def contracts(headers):
    found = {}
    for header in headers:
        for entity in header["entities"]:
            if entity["kind"] == "function" or entity["name"] in CLASSES:
                items = [(entity["name"], entity)]
            else:
                items = [(f"{entity['name']}::{each['name']}", each)
                         for each in entity.get("methods", ())]
            last = ""
            for name, item in items:
                last = item.get("doc", last if "follows" in item else "")
                if last and name not in found:
                    found[name] = python_text(last)
                elif name not in found:
                    found[name] = f"See `{name}` in {header['name']}."
    return found


def generate(api):
    headers = [header for header in api["headers"] if header["library"] != "formats"]
    enums = [entity for header in headers for entity in header["entities"]
             if entity["kind"] == "enum" and entity["name"] not in LEFT_OUT]
    parts = ['"""Made from docs/api.json by tools/make_python.py."""\n\nimport enum\n']
    parts += [enumeration(each) + "\n" for each in enums]
    parts.append("ENUMERATIONS = [" + ", ".join(each["name"].replace("::", "") for each in enums) + "]\n")
    docs = "".join(f"    {name!r}:\n        {doc!r},\n" for name, doc in sorted(contracts(headers).items()))
    parts.append("#: The comments of functions and methods in the headers.\nCONTRACTS = {\n" + docs + "}")
    return "\n\n".join(parts) + "\n"


PLACES = {"include", "libs", "simulation", "viewer"}  # of the descriptions


def words_of_sets(members):
    """The words of all sets of some members, of which the first is the word of the empty set."""
    return [",".join(word for bit, word in enumerate(members[1:]) if mask >> bit & 1) or members[0] for mask in range(2 ** (len(members) - 1))]


class Described:
    """The descriptions of the headers: of options, records and statistics."""

    def __init__(self, root, api):
        text = "".join(path.read_text(encoding="utf-8") for path in sorted(root.glob("**/*.hpp"))
                       if path.relative_to(root).parts[0] in PLACES)
        self.structs = {entity["name"].removeprefix("viewer::"): entity for header in api["headers"]
                        for entity in header["entities"] if entity["kind"] == "struct"}
        self.enums = {entity["name"]: entity for header in api["headers"] for entity in header["entities"]
                      if entity["kind"] == "enum"}
        self.words = {name.removeprefix("viewer::"): words_of_sets(words) if is_set else words
                      for is_set, name, words in ((is_set, name, re.findall(r'"([^"]+)"', words)) for is_set, name, words in
                                                  re.findall(r"constexpr std::array (set_)?words<([\w:]+)>\{(.*?)\}", text, re.DOTALL))}
        self.blocks = dict(re.findall(r"\nstruct Description<(?:viewer::)?([\w:]+)> ([:{].*?)\n\};", text, re.DOTALL))

    def members(self, struct):
        """The described members of a structure: (name, type, key, documentation, words for truth values)."""
        block, fields = self.blocks[struct], {each["name"]: each for each in self.structs[struct]["fields"]}
        found = []
        # A member begins with its name: `.name = "x"`, or `"x", &Struct::x` as arguments of a function.
        parts = re.split(r'\.name = "(?=\w+",)|(?=\(\s*"\w+",\s*&)', block)
        for part in parts[1:]:
            key = re.match(r'(?:\(\s*)?"?(\w+)"', part)
            member = re.search(r"&\w+(?:::\w+)*::(\w+)", part)
            if not key or not member or member[1] not in fields:
                continue
            begin = re.search(r"\.doc =|&\w+(?:::\w+)*::\w+,", part)
            doc = re.search(r'(?:"(?:[^"\\]|\\.)*"\s*)+', part[begin.end():]) if begin else None
            if ".doc =" in part:
                doc = re.search(r'(?:"(?:[^"\\]|\\.)*"\s*)+', part[part.index(".doc ="):])
            given = re.search(r'\.key = "(\w+)"', part)
            truth = re.search(r'\.truth_words = \{"(\w+)", "(\w+)"\}', part)
            found.append((member[1], fields[member[1]]["type"], given[1] if given else key[1],
                          "".join(re.findall(r'"((?:[^"\\]|\\.)*)"', doc[0])) if doc else "",
                          truth.groups() if truth else ()))
        return found


SCALARS = {"double": "float64", "bool": "bool_"} | {f"std::uint{n}_t": f"uint{n}" for n in (8, 16, 32, 64)}
SIDES = ("barycentric", "element", "object", "point", "triangle", "kind")  # `_tables._SIDES`
WITH_VERTICES = ("Contact", "ContinuousContact", "ProximityPair", "LimitingPair")
FOUND = ("ClosestPoint", "RayHit", "ElementDistance", "Impact")
OPTION_STRUCTS = ("ImpactOptions", "ObjectOctreeOptions", "SceneOctreeOptions", "ComparisonOptions", "ObjectOptions",
                  "SceneOptions", "StepOptions", "BroadPhaseOptions", "MassSpringOptions", "MassSpringMotion::Handle",
                  "MassSpringMotion", "RigidMotion", "ContactResponse", "SimulationOptions", "BreakOptions", "AttachOptions")


def literal(words):
    return f"Literal[{', '.join(repr(word) for word in words)}]"


def option_type(described, struct, type_, truth):
    """What Python takes for a member of options; empty for what has an argument of its own."""
    if type_.startswith("std::optional<"):
        return f"{option_type(described, struct, type_[14:-1], ())} | None"
    if type_ == "ContactKinds":
        return "Kinds"
    for enum in (type_, f"{struct}::{type_}"):
        if enum in described.words:
            python = f"{enum} | " if enum in described.enums else ""
            return python + literal(described.words[enum])
    if type_ in OPTION_STRUCTS:
        return type_
    if type_ == "bool":
        return f"bool | np.bool_ | {literal(truth)}" if truth else "bool | np.bool_"
    return {"double": "Number", "std::string": "str", "Vec3d": "Numbers", "RootCube": "Numbers", "Border": "ArrayLike",
            "std::vector<KindPair>": "Iterable[tuple[int, int]]"}.get(type_, "Whole" if "uint" in type_ and "<" not in type_ else "")


def parts_of(described, struct):
    """The structures of options in a structure, the outer ones first."""
    inner = [type_ for _, type_, _, _, _ in described.members(struct) if type_ in OPTION_STRUCTS]
    return inner + [part for each in inner for part in parts_of(described, each)]


def option_items(described, struct):
    """The type and the description of each keyword of a structure and of its parts."""
    items, leaves = {}, [(struct, member) for member in described.members(struct)]
    leaves += [(part, member) for part in parts_of(described, struct) for member in described.members(part)
               if member[1] not in OPTION_STRUCTS]
    names = [member[0] for _, member in leaves]
    for owner, (name, type_, key, doc, truth) in leaves:
        is_only = owner == struct or names.count(name) == 1
        aliases = (name,) if type_ in OPTION_STRUCTS else (key, name) if is_only else (key,)
        for each in aliases:
            items.setdefault(each, (option_type(described, owner, type_, truth), doc))
    return items


def request_class(described):
    scene = option_items(described, "SceneOptions")
    fields = [field["name"] for field in described.structs["DetectRequest"]["fields"]]
    items = {name: scene[name] for name in fields if name in scene} | option_items(described, "ImpactOptions")
    items["max_contacts"] = "Whole | None", "The largest number of contacts of each kind"
    return keywords_class(described, "DetectRequest", "Keywords of `Scene.detect` and `Scene.search`.", items,
                          ["ImpactOptions"])


def keywords_class(described, struct, doc, items, parts=(), total=False):
    bases = []
    for part in parts:  # their keywords come from their classes
        own = option_items(described, part)
        if own.items() <= items.items():
            bases.append(part)
            items = {name: items[name] for name in items if name not in own}
    bases = (bases or ["TypedDict"]) + ([] if total else ["total=False"])
    lines = [f"class {struct.replace('::', '')}({', '.join(bases)}):", f"    {doc!r}", ""]
    for name, (type_, text) in items.items():
        if type_ and name != "self":  # the name of the first parameter of methods
            lines += [f"    {name}: {type_.replace('::', '')}", f"    {text!r}"]
    return "\n".join(lines)


def columns(described, struct):
    """The columns of a record, as records.hpp makes them: (name, type, documentation)."""
    for _, type_, key, doc, _ in described.members(struct):
        array = re.fullmatch(r"std::array<(.+), (\d+)>", type_)
        enum = next((each for each in (type_, f"{struct}::{type_}") if each in described.words), "")
        if type_ == "ObjectId":
            yield key, "np.uint32", doc
            yield f"{key}_generation", "np.uint32", doc
        elif type_ == "Feature":
            yield f"{key}_kind", literal(described.words["FeatureKind"]), doc
            yield f"{key}_index", "np.uint8", doc
        elif enum:
            yield key, literal(described.words[enum]), doc
        elif type_ in SCALARS:
            yield key, f"np.{SCALARS[type_]}", doc
        elif type_ == "Vec3d":
            yield key, "npt.NDArray[np.float64]", doc
        elif array and array[1] in SCALARS:
            yield key, f"npt.NDArray[np.{SCALARS[array[1]]}]", doc
        elif array:
            for i in range(int(array[2])):
                yield from ((f"{name}_{i}", of, text) for name, of, text in columns(described, array[1]))
        else:
            yield from columns(described, type_)


def record_class(described, struct):
    items = list(columns(described, struct))
    names = {name: type_ for name, type_, _ in items}
    for side in SIDES:
        if f"{side}_a" in names and f"{side}_b" in names:
            scalar = re.search(r"np\.\w+", names[f"{side}_a"].removeprefix("npt.NDArray"))
            items.append((side, f"npt.NDArray[{scalar[0] if scalar else 'np.uint8'}]", "Both sides in one"))
    if struct in WITH_VERTICES:
        items.append(("vertices", "npt.NDArray[np.uint32]", "The vertices of both elements, (2, 3)"))

    def lines(name, doc, members):
        found = [f"class {name}(Record):", f"    {doc!r}", "", "    __slots__ = ()"]
        for member, type_, text in members:
            found += [f"    {member}: {type_}", f"    {text!r}"]
        return "\n".join(found)

    doc = python_text(described.structs[struct].get("doc", struct))
    parts = [lines(struct, doc, items)]
    if struct in FOUND:
        found = ("found", "np.bool_", "Whether there is an answer; the other members are valid only then")
        parts.append(lines(f"Found{struct}", doc, [found, *items]))
    return parts


def lists_class(described, records):
    """The lists of a result as properties."""
    lines = ["class ResultLists:", "    'The lists of a result.'", ""]
    short = {"continuous_contacts": "continuous", "proximity_pairs": "proximity", "contacts": "intersection",
             "penetrations": "penetration"}
    for field in described.structs["DetectResult"]["fields"]:
        row = re.fullmatch(r"std::span<const (.+)>", field["type"])
        if not row or field["name"] == "untested":
            continue
        type_ = (f"Table[{row[1]}]" if row[1] in records else "npt.NDArray[np.float64]" if row[1] == "Vec3d"
                 else f"npt.NDArray[np.{SCALARS[row[1]]}]")
        for name in filter(None, (field["name"], short.get(field["name"]))):
            lines += ["    @property", f"    def {name}(self) -> {type_}:",
                      f"        {python_text(field.get('doc', '') or name)!r}", "        raise NotImplementedError", ""]
    return "\n".join(lines).rstrip()


def generate_types(root, api):
    described = Described(root, api)
    records = [name for name in described.blocks if name not in OPTION_STRUCTS and "Stat" not in name
               and name in described.structs and described.blocks[name].startswith(":")]
    options = [keywords_class(described, each, "Options as keywords.", option_items(described, each),
                              parts_of(described, each)) for each in OPTION_STRUCTS]
    enums = {each.replace("::", "") for each in re.findall(r"\b[A-Z]\w+(?:::\w+)?(?= \| Literal)", "\n".join(options))}
    stats = {key: ("float" if type_ == "double" else "int" if type_ in SCALARS else "str", doc)
             for _, type_, key, doc, _ in described.members("StepStats")}
    parts = [HEAD.format(enums="".join(f"    {each},\n" for each in sorted({*enums, "ContactKinds"})))]
    parts += [*options, request_class(described), keywords_class(described, "StepStats", "`Result.stats`.", stats, total=True)]
    for each in sorted(records):
        parts += record_class(described, each)
    parts.append(lists_class(described, records))
    return "\n\n\n".join(parts) + "\n"


HEAD = '''"""Types for annotations, made from docs/api.json and the descriptions in the headers by tools/make_python.py:
options as keywords, such as `SceneOptions`; rows of tables, such as `Contact` of `Table[Contact]`."""

from __future__ import annotations

from typing import Any, Collection, Iterable, Literal, Sequence, TypedDict, Union

import numpy as np
import numpy.typing as npt
from numpy.typing import ArrayLike

from ._generated import (
{enums})
from ._tables import Record, Table

Number = Union[float, "np.floating[Any]", "np.integer[Any]"]
Numbers = Union[Sequence[float], "npt.NDArray[Any]"]
Whole = Union[int, "np.integer[Any]"]
Kind = Literal["none", "intersection", "continuous", "proximity", "penetration"]
#: One kind, several with commas, or a collection.
Kinds = Union[ContactKinds, str, Collection[Union[ContactKinds, Kind]]]
'''.rstrip()


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("usage: ")[1].split("\n\n")[0])
    parser.add_argument("--check", action="store_true")
    parser.add_argument("root", nargs="?", default=pathlib.Path(__file__).parent.parent, type=pathlib.Path)
    arguments = parser.parse_args()
    api = json.loads((arguments.root / "docs/api.json").read_text(encoding="utf-8"))
    for name, text in (("_generated.py", generate(api)), ("typing.py", generate_types(arguments.root, api))):
        path = arguments.root / "bindings/python/supple" / name
        if not arguments.check:
            path.write_text(text, encoding="utf-8")
        elif not path.exists() or path.read_text(encoding="utf-8") != text:
            return f"{path.relative_to(arguments.root)} is out of date; run tools/make_python.py"
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
