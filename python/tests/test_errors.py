"""What goes wrong is said in the sentences of the library."""

import math

import pytest

import hertzian


def test_a_request_at_fault_is_refused_before_any_work(one_sided):
    with pytest.raises(hertzian.RequestError) as caught:
        one_sided.response(0.9, 1.0, vary="force", omega=1.0)
    error = caught.value
    assert str(error) == "there is no parameter force; there are zeta, load, drive"
    assert error.kind == "request" and isinstance(error, ValueError)
    assert 'name: "force"' in error.details
    for arguments, sentence in [
        ((1.0, 1.0), "the range is empty: from and to are both 1"),
        ((-1.0, 1.0), "omega = -1: must be positive"),
        ((math.nan, 1.0), "NaN"),
    ]:
        with pytest.raises(hertzian.RequestError, match=sentence):
            one_sided.response(*arguments)


def test_arguments_that_are_none_are_named(one_sided):
    with pytest.raises(TypeError, match="response\\(\\) got an unexpected keyword argument 'harmonic'"):
        one_sided.response(0.9, 1.0, harmonic=3)
    with pytest.raises(TypeError, match="response\\(\\) argument 'tolerance'"):
        one_sided.response(0.9, 1.0, tolerance="fine")
    with pytest.raises(TypeError, match="harmonics is an option of the harmonic balance"):
        one_sided.response(0.9, 1.0, by=hertzian.Shooting(), harmonics=3)
    with pytest.raises(TypeError, match="by is a method"):
        one_sided.response(0.9, 1.0, by="shooting")
    with pytest.raises(TypeError, match="near_orbit is an Orbit or a Point"):
        one_sided.orbit(0.9, near_orbit=[1.0])


def test_no_orbit_is_an_error_of_its_kind():
    # Nothing holds it, and a constant force moves it on.
    model = hertzian.Model("Pushed(x) { ddot(x) + 0.1*dot(x) = 1 + cos(omega*t); }")
    with pytest.raises(hertzian.HertzianError) as caught:
        model.orbit(1.0)
    assert caught.value.kind in ("no-orbit", "model", "limit")
    assert str(caught.value)


def test_a_branch_that_ends_early_says_why(duffing):
    branch = duffing.response(0.8, 2.0, harmonics=5, max_points=5)
    assert len(branch) == 5
    assert branch.stopped.kind == "point-limit" and branch.stopped.values == {"points": 5}
    assert str(branch.stopped) == "reached the limit of 5 points"
    # Nothing is lost: it goes on where it was.
    whole = duffing.response(0.8, 2.0, harmonics=5)
    resumed = branch.resume(max_points=1000)
    assert resumed.points == whole.points and resumed.events == whole.events


def test_numbers_of_errors_are_read(one_sided):
    with pytest.raises(hertzian.RequestError) as caught:
        one_sided.response(-1.0, 1.0)
    error = caught.value
    assert error.variant == "Option" and error.values == {"value": -1.0}
    with pytest.raises(hertzian.DeclarationError) as caught:
        hertzian.Model("One(x) { ddot(x) + z = 0; }")
    error = caught.value
    line, column, _ = error.faults[0]
    assert error.values == {"line": line, "column": column}


def test_every_class_of_errors_has_its_kind():
    kinds = {
        "RequestError": "request",
        "ModelError": "model",
        "DeclarationError": "model",
        "NoOrbitError": "no-orbit",
        "LimitError": "limit",
        "MotionError": "motion",
        "CancelledError": "cancelled",
        "FileError": "file",
        "ResourceError": "system",
    }
    for name, kind in kinds.items():
        error = getattr(hertzian, name)
        assert issubclass(error, hertzian.HertzianError) and error.kind == kind
    assert issubclass(hertzian.FileError, OSError)
