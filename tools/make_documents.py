#!/usr/bin/env python3
"""Makes documents from what `supple --describe` prints, read from standard input.

usage: make_documents.py FOLDER | --man

Run it in the root of the repository. It writes into FOLDER docs/cli.md, every document with a table between
lines `<!-- begin NAME -->` and `<!-- end NAME -->`, and for the page of the viewer the sections of messages and
the members of view files. With --man it prints the manual page.
"""

import json
import pathlib
import re
import sys

# In the order of the enumerations of C++.
SCALARS = ("uint8", "uint8", "uint32", "uint64", "float64")
NOTHING, OBJECT, TRIANGLE, VERTEX, ELEMENT, WEIGHTS, ROWS, FIRST_ROW = range(8)  # Names
FEATURE = 2  # FieldInfo::Kind
VIEW_KINDS = ("number", "whole", "truth", "word", "colour", "text", "key", "point", "interval", "objects")

STATISTIC_HEADER = "| Dataset | Shape | Type | Unit | Meaning |"
OPTION_HEADER = "| Key | Default | Unit | Allowed | Meaning |"


def code(names):
    return ", ".join(f"`{name}`" for name in names)


def numbered(words):
    return ": " + ", ".join(f"{i} {word}" for i, word in enumerate(words)) if words else ""


# --- Options of scenes, and what recordings contain


def default_of(option):
    value = option["default"]
    if value is None or value == "inf":
        return "none"
    if isinstance(value, list):
        return f"[{', '.join(value)}]"
    if isinstance(value, bool):
        return code([str(value).lower()])
    return code([value]) if option.get("words") else value


def option_rows(options):
    for option in options:
        allowed = option["range"] or code(option.get("words")) + ("; several with commas between them" if option["is_set"] else "")
        yield f"| `{option['key']}` | {default_of(option)} | {option['unit']} | {allowed} | {option['doc']} |"


def attribute_rows(options):
    """The attributes of each type, in the order of the types' first attributes."""
    keys = {}
    for option in options:
        keys.setdefault(option["type"], []).append(option["key"])
    return [f"| {code(names)} | {kind} |" for kind, names in keys.items()]


def statistic_rows(statistics):
    for each in statistics:
        kind, doc = ("uint8", each["doc"] + numbered(each.get("words"))) if each["is_word"] else (each["type"], each["doc"])
        yield f"| `statistics/{each['key']}` | (F) | {kind} | {each['unit']} | {doc} |"


def unit_of(field):
    names = field["names"]
    if names == ROWS:
        return "vertices" if field["side"] else "rows"
    fixed = {OBJECT: "objects", TRIANGLE: "triangles", VERTEX: "vertices", ELEMENT: "vertices or triangles", FIRST_ROW: "rows"}
    return fixed.get(names, field["unit"])


def datasets_of(field):
    """The names and the meaning of the datasets of a member of a record; a feature has two."""
    name, doc, names = field["name"], field["doc"], field["names"]
    if names == OBJECT:
        name = "object_" + field["side"]
    if names == FIRST_ROW:
        doc += f": a row of `{field['list']}`, from the first one of the frame"
    if names == ELEMENT:
        doc += ": v v for a vertex, the two vertices for an edge, t t for a face"
    if names == WEIGHTS:
        doc += ": 1 0 0 for a vertex, 1−s s 0 for an edge, three for a face"
    if field["kind"] == FEATURE:
        doc += ": 0 vertex, 1 edge, 2 face; the index is that of the corner, or of the corner where the edge starts"
        return [name, name.replace("feature", "feature_index", 1)], doc
    doc += numbered(field["words"]) + (": 0 no, 1 yes" if field["scalar"] == 0 else "")
    return [name], doc


def is_other_side(before, names, doc):
    """Whether these are the same of object b as those before of object a: only letters a are b."""
    return (before[0][0].endswith("_a") and names[0].endswith("_b") and len(before[1]) == len(doc)
            and all(x == y or (x, y) == ("a", "b") for x, y in zip(before[1], doc)))


