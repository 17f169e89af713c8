"""Backbone curves, against closed forms."""

import numpy as np
import pytest

import hertzian

HERTZ = "Hertz(x) { ddot(x) + sgn(x)*|x|^1.5 = 0; }"

#: The frequency of an amplitude of one, by a quadrature of the period.
HERTZ_OMEGA = 0.95469356972851

#: Half a period at the frequency one, and half at the frequency two.
BILINEAR = """
Bilinear(x) {
    param zeta = 0.05;
    law stop(gap) { gap > 0 => 3*gap + zeta*dot(gap), else => 0 }
    ddot(x) + 2*zeta*dot(x) + x + stop(x) = cos(omega*t);
}
"""

#: Linear in contact, with the frequency two, and another mode of the frequency three.
BALL = """
Ball(x, y) {
    law contact(gap) { gap > 0 => 4*gap, else => 0 }
    ddot(x) + contact(x) = 4;
    ddot(y) + 9*y = 0;
}
"""

#: Two masses in a row, of which the second is driven, with modes of the frequencies one and sqrt(3).
PAIR = """
Pair(x, y) {
    param drive = 0.1;
    ddot(x) + 0.02*dot(x) + 2*x - y = 0;
    ddot(y) + 0.02*dot(y) + 2*y - x = drive*cos(omega*t);
}
"""


def test_free_oscillation_has_the_frequency_of_its_amplitude():
    model = hertzian.Model(HERTZ)
    curve = model.free_oscillation(0.5, 2.0)
    assert curve.varied == "omega" and curve.stopped.kind == "reached-end"
    amplitude = curve.measured("x:max")
    assert abs(amplitude[0] - 0.5) < 1e-9 and abs(amplitude[-1] - 2.0) < 1e-9
    assert np.allclose(curve.omega, HERTZ_OMEGA * amplitude**0.25, rtol=1e-9)
    assert set(curve.verdicts) == {"undecided"} and curve.leaps == []
    # The work of x^1.5 up to there.
    assert np.allclose(model.energies(curve), 0.4 * amplitude**2.5, rtol=1e-9)


def test_what_gives_or_takes_energy_is_left_out_where_that_is_asked_for():
    model = hertzian.Model(BILINEAR)
    curve = model.free_oscillation(1.0, 2.0, conservative=True)
    assert np.allclose(curve.omega, 4 / 3, rtol=1e-9)
    # Against the springs of both sides.
    largest = curve.measured("x:max")
    energies = model.energies(curve, conservative=True)
    assert np.allclose(energies, 2 * largest**2, rtol=1e-9)
    with pytest.raises(hertzian.HertzianError):
        model.free_oscillation(1.0, 2.0)


def test_modes_and_what_is_near_them():
    model = hertzian.Model(BALL)
    assert np.allclose(model.modes(), [2.0, 3.0], rtol=1e-12)
    for options in [{"near_rest": (np.array([1.1, 0.0]), 2.0)}, {"mode": 1}]:
        curve = model.free_oscillation(1.1, 1.9, **options)
        assert np.allclose(curve.omega, 2.0, rtol=1e-9)
        assert abs(curve.measured("x:p2p")[-1] - 1.8) < 1e-9
    second = model.free_oscillation(to=0.5, mode=2, along="y")
    assert np.allclose(second.omega, 3.0, rtol=1e-9)
    with pytest.raises(TypeError, match="near_rest"):
        model.free_oscillation(1.1, 1.9, near_rest=2.0)


def test_a_mode_ends_where_the_response_does():
    model = hertzian.Model(PAIR)
    assert np.allclose(model.modes(conservative=True), [1.0, 3**0.5], rtol=1e-12)
    response = model.response(0.8, 1.2, by=hertzian.Shooting())
    curve = model.free_oscillation(mode=1, up_to=response, along="y", conservative=True)
    assert np.allclose(curve.omega, 1.0, rtol=1e-9)
    assert abs(curve.measured("y:max")[-1] / response.measured("y:max").max() - 1.0) < 1e-9


def test_phase_resonance_of_a_linear_oscillator(linear):
    curve = linear.phase_resonance("drive", 1.0, between=(1.0, 3.0))
    assert curve.varied == "drive" and curve.stopped.kind == "reached-end"
    # The load balances damping alone: 2 zeta omega is 0.4.
    assert np.allclose(curve.omega, 2.0, rtol=1e-9)
    assert np.allclose(curve.measured("x:p2p"), 2 * curve.values / 0.4, rtol=1e-8)


def test_phase_resonance_begins_on_a_response():
    model = hertzian.Model(PAIR)
    response = model.response(0.8, 1.2, by=hertzian.Shooting())
    curve = model.phase_resonance("drive", 0.2, on=response)
    # The masses move as one, and half of the damping is that of the mass that is driven.
    assert abs(curve.omega[0] - 1.0) < 1e-3
    with pytest.raises(TypeError, match="help\\(phase_resonance\\) lists them"):
        model.phase_resonance("drive", 0.2, upon=response)


def test_a_callback_ends_a_backbone(linear):
    seen = []

    def watch(progress):
        seen.append(progress.done)
        return len(seen) < 3

    for curve in [
        hertzian.Model(HERTZ).free_oscillation(0.5, 2.0, progress=watch),
        linear.phase_resonance("drive", 1.0, between=(1.0, 3.0), progress=watch),
    ]:
        assert curve.stopped.kind == "interrupted"
        assert 1 <= len(curve) <= 3
