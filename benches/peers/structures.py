"""Times curves of structures with a stop by hertzian, AUTO-07p and pyHarm, and says how far each of their events is off.

    structures.py [--repeats N] [--patience SECONDS] [--only PROGRAM] [--out FOLDER]

`structures.sh` installs what is needed and runs this. HERTZIAN is the program, by default `cargo run --release`. Prints tables in
Markdown, and writes structures.csv and structures.json.
"""

import argparse
import contextlib
import csv
import functools
import importlib.metadata
import io
import json
import logging
import os
import pathlib
import platform
import statistics
import subprocess
import tempfile
import time
import warnings

import contenders

# Before numpy is loaded: one core for all.
os.environ.update(contenders.SINGLE)

import systems

# A curve that takes longer is run once.
LONG = 5
# An event of a program is that of the reference if it is nearer than this part of the range.
NEAR = 0.05

ALL = "all modes, the contact equation"
SETTINGS = {
    "hertzian": {
        "A": [(ALL, {"options": "--by contact-equation --modes 2 --steps 0"})],
        "B1": [
            ("reduced as it is by itself", {"options": ""}),
            ("all modes, shooting", {"options": "--by shooting --modes 20 --steps 0"}),
        ],
        "C": [(ALL, {"options": "--by contact-equation --modes 16 --steps 0"})],
    },
    "AUTO-07p": {
        "A": [
            ("200 intervals, width 0.001", {"width": 1e-3, "intervals": 200, "steps": (0.002, 0.01), "tolerance": 1e-9}),
            ("100 intervals, width 0.003", {"width": 3e-3, "intervals": 100, "steps": (0.002, 0.01), "tolerance": 1e-8}),
        ],
        "B1": [("100 intervals, width 0.001", {"width": 1e-3, "intervals": 100, "steps": (0.005, 0.05), "tolerance": 1e-8})],
        "C": [("100 intervals, width 0.001", {"width": 1e-3, "intervals": 100, "steps": (0.001, 0.02), "tolerance": 1e-8})],
    },
    "pyHarm": {
        "A": [
            ("10 harmonics, 1024 samples", {"harmonics": 10, "samples": 1024, "steps": (0.05, 0.1)}),
            ("20 harmonics, 512 samples", {"harmonics": 20, "samples": 512, "steps": (0.02, 0.05)}),
        ],
        "B1": [("20 harmonics, 512 samples", {"harmonics": 20, "samples": 512, "steps": (0.01, 0.05)})],
        "C": [("10 harmonics, 512 samples", {"harmonics": 10, "samples": 512, "steps": (0.01, 0.05)})],
    },
}


def matched(exact, curve, width):
    """Error of each exact event, None where it is missing, and the events that are none; the nearest pairs of a kind first."""
    pairs = [
        (abs(here - there), i, j)
        for i, (kind, there) in enumerate(exact)
        for j, (found, here) in enumerate(curve.events)
        if kind == found and abs(here - there) < width
    ]
    errors, taken = [None] * len(exact), set()
    for _, i, j in sorted(pairs):
        if errors[i] is None and j not in taken:
            errors[i] = float(curve.events[j][1] - exact[i][1])
            taken.add(j)
    return errors, [event for j, event in enumerate(curve.events) if j not in taken]


def race(program, structure, settings, repeats):
    """The curve after one that is not timed, and the seconds of all."""
    with contextlib.redirect_stdout(io.StringIO()), open(os.devnull, "w") as null, contextlib.redirect_stderr(null):
        started = time.perf_counter()
        curve = program(structure, settings)
        clock = [time.perf_counter() - started]
        runs = [curve]
        if curve.seconds <= LONG or (not curve.failure and program is contenders.pyharm):
            runs, clock = [], []
            for _ in range(repeats if curve.seconds <= LONG else 1):
                started = time.perf_counter()
                runs.append(program(structure, settings))
                clock.append(time.perf_counter() - started)
    return runs, clock


def row(name, setting, structure, runs, clock):
    curve = runs[-1]
    errors, false = matched(structure.events, curve, NEAR * (structure.range[1] - structure.range[0]))
    looked = [i for i, (kind, _) in enumerate(structure.events) if kind in curve.looked_for]
    known = [abs(errors[i]) for i in looked if errors[i] is not None]
    stated = [run.stated for run in runs if run.stated is not None]
    return {
        "structure": structure.name,
        "program": name,
        "setting": setting,
        "runs": len(runs),
        "seconds of the processor": statistics.median(run.seconds for run in runs),
        "seconds on the clock": statistics.median(clock),
        "seconds as stated": statistics.median(stated) if stated else None,
        "points": curve.points,
        "verdicts": curve.verdicts,
        "events": len(structure.events),
        "looked for": len(looked),
        "found": len(known),
        "false": len(false),
        "largest error": max(known, default=None),
        "failure": curve.failure,
        "errors": [
            {"kind": kind, "omega": omega, "error": errors[i] if i in looked else "not looked for"}
            for i, (kind, omega) in enumerate(structure.events)
        ],
        "false events": [{"kind": kind, "omega": float(omega)} for kind, omega in false],
    }


