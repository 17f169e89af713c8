"""What motions settle to, against exact values and closed forms."""

import math

import numpy as np
import pytest

import hertzian

#: Three periodic orbits at omega = 1, drive = 1: their points at phase zero, and the modulus of their multipliers squared, which is the
#: same for both; from the closed-form flow between switches in 80-bit arithmetic.
ORBITS = [
    ([[-1.9997761227576426582, 0.1782358746036854517]], complex(-0.6555964496279292, 0.6155829202791328)),
    (
        [[-5.632060192753840953, 3.5265900786501795847], [-8.0510703571952343584, -2.7565952285294068923]],
        complex(-0.5247461910891712, 0.7333361541700191),
    ),
    (
        [
            [-31.334287816436888456, 0.6053602851584004412],
            [-7.7914881650008648763, 6.8885455923379869184],
            [-15.398669863515477568, -5.6778250220211860413],
        ],
        complex(-0.3807749245935372, 0.8178886625843435),
    ),
]


def test_motions_settle_to_the_exact_orbits(one_sided, tmp_path):
    one_sided.set(drive=1.0)
    starts = np.array([points[0] for points, _ in ORBITS]) + 1e-3
    basins = one_sided.settle(starts, omega=1.0, longest=4)
    assert basins.complete and basins.fates.dtype == np.int16
    assert list(basins.fates) == [0, 1, 2]
    for attractor, (points, multiplier) in zip(basins.attractors, ORBITS):
        assert attractor.period == len(points)
        assert attractor.points.shape == (len(points), 2)
        # In the order in which it visits them, from the one with the smallest position.
        first = min(range(len(points)), key=lambda i: points[i][0])
        assert np.allclose(attractor.points, np.roll(points, -first, axis=0), atol=1e-9)
        assert min(abs(attractor.multipliers - multiplier)) < 1e-8
    assert basins.count(2) == 1 and basins.count(hertzian.Fate.ESCAPED) == 0
    assert basins.parameters["drive"] == basins.omega == 1.0
    path = tmp_path / "basins.json"
    basins.write(path)
    read = hertzian.Basins.read(path)
    assert read == basins and read.fates.shape == (3,)
    path.write_text(path.read_text().replace('"version":2', '"version":1'))
    with pytest.raises(hertzian.FileError, match="is of version 1, and files of version 2 are read"):
        hertzian.Basins.read(path)


def test_the_orbit_of_an_attractor_is_an_orbit(one_sided):
    one_sided.set(drive=1.0)
    points, _ = ORBITS[1]
    point = one_sided.orbit(1.0, near_state=points[0], period=2, by=hertzian.Shooting())
    assert point.orbit.period == 2 and point.stability.verdict == "stable"
    assert np.allclose(point.orbit.state, points[0], atol=1e-9)
    # Peak to peak from the same computation.
    assert abs(point.peak_to_peak - 16.34670511780529) < 1e-8


def test_a_basin_is_an_image():
    model = hertzian.Model("TwoWells(x) { param drive = 0.05; ddot(x) + 0.5*dot(x) - x + x^3 = drive*cos(omega*t); }")
    columns, rows = hertzian.Axis("x", -1.5, 1.5, cells=6), hertzian.Axis("dot(x)", -0.3, 0.3, cells=2)
    assert np.allclose(columns.middles, [-1.25, -0.75, -0.25, 0.25, 0.75, 1.25])
    basins = model.basin(columns, rows, omega=1.0, longest=1, tolerance=1e-8)
    assert basins.fates.shape == (2, 6)
    assert [attractor.period for attractor in basins.attractors] == [1, 1]
    # From within a well a motion stays there; the first one is that on the left.
    assert list(basins.fates[0, [0, 1, 4, 5]]) == [0, 0, 1, 1]
    with pytest.raises(ValueError, match="y is no entry of a state: coordinates are x"):
        model.basin(hertzian.Axis("y", 0, 1), rows, omega=1.0)
    with pytest.raises(hertzian.RequestError, match="grid must vary two different entries"):
        model.basin(rows, rows, omega=1.0)


def test_what_cannot_be_settled_is_refused(linear):
    with pytest.raises(hertzian.RequestError, match="grid must have at least one cell"):
        linear.settle(np.zeros((0, 2)), omega=1.0)
    with pytest.raises(hertzian.RequestError, match="grid must have the entries of a state"):
        linear.settle([[1.0, 0.0, 0.0]], omega=1.0)
    with pytest.raises(hertzian.RequestError, match="grid must be finite"):
        linear.settle([[1.0, math.nan]], omega=1.0)
    with pytest.raises(TypeError, match="settle\\(\\) needs the argument 'omega'"):
        linear.settle([[1.0, 0.0]])


def test_a_sweep_of_a_linear_motion_is_the_closed_form(linear):
    swept = linear.sweep(0.5, 1.5, values=3, transient=150, periods=2)
    assert swept.complete and list(swept.values) == [0.5, 1.0, 1.5]
    for row in swept.rows:
        response = 3.0 / (4.0 - row.value**2 + 0.2j * row.value)
        assert row.points.shape == (2, 2) and row.ended is None
        assert np.allclose(row.points, [response.real, -row.value * response.imag], atol=1e-8)


def test_a_history_is_the_closed_form():
    model = hertzian.Model("Free(x, y) { param k = 4; ddot(x) + k*x = 0; ddot(y) = cos(omega*t); }")
    times, states = model.history([1.0, -1.0, 0.5, 0.0], omega=1.0, periods=2, samples=10)
    assert times.shape == (21,) and states.shape == (21, 4)
    assert times[-1] == pytest.approx(4 * math.pi)
    x = np.cos(2 * times) + 0.25 * np.sin(2 * times)
    assert np.allclose(states.T, [x, -np.cos(times), 0.5 * np.cos(2 * times) - 2 * np.sin(2 * times), np.sin(times)])
    with pytest.raises(hertzian.RequestError, match="the state has 2 entries instead of 4"):
        model.history([0.0, 0.0], omega=1.0)