def list_rows(lists):
    for each in lists:
        heads, rows = [f"{each['name']}/end"], []
        for field in each["fields"]:
            # The row of the list names columns that are object a or b and nothing more.
            if field["names"] == OBJECT and field["doc"].startswith(("Object a", "Object b")):
                heads.append("object_" + field["side"])
                continue
            names, doc = datasets_of(field) if each["has_record"] else ([field["name"]], "")
            if rows and is_other_side(rows[-1], names, doc):
                rows[-1] = (rows[-1][0] + names, rows[-1][1] + "; b likewise", rows[-1][2])
            else:
                rows.append((names, doc, field))
        yield f"| {code(heads)} | | | | a row is: {each['doc']} |"
        for names, doc, field in rows:
            shape = "(rows)" if field["count"] == "1" or field["kind"] else f"(rows, {field['count']})"
            paths = [f"{each['name']}/{names[0]}", *names[1:]]
            yield f"| {code(paths)} | {shape} | {SCALARS[field['scalar']]} | {unit_of(field)} | {doc} |"


def csv_rows(kinds):
    for kind in kinds:
        details = [name for name in kind["with_details"] if name not in kind["columns"]]
        yield f"| {kind['kind']} | `{','.join(kind['columns'])}` | `{','.join(details)}` |"


# --- The viewer


def section_rows(program):
    for section in program["sections"]:
        scalars = {0: "", 1: section["scalar"] + ": "}.get(section["width"], f"{section['scalar']} × {section['width']}: ")
        per_object = "; one per object" if section["is_of_object"] else ""
        yield (f"| {section['tag']} | `{section['name']}` | {scalars}{section['element']} | "
               f"{', '.join(section['kinds'])}{per_object}{section['when'] and '; ' + section['when']} |")


def field_rows(fields):
    for field in fields:
        of = f"contact, in `{field['list']}`" if field["list"] else field["of"]
        yield f"| `{field['key']}` | {of}{', a vector' if field['is_vector'] else ''} | {field['unit']} | {field['doc']} |"


def lines_of_sections(program):
    yield f" = {json.dumps(program['message_kinds'])} as const;\n\nexport const FORMS = {{\n"
    for section in program["sections"]:
        form = {name: section[name] for name in ("name", "scalar", "width", "is_of_object", "kinds")}
        yield f"  {section['tag']}: {json.dumps(form)},\n"


def members_of_views(members):
    """By their path; there is no JSON for infinity."""
    return {member["path"]: {"kind": VIEW_KINDS[member["kind"]], "range": member["range"], "above": member["above"],
                             "words": member["words"].split(),
                             **{end: None if "inf" in member[end] else float(member[end]) for end in ("low", "high")}}
            for member in members}


def as_lines(named):
    """JSON with a line for each member."""
    return "{\n" + ",\n".join(f" {json.dumps(name)}: {json.dumps(value)}" for name, value in named.items()) + "\n}\n"


def replaced_lines(path, first, lines, last):
    """The text of a file with other lines between these two."""
    head, found, rest = pathlib.Path(path).read_text().partition(first)
    return head + found + "".join(lines) + rest[rest.index(last):]


# --- The options of commands


def prepare_options(commands):
    """Adds how options are spelled, such as `--threads N`, and to each that several commands have with the same
    description these commands. Returns the first of each."""
    first = {}
    for command in commands:
        for option in command["options"]:
            option["names"] = option["name"].replace(",", ", ")
            option["spelling"] = option["name"] + "..." if option["is_input"] else f"{option['names']} {option['value']}".strip()
            option["shared"] = first.setdefault((option["spelling"], option["doc"], option["is_input"]), option).setdefault("shared", [])
            option["shared"].append(command["name"])
        inputs = [option["name"] for option in command["options"] if option["is_input"]]
        command["arguments"] = "[OPTIONS] " + re.sub(r"^([^|]*)", r"\1...", inputs[-1] if inputs else "", count=1)
    return [option for option in first.values() if is_shared(option)]


def is_shared(option):
    return len(option["shared"]) > 1 and not option["is_input"]


def split_footer(footer):
    """The lines of the examples, and the paragraph after them."""
    examples, _, paragraph = footer.partition("\n\n")
    return examples.partition("\n")[2], paragraph


def example_rows(examples):
    """An example is a command, indented by two blanks, and lines that explain it, indented by six."""
    rows = []
    for line in examples.replace("|", "\\|").splitlines():
        if line.startswith("      "):
            rows[-1] += " " + line[6:]
        else:
            rows.append(f"| `{line[2:]}` |")
    return "\n".join(row + " |" for row in rows)


