#!/usr/bin/env python3
"""Sweeps by an integration that shares nothing with hertzian: `make.py NAME > NAME.csv`, with numpy and scipy.

The equations are written here once more, by hand. They are integrated by DOP853 (Hairer, Norsett, Wanner 1993) from switch to switch, each an event
of `scipy.integrate.solve_ivp`. A sweep goes on from the state before: by Newton's method on the map over a period where that stays near and is
stable, and otherwise by the motion itself, until it has settled; the last digits are Newton's. Amplitudes are those of the motion between its
turning points."""

import sys

import numpy as np
from scipy.integrate import solve_ivp

TAU = 2*np.pi


class System:
    """`slope(t, y, sides, omega)`, where `sides` says which of `levels(t, y)` are positive; the first half of a state are positions."""

    def __init__(self, slope, levels, size):
        self.slope, self.levels, self.size = slope, levels, size

    def flow(self, y, omega, rtol=1e-12, extremes=None, of=0):
        t, end, y = 0.0, TAU/omega, np.array(y, float)
        rate = len(y)//2 + of
        sides = self.levels(t, y + 1e-9*self.slope(t, y, self.levels(t, y) > 0, omega)) > 0
        while True:
            events = []
            for number, side in enumerate(sides):
                def event(t, y, number=number):
                    return self.levels(t, y)[number]
                event.terminal, event.direction = True, -1 if side else 1
                events.append(event)
            if extremes is not None:
                events.append(lambda t, y: y[rate])
            fixed = sides.copy()
            run = solve_ivp(lambda t, y: self.slope(t, y, fixed, omega), (t, end), y, "DOP853", rtol=rtol, atol=rtol*0.1, events=events)
            if extremes is not None:
                extremes.extend(state[of] for state in run.y_events[-1])
            t, y = run.t[-1], run.y[:, -1]
            if run.status == 0:
                return y
            for number in range(len(sides)):
                if len(run.t_events[number]):
                    sides[number] = not sides[number]

    def orbit(self, start, omega):
        """The periodic orbit near a state, and its largest multiplier; None where Newton's method leads nowhere."""
        y = np.array(start, float)
        order = len(y)
        for step in range(12):
            end = self.flow(y, omega)
            h = 1e-6
            columns = [(self.flow(y + h*unit, omega) - self.flow(y - h*unit, omega))/(2*h) for unit in np.eye(order)] if step < 4 else columns
            monodromy = np.array(columns).T
            update = np.linalg.solve(np.eye(order) - monodromy, end - y)
            y = y + update
            if np.max(np.abs(y)) > 1e3:
                return None
            if np.max(np.abs(update)) < 2e-12:
                return y, np.max(np.abs(np.linalg.eigvals(monodromy)))
        return None

    def sweep(self, start, omegas, of=0):
        y = np.array(start, float)
        for omega in omegas:
            found = self.orbit(y, omega)
            if found is None or found[1] > 1 or np.max(np.abs(found[0] - y)) > 0.3*self.size:
                for _ in range(6):
                    for _ in range(100):
                        y = self.flow(y, omega, rtol=1e-6)
                    found = self.orbit(y, omega)
                    if found is not None and found[1] < 1 and np.max(np.abs(found[0] - y)) < 1e-2:
                        break
                else:
                    raise ValueError(f"nothing settled at {omega}")
            y = found[0]
            extremes = []
            self.flow(y, omega, extremes=extremes, of=of)
            yield omega, max(extremes) - min(extremes)


def one_sided(drive, alpha=1.5, zeta=0.032, load=1.0):
    def slope(t, y, sides, omega):
        force = 2*zeta*y[1] + abs(y[0])**alpha if sides[0] else 0.0
        return np.array([y[1], drive*np.cos(omega*t) + load - force])
    return System(slope, lambda t, y: np.array([y[0]]), 2.0)


def backlash(zeta=0.05, stiffness=1.3, play=0.3, load=0.3, drive=0.15):
    def slope(t, y, sides, omega):
        force = stiffness*(y[0] - play) if sides[0] else stiffness*(y[0] + play) if not sides[1] else 0.0
        return np.array([y[1], drive*np.cos(omega*t) + load - 2*zeta*y[1] - force])
    return System(slope, lambda t, y: np.array([y[0] - play, y[0] + play]), 2.0)


def two_masses(stop=3.0, distance=0.5, coupling=0.6, zeta=0.015, drive=0.12):
    def slope(t, y, sides, omega):
        x, z, u, w = y
        force = stop*abs(x - distance)**1.5 if sides[0] else 0.0
        return np.array([u, w, drive*np.cos(omega*t) - 2*zeta*u - x - coupling*(x - z) - force,
                         -2*zeta*w - z - coupling*(z - x)])
    return System(slope, lambda t, y: np.array([y[0] - distance]), 1.0)


def written(rows, sweep, level=None):
    for omega, value in rows:
        print(f"{omega:.17g},{value:.13g},{sweep}" + (f",{level}" if level is not None else ""))


def main(name):
    if name == "one-sided":
        print("omega,x:p2p,sweep")
        written(one_sided(0.1).sweep([1.0, 0.0], np.linspace(0.62, 1.4, 30)), "rising")
        written(one_sided(0.1).sweep([1.0, 0.0], np.linspace(1.4, 0.62, 30)), "falling")
    if name == "noisy":
        # As someone would have measured it: hertz, a noise of one per cent.
        noise = np.random.default_rng(1)
        print("# a ball on a plane, swept up and down\nfrequency [Hz],x:p2p,sd,sweep")
        for sweep, omegas in [("rising", np.linspace(0.62, 1.4, 30)), ("falling", np.linspace(1.4, 0.62, 30))]:
            for omega, value in one_sided(0.1).sweep([1.0, 0.0], omegas):
                print(f"{omega/TAU:.6f},{value*(1 + 0.01*noise.standard_normal()):.4g},{0.01*value:.2g},{sweep}")
    if name == "levels":
        print("omega,x:p2p,sweep,drive")
        for drive in [0.06, 0.1, 0.14]:
            written(one_sided(drive).sweep([1.0, 0.0], np.linspace(1.4, 0.62, 60)), "falling", drive)
    if name == "backlash":
        print("omega,x:p2p,sweep")
        written(backlash().sweep([1.0, 0.0], np.linspace(0.5, 1.6, 30)), "rising")
        written(backlash().sweep([1.0, 0.0], np.linspace(1.6, 0.5, 30)), "falling")
    if name == "two-masses":
        print("omega,x:p2p,sweep")
        written(two_masses().sweep([0.0]*4, np.linspace(0.8, 1.9, 30)), "rising")
        written(two_masses().sweep([0.0]*4, np.linspace(1.9, 0.8, 30)), "falling")


main(sys.argv[1])
