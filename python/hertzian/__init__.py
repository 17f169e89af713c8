"""Vibration of oscillators with piecewise power-law forces: contacts that open, springs of any exponent, play, stops.

>>> import hertzian
>>> model = hertzian.Model('''
...     OneSided(x) {
...         param zeta in 0.0..;
...         param load;
...         param drive;
...         law contact(gap) { gap > 0 => 2*zeta*dot(gap) + gap^1.5, else => 0 }
...         ddot(x) + contact(x) = drive*cos(omega*t) + load;
...     }
... ''', zeta=0.032, load=1.0, drive=0.1)
>>> branch = model.response(0.6, 1.6)
>>> for fold in branch.folds:
...     print(fold)
fold at 1.14451691378816 (error 1e-14), peak-to-peak 1.4284046659
fold at 0.685842253572 (error 1e-12), peak-to-peak 8.4992561

Names are those of the Rust library. What takes no argument and costs nothing is an attribute. Times have the unit that the equation has
them in, frequencies are angles per time, and a state is all positions, then all velocities.
"""

from __future__ import annotations

from enum import IntEnum

from ._hertzian import (
    Attractor,
    Axis,
    Basins,
    BifurcationCurve,
    Branch,
    ContactEquation,
    ContactMotion,
    Diagram,
    DiagramBranch,
    Event,
    HarmonicBalance,
    Leap,
    Map,
    Model,
    ModelFacts,
    Motion,
    Named,
    Observed,
    Omitted,
    Orbit,
    Origin,
    Point,
    Progress,
    Reading,
    Row,
    Run,
    Searched,
    SettledTo,
    Settling,
    Shooting,
    Solution,
    Solutions,
    SolutionsAt,
    Special,
    Spectrum,
    Stability,
    Stop,
    Swept,
    Turn,
    Winding,
    __version__,
)
from .errors import (
    CancelledError,
    DeclarationError,
    FileError,
    HertzianError,
    LimitError,
    ModelError,
    MotionError,
    NoOrbitError,
    RequestError,
    ResourceError,
)


class Fate(IntEnum):
    """What becomes of a motion that settles to no periodic orbit; other fates are numbers of attractors."""

    #: No period was found, and neighbouring motions part.
    CHAOTIC = -1
    #: No period was found, and it is not chaotic: a longer period, several frequencies, or a transient longer than the patience.
    LONG = -2
    #: It grew beyond the bound.
    ESCAPED = -3
    #: It could not be computed.
    FAILED = -4
    #: Not looked at.
    UNKNOWN = -5


__all__ = [
    "Attractor",
    "Axis",
    "Basins",
    "BifurcationCurve",
    "Branch",
    "CancelledError",
    "ContactEquation",
    "ContactMotion",
    "DeclarationError",
    "Diagram",
    "DiagramBranch",
    "Event",
    "Fate",
    "FileError",
    "HarmonicBalance",
    "HertzianError",
    "Leap",
    "LimitError",
    "Map",
    "Model",
    "ModelError",
    "ModelFacts",
    "Motion",
    "MotionError",
    "Named",
    "NoOrbitError",
    "Observed",
    "Omitted",
    "Orbit",
    "Origin",
    "Point",
    "Progress",
    "Reading",
    "RequestError",
    "ResourceError",
    "Row",
    "Run",
    "Searched",
    "SettledTo",
    "Settling",
    "Shooting",
    "Solution",
    "Solutions",
    "SolutionsAt",
    "Special",
    "Spectrum",
    "Stability",
    "Stop",
    "Swept",
    "Turn",
    "Winding",
    "__version__",
]
