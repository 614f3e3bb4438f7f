#!/usr/bin/env python3
"""Fails when the public interface in docs/api.json lacks documentation, or a binding does not cover it.

usage: check_api.py [--binding FILE]... [ROOT]

Comments: each type, function, constant and method, and each constructor with named parameters, has a doc
comment, or shares that of the declaration in the line above or of an earlier overload. Operators and accessors
(const methods with at most one parameter) need none. Fields need one in structures that users fill in, unless
their type is one of this interface. The comment of a structure explains its other fields.

Documents: what needs a comment in the core occurs as code in README.md, docs/*.md, experiments/*.md or another
comment, or it is in UNMENTIONED. `set_x` and `verify_x` are mentioned where `x` is, and a type where a declaration
has it.

Bindings: FILE has {"names": [...], "left_out": {NAME: REASON}}, and "libraries": [...] if it covers only some.
Both lists together have all types, functions, constants, values, fields and methods ("Scene::detect"). A type
that is left out leaves out its members.
"""

import argparse
import json
import pathlib
import re
import sys
from typing import NamedTuple

MEMBERS = ("values", "fields", "constructors", "methods")
FILLED_IN = ("Options::", "Request::", "Limits::", "Response::")
# Names or headers of the core that no document needs to mention, each with the reason.
UNMENTIONED = {
    "supple/description.hpp": "serves the programs of this repository; CONTRIBUTING.md says what is made from it",
    "supple/record_descriptions.hpp": "as description.hpp",
    "supple/result_lists.hpp": "as description.hpp",
    "supple/record_info.hpp": "as description.hpp",
    "supple/utf8.hpp": "makes the text of messages, which users only read",
    "supple/version.hpp": "has the version and nothing else",
    "TrianglePair": "a pair of the narrow phase, which no public function returns",
    "DetectResult::enclosed_vertices_of": "a range of the list that `IntersectionCurve` explains",
    "Scene::remove": "the reverse of `Scene::add`",
}


class Declaration(NamedTuple):
    header: dict
    owner: str  # "Scene::" or nothing
    key: str  # of the list that it is in: "entities", "methods", ...
    item: dict
    before: list  # the items before it in the list

    @property
    def name(self):
        return self.owner + self.item["name"]

    def is_documented(self):
        overloads = [item for item in self.before if item["name"] == self.item["name"]]
        shared = "follows" in self.item and self.before and self._replace(item=self.before[-1], before=self.before[:-1])
        return any("doc" in item for item in (self.item, *overloads)) or bool(shared) and shared.is_documented()

    def needs_comment(self, types):
        if self.key == "fields":
            return self.owner.endswith(FILLED_IN) and re.sub(r"std::optional<|>$", "", self.item["type"]) not in types
        if self.key == "constructors":
            return any("name" in parameter for parameter in self.item["parameters"])
        is_accessor = self.item.get("const") and len(self.item["parameters"]) <= 1
        return self.key in ("entities", "methods") and not is_accessor and not self.name.startswith("operator")


def declarations(api):
    for header in api["headers"]:
        inner = [(each["name"] + "::", key, each[key]) for each in header["entities"] for key in MEMBERS if key in each]
        for owner, key, items in [("", "entities", header["entities"]), *inner]:
            yield from (Declaration(header, owner, key, item, items[:place]) for place, item in enumerate(items))


def code_words(text):
    """The identifiers in code spans and code blocks of a text."""
    return set(re.findall(r"\w+", " ".join(re.findall(r"```.*?```|`[^`]*`", text, re.DOTALL))))


def documentation_problems(api, root):
    every = list(declarations(api))
    types = {each.name for each in every if each.item.get("kind") in ("struct", "class", "enum", "alias", "concept")}
    needing = [each for each in every if each.needs_comment(types)]
    yield from (f"{each.name}: has no doc comment" for each in needing if not each.is_documented())
    needing = [each for each in needing if each.header["library"] == "core" and each.key != "constructors"]
    documents = (path.read_text(encoding="utf-8") for pattern in ("README.md", "docs/*.md", "experiments/*.md") for path in root.glob(pattern))
    known = set().union(*map(code_words, documents))
    comments = [(each.name, code_words(each.item.get("doc", ""))) for each in every]
    whole = [(each.name, set(re.findall(r"\w+", json.dumps(each.item)))) for each in every]
    for each in needing:
        words = {word := each.name.split("::")[-1], re.sub("^(set|verify)_", "", word)}
        others = whole if each.name in types else comments
        is_excused = words & known or UNMENTIONED.keys() & {each.name, each.header["name"]}
        if not is_excused and not any(words & found for name, found in others if name != each.name):
            yield f"{each.name}: no document mentions it"


def binding_problems(api, binding):
    """Compares the list of names of a binding with the interface."""
    names, left_out = set(binding["names"]), binding.get("left_out", {}).keys()
    api = {"headers": [each for each in api["headers"] if each["library"] in binding.get("libraries", [each["library"]])]}
    wanted = {each.name for each in declarations(api) if each.key != "constructors" and "operator" not in each.name}
    yield from (f"{name}: is not in the interface" for name in sorted((names | left_out) - wanted))
    yield from (f"{name}: is both bound and left out" for name in sorted(names & left_out))
    for name in sorted(wanted - names):
        if not left_out & {name, *(name[:match.start()] for match in re.finditer("::", name))}:
            yield f"{name}: is missing; bind it, or give a reason in left_out"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--binding", action="append", default=[], type=pathlib.Path)
    parser.add_argument("root", nargs="?", default=pathlib.Path(__file__).parent.parent, type=pathlib.Path)
    arguments = parser.parse_args()
    api = json.loads((arguments.root / "docs/api.json").read_text(encoding="utf-8"))
    found = list(dict.fromkeys(documentation_problems(api, arguments.root)))  # overloads once
    for path in arguments.binding:
        found += [f"{path}: {problem}" for problem in binding_problems(api, json.loads(path.read_text()))]
    return "\n".join(found) or 0


if __name__ == "__main__":
    sys.exit(main())
