#!/usr/bin/env python3
"""lines.py SOURCES...: how much code only the diagnosis needs.

Lines of code (no comment, not blank) of all files under SOURCES/lib and SOURCES/tools that are reached by
includes from hs-diagnose, or from what hs-identify takes of lib/diagnose and lib/plan, and from nothing else;
effects' own files are not counted. A .cpp file stands with the header of its name, else with the first header
of its folder that it includes.
"""
import pathlib
import re
import sys

INCLUDE = re.compile(r'^\s*#include "([^"]+)"', re.M)
# The last names are those of versions in which a tool was one file and headers beside it.
DIAGNOSING = re.compile(r"^(lib/diagnose/|lib/plan/|tools/hs-diagnose|tools/hs-identify/plan"
                        r"|tools/identify_(plan|search))")


def code_lines(text):
    text = re.sub(r"/\*.*?\*/", "", text, flags=re.S)
    return sum(1 for line in text.splitlines() if line.strip() and not line.strip().startswith("//"))


def read(root):
    files = {}
    for folder in ("lib", "tools"):
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in (".h", ".cpp"):
                files[path.relative_to(root).as_posix()] = path.read_text()
    return files


def included(name, text, files):
    folder = name.rsplit("/", 1)[0]
    for include in INCLUDE.findall(text):
        for place in (f"lib/{include}", f"tools/{include}", f"{folder}/{include}"):
            if place in files:
                yield place
                break


def implementations(files):
    of = {}
    for name, text in files.items():
        if not name.endswith(".cpp") or "int main(" in text:
            continue
        header = name[:-4] + ".h"
        if header not in files:
            folder = name.rsplit("/", 1)[0]
            header = next((h for h in included(name, text, files) if h.rsplit("/", 1)[0] == folder), None)
        if header:
            of.setdefault(header, []).append(name)
    return of


def reached(roots, files, of, may_go):
    seen, todo = set(), list(roots)
    while todo:
        name = todo.pop()
        if name in seen:
            continue
        seen.add(name)
        todo += [f for f in [*included(name, files[name], files), *of.get(name, [])] if may_go(name, f)]
    return seen


def main():
    for source in sys.argv[1:]:
        files = read(pathlib.Path(source))
        of = implementations(files)
        tools = [f for f in files if f.startswith("tools/") and f.endswith(".cpp")]
        others = [f for f in tools if not DIAGNOSING.match(f)]
        of_others = reached(others, files, of,
                            lambda a, b: not (a.startswith("tools/hs-identify") and DIAGNOSING.match(b)))
        of_all = reached(tools, files, of, lambda a, b: True)
        alone = sorted(f for f in of_all - of_others if not f.startswith("lib/effects/"))
        for name in alone:
            print(f"{code_lines(files[name]):6} {name}")
        print(f"{sum(code_lines(files[f]) for f in alone):6} in {len(alone)} files: {source}\n")


if len(sys.argv) < 2:
    sys.exit(__doc__)
main()
