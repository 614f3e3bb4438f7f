#!/usr/bin/env python3
"""Fails on an include that goes against the layers.

usage: check_include_order.py [ROOT]

A folder of src/supple includes only from itself and from the folders before it in LAYERS. An include of an
internal header contains its folder ("core/parallel.hpp"). LIBS are the libraries in libs/: each includes
headers of the core and of the libraries that it names. COMPONENTS has the limits of the libraries around
them. Public headers include only public headers and the standard library. The programs around the library
include only public headers, files of their own folder and of the one in BUILT_ON, and files of the viewer
folders in SHARED. Only core/ starts threads, so only core/ may include oneTBB. A chain of includes within a
layer, a component or a program has at most LONGEST_CHAIN files, and a folder at most MOST_FILES files of its
own, so that a reader can hold it in mind. A file that uses a name of STANDARD includes its header, itself or
through headers of the project: precompiled headers hide that it is missing, and not all builds have them.
"""

import collections
import pathlib
import re
import sys

LAYERS = [
    "core", "geometry", "mesh", "contact", "octree", "broad_phase", "narrow_phase", "world", "queries", "answers",
    "scene",
]
LONGEST_CHAIN = 5
# An octree has volumes of its nodes, which are fitted; a search has a pass for each kind, which has parts; a
# body has a solver with equations, which sum forces over a network; a session has commands
# that read arguments as settings of a stage; cells of the contest take turns of contestants, whose tasks are workloads.
LONGER_CHAINS = {"octree": 6, "answers": 6, "simulation/src": 7, "viewer/session": 7, "benchmarks": 7}
MOST_FILES = 20
# Libraries in libs/, each with those whose internal headers it may include. They include all layers.
LIBS = {"files": [], "describe": [], "verify": [], "inspect": [], "comparison": [], "manifold": []}
# Libraries around these, each with the last layer whose internal headers it may include; recording: none.
COMPONENTS = {"models": "mesh", "simulation": "mesh", "formats": "mesh", "recording": None, "distributed": "scene"}
# Components that include internal headers of libraries in libs/.
LIBS_OF_COMPONENTS = {"formats": ["files"], "distributed": ["verify"]}
PROGRAMS = ["viewer/session", "viewer/export", "viewer/view_file", "viewer/server", "viewer/attach", "cli", "distributed/program", "experiments", "examples", "benchmarks"]
# Folders of small programs that do not depend on each other.
LISTS = ["examples"]
# Folders of the viewer that others may include although they are not public: "session/scene_view.hpp".
SHARED = {"viewer/server": ["session"], "viewer/view_file": ["session", "export"], "viewer/attach": ["session", "export", "view_file", "server"], "cli": ["session", "export", "view_file", "server"], "experiments": ["session"], "distributed/program": ["session"]}
# Programs that are built on the parts of another one; a benchmark divides space as a distributed scene does.
BUILT_ON = {"experiments": "cli", "distributed/program": "cli", "benchmarks": "distributed/src"}
PUBLIC = ["include", "viewer/include"] + [f"libs/{name}/include" for name in LIBS] + [f"{name}/include" for name in COMPONENTS]
SOURCES = {".cpp", ".hpp", ".h", ".cc"}
STANDARD = {
    "algorithm": "clamp fill lower_bound max max_element min min_element minmax sort stable_sort upper_bound",
    "array": "array", "atomic": "atomic", "bit": "bit_cast countr_zero popcount", "cctype": "isdigit isspace tolower toupper",
    "charconv": "from_chars to_chars", "cmath": "abs floor hypot isfinite isnan sqrt", "condition_variable": "condition_variable",
    "cstdio": "FILE fprintf printf snprintf", "cstdlib": "abort exit getenv strtod", "cstring": "memcmp memcpy memmove memset strlen",
    "deque": "deque", "fstream": "ifstream ofstream", "functional": "function", "iomanip": "setprecision setw",
    "iostream": "cerr cin cout", "limits": "numeric_limits", "map": "map", "memory": "make_shared make_unique shared_ptr unique_ptr",
    "mutex": "lock_guard mutex scoped_lock unique_lock", "numeric": "accumulate exclusive_scan iota", "optional": "nullopt optional",
    "queue": "priority_queue queue", "random": "mt19937 mt19937_64 uniform_int_distribution uniform_real_distribution",
    "set": "set", "span": "span", "sstream": "istringstream ostringstream stringstream", "thread": "thread this_thread",
    "tuple": "make_tuple tie tuple", "unordered_map": "unordered_map", "unordered_set": "unordered_set", "variant": "get_if variant visit",
}
HEADER_OF = {name: header for header, names in STANDARD.items() for name in names.split()}
STANDARD_NAME = re.compile(r"\bstd::(\w+)")
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')


def includes(path):
    """Yields (line number, the bracket, the name) of each include."""
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        match = INCLUDE.match(line)
        if match:
            yield number, match[1], match[2]


def sources(folder):
    return sorted(p for p in folder.rglob("*") if p.suffix in SOURCES)


def is_public(root, name, folders=PUBLIC):
    return name.startswith("supple/") and any((root / folder / name).is_file() for folder in folders)


def problem_in_library(root, layer, bracket, name, folders=PUBLIC):
    if name.startswith("tbb/") and layer != "core":
        return "only core/ includes oneTBB; use core/parallel.hpp"
    if bracket == "<" or is_public(root, name, folders):
        return None
    target = name.split("/")[0]
    if target not in LAYERS or "/" not in name:
        return f"name an internal header by its layer, one of {', '.join(LAYERS)}"
    if not (root / "src/supple" / name).is_file():
        return "there is no such header"
    if LAYERS.index(target) > LAYERS.index(layer):
        return f"{layer} comes before {target}, so what builds on {layer} must not include from it"
    return None


