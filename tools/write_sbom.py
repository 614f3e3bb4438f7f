#!/usr/bin/env python3
"""Writes the bill of materials of the program as SPDX 2.3 in JSON.

usage: write_sbom.py PROGRAM BUILD_FOLDER VERSION OUTPUT

It lists what is in the program or linked with it: the libraries that the program names, the packages whose headers
the compiler read, and the npm packages in the viewer's page. Versions are those of Debian's packages on this
machine; on other systems they are unknown. The same build on the same machine gives the same bytes.
"""
import hashlib
import json
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
# The licences that their authors state, by the beginning of the package's name.
LICENCES = {
    "libassimp": "BSD-3-Clause", "libboost": "BSL-1.0", "libc6": "LGPL-2.1-or-later", "libcli11": "BSD-3-Clause", "libdraco": "Apache-2.0",
    "libeigen3": "MPL-2.0", "libfmt": "MIT", "libgcc": "GPL-3.0-or-later WITH GCC-exception-3.1", "libhdf5": "BSD-3-Clause",
    "libhwy": "Apache-2.0", "libmeshoptimizer": "MIT", "libpugixml": "MIT", "libstdc++": "GPL-3.0-or-later WITH GCC-exception-3.1", "libtbb": "Apache-2.0",
    "libtomlplusplus": "MIT", "libzip": "BSD-3-Clause", "linux-libc-dev": "GPL-2.0-only WITH Linux-syscall-note", "nlohmann-json3": "MIT", "rapidjson": "MIT", "zlib1g": "Zlib",
}


def lines_of(*command):
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True)
    return done.stdout.splitlines()


def debian_packages(paths):
    """The packages that own the files, with their versions; none where there is no dpkg."""
    # Debian 12 has /lib as a link to /usr/lib, and its lists have either name.
    spellings = {spelling for path in paths for spelling in (path, path.removeprefix("/usr"), str(pathlib.Path(path).resolve()))}
    owners = {line.split(":")[0] for line in lines_of("dpkg-query", "-S", *sorted(spellings))}
    return dict(line.split(" ") for line in lines_of("dpkg-query", "-W", "-f=${Package} ${Version}\\n", *sorted(owners))) if owners else {}


def linked_libraries(program):
    needed = {found.group(1) for line in lines_of("readelf", "-d", program) if (found := re.search(r"NEEDED.*\[(.*)\]", line))}
    located = {}
    for line in lines_of("ldd", program):
        if found := re.match(r"\s*(\S+) => (/\S+)", line):
            located[found.group(1)] = found.group(2)
    return {located[name] for name in needed if name in located}


def read_headers(build):
    """One header of each folder of the system that the compiler read for the program."""
    headers, is_of_program = {}, False
    for line in lines_of("ninja", "-C", build, "-t", "deps"):
        path = line.strip()
        if not line.startswith(" "):
            is_of_program = not line.startswith(("tests/", "fuzz/", "examples/", "benchmarks/", "distributed/",
                                                 "bindings/python/CMakeFiles/supple_python_distributed.dir/"))
        elif is_of_program and path.startswith("/usr/"):
            headers.setdefault(str(pathlib.PurePath(path).parent), path)
    return set(headers.values())


def sources_in(build):
    """The version of ufbx, whose sources are compiled into the program from any folder; empty without it."""
    for line in lines_of("ninja", "-C", build, "-t", "deps"):
        path = pathlib.Path(build, line.strip())
        if path.name == "ufbx.h" and path.exists() and (path.parent / "ufbx.c").exists():
            found = re.search(r"#define UFBX_HEADER_VERSION ufbx_pack_version\((\d+), (\d+), (\d+)\)", path.read_text())
            return ".".join(found.groups()) if found else ""
    return ""


def page_packages():
    folder = ROOT / "viewer" / "page"
    imported = set()
    for source in sorted((folder / "src").rglob("*.ts")):
        for name in re.findall(r"from ['\"]([^.'\"][^'\"]*)['\"]|import ['\"]([^.'\"][^'\"]*)['\"]", source.read_text()):
            imported.add("/".join((name[0] or name[1]).split("/")[:1]))
    locked = json.loads((folder / "package-lock.json").read_text())["packages"]
    return {name: locked[f"node_modules/{name}"] for name in sorted(imported) if f"node_modules/{name}" in locked}


def package(kind, name, version, licence, locator, **more):
    return {"SPDXID": f"SPDXRef-{kind}-" + re.sub(r"[^A-Za-z0-9.-]", "-", name), "name": name, "versionInfo": version,
            "downloadLocation": "NOASSERTION", "filesAnalyzed": False, "licenseConcluded": "NOASSERTION",
            "licenseDeclared": licence, "copyrightText": "NOASSERTION",
            "externalRefs": [{"referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl", "referenceLocator": locator}], **more}


def licence_of(name):
    return next((licence for begin, licence in LICENCES.items() if name.startswith(begin)), "NOASSERTION")


def main():
    program, build, version, output = sys.argv[1:]
    digest = hashlib.sha256(pathlib.Path(program).read_bytes()).hexdigest()
    packages = [package("Program", "supple", version, "Apache-2.0", f"pkg:generic/supple@{version}",
                        checksums=[{"algorithm": "SHA256", "checksumValue": digest}], primaryPackagePurpose="APPLICATION")]
    relations = [("SPDXRef-DOCUMENT", "DESCRIBES", packages[0]["SPDXID"])]
    linked = debian_packages(linked_libraries(program))
    compiled = debian_packages(read_headers(build))
    for name, of_debian in sorted({**compiled, **linked}.items()):
        packages.append(package("Debian", name, of_debian, licence_of(name), f"pkg:deb/debian/{name}@{of_debian}"))
        relation = "DYNAMIC_LINK" if name in linked else "DEPENDS_ON"
        relations.append((packages[0]["SPDXID"], relation, packages[-1]["SPDXID"]))
    if ufbx := sources_in(build):
        packages.append(package("Source", "ufbx", ufbx, "MIT OR Unlicense", f"pkg:github/ufbx/ufbx@v{ufbx}"))
        relations.append((packages[0]["SPDXID"], "CONTAINS", packages[-1]["SPDXID"]))
    for name, locked in page_packages().items():
        packages.append(package("npm", name, locked["version"], locked.get("license", "NOASSERTION"),
                                f"pkg:npm/{name}@{locked['version']}"))
        relations.append((packages[0]["SPDXID"], "CONTAINS", packages[-1]["SPDXID"]))
    document = {
        "spdxVersion": "SPDX-2.3", "dataLicense": "CC0-1.0", "SPDXID": "SPDXRef-DOCUMENT", "name": f"supple-{version}",
        "documentNamespace": f"https://spdx.org/spdxdocs/supple-{version}-{digest}",
        # The time of the build would give other bytes each time.
        "creationInfo": {"created": "1970-01-01T00:00:00Z", "creators": ["Tool: write_sbom.py"]},
        "packages": packages,
        "relationships": [{"spdxElementId": a, "relationshipType": kind, "relatedSpdxElement": b} for a, kind, b in relations],
    }
    pathlib.Path(output).write_text(json.dumps(document, indent=1) + "\n")


if __name__ == "__main__":
    main()
