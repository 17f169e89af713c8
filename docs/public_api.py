#!/usr/bin/env python3
"""Compares the public items of the published packages with public-api.txt, as `cargo doc` lists them.

usage: docs/public_api.py [--write]

What is there is read off target/doc/PACKAGE/all.html, after `cargo doc --workspace --no-deps`. With --write the list is written
anew: a change of it is a change of the interface, and belongs in CHANGELOG.md.
"""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
LIST = ROOT / "public-api.txt"
PACKAGES = ["hertzian", "hertzian_chart", "hertzian_contract"]
TYPES = {"structs", "enums", "traits", "types", "unions"}


def items(package):
    """Kind and path of every public item of a package; what it re-exports from a leaf counts there."""
    page = ROOT / "target" / "doc" / package / "all.html"
    text = page.read_text(encoding="utf-8")
    for section in re.finditer(r'<h3 id="(\w+)">.*?</h3>(.*?)</ul>', text, re.S):
        for path in re.findall(r"<a href=\"[^\"]+\">([^<]+)</a>", section.group(2)):
            yield section.group(1), path


def listed():
    """The text of the list, and the number of types."""
    leaves = {path.split("::")[-1] for package in PACKAGES[1:] for _, path in items(package)}
    lines, types, seen = [], 0, set()
    for package in PACKAGES:
        for kind, path in sorted(items(package)):
            name = path.split("::")[-1]
            if package == "hertzian" and (name in leaves or (kind, name) in seen):
                continue
            seen.add((kind, name))
            types += kind in TYPES and package == "hertzian"
            lines.append(f"{package} {kind} {path}")
    return "\n".join(lines) + "\n", types


def main():
    text, types = listed()
    print(f"{types} public types of hertzian itself")
    if "--write" in sys.argv[1:]:
        LIST.write_text(text, encoding="utf-8")
        return 0
    known = LIST.read_text(encoding="utf-8") if LIST.exists() else ""
    old, new = set(known.splitlines()), set(text.splitlines())
    for line in sorted(old - new):
        print(f"- {line}")
    for line in sorted(new - old):
        print(f"+ {line}")
    if old != new:
        print("the interface has changed: docs/public_api.py --write, and a line in CHANGELOG.md", file=sys.stderr)
    return int(old != new)


if __name__ == "__main__":
    sys.exit(main())
