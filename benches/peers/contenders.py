"""Programs on a structure of `systems`: each is a function of the structure and its settings that returns a `Curve`."""

import json
import math
import os
import pathlib
import re
import resource
import shlex
import signal
import subprocess
import tempfile
import time
from dataclasses import dataclass, field

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
AUTO = pathlib.Path(os.environ.get("AUTO_DIR", "/usr/lib/auto-07p"))
# Seconds of the processor after which a curve is given up.
PATIENCE = 120
# One core, for all alike.
SINGLE = {name: "1" for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "RAYON_NUM_THREADS")}


@dataclass
class Curve:
    """What a program made of a structure."""

    # Seconds of the processor.
    seconds: float
    points: int
    # Kind and frequency of each event, in the order of the curve.
    events: list = field(default_factory=list)
    # The kinds that the program looks for.
    looked_for: tuple = ("fold",)
    # What is wrong with the curve.
    failure: str = ""
    # Seconds on the clock that the program itself states for its curve.
    stated: float = None
    # Orbits whose stability the program says.
    verdicts: int = 0


def turns(omega):
    """Where a list of frequencies turns: the vertex of a parabola through three points."""
    found = []
    for a, b, c in zip(omega, omega[1:], omega[2:]):
        if (b - a) * (c - b) < 0:
            found.append(b - (c - a) ** 2 / (8 * (a - 2 * b + c)))
    return found


def run(command, folder):
    """Runs a program on one core: its seconds of the processor, what it printed, and whether it came to an end."""
    limit = lambda: resource.setrlimit(resource.RLIMIT_CPU, (PATIENCE, PATIENCE + 5))
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(
        command, cwd=folder, preexec_fn=limit, env={**os.environ, **SINGLE}, text=True, stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
    )
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return seconds, done.stdout, done.returncode not in (-signal.SIGXCPU, -signal.SIGKILL)


AUTO_KINDS = {5: "fold", 6: "branch point", 7: "PD", 8: "NS"}


def auto_program(folder):
    """The structure's equations with AUTO, as its own makefile builds them."""
    objects = sorted(str(path) for path in (AUTO / "lib").glob("*.o"))
    command = ["gfortran", "-O3", "-march=native", "-fopenmp", "-std=legacy", str(HERE / "structure.f90"), *objects]
    subprocess.run([*command, "-o", str(folder / "structure")], check=True, cwd=folder)
    return folder / "structure"


def auto_inputs(structure, folder, settings):
    n = len(structure.mass)
    inverse = np.linalg.inv(structure.mass)
    start, end = structure.range
    q = structure.harmonic(start)
    numbers = [n, structure.stop + 1, structure.stop_stiffness, structure.gap, settings["width"]]
    arrays = [inverse @ structure.stiffness, inverse @ structure.damping, inverse[:, structure.stop]]
    arrays += [inverse[:, structure.driven] * structure.drive, q.real, q.imag]
    lines = [numbers, *(np.asarray(array).flatten(order="F") for array in arrays)]
    text = "\n".join(" ".join(repr(value.item() if hasattr(value, "item") else value) for value in line) for line in lines)
    (folder / "structure.dat").write_text(text + "\n")
    (folder / "start.dat").write_text(f"{start!r}\n")
    margin = 0.02 * (end - start)
    constants = {
        "NDIM": 2 * n + 2, "IPS": 2, "IRS": 0, "ILP": 1, "ICP": [1, 11], "NTST": settings["intervals"], "NCOL": 4, "IAD": 1,
        "ISP": 2, "ISW": 1, "MXBF": 0, "IID": 0, "ITMX": 8, "ITNW": 7, "NWTN": 3, "JAC": 1, "IADS": 1, "NPR": 0, "IPLT": 0,
        "EPSL": settings["tolerance"], "EPSU": settings["tolerance"], "EPSS": 100 * settings["tolerance"],
        "NMX": 20000, "DS": settings["steps"][0], "DSMIN": settings["steps"][0] * 1e-5, "DSMAX": settings["steps"][1],
        "RL0": start - margin, "RL1": end, "THL": "{11: 0.0}",
    }
    (folder / "fort.2").write_text("".join(f"{name} = {value}\n" for name, value in constants.items()))


