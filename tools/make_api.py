#!/usr/bin/env python3
"""Writes docs/api.json: every public type, field, enumeration, constant and function with its documentation.

usage: make_api.py [--check] [ROOT]

Reads all headers include/supple/*.hpp and LIBRARY/include/supple/*.hpp below ROOT with libclang. With --check
it writes nothing and fails when the file is out of date.

The file has a list `headers`, the core first; each has its `library`, its `name` and its `entities` in the
order of the header. `kind` is struct, class, enum, function, constant, macro, alias or concept. Names are
without `supple::`; a nested type has the name of its owner in front and is listed after it. Each overload is an
entity. `default` and `value` are as spelled, types as libclang prints them. `doc` is the comment that begins
with `///`, one line for each paragraph; it is absent where the header has none. `follows` marks a
declaration without a comment in the line after another one, whose comment may be for both. Left out are the
namespace `detail`, what is private, explicit specialisations (such as `Description<...>` and `words<...>`),
macros that their header undefines, defaulted comparisons and destructors.
"""

import json
import pathlib
import re
import shutil
import subprocess
import sys

sys.path.append("/usr/lib/python3/dist-packages")  # Debian's package, for a Python that is not Debian's
try:
    from clang import cindex
    from clang.cindex import AccessSpecifier, CursorKind as Kind
except ImportError:
    cindex = None

MEMBER_LISTS = ("values", "fields", "constructors", "methods", "operators")
SIMPLE_KINDS = cindex and {Kind.VAR_DECL: "constant", Kind.MACRO_DEFINITION: "macro", Kind.CONCEPT_DECL: "concept",
                           Kind.TYPE_ALIAS_DECL: "alias", Kind.TYPE_ALIAS_TEMPLATE_DECL: "alias"}
FUNCTIONS = cindex and (Kind.FUNCTION_DECL, Kind.FUNCTION_TEMPLATE, Kind.CXX_METHOD, Kind.CONSTRUCTOR,
                        Kind.CONVERSION_FUNCTION)
BEGIN = re.compile(r"\s*(#define |friend |\[\[\w+\]\] )?")  # what stands before the part that libclang reports
COMPARISON = re.compile(r"operator(==|!=|<=>|<|>|<=|>=)$")


def api_headers(root):
    """The (library, path) of each public header: those of the core, then those of the other libraries."""
    core = [("core", path) for path in sorted(root.glob("include/supple/*.hpp"))]
    others = sorted([*root.glob("libs/*/include/supple/*.hpp"), *root.glob("*/include/supple/*.hpp")])
    return core + [(path.parents[2].name, path) for path in others]


def paragraphs(lines):
    """Joins the lines of a comment to paragraphs. List items, code and indented lines keep their lines."""
    text, in_code, in_item = "", False, False
    for line in (re.sub(r"^///<? ?", "", line).rstrip() for line in lines):
        fence, item = line.startswith("```"), bool(re.match(r"[-*] ", line))
        if in_code or fence or not line:
            text += "\n" + line
            in_code, in_item = in_code != fence, False
        elif item or line.startswith("    ") or in_item and not line.startswith("  ") or text.endswith(("\n", "```")):
            text += "\n" + line
            in_item = item
        else:
            text += " " + line.strip()
    return re.sub(r"\n{2,}", "\n\n", text).strip()


class Header:
    """The text of one header, which has the comments and what is reported as spelled."""

    def __init__(self, path):
        self.bytes = path.read_bytes()
        self.lines = self.bytes.decode().split("\n")
        self.last_line = 0  # of the declaration that was read before

    def text(self, begin, end):
        """The source between two byte offsets, in one line."""
        return re.sub(r"\s+", " ", self.bytes[begin:end].decode()).strip()

    def doc(self, cursor):
        """The `///` lines above a declaration, then the `///<` comment after it."""
        first = number = cursor.extent.start.line - 1
        begins_line = BEGIN.fullmatch(self.lines[first].encode()[:cursor.extent.start.column - 1].decode())
        while begins_line and number > 0 and re.match(r"\s*///(?!<)", self.lines[number - 1]):
            number -= 1
        before = [line.strip() for line in self.lines[number:first]]
        end = cursor.extent.end
        line = self.lines[end.line - 1].encode()[end.column - 1:].decode()
        match = re.match(r"[^{}/]*(///<.*)", line)
        after, number = [match[1]] if match else [], end.line
        while match and number < len(self.lines) and self.lines[number].strip().startswith("///<"):
            after.append(self.lines[number].strip())
            number += 1
        return "\n\n".join(filter(None, [paragraphs(before), paragraphs(after)]))