def number(value, digits):
    return "" if value is None else f"{value:.{digits}g}"


def summary(rows):
    print("\n| structure | program | setting | s, processor | s, stated | points | events found | false | largest error | |")
    print("|---|---|---|---|---|---|---|---|---|---|")
    for r in rows:
        found = f"{r['found']} of {r['events']}"
        if r["looked for"] < r["events"]:
            found = f"{r['found']} of {r['looked for']} folds"
        cells = [r["structure"], r["program"], r["setting"], number(r["seconds of the processor"], 3)]
        cells += [number(r["seconds as stated"], 3), r["points"], found, r["false"], number(r["largest error"], 2), r["failure"]]
        print("| " + " | ".join(str(cell) for cell in cells) + " |")


def events(structure, rows):
    """Errors of each event, a column for each program."""
    rows = [r for r in rows if r["structure"] == structure.name]
    print(f"\n{structure.name}, {structure.about}: error of each event\n")
    print("| event | exact | " + " | ".join(f"{r['program']}, {r['setting']}" for r in rows) + " |")
    print("|---" * (2 + len(rows)) + "|")
    for i, (kind, omega) in enumerate(structure.events):
        cells = [r["errors"][i]["error"] for r in rows]
        cells = [{None: "missing", "not looked for": "-"}[c] if c is None or isinstance(c, str) else f"{c:.1e}" for c in cells]
        print(f"| {kind} | {omega:.12f} | " + " | ".join(cells) + " |")


def machine():
    """Versions and hardware."""
    info = pathlib.Path("/proc/cpuinfo").read_text()
    fields = dict(line.split(":", 1) for line in info.split("\n\n")[0].splitlines() if ":" in line)
    fields = {name.strip(): value.strip() for name, value in fields.items()}

    def said(command):
        done = subprocess.run(command, capture_output=True, text=True)
        return done.stdout.splitlines()[0] if done.returncode == 0 and done.stdout else "unknown"

    return {
        "processor": " ".join(fields.get(name, "") for name in ["model name", "cpu family", "model"]),
        "cores": os.cpu_count(),
        "load": os.getloadavg()[0],
        "kernel": platform.release(),
        "python": platform.python_version(),
        "gfortran": said(["gfortran", "--version"]),
        "auto-07p": said(["dpkg-query", "--showformat=${Version}", "--show", "auto-07p"]),
        "hertzian": said([*contenders.hertzian_program(), "--version"]),
        "program of hertzian": "HERTZIAN" if "HERTZIAN" in os.environ else "cargo run --release",
        **{name: importlib.metadata.version(name) for name in ["pyHarm-os", "numpy", "scipy"]},
    }


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--patience", type=int, default=contenders.PATIENCE, help="seconds after which a curve is given up")
    parser.add_argument("--only", choices=list(SETTINGS), help="one program alone")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path(__file__).parent / "out")
    options = parser.parse_args()
    options.out = options.out.resolve()
    options.out.mkdir(parents=True, exist_ok=True)
    contenders.PATIENCE = options.patience
    # pyHarm writes into the folder that it is started in.
    folder = pathlib.Path(tempfile.mkdtemp())
    os.chdir(folder)
    logging.disable(logging.CRITICAL)
    warnings.simplefilter("ignore")
    programs = {"hertzian": contenders.hertzian, "pyHarm": contenders.pyharm}
    if (contenders.AUTO / "lib").is_dir() and options.only in (None, "AUTO-07p"):
        programs["AUTO-07p"] = functools.partial(contenders.auto, program=contenders.auto_program(folder))
    rows, everything = [], systems.structures()
    for structure in everything:
        for name, settings in SETTINGS.items():
            if name not in programs or options.only not in (None, name):
                continue
            for setting, values in settings[structure.name]:
                runs, clock = race(programs[name], structure, values, options.repeats)
                rows.append(row(name, setting, structure, runs, clock))
                kept = [str(rows[-1][key]) for key in ("structure", "program", "setting", "seconds of the processor", "failure")]
                print(" | ".join(kept), flush=True)
    summary(rows)
    for structure in everything:
        events(structure, rows)
    flat = [{key: value for key, value in r.items() if not isinstance(value, list)} for r in rows]
    with open(options.out / "structures.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, flat[0], lineterminator="\n")
        writer.writeheader()
        writer.writerows(flat)
    asked = {key: str(value) for key, value in vars(options).items() if key != "out"}
    record = {"machine": machine(), "options": asked, "settings": SETTINGS, "rows": rows}
    record["exact"] = {s.name: s.events for s in everything}
    (options.out / "structures.json").write_text(json.dumps(record, indent=1) + "\n")


if __name__ == "__main__":
    main()
