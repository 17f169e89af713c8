"""Branches and their orbits, against exact values and closed forms."""

import math

import numpy as np
import pytest

import hertzian

#: Figure 5a, by the closed-form flow between switches.
FOLD = (0.96016367187857, 2.03840168022514)


def test_a_fold_is_the_exact_one(fold_branch):
    [fold] = fold_branch.folds
    omega, peak_to_peak = FOLD
    assert abs(fold.value - omega) <= fold.error < 1e-7
    assert fold.kind == "fold" and fold.turns
    assert fold.point.value == fold.value
    assert abs(fold.point.peak_to_peak / peak_to_peak - 1.0) < 1e-6
    # At a fold a multiplier is one.
    assert abs(fold.point.stability.multipliers[0] - 1.0) < 1e-4
    assert str(fold).startswith("fold at 0.96016367")
    assert fold in fold_branch.events


def test_arrays_have_a_number_for_each_orbit(fold_branch):
    count = len(fold_branch)
    points = fold_branch.points
    assert count == len(points) > 5
    for array in [fold_branch.values, fold_branch.omega, fold_branch.errors, fold_branch.verdicts]:
        assert array.shape == (count,)
    assert fold_branch.values.dtype == np.float64
    assert fold_branch.multipliers.shape == (count, 2)
    assert fold_branch.multipliers.dtype == np.complex128
    assert fold_branch.parameters.shape == (count, 3)
    assert np.array_equal(fold_branch.values, [point.value for point in points])
    assert list(fold_branch.verdicts) == [point.stability.verdict for point in points]
    assert np.array_equal(fold_branch.multipliers[3], points[3].stability.multipliers)
    # Stable up to the fold, then unstable.
    after = fold_branch.folds[0].after
    assert set(fold_branch.verdicts[: after - 1]) == {"stable"} and set(fold_branch.verdicts[after + 1 :]) == {"unstable"}
    assert fold_branch.stopped.kind == "left-at-start"
    assert str(fold_branch.stopped) == "turned back and left the range at its start"
    assert np.all(fold_branch.errors < 2e-6)
    assert points[0].parameters == {"zeta": 0.032, "load": 1.0, "drive": 0.1}
    assert fold_branch.varied == "omega" and fold_branch.period == 1
    assert fold_branch.statistics["accepted_steps"] >= count - 1
    assert fold_branch.elapsed > 0.0
    assert fold_branch.winding is None and fold_branch.turns == []