def spelled(type_):
    return re.sub(r" ([&*]+)", r"\1", type_.spelling)


def add(entity, **parts):
    """Adds what is not empty to an entity."""
    entity.update((key, part) for key, part in parts.items() if part)
    return entity


def initializer(header, cursor):
    """What follows the name of a declaration: its default value, or nothing."""
    begin = cursor.location.offset + len(cursor.spelling.encode())
    return header.text(begin, cursor.extent.end.offset).removeprefix("=").strip()


def template(header, cursor):
    """The template parameters as spelled, and what the template requires of them."""
    kinds = (Kind.TEMPLATE_TYPE_PARAMETER, Kind.TEMPLATE_NON_TYPE_PARAMETER, Kind.TEMPLATE_TEMPLATE_PARAMETER)
    own = [child for child in cursor.get_children() if child.kind in kinds]
    if not own:
        return [], ""
    match = re.match(r"> requires\b ?(.*)", header.text(own[-1].extent.end.offset, cursor.location.offset))
    ends = [child.extent.end.offset for child in own]
    parameters = [header.text(begin, end) for begin, end in zip([cursor.extent.start.offset, *ends], ends)]
    requires = match[1].removesuffix(spelled(cursor.result_type)).strip() if match else ""
    return [re.sub(r"^(template ?<|,) ?", "", text) for text in parameters], requires


def function(header, cursor, is_constructor=False):
    parameters, requires = template(header, cursor)
    entity = add({"name": re.sub(r"(?<!operator)<.*", "", cursor.spelling)}, template=parameters, requires=requires)
    own = [child for child in cursor.get_children() if child.kind == Kind.PARM_DECL]
    entity["parameters"] = [add(add({}, name=each.spelling) | {"type": spelled(each.type)},
                                default=each.spelling and initializer(header, each)) for each in own]
    if not is_constructor:
        entity["returns"] = spelled(cursor.result_type)
    add(entity, static=cursor.is_static_method(), const=cursor.is_const_method())
    return described(header, cursor, entity)


def described(header, cursor, entity):
    """Adds the comment, or that the declaration follows another one without a line between."""
    doc = header.doc(cursor)
    follows = not doc and cursor.extent.start.line - header.last_line in (0, 1)
    header.last_line = cursor.extent.end.line
    return add(entity, follows=follows, doc=doc)


def class_entities(header, cursor, scope):
    """A structure or class, then its public nested types."""
    name = scope + cursor.spelling
    keyword = re.findall(r"\bstruct\b|\bclass\b", header.text(cursor.extent.start.offset, cursor.location.offset))[-1]
    entity = add({"kind": keyword, "name": name}, template=template(header, cursor)[0], doc=header.doc(cursor))
    members, starts, nested = {key: [] for key in MEMBER_LISTS}, [], []
    for child in cursor.get_children():
        if child.kind == Kind.CXX_BASE_SPECIFIER:
            entity.setdefault("bases", []).append(spelled(child.type))
        if child.access_specifier != AccessSpecifier.PUBLIC:
            continue
        if child.kind == Kind.FRIEND_DECL:
            child = next(child.get_children(), child)
        if child.kind == Kind.FIELD_DECL:
            field = add({"name": child.spelling, "type": spelled(child.type)}, default=initializer(header, child))
            members["fields"].append(described(header, child, field))
            starts.append(child.extent.start.offset)
        elif child.kind in FUNCTIONS:
            if COMPARISON.match(child.spelling) and child.is_default_method():
                continue
            is_constructor = child.spelling.split("<")[0] == cursor.spelling
            key = "operators" if child.spelling.startswith("operator") else "methods"
            members["constructors" if is_constructor else key].append(function(header, child, is_constructor))
        else:
            nested += entities_of(header, child, name + "::")
    # Several declarators of one declaration, `ObjectId a, b;`, share a comment.
    docs = {start: field["doc"] for start, field in zip(starts, members["fields"]) if "doc" in field}
    for start, field in zip(starts, members["fields"]):
        if start in docs:
            field.pop("follows", None)
            field["doc"] = docs[start]
    return [add(entity, **members)] + nested


def enum_entity(header, cursor, scope):
    entity = {"kind": "enum", "name": scope + cursor.spelling, "type": spelled(cursor.enum_type)}
    values = [add({"name": child.spelling, "value": child.enum_value}, doc=header.doc(child))
              for child in cursor.get_children() if child.kind == Kind.ENUM_CONSTANT_DECL]
    return add(entity, doc=header.doc(cursor), values=values)


