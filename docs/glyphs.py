#!/usr/bin/env python3
"""Writes core/chart/src/glyphs.txt: outlines of the letters in charts, from DejaVu Sans. Needs fonttools.

    docs/glyphs.py DejaVuSans.ttf

A line is a character's code, its advance, and its outline as commands of an SVG path (y upwards, 1024 units to the em), all of them
relative, so that a glyph is drawn wherever the pen stands.
"""

import sys
from pathlib import Path

from fontTools.pens.recordingPen import DecomposingRecordingPen
from fontTools.ttLib import TTFont

EM = 1024
CHARACTERS = (
    [chr(c) for c in range(0x20, 0x7F)]
    + [chr(c) for c in range(0xA1, 0x100) if c != 0xAD]
    + [chr(c) for c in range(0x391, 0x3CA) if c != 0x3A2]
    + list("⁰⁴⁵⁶⁷⁸⁹⁺⁻₀₁₂₃₄₅₆₇₈₉–—‘’“”…′″−√∞∂∫≈≠≤≥→")
)


def outline(glyphs, name, scale):
    """The glyph as relative commands."""
    pen = DecomposingRecordingPen(glyphs)
    glyphs[name].draw(pen)
    text, here, start = "", (0, 0), (0, 0)

    def step(command, points):
        nonlocal text, here
        points = [(round(x * scale), round(y * scale)) for x, y in points]
        numbers = [value - origin for point in points for value, origin in zip(point, here)]
        text += command + " ".join(map(str, numbers)).replace(" -", "-")
        here = points[-1]

    for kind, points in pen.value:
        if kind == "moveTo":
            step("m", points)
            start = here
        elif kind == "lineTo":
            step("l", points)
        elif kind == "qCurveTo":
            # Between two control points lies a point of the curve.
            for control, after in zip(points[:-2], points[1:-1]):
                middle = tuple((a + b) / 2 for a, b in zip(control, after))
                step("q", [control, middle])
            step("q", points[-2:])
        elif kind == "closePath":
            text, here = text + "z", start
    return text


def main():
    font = TTFont(sys.argv[1])
    names, glyphs = font.getBestCmap(), font.getGlyphSet()
    scale = EM / font["head"].unitsPerEm
    lines = []
    for character in sorted(CHARACTERS):
        name = names[ord(character)]
        advance = round(glyphs[name].width * scale)
        lines.append(f"{ord(character):x} {advance} {outline(glyphs, name, scale)}".rstrip())
    target = Path(__file__).parent.parent / "core/chart/src/glyphs.txt"
    target.write_text("\n".join(lines) + "\n")


main()
