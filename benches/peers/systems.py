"""The three structures of `structures.py`, with the exact values of their events.

A is two masses, B1 a beam of ten elements, C a chain of sixteen masses; each has an elastic stop. Events are those of
`tests/src/reference.json`, computed by event-driven shooting and confirmed by a second method.
"""

import json
import pathlib
from dataclasses import dataclass

import numpy as np
import scipy.linalg

REFERENCE = pathlib.Path(__file__).resolve().parents[2] / "tests" / "src" / "reference.json"


@dataclass
class Structure:
    """M x'' + C x' + K x + e_s stiffness max(x_s - gap, 0) = e_d drive cos(w t)."""

    name: str
    about: str
    mass: np.ndarray
    damping: np.ndarray
    stiffness: np.ndarray
    stop: int
    stop_stiffness: float
    gap: float
    driven: int
    drive: float
    # Frequencies that are followed. No contact at either end.
    range: tuple
    # Kind and frequency of each event, as the reference has them.
    events: list

    def harmonic(self, omega):
        """Amplitude of the motion without contact: x = Re(q exp(i w t))."""
        dynamic = self.stiffness - omega**2 * self.mass + 1j * omega * self.damping
        load = np.zeros(len(self.mass))
        load[self.driven] = self.drive
        return np.linalg.solve(dynamic, load)


def reference(name):
    cases = json.loads(REFERENCE.read_text())["cases"]
    events = next(case["events"] for case in cases if case["name"] == name)
    return [(event["kind"], float(event["omega"])) for event in events]


def chain(count):
    """Stiffness of masses in a row, the last one held by a spring."""
    stiffness = 2 * np.eye(count) - np.eye(count, k=1) - np.eye(count, k=-1)
    stiffness[0, 0] = 1
    return stiffness


def beam(elements):
    """Mass and stiffness of a cantilever of length, mass per length and bending stiffness one, by Hermite elements."""
    h = 1 / elements
    mass = h / 420 * np.array([
        [156, 22 * h, 54, -13 * h],
        [22 * h, 4 * h**2, 13 * h, -3 * h**2],
        [54, 13 * h, 156, -22 * h],
        [-13 * h, -3 * h**2, -22 * h, 4 * h**2],
    ])
    stiffness = 1 / h**3 * np.array([
        [12, 6 * h, -12, 6 * h],
        [6 * h, 4 * h**2, -6 * h, 2 * h**2],
        [-12, -6 * h, 12, -6 * h],
        [6 * h, 2 * h**2, -6 * h, 4 * h**2],
    ])
    size = 2 * (elements + 1)
    whole = [np.zeros((size, size)), np.zeros((size, size))]
    for element in range(elements):
        at = slice(2 * element, 2 * element + 4)
        whole[0][at, at] += mass
        whole[1][at, at] += stiffness
    return [matrix[2:, 2:] for matrix in whole]


def modal_damping(mass, stiffness, ratio):
    squares, modes = scipy.linalg.eigh(stiffness, mass)
    return mass @ modes @ np.diag(2 * ratio * np.sqrt(squares)) @ modes.T @ mass


def structures():
    two, sixteen = chain(2), chain(16)
    mass, stiffness = beam(10)
    return [
        Structure("A", "two masses", np.eye(2), 0.03 * two, two, 0, 100, 1, 1, 0.1, (0.5, 1.0), reference("A")),
        Structure(
            "B1", "beam, 20 coordinates", mass, modal_damping(mass, stiffness, 0.01), stiffness, 18, 50, 0.1, 18, 0.03,
            (3.3, 4.5), reference("B1"),
        ),
        Structure(
            "C", "chain of 16 masses", np.eye(16), 0.03 * sixteen, sixteen, 0, 100, 1, 15, 0.1, (0.275, 0.298),
            reference("C"),
        ),
    ]