def cell(text):
    return "`" + text.replace("|", "\\|") + "`"


def markdown(program, shared):
    keys = {option["key"] for name in ("SceneOptions", "ObjectOptions") for option in program["structures"][name]
            if not option["is_of_machine"]}

    def is_listed_elsewhere(option):  # in docs/options.md
        return re.sub("^no_", "", option["name"][2:].replace("-", "_")) in keys

    def with_default(option):
        default = re.fullmatch(r".*default: (.*)\).*?", option["doc"], re.S)
        return option["names"] + (" " + default[1] if default else "")

    examples, paragraph = split_footer(program["footer"])
    text = f"""# The command line

`make docs` writes this page from the options of the program. `--help` and the manual page
also list the options of scenes and objects.

{program["doc"]}

```text
{examples}
```

{paragraph}
"""
    for command in program["commands"]:
        name, doc, options = command["name"], command["doc"], command["options"]
        text += f"\n## supple {name}\n\n{doc}: `supple {name} {command['arguments']}`\n\n| Option | Meaning |\n|---|---|\n"
        own = [option for option in options if not is_shared(option)]
        with_other_defaults = [with_default(option) for option in own if is_listed_elsewhere(option)]
        text += "".join(f"| {cell(option['spelling'])} | {option['doc']} |\n" for option in own if not is_listed_elsewhere(option))
        if with_other_defaults:
            text += ("| [options](options.md#scene) of table1, with their defaults there | "
                     + ", ".join(map(cell, with_other_defaults)) + " |\n")
        examples, paragraph = split_footer(command["footer"])
        text += (f"| [also](#options-of-several-commands) | {code(option['names'] for option in options if is_shared(option))} |\n\n"
                 f"| Example | What it does |\n|---|---|\n{example_rows(examples)}\n" + (paragraph and f"\n{paragraph}\n"))
    return text + """
## Options of several commands

The options of [scenes](options.md#scene) and [objects](options.md#object) are on their own page, with
defaults and ranges: `--leaf-size` is `leaf_size` there, and `--no-curves` sets `curves` to `false`. Those of
objects hold for all objects of a command. `--scene-octree-root` also takes `border`: the cube around the
border of the scene. The other options that several commands have:

| Option | Meaning | Commands |
|---|---|---|
""" + "".join(f"| {cell(option['spelling'])} | {option['doc']} | {', '.join(option['shared'])} |\n"
                for option in shared if not is_listed_elsewhere(option))


def roff(text):
    """Escapes text: a leading dot or quote is not a request, and hyphens of options stay hyphens."""
    return re.sub(r"^(?=[.'])", r"\\&", text.replace("\\", "\\e").replace("-", "\\-"), flags=re.M)


def manual(program, shared):
    def described(options):
        return "".join(f".TP\n.B {roff(option['spelling'])}\n{roff(option['doc'])}\n" for option in options)

    text = (f'.TH SUPPLE 1 "" "supple {program["supple"]}" "User Commands"\n.SH NAME\nsupple \\- find every collision between '
            "deforming triangle meshes, exactly\n.SH SYNOPSIS\n")
    for command in program["commands"]:
        text += f".B supple {command['name']}\n{command['arguments']}\n.br\n"
    text += (f".SH DESCRIPTION\n{roff(program['doc'])}\nMeshes are OBJ, OFF, PLY, STL, glTF, 3MF, Gmsh, VTK, TetGen or Medit "
             "files, or FBX, COLLADA and others that Assimp reads; scene files are TOML, recordings HDF5.\n")
    for command in program["commands"]:
        names = [option["names"] for option in command["options"] if is_shared(option)]
        examples, paragraph = split_footer(command["footer"])
        text += (f".SH SUPPLE {command['name'].upper()}\n{roff(command['doc'])}.\n"
                 + described(option for option in command["options"] if not is_shared(option))
                 + f".PP\nAlso the options of several commands (below): {roff(', '.join(names))}\n.SS Examples\n"
                 + f".nf\n{roff(examples)}\n.fi\n" + (paragraph and f".PP\n{roff(paragraph)}\n"))
    return text + ".SH OPTIONS OF SEVERAL COMMANDS\n" + described(shared) + r""".SH EXIT STATUS
.TP
.B 0
Success.
.TP
.B 1
\-\-fail\-on\-contact: something touches. diff: the recordings differ.
.TP
.B 2
Usage or input error, reported in one line on standard error. simulate: the motion blew up. \-\-fail\-on\-contact: nothing touches, but something was not tested.
.TP
.B 3
\-\-verify: brute force gives a different result. ccd\-queries: an answer is false.
.TP
.B 130, 143
A command was interrupted by SIGINT or SIGTERM; its files are whole and say that they are truncated.
"""


