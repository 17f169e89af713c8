#!/usr/bin/env python3
"""Orbits of the examples by an integration that shares nothing with hertzian: `reference.py > reference.tsv`, with numpy and scipy.

The equations are written here once more, by hand, with time as the phase `omega t`. They are integrated by DOP853 (Hairer, Norsett, Wanner 1993) from
switch to switch, each an event of `scipy.integrate.solve_ivp`. Periodic orbits are fixed points of the map over a period, found by Newton's method
with differences from random starts, so that unstable ones are found too; `stable` says whether all multipliers are inside of the unit circle. A
fold is where the frequency has an extreme among the orbits that begin at given positions."""

import platform
from collections import defaultdict

import numpy as np
import scipy
from scipy.integrate import solve_ivp
from scipy.linalg import expm
from scipy.optimize import brentq, minimize_scalar

TAU = 2*np.pi


def nearest(of, times, values, sign):
    """The largest value times a sign, looked for more closely where it is the largest of these."""
    for _ in range(4):
        at = int(np.argmax(sign*values))
        times = np.linspace(times[max(at - 1, 0)], times[min(at + 1, len(times) - 1)], 21)
        values = of(times)
    return sign*np.max(sign*values)


class System:
    """`y' = slope(t, y, sides)`, where the sides of `levels(t, y)` say which are positive. States are of order one to ten."""

    def __init__(self, slope, levels, period=TAU):
        self.slope, self.levels, self.period = slope, levels, period

    def flow(self, start, see=lambda run, sides: None):
        """The state after a period."""
        t, y = 0.0, np.array(start, float)
        # Just behind the beginning: what begins at a level is on the side to which it goes.
        ahead = y + 1e-9*self.slope(t, y, self.levels(t, y) > 0)
        sides = self.levels(1e-9, ahead) > 0
        while True:
            fixed, events = sides.copy(), []
            for number, side in enumerate(fixed):
                def event(t, y, number=number):
                    return self.levels(t, y)[number]
                event.terminal, event.direction = True, -1 if side else 1
                events.append(event)
            run = solve_ivp(lambda t, y: self.slope(t, y, fixed), (t, self.period), y, "DOP853", rtol=1e-12, atol=1e-13,
                            events=events, dense_output=True)
            see(run, fixed)
            t, y = run.t[-1], run.y[:, -1]
            if run.status == 0:
                return y
            for number, found in enumerate(run.t_events):
                if len(found):
                    sides[number] = not sides[number]

    def signals(self, start, of, pieces=400, nodes=8):
        """Extremes and rms of `of(t, y, sides)`, a row for each signal, over a period: at Gauss nodes of many pieces between switches."""
        at, weights = np.polynomial.legendre.leggauss(nodes)
        extremes, squares = defaultdict(list), 0.0

        def see(run, sides):
            nonlocal squares
            ends = np.linspace(run.t[0], run.t[-1], max(4, int(pieces*(run.t[-1] - run.t[0])/self.period)) + 1)
            half = 0.5*np.diff(ends)[:, None]
            times = (ends[:-1, None] + half*(1 + at)).ravel()
            here = of(times, run.sol(times), sides)
            squares = squares + here**2 @ (half*weights).ravel()
            times = np.sort(np.concatenate([times, ends]))
            for number, row in enumerate(of(times, run.sol(times), sides)):
                extremes[number].append([nearest(lambda t: of(t, run.sol(t), sides)[number], times, row, sign) for sign in (-1, 1)])

        self.flow(start, see)
        rows = zip(extremes.values(), np.sqrt(squares/self.period))
        return [{"min": float(np.min(ends)), "max": float(np.max(ends)), "rms": float(rms)} for ends, rms in rows]

    def monodromy(self, start, size=1e-6):
        columns = []
        for entry in np.eye(len(start)):
            ends = [self.flow(start + sign*size*entry) for sign in (1, -1)]
            columns.append((ends[0] - ends[1])/(2*size))
        return np.array(columns).T

    def orbit(self, start, most=20):
        """A fixed point near a start, or nothing."""
        y = np.array(start, float)
        for _ in range(most):
            left = self.flow(y) - y
            if not np.all(np.isfinite(left)) or np.abs(left).max() > 1e3:
                return None
            if np.abs(left).max() < 2e-11*max(1.0, np.abs(y).max()):
                return y
            step = np.linalg.solve(self.monodromy(y) - np.eye(len(y)), left)
            y = y - step*min(1.0, 5.0/np.abs(step).max())
        return None

    def orbits(self, starts):
        found = []
        for start in starts:
            y = self.orbit(start)
            if y is not None and not any(np.abs(y - other).max() < 1e-6 for other in found):
                found.append(y)
        return found

    def is_stable(self, y):
        return bool(np.abs(np.linalg.eigvals(self.monodromy(y))).max() < 1)

    def described(self, orbits, of, names):
        """Orbits in the order of their first signal."""
        all = [{"stable": self.is_stable(y), **dict(zip(names, self.signals(y, of)))} for y in orbits]
        return sorted(all, key=lambda orbit: orbit[names[0]]["max"] - orbit[names[0]]["min"])


