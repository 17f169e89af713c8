#!/usr/bin/env python3
"""Runs the Python blocks of the book, each in a folder with the files that it reads.

    docs/python_blocks.py FOLDER

FOLDER holds branch.csv and branch.json, as `hertzian response` writes them, and attractors.npy, as `hertzian attractors` does. Needs numpy.
"""

import os
import pathlib
import re
import sys

BOOK = pathlib.Path(__file__).resolve().parent / "book/src"


def main():
    os.chdir(sys.argv[1])
    count = 0
    for chapter in sorted(BOOK.glob("*.md")):
        for block in re.findall(r"^```python\n(.*?)^```", chapter.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL):
            print(f"{chapter.name}:")
            exec(compile(block, chapter.name, "exec"), {})
            count += 1
    print(f"{count} blocks")
    return 0 if count else 1


if __name__ == "__main__":
    sys.exit(main())