def auto(structure, settings, program):
    """AUTO-07p, the stop smoothed over a width: collocation with multipliers."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        auto_inputs(structure, folder, settings)
        seconds, said, ended = run([str(program)], folder)
        rows = []
        if (folder / "fort.7").exists():
            for line in (folder / "fort.7").read_text().splitlines():
                parts = line.split()
                if len(parts) > 5 and parts[0] != "0" and re.fullmatch(r"-?\d+", parts[2]):
                    rows.append((int(parts[2]), float(re.sub(r"(\d)([-+]\d{3})$", r"\1E\2", parts[4]))))
    events = [(AUTO_KINDS[abs(kind) % 10], omega) for kind, omega in rows if abs(kind) % 10 in AUTO_KINDS]
    failure = "" if ended else f"given up after {PATIENCE} s"
    if ended and (not rows or rows[-1][1] < structure.range[1] - 1e-6):
        failure = f"ended at {rows[-1][1]:.6f}" if rows else "no point: " + " ".join(said.split())[-80:]
    return Curve(seconds, len(rows), events, ("fold", "PD", "NS"), failure)


def pyharm(structure, settings):
    """pyHarm: sampled harmonic balance, no stability."""
    from pyHarm.Maestro import Maestro

    low, high = structure.range
    start, most = settings["steps"]
    analysis = {
        "study": "frf", "puls_inf": low, "puls_sup": high, "ds0": start, "ds_max": most, "verbose": False,
        **settings.get("options", {}),
    }
    stop = {
        "type": "PenaltyUnilateralGap", "connect": {"body": [structure.stop]}, "dirs": [0], "g": structure.gap,
        "k": structure.stop_stiffness,
    }
    drive = {
        "type": "GOForcing", "connect": {"body": [structure.driven]}, "dirs": [0], "dto": 0, "ho": 1,
        "amp": structure.drive,
    }
    body = {"matrix": {"M": structure.mass, "C": structure.damping, "K": structure.stiffness}, "ndofs": 1}
    maestro = Maestro({
        "analysis": {"curve": analysis},
        "system": {"type": "Base", "nh": settings["harmonics"], "nti": settings["samples"]},
        "substructures": {"body": body},
        "connectors": {"stop": stop, "drive": drive},
    })

    def give_up(*_):
        raise TimeoutError

    signal.signal(signal.SIGPROF, give_up)
    failure = ""
    started = time.process_time()
    signal.setitimer(signal.ITIMER_PROF, PATIENCE)
    try:
        maestro.operate()
    except (TimeoutError, SystemError):  # numba turns the first into the second
        failure = f"given up after {PATIENCE} s"
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
    seconds = time.process_time() - started
    omega = [s.x[-1] for s in maestro.nls["curve"].SolList if s.flag_accepted and s.x is not None]
    if not failure and (not omega or omega[-1] < high):
        failure = f"ended at {omega[-1]:.6f}" if omega else "no point"
    events = [("fold", turn) for turn in turns(omega) if math.isfinite(turn)]
    return Curve(seconds, len(omega), events, ("fold",), failure)


HERTZIAN_KINDS = {"fold": "fold", "period-doubling": "PD", "neimark-sacker": "NS"}
DESCRIPTION = """name = "{name}"

[matrices]
mass = "mass.npy"
damping = "damping.npy"
stiffness = "stiffness.npy"

[parameters]
drive = {{ value = {drive!r} }}

[[load]]
direction = {{ coordinates = [{driven}] }}
amplitude = "drive"

[[contact]]
name = "stop"
law = "Stop(gap, k >= 0) {{ gap > 0 => k*gap, else => 0 }}"
arguments = {{ k = {stop_stiffness:.1f} }}
direction = {{ coordinates = [{stop}] }}
offset = {gap:.1f}

[[output]]
name = "at the stop"
direction = {{ coordinates = [{stop}] }}
"""


def hertzian_inputs(structure, folder):
    """The files of `--structure`: matrices and what acts on them."""
    for name in ("mass", "damping", "stiffness"):
        matrix = getattr(structure, name)
        np.save(folder / f"{name}.npy", (matrix + matrix.T) / 2)
    (folder / "structure.toml").write_text(DESCRIPTION.format(**vars(structure)))


def hertzian_program():
    """What comes before the arguments."""
    manifest = HERE.parents[1] / "Cargo.toml"
    cargo = f"cargo run --quiet --release --manifest-path {shlex.quote(str(manifest))} -p hertzian-cli --"
    return shlex.split(os.environ.get("HERTZIAN", cargo))


def hertzian(structure, settings):
    """hertzian: a curve with verdicts and events."""
    low, high = structure.range
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        hertzian_inputs(structure, folder)
        command = [*hertzian_program(), "response", "--structure", "structure.toml", "--from", str(low), "--to", str(high)]
        command += ["--one-branch", "--json", "curve.json", *shlex.split(settings["options"])]
        seconds, said, ended = run(command, folder)
        if not (folder / "curve.json").exists():
            failure = "no curve: " + " ".join(said.split())[-80:] if ended else f"given up after {PATIENCE} s"
            return Curve(seconds, 0, [], ("fold", "PD", "NS"), failure)
        branches = json.loads((folder / "curve.json").read_text())["branches"]
    events, points, stated, verdicts = [], 0, 0.0, 0
    for branch in branches:
        stated += branch["elapsed"]
        points += len(branch["points"])
        verdicts += sum(point["stability"]["verdict"] in ("stable", "unstable") for point in branch["points"])
        for event in branch["events"]:
            if isinstance(event["kind"], str):
                kind = HERTZIAN_KINDS.get(event["kind"], event["kind"])
                events.append((kind, event["point"]["value"]))
    failure = "" if branches[0]["stopped"] == "reached-end" else f"ended: {branches[0]['stopped']}"
    return Curve(seconds, points, events, ("fold", "PD", "NS"), failure, stated, verdicts)