def fold(system_at, position, omega, y):
    """The largest frequency of orbits that begin at positions between two, near an orbit `y = (x, v)` at `omega`."""
    near = np.array([y[1], omega])

    def frequency(x):
        nonlocal near
        guess = near.copy()
        for _ in range(30):
            def left(unknown):
                return system_at(unknown[1]).flow([x, unknown[0]]) - [x, unknown[0]]
            here = left(guess)
            if np.abs(here).max() < 1e-12:
                break
            sizes = [1e-6, 1e-6*omega]
            columns = [(left(guess + size*entry) - left(guess - size*entry))/(2*size) for size, entry in zip(sizes, np.eye(2))]
            guess = guess - np.linalg.solve(np.array(columns).T, here)
        near = guess
        return guess[1]

    return float(-minimize_scalar(lambda x: -frequency(x), bounds=position, method="bounded", options={"xatol": 1e-6}).fun)


# Gears that turn freely: r = pinion - wheel in units of the play, 5e-5 m.
def gears(omega, load=2e3, variation=0.2):
    def slope(t, y, sides):
        pressed = y[0] - 1 if sides[0] else y[0] + 1 if sides[1] else 0.0
        force = 2e8*(1 + variation*np.cos(t))*pressed - load/5e-5
        return np.array([y[1], -1.5*force/omega**2 - 1.5*1e3/omega*y[1]])
    return System(slope, lambda t, y: np.array([y[0] - 1, -y[0] - 1]))


def doubling(low, high):
    """Where det(M + I) of the mesh that is always pressed vanishes."""
    def test(omega):
        linear = System(lambda t, y, sides: np.array([y[1], -3e8*(1 + 0.2*np.cos(t))/omega**2*y[0] - 1.5e3/omega*y[1]]), lambda t, y: np.zeros(0))
        return np.linalg.det(np.array([linear.flow(start) for start in np.eye(2)]) + np.eye(2))
    return float(brentq(test, low, high, xtol=1e-9, rtol=1e-14))


def settled(system, starts, periods=70, most=4):
    """States of the stable orbits of up to `most` periods that motions settle to, one of each."""
    known = []
    for y in starts:
        for _ in range(periods):
            y = system.flow(y)
        images = [y]
        for _ in range(most - 1):
            images.append(system.flow(images[-1]))
        if not any(np.abs(other - image).max() < 1e-6 for other in known for image in images):
            known.append(y)
    return known


def gear_orbits(starts, random):
    """What motions settle to, and what Newton's method finds near it."""
    system = gears(1.4e4)
    stable = settled(system, starts)
    beside = [y + 0.15*random.normal(size=2) for y in stable for _ in range(12)]
    return system.described(system.orbits(stable + beside), lambda t, y, sides: 50*y[:1], ["relative"])


