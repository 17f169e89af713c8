"""Times the power law of hertzian beside those of other generators and of a person, in turns, in one process.

    peers.py LIBRARY [--turns N] [--out FOLDER]

LIBRARY is what `ours` builds; `run.sh` does everything. Prints tables in Markdown, and writes peers.csv and peers.json.
"""

import argparse
import csv
import ctypes
import importlib.metadata
import json
import pathlib
import platform
import statistics
import subprocess
import time

import numpy as np

import generators

COUNT = 1024
CALLS = 16
ZETA, ALPHA = 0.032, 1.7
OWN = "CasADi, its own evaluation"
STRICT = ["-O3", "-march=native"]
FAST = [*STRICT, "-ffast-math"]
HERE = pathlib.Path(__file__).parent
TITLES = {"power": "the exponent an argument", "three_halves": "exponent 3/2"}


class Samples:
    """One period of an orbit and room for results: on lines of the cache, and not a power of two apart."""

    def __init__(self):
        stride = COUNT + 40
        self.memory = np.zeros(6 * stride + 8)
        start = (-self.memory.ctypes.data // 8) % 8
        rooms = [self.memory[start + k * stride :][:COUNT] for k in range(6)]
        self.gap, self.rate, *self.out = rooms
        tau = 2 * np.pi * np.arange(COUNT) / COUNT
        self.gap[:] = 0.3 + 1.1 * np.cos(tau) + 0.2 * np.sin(2 * tau)
        self.rate[:] = -1.1 * np.sin(tau) + 0.4 * np.cos(2 * tau)

    def expected(self, exponent):
        """The values by numpy."""
        alpha = ALPHA if exponent == "power" else 1.5
        size, sign = np.abs(self.gap), np.sign(self.gap)
        power = sign * size**alpha
        values = [2 * ZETA * self.rate + power, alpha * power / self.gap, np.full(COUNT, 2 * ZETA)]
        return values + [power * np.log(size)] if exponent == "power" else values


class Compiled:
    """A kernel in a shared library."""

    def __init__(self, library, symbol, timer, samples):
        self.library = ctypes.CDLL(str(library))
        address = ctypes.cast(getattr(self.library, symbol), ctypes.c_void_p)
        pointers = [ctypes.c_void_p(x.ctypes.data) for x in [samples.gap, samples.rate, *samples.out]]
        scalars = [ctypes.c_double(ZETA), ctypes.c_double(ALPHA)]
        self.timer = timer
        self.arguments = [address, *pointers[:2], *scalars, *pointers[2:], ctypes.c_long(COUNT), ctypes.c_int(CALLS)]

    def seconds(self):
        return self.timer(*self.arguments)


class Interpreted:
    """CasADi's own evaluation on buffers, which is its cheapest way of being called."""

    def __init__(self, function, samples):
        self.buffer, self.trigger = function.buffer()
        self.kept = [samples.gap, samples.rate, np.array([ZETA]), np.array([ALPHA])]
        for index, array in enumerate(self.kept):
            self.buffer.set_arg(index, memoryview(array))
        for index in range(function.n_out()):
            self.buffer.set_res(index, memoryview(samples.out[index]))

    def seconds(self):
        self.trigger()
        start = time.perf_counter()
        for _ in range(CALLS):
            self.trigger()
        return time.perf_counter() - start


def compile_source(folder, name, kind, source, options):
    """A shared library of a source; math functions come from the vector library where the options allow it."""
    path = folder / f"{name}.{kind}"
    path.write_text(source)
    library = folder / f"{name}.so"
    compiler = "g++" if kind == "cpp" else "gcc"
    subprocess.run([compiler, *options, "-shared", "-fPIC", "-w", "-o", library, path, "-lm"], check=True)
    return library


def contenders(exponent, ours, folder, samples):
    """Name and kernel of everyone."""
    timer_library = ctypes.CDLL(str(compile_source(folder, "timer", "c", (HERE / "timer.c").read_text(), ["-O2"])))
    timer = timer_library.timed
    timer.restype = ctypes.c_double
    found = {"hertzian": Compiled(ours, exponent, timer, samples)}
    by_hand = (HERE / "by_hand.c").read_text()
    sources = {"C by hand": ("c", by_hand.replace(f"void {exponent}(", "void kernel("))}
    if exponent == "power":
        sources["C by hand, in blocks"] = ("c", by_hand.replace("void power_in_blocks(", "void kernel("))
    for name, generate in [
        ("CasADi C", generators.casadi),
        ("CasADi C of arrays", lambda *law: generators.casadi_arrays(*law, COUNT)),
        ("SymPy C", generators.sympy),
        ("SymForce C++", generators.symforce),
    ]:
        sources[name] = generate(exponent, False)
        if exponent == "power":
            sources[f"{name}, told exp(alpha ln)"] = generate(exponent, True)
    for name, (kind, source) in sources.items():
        for how, options in [("strict", STRICT), ("fast-math", FAST)]:
            file = "".join(c if c.isalnum() else "_" for c in f"{exponent} {name} {how}")
            library = compile_source(folder, file, kind, source, options)
            found[f"{name}, {how}"] = Compiled(library, "kernel", timer, samples)
    one = generators.casadi_function(exponent)
    found[OWN] = Interpreted(generators.casadi_function(exponent, count=COUNT), samples)
    found[f"{OWN}, sample by sample"] = Interpreted(one.map("mapped", "serial", COUNT, [2, 3], []), samples)
    return found


def check(kernels, exponent, samples):
    """Largest error of each, relative to the largest value of its output."""
    expected = samples.expected(exponent)
    errors = {}
    for name, kernel in kernels.items():
        for out in samples.out:
            out[:] = np.nan
        kernel.seconds()
        # What was not written is not a number, and the maximum of numpy keeps it.
        error = np.max([np.max(np.abs(out - e)) / np.max(np.abs(e)) for out, e in zip(samples.out, expected)])
        assert error < 1e-12, f"{name} is wrong by {error}"
        errors[name] = error
    return errors


def race(kernels, turns):
    """Median nanoseconds per sample."""
    times = {name: [] for name in kernels}
    for _ in range(turns):
        for name, kernel in kernels.items():
            times[name].append(kernel.seconds())
    return {name: 1e9 * statistics.median(t) / (CALLS * COUNT) for name, t in times.items()}


def ratios(exponent, times):
    """What is compared with what, and the ratio of their times."""
    ours = times["hertzian"]
    generated = {n: t for n, t in times.items() if n.startswith(("CasADi C", "SymPy", "SymForce"))}
    natural = {n: t for n, t in generated.items() if "told" not in n}
    own = times[OWN]

    def least(of):
        name = min(of, key=of.get)
        return name, of[name]

    found = []
    if exponent == "power":
        for how, those in [("best generator", natural), ("best if told how", generated)]:
            name, best = least(those)
            found.append((f"{how} ({name}) / hertzian", best / ours))
        ratio = ours / times["C by hand, fast-math"]
        found.append(("hertzian / C by hand with fast-math", ratio))
        ratio = ours / times["C by hand, in blocks, fast-math"]
        found.append(("hertzian / C by hand in blocks with fast-math", ratio))
    else:
        name, best = least({n: t for n, t in times.items() if not n.startswith("hertzian")})
        found.append((f"hertzian / best of all ({name})", ours / best))
    found.append(("CasADi's own evaluation / hertzian", own / ours))
    code = times["CasADi C, strict"]
    found.append(("CasADi C, strict / hertzian", code / ours))
    return found


def machine():
    """Versions and hardware."""

    def first_line(command):
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()[0]

    info = pathlib.Path("/proc/cpuinfo").read_text()
    fields = dict(line.split(":", 1) for line in info.split("\n\n")[0].splitlines() if ":" in line)
    fields = {name.strip(): value.strip() for name, value in fields.items()}
    wanted = ["sse2", "avx2", "fma", "avx512f", "avx512dq", "avx512vl"]
    return {
        "processor": " ".join(fields.get(name, "") for name in ["model name", "cpu family", "model"]),
        "features": [name for name in wanted if name in fields.get("flags", "").split()],
        "kernel": platform.release(),
        "libc": " ".join(platform.libc_ver()),
        "gcc": first_line(["gcc", "--version"]),
        "rustc": first_line(["rustc", "--version"]),
        "python": platform.python_version(),
        **{name: importlib.metadata.version(name) for name in ["casadi", "sympy", "symforce", "numpy"]},
    }


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("library", type=pathlib.Path)
    parser.add_argument("--turns", type=int, default=301)
    parser.add_argument("--out", type=pathlib.Path, default=HERE / "out")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    samples = Samples()
    rows, compared, about = [], [], machine()
    print(f"{about['processor']} ({', '.join(about['features'])}); {about['gcc']}; {about['rustc']}; {about['libc']}")
    for exponent, title in TITLES.items():
        kernels = contenders(exponent, options.library.resolve(), options.out, samples)
        errors = check(kernels, exponent, samples)
        times = race(kernels, options.turns)
        print(f"\n{title}, nanoseconds per sample, medians of {options.turns} turns of {CALLS} calls\n")
        print("| contender | ns | / hertzian | error |\n|---|---:|---:|---:|")
        for name, median in sorted(times.items(), key=lambda item: item[1]):
            print(f"| {name} | {median:.2f} | {median / times['hertzian']:.2f} | {errors[name]:.0e} |")
            rows.append({"exponent": title, "contender": name, "nanoseconds": median, "error": errors[name]})
        print()
        for sentence, ratio in ratios(exponent, times):
            print(f"- {sentence}: {ratio:.2f}")
            compared.append({"exponent": title, "what": sentence, "ratio": ratio})
    with open(options.out / "peers.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0])
        writer.writeheader()
        writer.writerows(rows)
    everything = {"machine": about, "times": rows, "ratios": compared}
    (options.out / "peers.json").write_text(json.dumps(everything, indent=1) + "\n")


if __name__ == "__main__":
    main()
