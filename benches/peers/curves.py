"""Times curves of other programs for harmonic balance, on the problems of `work_precision` that they can express.

    curves.py FILE [--repeats N]

`curves.sh` installs them and runs this. FILE is read and written: rows of the programs below are replaced, others stay.

- pyHarm: two masses with a stiff stop, its element PenaltyUnilateralGap; arc length. Its elements have no other power that is
  real for both signs, and no damping of one side.
- harmonicbalance: the continuous spring of exponent 3/2, given as a function; arc length.
- mousai: the same spring; frequency by frequency, each from the orbit before, since it has no arc length.

Each gets the steps and, where it asks for one, the first guess with which it came furthest of those that were tried.
"""

import argparse
import contextlib
import csv
import datetime
import importlib.metadata
import io
import logging
import os
import pathlib
import platform
import signal
import statistics
import tempfile
import time
import warnings

import numpy as np

FIELDS = ["problem", "program", "setting", "measured", "points", "seconds_median", "seconds_least", "seconds_most", "fold"]
FIELDS += ["peak_to_peak", "failure", "note"]
# The folds of the two problems, that of largest amplitude first, to the digits that it takes to tell them apart.
FOLDS = {"stiff-stop": (0.757, 0.656), "continuous-1.5": (1.3326960, 0.9095137)}
ZETA, DRIVE, AT = 0.01, 0.1, 1.2
POINTS = 125
# Seconds after which a curve is given up.
PATIENCE = 15


def turns(omega):
    """Where a list of frequencies turns: the vertex of a parabola through three points."""
    found = []
    for a, b, c in zip(omega, omega[1:], omega[2:]):
        if (b - a) * (c - b) < 0:
            found.append(b - (c - a) ** 2 / (8 * (a - 2 * b + c)))
    return found


def spring(x):
    return np.sign(x) * np.abs(x) ** 1.5


def judged(problem, omega, upper):
    """The turn nearest to the fold, and what is wrong with the curve."""
    found, there = turns(omega), FOLDS[problem]
    fold = min(found, key=lambda turn: abs(turn - there[0]), default=None)
    if max(omega) < upper and omega[-1] < upper:
        return fold, f"ended at {omega[-1]:.4f}"
    if len(found) != len(there):
        return fold, f"{len(found)} folds, where there are {len(there)}"
    return fold, ""


def pyharm(harmonics):
    """One curve of the two masses: seconds, points, fold, peak-to-peak, failure."""
    from pyHarm.Maestro import Maestro

    mass, stiffness = np.eye(2), np.array([[1.0, -1.0], [-1.0, 2.0]])
    analysis = {"study": "frf", "puls_inf": 0.5, "puls_sup": 1.0, "ds0": 0.05, "ds_max": 0.1, "verbose": False}
    stop = {"type": "PenaltyUnilateralGap", "connect": {"body": [0]}, "dirs": [0], "g": 1.0, "k": 100.0}
    drive = {"type": "GOForcing", "connect": {"body": [1]}, "dirs": [0], "dto": 0, "ho": 1, "amp": DRIVE}
    body = {"matrix": {"M": mass, "C": 0.03 * stiffness, "K": stiffness}, "ndofs": 1}
    whole = {
        "analysis": {"curve": analysis},
        "system": {"type": "Base", "nh": harmonics, "nti": 1024},
        "substructures": {"body": body},
        "connectors": {"stop": stop, "drive": drive},
    }
    maestro = Maestro(whole)
    started = time.perf_counter()
    maestro.operate()
    seconds = time.perf_counter() - started
    omega = [s.x[-1] for s in maestro.nls["curve"].SolList if s.flag_accepted]
    fold, failure = judged("stiff-stop", omega, 1.0)
    return seconds, len(omega), fold, None, failure


def harmonicbalance(harmonics):
    """One curve of the spring."""
    from harmonicbalance.fourier import Fourier
    from harmonicbalance.predictorcorrector import PredictorCorrectorSolver

    def drive(omega):
        wave = Fourier(omega=omega, n=harmonics)
        wave[1] = DRIVE
        return wave

    def residual(x):
        return x.dt().dt() + 2 * ZETA * x.dt() + x.nonlinearity(spring) - drive(x.omega)

    solver = PredictorCorrectorSolver(
        residual, 2 * drive(0.5), alpha_start=0.5, alpha_end=1.7, alpha_step=0.05, method="hybr"
    )
    started = time.perf_counter()
    solver.solve()
    seconds = time.perf_counter() - started
    omega = [x.omega for x in solver.solutions]
    fold, failure = judged("continuous-1.5", omega, 1.7)
    phase = np.linspace(0, 2 * np.pi, 2001)
    sizes = [np.ptp(x(phase / x.omega)) for x in solver.solve_specific(AT)]
    return seconds, len(omega), fold, max(sizes, default=None), failure


