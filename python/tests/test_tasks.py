"""What an engineer asks of the models in examples/models, without any Rust."""

import pathlib

import numpy as np
import pytest

import hertzian

MODELS = pathlib.Path(__file__).resolve().parents[2] / "examples" / "models"


def test_gears_that_turn_freely():
    """As long as the teeth press, the mesh is linear: at these frequencies a multiplier is minus one, by an integration of its own (DOP853) of
    r'' = -3/2 (k (1 + cos(omega t)/5) r + c r') over a period."""
    gears = hertzian.Model.read(MODELS / "gear_mesh.txt")
    branch = gears.response(3.3e4, 3.6e4, by=hertzian.HarmonicBalance(doublings=True))
    doublings = [event for event in branch.events if event.kind == "period-doubling"]
    assert len(doublings) == 2
    for event, exact in zip(doublings, [33721.4047754015, 35452.8578365181]):
        assert abs(event.value - exact) <= event.error < 1e-6
    # The mean is the deformation by the load, 10 um, behind half of the backlash, 50 um.
    assert branch.measured("relative:rms") == pytest.approx(60.0, rel=0.01)


def test_the_orbit_of_a_shaft_and_the_forces_of_its_balls():
    bearing = hertzian.Model.read(MODELS / "ball_bearing.txt")
    point = bearing.orbit(0.5, tolerance=1e-3)
    times = np.linspace(0.0, 2*np.pi/point.orbit.base, 2000, endpoint=False)
    (y, _), (x, _) = (point.orbit.state_at(name, times) for name in ("y", "x"))
    angles = 0.2*times + 2*np.pi*np.arange(8)[:, np.newaxis]/8
    forces = np.maximum(y*np.cos(angles) + x*np.sin(angles) - 0.2, 0.0)**1.5
    # In the mean the balls carry the load, and nothing across it.
    assert np.sum(forces*np.cos(angles), axis=0).mean() == pytest.approx(1.0, abs=1e-4)
    assert np.sum(forces*np.sin(angles), axis=0).mean() == pytest.approx(0.0, abs=1e-4)
    for ball in range(8):
        assert point.measured(f"ball_{ball + 1}:max") == pytest.approx(forces.max(), rel=1e-4)


def test_a_surface_is_left():
    """With a tip that is pressed into it at the beginning; where it is far away it is linear, with the amplitude of the free resonance."""
    tip = hertzian.Model.read(MODELS / "tip.txt")
    assert tip.orbit(-1.0, vary="distance", omega=1.0, tolerance=1e-3).stability.verdict == "stable"
    branch = tip.response(9.0, 14.0, vary="distance", omega=1.0, tolerance=1e-3, stability=False)
    assert branch.measured("x:h1")[-1] == pytest.approx(10.0, abs=2e-3)
