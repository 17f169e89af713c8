#!/usr/bin/env python3
"""Checks that every relative link and picture in the Markdown files of this repository leads to a file.

    docs/check.py

Links to the web are not followed: whether they answer depends on the day.
"""

import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
# [text](target) and ![text](target), the target without a title.
LINK = re.compile(r"\[[^\]]*\]\(([^)\s]+)[^)]*\)")
# The same in HTML, as of small pictures side by side.
TAG = re.compile(r'<(?:a|img)\b[^>]*?\b(?:href|src)="([^"]+)"')
FENCE = re.compile(r"^(```|~~~).*?^\1", re.MULTILINE | re.DOTALL)


def heading_anchors(text):
    """Anchors that headings get on the pages of repositories and of mdBook."""
    headings = re.findall(r"^#+ (.*)$", text, re.MULTILINE)
    words = (re.sub(r"[^\w\- ]", "", heading.lower()) for heading in headings)
    return {heading.strip().replace(" ", "-") for heading in words}


def faults(path):
    text = FENCE.sub("", path.read_text(encoding="utf-8"))
    for target in LINK.findall(text) + TAG.findall(text):
        if re.match(r"[a-z]+:", target):
            continue
        name, _, anchor = target.partition("#")
        there = (path.parent / name) if name else path
        if not there.exists():
            yield f"{target}: no such file"
        elif anchor and there.suffix == ".md" and anchor not in heading_anchors(there.read_text(encoding="utf-8")):
            yield f"{target}: no such heading"


def main():
    listed = subprocess.run(["git", "ls-files", "*.md"], cwd=ROOT, check=True, capture_output=True, text=True)
    count = 0
    for name in listed.stdout.split():
        for fault in faults(ROOT / name):
            print(f"{name}: {fault}")
            count += 1
    book = ROOT / "docs/book/src"
    summary = (book / "SUMMARY.md").read_text(encoding="utf-8")
    for chapter in sorted(book.glob("*.md")):
        if chapter.name != "SUMMARY.md" and f"({chapter.name})" not in summary:
            print(f"docs/book/src/{chapter.name}: not in SUMMARY.md")
            count += 1
    return 1 if count else 0


if __name__ == "__main__":
    sys.exit(main())