def mousai(harmonics):
    """Frequencies up to the one of comparison, each from the orbit before."""
    import mousai as program

    def acceleration(x, v, parameters):
        phase = parameters["omega"] * parameters["cur_time"]
        return np.array([[DRIVE * np.cos(phase) - 2 * ZETA * v[0] - spring(x[0])]])

    tau = 2 * np.pi * np.arange(2 * harmonics + 1) / (2 * harmonics + 1)
    x, passed, failure = 0.2 * np.cos(tau)[None, :], 0, "cannot pass a fold"
    started = time.perf_counter()
    for omega in np.linspace(0.5, AT, POINTS):
        try:
            _, x, *_ = program.hb_time(acceleration, x, omega=omega, num_harmonics=harmonics)
        except Exception as error:
            failure = f"{type(error).__name__} at {omega:.4f}"
            break
        passed += 1
    seconds = time.perf_counter() - started
    if passed < POINTS:
        return seconds, passed, None, None, failure
    # The orbit between its samples.
    fine = np.fft.irfft(np.fft.rfft(x[0]), 2001) * 2001 / len(tau)
    return seconds, passed, None, np.ptp(fine), failure


RACE = [
    ("pyHarm", "pyHarm-os", "stiff-stop", pyharm, "arc length, 1024 samples"),
    ("harmonicbalance", "harmonicbalance", "continuous-1.5", harmonicbalance, "arc length, 4 samples a harmonic and one more"),
    ("mousai", "mousai", "continuous-1.5", mousai, f"frequency by frequency to {AT}, for {POINTS} points"),
]


def limited(curve, harmonics):
    """A curve, or that it took too long."""

    def give_up(*_):
        raise TimeoutError

    signal.signal(signal.SIGALRM, give_up)
    signal.alarm(PATIENCE)
    try:
        return curve(harmonics)
    except (TimeoutError, SystemError):  # numba turns the first into the second
        return PATIENCE, 0, None, None, f"no end within {PATIENCE} s"
    finally:
        signal.alarm(0)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("file", type=pathlib.Path)
    parser.add_argument("--repeats", type=int, default=3)
    options = parser.parse_args()
    options.file = options.file.resolve()
    # pyHarm writes into the folder that it is started in.
    os.chdir(tempfile.mkdtemp())
    logging.disable(logging.CRITICAL)
    warnings.simplefilter("ignore")
    names = {name for name, *_ in RACE}
    kept = []
    if options.file.exists():
        with open(options.file, newline="") as file:
            kept = [row for row in csv.DictReader(file) if row["program"].split(" ")[0] not in names]
    rows = []
    for name, package, problem, curve, note in RACE:
        for harmonics in (5, 10, 20):
            with contextlib.redirect_stdout(io.StringIO()), open(os.devnull, "w") as null, contextlib.redirect_stderr(null):
                # What is compiled on its first use is not timed.
                first = limited(curve, harmonics)
                ended = first[1] == 0
                runs = [first] if ended else [limited(curve, harmonics) for _ in range(options.repeats)]
            seconds = [run[0] * (POINTS / run[1] if curve is mousai and run[1] else 1) for run in runs]
            _, points, fold, size, failure = runs[-1]
            rows.append({
                "problem": problem,
                "program": f"{name} {importlib.metadata.version(package)}",
                "setting": f"K = {harmonics}",
                "measured": datetime.date.today().isoformat(),
                "points": points,
                "seconds_median": f"{statistics.median(seconds):.4g}",
                "seconds_least": f"{min(seconds):.4g}",
                "seconds_most": f"{max(seconds):.4g}",
                "fold": "" if fold is None else f"{fold:.10g}",
                "peak_to_peak": "" if size is None else f"{size:.10g}",
                "failure": failure,
                "note": f"{note}; Python {platform.python_version()}",
            })
            print(" | ".join(str(value) for value in rows[-1].values()), flush=True)
    with open(options.file, "w", newline="") as file:
        writer = csv.DictWriter(file, FIELDS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(kept + rows)


if __name__ == "__main__":
    main()