def test_what_is_measured_goes_by_names(fold_branch):
    assert fold_branch.leading == "speed:p2p"
    # Points by the contact equation have their series, and what follows from it, once they are completed.
    point = fold_branch.complete(fold_branch.points[4])
    # The output is twice the speed.
    assert fold_branch.measured()[4] == point.measured("speed")
    x, speed = point.reading("x"), point.reading("speed")
    assert np.allclose(speed.series[1::2], 2 * x.base * x.series[2::2] * np.arange(1, len(x.series) // 2 + 1))
    assert fold_branch.measured("x:rms", point) == point.measured("x:rms") == point.observed.motions["x"].rms
    assert fold_branch.measured("contact:max").shape == (len(fold_branch),)
    contact = point.observed.contacts["contact"]
    assert contact.maximum_force == point.measured("contact:max") == contact.peak_force
    # In the mean the contact carries the load.
    assert abs(contact.impulse - 2 * math.pi / point.omega) < 1e-9
    assert abs(sum(point.observed.on_pieces["contact"]) - 1.0) < 1e-12
    assert point.measured("x:h900") is None
    assert np.isnan(fold_branch.measured("x:h900")).all()
    with pytest.raises(hertzian.RequestError, match="no output, coordinate or contact is called tip"):
        fold_branch.measured("tip:rms")
    with pytest.raises(hertzian.RequestError, match="nothing is measured by `size`"):
        point.measured("x:size")


def test_orbits_at_a_value(fold_branch, one_sided):
    points = fold_branch.at(0.95)
    assert [point.value for point in points] == [0.95, 0.95]
    assert [point.stability.verdict for point in points] == ["stable", "unstable"]
    assert fold_branch.at(2.0) == []
    near = one_sided.orbit(0.95, near_orbit=points[1])
    assert abs(near.peak_to_peak / points[1].peak_to_peak - 1.0) < 1e-6
    again = one_sided.orbit(0.95, near_state=points[1].orbit.state, by=hertzian.Shooting())
    assert abs(again.peak_to_peak / points[1].peak_to_peak - 1.0) < 1e-5


@pytest.mark.parametrize("by", [None, hertzian.HarmonicBalance(harmonics=3), hertzian.Shooting()])
def test_a_linear_orbit_is_the_closed_form(linear, by):
    omega = 1.3
    response = 3.0 / (4.0 - omega**2 + 0.2j * omega)
    point = linear.orbit(omega, by=by)
    assert abs(point.peak_to_peak - 2 * abs(response)) < 1e-9
    assert point.stability.verdict == "stable"
    # The product of the multipliers is exp(-2 zeta T).
    product = np.prod(point.stability.multipliers)
    assert abs(product - math.exp(-0.2 * 2 * math.pi / omega)) < 1e-6
    # The derivative of Re(response exp(i omega t)) at zero.
    assert np.allclose(point.orbit.state, [response.real, -omega * response.imag], atol=1e-8)


def test_accuracy_is_that_of_an_output(one_sided):
    branch = one_sided.response(0.5, 0.6, tolerance=1e-4, accuracy_of="speed")
    assert branch.accuracy_of == "speed"
    assert np.all(branch.errors < 1e-4)
    (point,) = branch.at(0.55)
    exact = one_sided.orbit(0.55, by=hertzian.Shooting(), tolerance=1e-11)
    assert abs(branch.measured("speed", point) / exact.measured("speed") - 1) < point.error
    # Coordinates but the first are read when the orbit is completed; there is one here.
    observed = branch.points[0].observed
    assert list(observed.motions) == ["x"] and not branch.complete(branch.points[0]).observed.sampled
    with pytest.raises(hertzian.RequestError, match="accuracy is that of an output or a coordinate"):
        one_sided.response(0.5, 0.6, accuracy_of="contact")


def test_series_spectrum_and_states_agree(linear):
    omega = 1.3
    response = 3.0 / (4.0 - omega**2 + 0.2j * omega)
    orbit = linear.orbit(omega, harmonics=3).orbit
    assert (orbit.omega, orbit.base, orbit.period, orbit.harmonics, orbit.coordinates) == (omega, omega, 1, 3, 1)
    assert np.allclose(orbit.series("x")[1:3], [response.real, -response.imag])
    assert np.array_equal(orbit.series("x"), orbit.series(0))
    times = np.linspace(0.0, 2 * math.pi / omega, 7).reshape(1, 7)
    x, v = orbit.state_at("x", times)
    expected = response * np.exp(1j * omega * times)
    assert x.shape == v.shape == (1, 7)
    assert np.allclose(x, expected.real) and np.allclose(v, (1j * omega * expected).real)
    position, velocity = orbit.state_at("x", 0.0)
    assert isinstance(position, float)
    assert np.allclose([position, velocity], orbit.state)
    reading = linear.orbit(omega, harmonics=3).reading("x")
    assert np.allclose(reading.value(times), x)
    spectrum = reading.spectrum
    assert np.allclose(spectrum.omega, [0, omega, 2 * omega, 3 * omega])
    assert np.allclose(spectrum.amplitude, [0, abs(response), 0, 0])
    assert abs(spectrum.phase[1] + np.angle(response)) < 1e-12
    assert abs(reading.motion.crest_factor - math.sqrt(2)) < 1e-9
    with pytest.raises(KeyError, match="no coordinate is called y: there are x"):
        orbit.series("y")
    with pytest.raises(KeyError):
        orbit.series(1)


def test_states_of_shooting_and_what_completes_them(one_sided):
    branch = one_sided.response(1.3, 1.4, by=hertzian.Shooting(segments=2))
    point = branch.points[0]
    assert point.orbit.states.shape == (2, 2)
    assert point.orbit.harmonics == 0
    assert point.observed.contacts == {} and point.observed.motions["x"].rms is None
    with pytest.raises(hertzian.RequestError, match="the series of this orbit are not known"):
        point.orbit.series("x")
    complete = branch.complete(point)
    assert complete.orbit.harmonics > 0
    # In contact all the time it is linear: a cosine about the deflection by the load.
    assert complete.observed.contacts["contact"].fraction == 1.0
    assert complete.observed.motions["x"].rms == pytest.approx(math.hypot(1.0, point.peak_to_peak / math.sqrt(8)))


def test_all_orbits_are_completed(one_sided):
    branch = one_sided.response(1.3, 1.4, by=hertzian.Shooting())
    seen = []
    complete = branch.complete_all(progress=seen.append)
    assert [progress.done for progress in seen] == list(range(1, len(branch.points) + 1))
    assert {progress.stage for progress in seen} == {"completing"} and seen[0].total == len(branch.points)
    for before, point in zip(branch.points, complete.points):
        assert before.observed.motions["x"].rms is None
        assert point.observed.motions["x"].rms == pytest.approx(math.hypot(1.0, point.peak_to_peak / math.sqrt(8)))
    # Stopped on the way it has what was completed by then.
    begun = branch.complete_all(progress=lambda progress: progress.done < 2)
    assert [point.orbit.harmonics > 0 for point in begun.points] == [True, True] + [False] * (len(branch.points) - 2)


def test_a_parameter_is_varied(linear):
    branch = linear.response(1.0, 2.0, vary="drive", omega=1.0, harmonics=1)
    assert branch.varied == "drive"
    assert np.all(branch.omega == 1.0)
    assert np.allclose(branch.measured("x"), branch.values * 2 / abs(3.0 + 0.2j))
    assert np.array_equal(branch.parameters[:, 1], branch.values)
    # A second value of a model does not change what was computed.
    linear.set(drive=7.0)
    assert branch.at(1.5)[0].peak_to_peak == pytest.approx(3.0 / abs(3.0 + 0.2j))


def test_a_guess_leads_to_the_large_orbit(duffing):
    series = hertzian.Orbit.from_series(duffing, 1.3, 1, [[0.0, 0.5, 0.8]])
    samples = 0.5 * np.cos(np.arange(16) * math.pi / 8) + 0.8 * np.sin(np.arange(16) * math.pi / 8)
    for guess in [series, hertzian.Orbit.from_samples(duffing, 1.3, 1, [samples])]:
        assert duffing.orbit(1.3, near_orbit=guess).peak_to_peak > 1.0
    with pytest.raises(hertzian.RequestError):
        hertzian.Orbit.from_series(duffing, 1.3, 1, [[0.0], [1.0]])


def test_a_branch_is_drawn_and_written_as_a_table(curve, tmp_path):
    runs = curve.runs("x")
    assert [run.verdict for run in runs] == ["stable", "unstable", "stable"]
    assert all(run.points.shape[1] == 2 for run in runs)
    # Neighbours share the fold.
    assert np.array_equal(runs[0].points[-1], runs[1].points[0])
    curve.plot(tmp_path / "curve.svg", of="x:rms", frequency="hertz")
    text = (tmp_path / "curve.svg").read_text()
    assert text.startswith("<svg") and "rms of x" in text
    assert curve.to_svg() == curve._repr_svg_()
    curve.write_csv(tmp_path / "curve.csv")
    table = np.genfromtxt(tmp_path / "curve.csv", delimiter=",", names=True, dtype=None, encoding="utf-8")
    assert np.array_equal(table["omega"], curve.values)
    assert curve.to_csv() == (tmp_path / "curve.csv").read_text()
    with pytest.raises(ValueError, match="bpm is no frequency"):
        curve.to_svg(frequency="bpm")


def test_all_solutions_of_a_range(duffing):
    solutions = duffing.solutions([1.0, 1.3], 0.9, 2.0, harmonics=5)
    below, above = solutions.at
    assert (len(below.orbits), len(above.orbits)) == (1, 3)
    assert (above.count("stable"), above.count("unstable")) == (2, 1)
    assert above.largest == max(orbit.point.peak_to_peak for orbit in above.orbits)
    assert "omega = 1.3: 3 orbits, 2 stable, 1 unstable" in str(solutions)
    assert len(solutions.diagram) == 1
    # An orbit knows the branch that it lies on.
    [one] = below.orbits
    assert one.branch == 0 and one.point.measured("x:h1") > 0.0


def test_charts_look_as_asked(fold_branch):
    decibels = fold_branch.to_svg("x:rms", scale="db")
    assert "dB over 1" in decibels
    stacked = fold_branch.to_svg("x", stack=3)
    assert "amplitudes of x" in stacked
    without = fold_branch.to_svg(events=["period-doubling"])
    assert "fold" in fold_branch.to_svg() and "not marked: 1 fold" in without
    with pytest.raises(ValueError, match="cubic is no scale"):
        fold_branch.to_svg(scale="cubic")
    with pytest.raises(ValueError):
        fold_branch.to_svg(events=["peak"])