def gear_tasks(random):
    starts = [[1 + 1.5*random.normal(), 1.5*random.normal()] for _ in range(40)]
    counts = [len(settled(gears(1.4e4, load, variation), starts)) for load in (1e3, 2e3, 4e3) for variation in (0.1, 0.2, 0.3)]
    return {"orbits": gear_orbits(starts[:10], random), "doublings": [doubling(3.35e4, 3.4e4), doubling(3.52e4, 3.57e4)], "stable": counts}


# A shaft on eight balls, over the time in which one takes the place of the last.
def bearing(omega):
    angles = TAU*np.arange(8)/8

    def gaps(t, y):
        phi = angles + 0.4*t
        return y[0]*np.cos(phi) + y[1]*np.sin(phi) - 0.2

    def forces(t, y):
        phi = angles[:, None] + 0.4*t
        return np.maximum(y[0]*np.cos(phi) + y[1]*np.sin(phi) - 0.2, 0)**1.5

    def slope(t, y, sides):
        pressed = np.where(sides, np.abs(gaps(t, y))**1.5, 0.0)
        phi = angles + 0.4*t
        return np.array([y[2], y[3], (1 - pressed @ np.cos(phi))/omega**2 - 0.1*y[2]/omega, -(pressed @ np.sin(phi))/omega**2 - 0.1*y[3]/omega])

    system = System(slope, gaps, TAU*5/16)
    return system, lambda t, y, sides: np.array([y[0], y[1], forces(t, y).max(axis=0)])


def bearing_task(omega):
    system, of = bearing(omega)
    y = np.array([1.0, 0.0, 0.0, 0.0])
    for _ in range(60):
        y = system.flow(y)
    return {"omega": omega, "orbits": system.described(system.orbits([y]), of, ["y", "x", "ball"])}


# The tip of a force microscope, in nm.
def tip(distance):
    def slope(t, y, sides):
        gap = y[0] - distance
        surface = 0.1*abs(gap)**1.5 - 0.004/0.165**2 if sides[0] else -0.004/(0.165 - min(gap, 0.0))**2
        return np.array([y[1], 10/400*np.cos(t) - y[1]/400 - y[0] - surface])
    return System(slope, lambda t, y: np.array([y[0] - distance]))


def tip_task(random, distance):
    system = tip(distance)
    starts = [[a*np.cos(phase), a*np.sin(phase)] for a in (0.5, 3.0, 4.6, 4.8, 5.0, 5.2, 5.5) for phase in random.uniform(0, TAU, 5)]
    orbits = system.orbits(starts)

    def of(t, y, sides):
        gap = y[0] - distance
        force = 0.2*np.abs(gap)**1.5 - 0.008/0.165**2 if sides[0] else -0.008/(0.165 - np.minimum(gap, 0))**2
        return np.array([y[0], force])
    return {"distance": distance, "orbits": system.described(orbits, of, ["x", "surface"])}


# A bolted joint, in units of 0.1 mm.
def joint(omega):
    def slope(t, y, sides):
        faces = 1e7*abs(y[0])**1.5 if sides[0] else 0.0
        return np.array([y[1], ((1000 + 300*np.cos(t))/1e-4 - 100*omega*y[1] - 5e6*y[0] - faces)/(2*omega**2)])
    return System(slope, lambda t, y: y[:1])


def joint_task(random, omega):
    system = joint(omega)
    orbits = system.orbits([[1 + random.normal(), random.normal()] for _ in range(25)])
    return {"omega": omega, "orbits": system.described(orbits, lambda t, y, sides: np.array([-100*y[0], np.maximum(y[0], 0)**1.5]), ["opening", "pressing"])}


# Three elements of a beam: cubics between deflections and slopes, integrated by Gauss nodes; lengths in thousandths of the beam.
def beam_matrices():
    h, nodes = 1/3, np.polynomial.legendre.leggauss(6)
    mass, stiffness = np.zeros((8, 8)), np.zeros((8, 8))
    for element in range(3):
        for s, weight in zip(0.5*(nodes[0] + 1), 0.5*h*nodes[1]):
            shape = np.array([1 - 3*s**2 + 2*s**3, h*(s - 2*s**2 + s**3), 3*s**2 - 2*s**3, h*(s**3 - s**2)])
            bent = np.array([12*s - 6, h*(6*s - 4), 6 - 12*s, h*(6*s - 2)])/h**2
            place = slice(2*element, 2*element + 4)
            mass[place, place] += weight*np.outer(shape, shape)
            stiffness[place, place] += weight*np.outer(bent, bent)
    return mass[:6, :6], stiffness[:6, :6]


