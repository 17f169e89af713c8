"""A model from text."""

import copy
import math
import pickle

import numpy as np
import pytest

import hertzian
from conftest import ONE_SIDED


def test_a_model_says_what_it_consists_of(one_sided):
    facts = one_sided.facts
    assert facts.name == "OneSided"
    assert facts.equation.splitlines()[0] == "ddot(x) + contact(x) = drive*cos(omega*t) + load"
    assert facts.coordinates == ["x"]
    assert [parameter.name for parameter in facts.parameters] == ["zeta", "load", "drive"]
    assert facts.parameters[0].documentation == "damping ratio"
    assert [(output.name, output.documentation) for output in facts.outputs] == [("speed", "twice the speed")]
    assert (facts.contacts, facts.pieces) == (["contact"], [2])
    assert "zeta=0.032" in repr(one_sided)


def test_parameters_are_set_by_name(one_sided):
    assert one_sided.parameters == {"zeta": 0.032, "load": 1.0, "drive": 0.1}
    one_sided.set(drive=np.float64(0.2), load=2)
    assert one_sided.parameters == {"zeta": 0.032, "load": 2.0, "drive": 0.2}
    # All of them, or none.
    with pytest.raises(hertzian.RequestError, match="there is no parameter force; there are zeta, load, drive"):
        one_sided.set(drive=0.3, force=1.0)
    assert one_sided.parameters["drive"] == 0.2
    with pytest.raises(TypeError, match="the value of parameter drive must be a number"):
        one_sided.set(drive="large")


def test_a_parameter_without_a_value_is_refused_by_name():
    model = hertzian.Model(ONE_SIDED, zeta=0.1, load=1.0)
    assert math.isnan(model.parameters["drive"])
    with pytest.raises(hertzian.RequestError, match="parameter drive = NaN"):
        model.response(0.9, 1.0)


def test_faults_of_a_declaration_have_their_places():
    with pytest.raises(hertzian.DeclarationError) as caught:
        hertzian.Model("A(x) {\n  ddot(x) + k*x = 0;\n}")
    error = caught.value
    assert isinstance(error, hertzian.ModelError) and isinstance(error, ValueError)
    assert error.kind == "model"
    [(line, column, message)] = error.faults
    assert (line, column) == (2, 13)
    assert "unknown name `k`" in message
    assert str(error) == f"2:13: {message}"
    with pytest.raises(hertzian.DeclarationError):
        hertzian.Model("")


def test_a_model_is_read_from_a_file(tmp_path, one_sided):
    path = tmp_path / "model.txt"
    path.write_text(ONE_SIDED)
    model = hertzian.Model.read(path, zeta=0.032, load=1.0, drive=0.1)
    assert model.parameters == one_sided.parameters
    assert model.text == ONE_SIDED
    with pytest.raises(FileNotFoundError):
        hertzian.Model.read(tmp_path / "missing.txt")


def test_models_are_copied_and_pickled():
    model = hertzian.Model(ONE_SIDED, zeta=0.1, load=1.0)
    for other in [copy.copy(model), pickle.loads(pickle.dumps(model))]:
        assert other.text == model.text
        assert other.parameters["zeta"] == 0.1
        assert math.isnan(other.parameters["drive"])
        other.set(zeta=0.2)
    assert model.parameters["zeta"] == 0.1
