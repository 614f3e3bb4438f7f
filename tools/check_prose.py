#!/usr/bin/env python3
"""Checks the prose of documents and comments.

usage: check_prose.py [ROOT]

Lines of Markdown prose have at most 110 columns; code, tables and the targets of links do not count. Prose and comments
avoid phrases that readers stumble over. Prints file, line and reason; fails when it found anything.
"""

import pathlib
import re
import subprocess
import sys

COLUMNS = 110
# What to avoid, and what to write instead.
PHRASES = {
    r"(?<![\w.] )\bOf (?!course)[a-z][^.:]{0,60}:": "begin with the subject, not with 'Of …:'",
    r"\btold (which|apart|of|that|so)\b": "'given', 'distinguished', 'notified'",
    r"\blanes? (of a node|that holds?)\b|\binner lanes?\b": "'child'",
    r"\bunfolded\b|\bunfolds\b": "'self-collision culling'",
    r"\bbulk search\b|\bsearch in bulk\b": "'hierarchical grid'",
    r"\bmeasured box(es)?\b": "'quantized box'",
    r"\bturn(s|ed)? (back|them back) at\b": "'reflect'",
    r"\b(is|are) asked for\b|\bwho asks for\b": "'request', or name who needs it",
    r"\b(built|built up|computed|made|begun|asked) anew\b": "'again', 'rebuild'",
    r"\bhow far that is\b|\bwhat becomes of\b|\bwhat comes of\b": "name the thing",
    r"\b(a row|a line) a\b|\bone a (core|query|frame|step|file|row)\b|\ban object each\b": "'one per …'",
    r"\ba (row|frame|file) at a time\b": "'row by row', 'one frame at a time'",
    r"\bsent off\b|\bunder way\b|\bcease[sd]?\b|\bmend(s|ed)?\b": "'gets a velocity', 'current', 'stop', 'fix'",
    r"\bfor people's eyes\b|\bfor nobody\b|\bthe one door\b": "say who reads it, or 'the only …'",
}
DOCUMENTS = ["*.md", ":!benchmarks/results", ":!docs/cli.md"]  # records, and what a program writes
SOURCES = ["*.hpp", "*.cpp", "*.ts", "*.mjs", "*.py", "*.sh", "*.toml"]
COMMENT = re.compile(r"^\s*(?:///?<?|#(?!!|include|if|e|define|pragma|undef)|\*(?!/)|/\*\*)\s?(.*)|\s//[/<]*\s(.*)")


def files(root, patterns):
    names = subprocess.run(["git", "ls-files", "--cached", "--others", "--exclude-standard", *patterns], cwd=root,
                           check=True, capture_output=True, text=True).stdout.split("\n")
    return [root / name for name in names if name and name != "tools/check_prose.py" and (root / name).exists()]


def problems(path, number, text):
    for pattern, instead in PHRASES.items():
        match = re.search(pattern, text)
        if match:
            yield f"{path}:{number}: '{match[0].strip()}': {instead}"


def check_document(path):
    in_code = False
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        if line.lstrip().startswith("```"):
            in_code = not in_code
        elif not in_code and not line.startswith("    "):
            width = len(re.sub(r"\]\([^)]*\)", "]()", line))
            if width > COLUMNS and not line.startswith("|"):
                yield f"{path}:{number}: {width} columns; prose has at most {COLUMNS}"
            yield from problems(path, number, re.sub(r"`[^`]*`", "``", line))


def check_source(path):
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        match = COMMENT.search(line)
        if match:
            yield from problems(path, number, match[1] or match[2] or "")


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".").resolve()
    found = [p for path in files(root, DOCUMENTS) for p in check_document(path)]
    found += [p for path in files(root, SOURCES) for p in check_source(path)]
    print("\n".join(found).replace(f"{root}/", ""), end="\n" if found else "")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