def structure(mass, damping, stiffness, contact, load, level):
    """Of matrices by phase, with a force at the last entry of `contact` beyond a level."""
    inverse, n = np.linalg.inv(mass), len(mass)

    def system(omega):
        def slope(t, y, sides):
            q, v = y[:n], y[n:]
            force = load(omega, t) - stiffness @ q - omega*(damping @ v) - (contact(q) if sides[0] else 0.0)
            return np.concatenate([v, inverse @ force/omega**2])
        return System(slope, lambda t, y: np.array([level(y[:n])]))
    return system


class Affine(System):
    """Two matrices, one for each side of the level `c @ z = 1`, of states with cos t, sin t and 1 behind them: motions are exponentials."""

    def __init__(self, matrices, c, samples=2000):
        self.matrices, self.c, self.samples, self.step = matrices, c, samples, TAU/samples
        self.steps = [expm(self.step*matrix) for matrix in matrices]

    def stretches(self, start):
        """Where each begins, its side, its length and where it ends."""
        z = np.concatenate([start, [1.0, 0.0, 1.0]])
        slope = self.c @ (self.matrices[0] @ z)
        side = int(self.c @ z > 1 or (self.c @ z == 1 and slope > 0))
        for _ in range(self.samples):
            left = self.step
            ahead = self.steps[side] @ z
            while (self.c @ ahead > 1) != bool(side):
                time = brentq(lambda t: self.c @ (expm(t*self.matrices[side]) @ z) - 1, 0, left, xtol=1e-15) if abs(self.c @ z - 1) > 1e-14 else left
                end = expm(time*self.matrices[side]) @ z
                yield z, side, time, end
                z, left, side = end, left - time, 1 - side
                ahead = expm(left*self.matrices[side]) @ z
            yield z, side, left, ahead
            z = ahead

    def flow(self, start):
        for *_, z in self.stretches(start):
            pass
        return z[:-3]

    def extremes(self, start, entry, rate):
        """Of an entry, whose derivative is another one: at the ends of stretches, and where the derivative vanishes."""
        values = []
        for z, side, length, end in self.stretches(start):
            values.append(z[entry])
            if z[rate]*end[rate] < 0:
                def ahead(t):
                    return expm(t*self.matrices[side]) @ z
                values.append(ahead(brentq(lambda t: ahead(t)[rate], 0, length, xtol=1e-15))[entry])
        return min(values), max(values)


def beam_task(omega, starts):
    mass, stiffness = beam_matrices()
    inverse, tip, none = np.linalg.inv(mass), np.eye(6)[0], np.zeros((6, 6))
    matrices = []
    for stop in (0.0, 20.0):
        held = stiffness + stop*np.outer(tip, tip)
        matrix = np.zeros((15, 15))
        matrix[:6, 6:12] = np.eye(6)
        matrix[6:12, :6] = -inverse @ held/omega**2
        matrix[6:12, 6:12] = -inverse @ stiffness*0.02/3.516/omega
        matrix[6:12, 12] = inverse @ tip*0.2/omega**2
        matrix[6:12, 14] = inverse @ tip*stop/omega**2
        matrix[12, 13], matrix[13, 12] = -1, 1
        matrices.append(matrix)
    system = Affine(matrices, np.eye(15)[0])
    orbits = system.orbits([np.concatenate([size*np.linspace(1, 0, 6)**2, np.zeros(6)]) for size in starts])
    described = []
    for y in orbits:
        low, high = system.extremes(y, 0, 6)
        described.append({"stable": system.is_stable(y), "tip": {"min": float(1e-3*low), "max": float(1e-3*high)}})
    return {"omega": omega, "orbits": sorted(described, key=lambda orbit: orbit["tip"]["max"] - orbit["tip"]["min"])}


