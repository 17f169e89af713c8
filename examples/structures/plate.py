#!/usr/bin/env python3
"""Writes a cantilever as a plane-stress solid: mass.mtx and stiffness.mtx, and the description plate.toml with a stop below its tip.

    python3 plate.py 40 8 /tmp/plate      # 40 by 8 elements: 720 coordinates
    python3 plate.py 400 125 /tmp/plate   # 100800 coordinates

Steel, 0.5 m long, 0.05 m high, 0.01 m thick; bilinear elements with four points of Gauss. Coordinate 2k is the displacement of node k along
the beam, 2k + 1 that across it.
"""
import math, os, sys

columns, rows, folder = int(sys.argv[1]), int(sys.argv[2]), sys.argv[3]
length, height, thick, young, poisson, density = 0.5, 0.05, 0.01, 210e9, 0.3, 7850.0
a, b = length / columns, height / rows
patch = 0.04  # length of the stop, in m: a point on a solid would give way more and more with finer elements

def element():
    """Stiffness and mass of one rectangle, whose nodes go round it from its lower left corner."""
    stiffness, mass = [[0.0] * 8 for _ in range(8)], [[0.0] * 8 for _ in range(8)]
    plane = young / (1 - poisson**2)
    law = [[plane, plane * poisson, 0], [plane * poisson, plane, 0], [0, 0, plane * (1 - poisson) / 2]]
    corners, point = [(-1, -1), (1, -1), (1, 1), (-1, 1)], 1 / math.sqrt(3)
    for x, y in [(s * point, t * point) for s in (-1, 1) for t in (-1, 1)]:
        weight = thick * a * b / 4
        shape = [(1 + s * x) * (1 + t * y) / 4 for s, t in corners]
        strain = [[0.0] * 8 for _ in range(3)]
        for k, (s, t) in enumerate(corners):
            along, across = s * (1 + t * y) / (2 * a), t * (1 + s * x) / (2 * b)
            strain[0][2 * k], strain[1][2 * k + 1] = along, across
            strain[2][2 * k], strain[2][2 * k + 1] = across, along
        for i in range(8):
            for j in range(8):
                stiffness[i][j] += weight * sum(strain[p][i] * law[p][q] * strain[q][j] for p in range(3) for q in range(3))
                if (i - j) % 2 == 0:
                    mass[i][j] += weight * density * shape[i // 2] * shape[j // 2]
    return stiffness, mass

def node(i, j):
    return (i - 1) * (rows + 1) + j  # the column i = 0 is clamped

def write(name, matrix, size):
    entries = {}
    for i in range(columns):
        for j in range(rows):
            corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
            places = [2 * node(*c) + d if c[0] > 0 else -1 for c in corners for d in range(2)]
            for p in range(8):
                for q in range(8):
                    if places[p] >= places[q] >= 0 and matrix[p][q] != 0.0:
                        key = places[p] * size + places[q]
                        entries[key] = entries.get(key, 0.0) + matrix[p][q]
    with open(os.path.join(folder, name), "w") as file:
        file.write(f"%%MatrixMarket matrix coordinate real symmetric\n{size} {size} {len(entries)}\n")
        file.writelines(f"{key // size + 1} {key % size + 1} {value!r}\n" for key, value in entries.items())

os.makedirs(folder, exist_ok=True)
stiffness, mass = element()
write("stiffness.mtx", stiffness, 2 * columns * (rows + 1))
write("mass.mtx", mass, 2 * columns * (rows + 1))
share = {}  # of the nodes below: the pressure, a cosine over the patch, times their hat functions
for s in range(400):
    across = (s + 0.5) / 400
    at = (length - patch + patch * across) / a
    left = min(int(at), columns - 1)
    for i, hat in ((left, left + 1 - at), (left + 1, at - left)):
        share[i] = share.get(i, 0.0) + hat * (1 - math.cos(2 * math.pi * across)) / 400
below = [i for i in sorted(share) if i > 0]
tip = [2 * node(columns, j) + 1 for j in range(rows + 1)]
text = open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "plate.toml.in")).read()
text = text.replace("@STOP@", str([2 * node(i, 0) + 1 for i in below])).replace("@TIP@", str(tip))
text = text.replace("@WEIGHTS@", str([-round(share[i], 12) for i in below]))
open(os.path.join(folder, "plate.toml"), "w").write(text)