def entities_of(header, cursor, scope=""):
    """The entities of one declaration, none when it is not public."""
    name = scope + cursor.spelling
    begin = header.text(cursor.extent.start.offset, cursor.location.offset)
    if cursor.spelling == "detail" or begin.startswith("template <>") or f"#undef {cursor.spelling}" in header.lines:
        return []
    if cursor.kind == Kind.NAMESPACE:
        inner = "" if name == "supple" else name + "::"
        return [entity for child in cursor.get_children() for entity in entities_of(header, child, inner)]
    if cursor.kind in (Kind.STRUCT_DECL, Kind.CLASS_DECL, Kind.CLASS_TEMPLATE):
        return class_entities(header, cursor, scope) if (cursor.get_definition() or cursor) == cursor else []
    if cursor.kind == Kind.ENUM_DECL:
        return [enum_entity(header, cursor, scope)]
    if cursor.kind in FUNCTIONS:
        entity = {"kind": "function", **function(header, cursor)}
        return [entity | {"name": scope + entity["name"]}]
    kind = SIMPLE_KINDS.get(cursor.kind)
    if kind is None:
        return []
    entity = add({"kind": kind, "name": name}, template=template(header, cursor)[0])
    if kind == "constant":
        entity["type"] = spelled(cursor.type)
    entity["type" if kind == "alias" else "value"] = initializer(header, cursor)
    return [described(header, cursor, entity)]


def read_api(root):
    """Reads the public headers below a folder into the structure of docs/api.json."""
    paths = api_headers(root)
    # One translation unit with all headers: the standard library is read once.
    name = str(root / "api.cpp")
    text = "".join(f'#include "{path}"\n' for _, path in paths)
    folders = sorted({str(path.parent.parent) for _, path in paths})
    if shutil.which("mpicxx"):  # `distributed` includes its header
        folders += subprocess.run(["mpicxx", "--showme:incdirs"], capture_output=True, text=True, check=True).stdout.split()
    unit = cindex.Index.create().parse(
        name, ["-xc++", "-std=c++20", *(f"-I{folder}" for folder in folders)], [(name, text)],
        cindex.TranslationUnit.PARSE_DETAILED_PROCESSING_RECORD)
    errors = [problem for problem in unit.diagnostics if problem.severity >= cindex.Diagnostic.Error]
    if errors:
        place = f"{errors[0].location.file}:{errors[0].location.line}".replace(f"{root}/", "")
        sys.exit(f"{place}: {errors[0].spelling}")
    found, headers = {str(path): [] for _, path in paths}, {str(path): Header(path) for _, path in paths}
    for cursor in unit.cursor.get_children():
        path = str(cursor.location.file)
        if path in found:
            found[path] += entities_of(headers[path], cursor)
    return {"headers": [{"library": library, "name": f"supple/{path.name}", "entities": found[str(path)]}
                        for library, path in paths]}


def write(value, indent=""):
    """JSON in which each header, entity and member begins a line."""
    lists = [key for key in value if key in MEMBER_LISTS + ("entities", "headers")]
    begin = json.dumps({key: part for key, part in value.items() if key not in lists}, ensure_ascii=False)[1:-1]
    inner = indent + "  "
    parts = [f'"{key}": [\n' + ",\n".join(inner + write(item, inner) for item in value[key]) + "]" for key in lists]
    return "{" + ", ".join(filter(None, [begin, *parts])) + "}"


def main(arguments):
    places = [argument for argument in arguments if argument != "--check"] or [pathlib.Path(__file__).parent.parent]
    root = pathlib.Path(places[0]).resolve()
    if cindex is None:
        sys.exit("make_api: needs libclang for Python; run: apt-get install python3-clang-19")
    path, text = root / "docs/api.json", write(read_api(root)) + "\n"
    if "--check" not in arguments:
        path.write_text(text, encoding="utf-8")
        return 0
    old = path.read_text(encoding="utf-8") if path.exists() else ""
    if old == text:
        return 0
    changed = "\n".join(set(old.splitlines()) ^ set(text.splitlines()))
    names = sorted(set(re.findall(r'^ *{.*?"name": "(.*?)"', changed, re.MULTILINE))) or ["their order"]
    more = f" and {len(names) - 5} more" if len(names) > 5 else ""
    print(f"docs/api.json: differs from the headers in {', '.join(names[:5])}{more}; run: make docs", file=sys.stderr)
    return 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