# A strip on a shaken clamp by finite differences, in mm.
def cantilever_task(omega, starts):
    stiffness = 22*np.array([[7, -4, 1, 0, 0], [-4, 6, -4, 1, 0], [1, -4, 6, -4, 1], [0, 1, -4, 5, -2], [0, 0, 1, -2, 1]], float)
    weights = np.array([1, 1, 1, 1, 0.5])
    mass = 1.57e-6*np.diag(weights)
    last = np.eye(5)[4]

    def load(omega, t):
        return 1.57e-6*0.05*omega**2*np.cos(t)*weights
    system = structure(mass, 4e-5*stiffness, stiffness, lambda q: abs(q[4] - 1)**1.5*last, load, lambda q: q[4] - 1)(omega)
    orbits = system.orbits([np.concatenate([size*(np.arange(1, 6)/5)**1.8, np.zeros(5)]) for size in starts])
    return {"omega": omega, "orbits": system.described(
        orbits, lambda t, y, sides: np.array([y[4], np.maximum(y[4] - 1, 0)**1.5]), ["tip", "impact"])}


# A part with a stop, in units of 0.1 mm.
def variant(play, stop, damping):
    def system(omega):
        def slope(t, y, sides):
            hertz = stop*np.sqrt(0.1)*abs(y[0] - 10*play)**1.5 if sides[0] else 0.0
            return np.array([y[1], (4*np.cos(t) - damping*omega*y[1] - 10*y[0] - hertz)/(1e-3*omega**2)])
        return System(slope, lambda t, y: np.array([y[0] - 10*play]))
    # Along the resonance up to where no orbit is found near the last one.
    omega, y, step = 95.0, np.zeros(2), 2.0
    y = system(omega).orbit(y)
    while step > 0.05:
        ahead = system(omega + step).orbit(y, most=8)
        if ahead is None or np.abs(ahead - y).max() > 2.5:
            step /= 2
        else:
            omega, y = omega + step, ahead
    jump = fold(system, (y[0] - 2.0, y[0] + 2.0), omega, y)
    return {"play": play, "stop": stop, "damping": damping, "jump": jump}


def main():
    random = np.random.default_rng(1)
    print(f"# by reference.py with Python {platform.python_version()}, numpy {np.__version__}, scipy {scipy.__version__}")
    print("task", "at", "orbit", "is", "what", "value", sep="\t")

    def orbits(task, at, found):
        for number, orbit in enumerate(found["orbits"], 1):
            for signal, measures in orbit.items():
                if signal != "stable":
                    for measure, value in measures.items():
                        print(task, at, number, "stable" if orbit["stable"] else "unstable", f"{signal}:{measure}", repr(value), sep="\t", flush=True)

    of_gears = gear_tasks(random)
    orbits("gear_mesh", 14000, of_gears)
    for value in of_gears["doublings"]:
        print("gear_mesh", "", "", "doubling", "omega", repr(value), sep="\t")
    print("gear_mesh", 14000, "", "stable", "count", " ".join(map(str, of_gears["stable"])), sep="\t", flush=True)
    orbits("ball_bearing", 0.5, bearing_task(0.5))
    orbits("approach", 5, tip_task(random, 5.0))
    orbits("bolted_joint", 2500, joint_task(random, 2500.0))
    orbits("beam", 3.9, beam_task(3.9, (0.5, 1.0, 2.0, -2.0)))
    orbits("cantilever", 600, cantilever_task(600.0, (0.3, 3.0, -2.9)))
    for values in ((0.5, 20.0, 2e-3), (0.42, 24.0, 1.7e-3), (0.58, 16.0, 2.3e-3)):
        print("variants", *[" ".join(map(str, values)), "", "jump", "omega"], repr(variant(*values)["jump"]), sep="\t", flush=True)


if __name__ == "__main__":
    main()
