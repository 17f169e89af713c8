"""Bifurcations and what begins at them, against exact values."""

import numpy as np
import pytest

import hertzian

#: The drive at which the period of figure 8 doubles (A1), and where that of the branch which begins there doubles (A4): from the
#: closed-form flow between switches with 60-digit arithmetic.
DOUBLING = 1.282584167663767668720010816491575130915
SECOND = 1.531044135499983048113838266945532267642


def test_a_doubling_and_the_branch_that_begins_there(one_sided):
    branch = one_sided.response(1.2, 1.4, vary="drive", omega=1.0, by=hertzian.Shooting())
    [doubling] = [event for event in branch.events if event.kind == "period-doubling"]
    assert abs(doubling.value - DOUBLING) < 1e-11
    assert not doubling.turns
    longer = branch.switch(doubling)
    assert longer.period == 2
    assert abs(longer.values[0] - DOUBLING) < 1e-3
    with pytest.raises(ValueError, match="left is no side"):
        branch.switch(doubling, "left")
    curve = branch.track(doubling, "zeta", [0.03, 0.033])
    assert (curve.kind, curve.names, curve.period) == ("period-doubling", ("drive", "zeta"), 1)
    assert curve.values.shape == (len(curve), 2) and curve.states.shape == (len(curve), 2)
    assert curve.peak_to_peak.shape == (len(curve),) and np.all(curve.peak_to_peak > 0.0)
    # It passes through the doubling.
    drive = np.interp(0.032, curve.values[:, 1], curve.values[:, 0])
    assert abs(drive - DOUBLING) < 1e-3
    assert [end.kind for end in curve.ends] == ["reached-end", "reached-end"]


def test_a_diagram_says_what_begins_where(one_sided, tmp_path):
    diagram = one_sided.bifurcations(1.25, 1.56, vary="drive", omega=1.0, depth=1)
    first, second = diagram.branches
    assert (first.origin.kind, first.depth, first.period) == ("first", 0, 1)
    assert second.origin.kind == "event" and second.origin.values["branch"] == 0
    assert (second.depth, second.period, second.mirrored) == (1, 2, False)
    doublings = dict(diagram.events("period-doubling"))
    assert abs(doublings[0].value - DOUBLING) < 1e-11
    assert abs(doublings[1].value - SECOND) < 1e-11
    assert [omitted.reason for omitted in diagram.omitted if omitted.branch == 1] == ["deeper than asked for"]
    assert diagram.uncovered.shape == (0, 2) and diagram.missed == []
    at = diagram.solutions_at(1.4)
    assert sorted(orbit.point.orbit.period for orbit in at.orbits) == [1, 2]
    with pytest.raises(ValueError, match="hopf is no kind of events"):
        diagram.events("hopf")
    path = tmp_path / "diagram.json"
    diagram.write(path)
    read = hertzian.Diagram.read(path, one_sided)
    assert [branch.branch for branch in read.branches] == [first.branch, second.branch]
    assert [branch.depth for branch in read.branches] == [0, 1]
    assert [omitted.reason for omitted in read.omitted] == [omitted.reason for omitted in diagram.omitted]
    assert "period 2" in diagram.to_svg()


def test_a_range_is_covered(duffing):
    diagram = duffing.cover(0.9, 1.4, harmonics=5)
    assert len(diagram) == 1 and diagram.uncovered.shape == (0, 2)
    searched = duffing.bifurcations(1.25, 1.35, depth=0, cover=hertzian.Settling(starts=6), settled_at=[1.3]).searched
    at = [searched for searched in searched if searched.value == 1.3]
    assert len(at[0].fates) == 6
    # Two stable orbits, and motions that settle to each.
    assert {orbit.period for orbit in at[0].orbits} == {1} and set(at[0].fates) == {0, 1}


def test_a_map_counts_what_exists(one_sided, tmp_path):
    # Folds at a drive of 0.1 are at 0.7151 and 0.9602; at 0.02 the contact is never lost.
    found = one_sided.map([0.7, 0.9], 0.65, 1.05, "drive", [0.02, 0.1], by=hertzian.Shooting())
    assert found.names == ("omega", "drive")
    assert found.columns.tolist() == [0.7, 0.9] and found.rows.tolist() == [0.02, 0.1]
    assert found.stable.tolist() == [[1, 1], [1, 2]]
    assert found.unstable.tolist() == [[0, 0], [0, 1]]
    assert found.verdicts[1][1] == "stable and unstable"
    # Without contact lost the mass is on a linear spring: the amplitude is drive over that of its stiffness; the output is twice the speed.
    stiffness = np.abs(1 - 0.7**2 + 2j * 0.032 * 0.7)
    assert found.signal == "speed"
    assert abs(found.largest[0, 0] / (2 * 0.7 * 2 * 0.02 / stiffness) - 1) < 1e-5
    path = tmp_path / "map.json"
    found.write(path)
    assert hertzian.Map.read(path) == found
    for of in ["stable", "largest", "verdict"]:
        found.plot(tmp_path / "map.svg", of)
        assert "drive" in (tmp_path / "map.svg").read_text()
    with pytest.raises(ValueError, match="peak is no chart of a map"):
        found.plot(tmp_path / "map.svg", "peak")
    with pytest.raises(hertzian.RequestError):
        one_sided.map([0.7], 0.65, 1.05, "omega", [0.02])
