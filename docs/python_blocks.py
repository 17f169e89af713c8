#!/usr/bin/env python3
"""Runs the Python blocks of the book, those of a chapter one after the other, in a folder with the files that they read.

    docs/python_blocks.py FOLDER [CHAPTER..]

FOLDER holds, for files.md, branch.csv and branch.json, as `hertzian response` writes them, and attractors.npy, as `hertzian attractors` does. Needs numpy,
and for python.md the package of python/.
"""

import os
import pathlib
import re
import sys

BOOK = pathlib.Path(__file__).resolve().parent / "book/src"


def main():
    os.chdir(sys.argv[1])
    count = 0
    chapters = [BOOK / name for name in sys.argv[2:]] or sorted(BOOK.glob("*.md"))
    for chapter in chapters:
        names = {}
        for block in re.findall(r"^```python\n(.*?)^```", chapter.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL):
            print(f"{chapter.name}:")
            exec(compile(block, chapter.name, "exec"), names)
            count += 1
    print(f"{count} blocks")
    return 0 if count else 1


if __name__ == "__main__":
    sys.exit(main())