def problem_in_component(root, layer, libs, bracket, name):
    if name.split("/")[0] in libs and (root / "libs" / name).is_file():
        return None
    if layer is not None:
        return problem_in_library(root, layer, bracket, name)
    if bracket == "<" or is_public(root, name):
        return None
    return "include only public headers (supple/...) and files of the same folder"


def problem_in_public_header(root, folder, bracket, name):
    if bracket == "<":
        return "a public header needs no third party; move this into src/" if "/" in name else None
    folders = ["include"] if folder == "include" else PUBLIC
    return None if is_public(root, name, folders) else "a public header includes only public headers (supple/...), one of the core only those of the core"


def problem_in_program(root, folder, path, bracket, name):
    if bracket == "<" or is_public(root, name):
        return None
    own = (path.parent, folder, root / BUILT_ON.get(folder.relative_to(root).as_posix(), folder))
    if any((base / name).is_file() for base in own) and ".." not in name:
        return None
    if name.split("/")[0] in SHARED.get(folder.relative_to(root).as_posix(), []) and (root / "viewer" / name).is_file():
        return None
    return "include only public headers (supple/...) and files of the same folder"


def longest_chain(base, folder, chain):
    """The longest chain of includes within the folder that begins with this chain of files. Files are named from
    `base`, or are in the folder of the file that includes them."""
    own = []
    for _, bracket, name in includes(chain[-1]):
        for path in (chain[-1].parent / name, base / name):
            if bracket == '"' and path.is_file() and path.is_relative_to(folder) and path not in chain:
                own.append(path)
                break
    return max((longest_chain(base, folder, chain + [path]) for path in own), key=len, default=chain)


def in_lib(root, name):
    folder = root / "libs" / name
    return [path for path in sources(folder) if not path.is_relative_to(folder / "include")]


def headers_that_miss(root):
    """Yields (path, line number, a standard name, what is wrong) for each use without its header."""
    folders = [root / name for name in ("src", "libs", "tests", "fuzz", "bindings", "include", "viewer", *COMPONENTS, *PROGRAMS)]
    named = collections.defaultdict(set)
    for path in {path for folder in folders for path in sources(folder) if "node_modules" not in path.parts}:
        named[path.name].add(path)
    known = {}

    def headers(path):
        if path not in known:
            known[path] = set()
            for _, bracket, name in includes(path):
                own = [other for other in named[pathlib.PurePath(name).name] if other.as_posix().endswith(f"/{name}")]
                known[path].update([name], *map(headers, own))
        return known[path]

    for path in sorted(set().union(*named.values())):
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
            for name in STANDARD_NAME.findall(line.split("//")[0]):
                if name in HEADER_OF and HEADER_OF[name] not in headers(path):
                    yield path, number, f"std::{name}", f"include <{HEADER_OF[name]}>, here or in a header of this file"


def problems(root):
    """Yields (path, line number, include, what is wrong)."""
    library = root / "src/supple"
    for path in sources(library):
        layer = path.relative_to(library).parts[0]
        if layer not in LAYERS:
            yield path, 1, layer, f"not in a layer; move it into one of {', '.join(LAYERS)}"
            continue
        for number, bracket, name in includes(path):
            if what := problem_in_library(root, layer, bracket, name, ["include"]):
                yield path, number, name, what
    own_folders = [f"{name}/src" for name in COMPONENTS] + [name for name in PROGRAMS if name not in LISTS]
    in_bases = [(layer, library) for layer in LAYERS] + [(lib, root / "libs") for lib in LIBS]
    for name, base in in_bases + [(name, root / name) for name in own_folders]:
        most, folder = LONGER_CHAINS.get(name, LONGEST_CHAIN), base if base.name == pathlib.Path(name).name else base / name
        for path in sources(folder):
            chain = longest_chain(base, folder, [path])
            if len(chain) > most:
                names = " includes ".join(p.relative_to(base).as_posix() for p in chain)
                yield path, 1, names, f"a chain of more than {most} files"
    in_rooms = [path for folder in [library, root / "libs"] + [root / name for name in own_folders] for path in sources(folder)]
    for folder, count in sorted(collections.Counter(path.parent for path in in_rooms).items()):
        if count > MOST_FILES:
            yield folder, 1, folder.name, f"a folder of {count} files; give it rooms of at most {MOST_FILES}"
    for component, layer in COMPONENTS.items():
        own = root / component / "src"
        for path in sources(own):
            for number, bracket, name in includes(path):
                if bracket == '"' and (own / name).is_file():
                    continue
                if what := problem_in_component(root, layer, LIBS_OF_COMPONENTS.get(component, []), bracket, name):
                    yield path, number, name, what
    for name, used in LIBS.items():
        for path in in_lib(root, name):
            for number, bracket, included in includes(path):
                if what := problem_in_component(root, LAYERS[-1], [name, *used], bracket, included):
                    yield path, number, included, what
    for folder in PUBLIC:
        for path in sources(root / folder):
            for number, bracket, name in includes(path):
                if what := problem_in_public_header(root, folder, bracket, name):
                    yield path, number, name, what
    for program in PROGRAMS:
        folder = root / program
        for path in sources(folder):
            for number, bracket, name in includes(path):
                if what := problem_in_program(root, folder, path, bracket, name):
                    yield path, number, name, what
    yield from headers_that_miss(root)


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parent.parent)
    found = list(problems(root))
    for path, number, name, what in found:
        print(f"{path.relative_to(root)}:{number}: {name}: {what}", file=sys.stderr)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