def tables_of(program):
    """The header and the rows of each table."""
    of = {name: [option for option in options if not option["is_of_machine"]] for name, options in program["structures"].items()}
    of_scene = {option["key"] for option in program["structures"]["SceneOptions"]}
    settings = [option for option in of["SceneOptions"] + of["ObjectOctreeOptions"] if option["is_setting"]]
    tables = {
        "recording_scene_options": ("| Attributes | Type |", attribute_rows(of["SceneOptions"])),
        "recording_object_options": ("| Attributes | Type |", attribute_rows(of["ObjectOptions"])),
        "recording_lists": (STATISTIC_HEADER, list_rows(program["lists"])),
        "protocol_sections": ("| tag | name | element | in |", section_rows(program)),
        "view_members": ("| Member | Value | Meaning |",
                         [f"| `{each['path']}` | {each['range']} | {each['doc']} |" for each in program["view_members"]]),
        "protocol_fields": ("| Key | Of each | Unit | Meaning |", field_rows(program["fields"])),
        "recording_statistics": (STATISTIC_HEADER, statistic_rows(program["structures"]["StepStats"])),
        "json_csv": ("| Contacts | Columns | With `--contact-details` also |", csv_rows(program["csv"])),
        "protocol_settings": ("| Key | Default |", [f"| `{each['key']}` | {default_of(each)} |" for each in settings]),
    }
    of["SimulationOptions"] = [option for option in of["SimulationOptions"] if option["key"] not in of_scene]
    for name, structure in (("object", "ObjectOptions"), ("coordinate", "CoordinateConversion"),
                            ("simulation", "SimulationOptions"), ("detection", "SceneOptions"), ("wave", "WaveMotion"),
                            ("mass_spring", "MassSpringMotion"), ("rigid", "RigidMotion"), ("response", "ContactResponse")):
        tables[f"scene_{name}_options"] = (OPTION_HEADER, option_rows(of[structure]))
    return tables


def filled(document, tables):
    """The text of the document with the rows of its tables."""
    def fill(match):
        if match[1] not in tables:
            sys.exit(f"{document}: there is no table {match[1]}")
        header, rows = tables[match[1]]
        lines = [header, "|" + "---|" * (header.count("|") - 1), *rows]
        return f"<!-- begin {match[1]} -->\n" + "\n".join(lines) + f"\n<!-- end {match[1]} -->\n"

    text = document.read_text()
    return re.sub(r"^<!-- begin (\S+) -->\n.*?^<!-- end \S+ -->\n", fill, text, flags=re.M | re.S)


def main():
    # Numbers stay as they are spelled, but those that stand for words.
    program = json.load(sys.stdin, parse_int=str, parse_float=str, object_hook=lambda members: {
        key: int(value) if key in ("kind", "scalar", "names", "width") and isinstance(value, str) and value.isdigit() else value
        for key, value in members.items()})
    shared = prepare_options(program["commands"])
    if sys.argv[1] == "--man":
        return print(manual(program, shared), end="")
    protocol, sections = "viewer/page/src/protocol/", "viewer/page/src/protocol/sections_generated.ts"
    files = {"docs/cli.md": markdown(program, shared),
             sections: replaced_lines(sections, "export const KINDS", lines_of_sections(program), "} as const satisfies"),
             protocol + "lists_generated.json": as_lines({each.pop("name"): each for each in program["lists_of_frames"]}),
             protocol + "view_members_generated.json": as_lines(members_of_views(program["view_members"]))}
    tables = tables_of(program)
    for document in [*pathlib.Path("docs").glob("*.md"), *pathlib.Path("viewer").glob("*.md")]:
        if "\n<!-- begin " in document.read_text():
            files[str(document)] = filled(document, tables)
    for name, text in files.items():
        path = pathlib.Path(sys.argv[1], name)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)


if __name__ == "__main__":
    main()
