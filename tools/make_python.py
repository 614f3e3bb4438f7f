#!/usr/bin/env python3
"""Writes what the Python package takes from docs/api.json: bindings/python/supple/_generated.py.

usage: make_python.py [--check] [ROOT]

The file has the enumerations as `enum.IntEnum`, with their values and comments, and the comments of all
functions and methods. With --check it writes nothing and fails when the file is out of date.
"""

import argparse
import json
import pathlib
import re

# Enumerations that only the programs of this repository use.
LEFT_OUT = {"Names", "MatrixItems", "UpAxis", "LengthUnit", "ContactSide", "viewer::FieldElement"}

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


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("usage: ")[1].split("\n\n")[0])
    parser.add_argument("--check", action="store_true")
    parser.add_argument("root", nargs="?", default=pathlib.Path(__file__).parent.parent, type=pathlib.Path)
    arguments = parser.parse_args()
    api = json.loads((arguments.root / "docs/api.json").read_text(encoding="utf-8"))
    path = arguments.root / "bindings/python/supple/_generated.py"
    text = generate(api)
    if not arguments.check:
        path.write_text(text, encoding="utf-8")
    elif not path.exists() or path.read_text(encoding="utf-8") != text:
        return f"{path.relative_to(arguments.root)} is out of date; run tools/make_python.py"
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
