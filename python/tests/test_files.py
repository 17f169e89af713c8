"""Files: what is written is read back, and what the program `hertzian` writes."""

import os
import pathlib
import subprocess

import numpy as np
import pytest

import hertzian


def test_what_is_written_is_read_back(curve, duffing, tmp_path):
    path = tmp_path / "curve.json"
    curve.write(path)
    read = hertzian.Branch.read(path)
    assert read == curve
    assert np.array_equal(read.measured("x"), curve.measured("x"))
    # For further orbits it takes its model.
    with pytest.raises(hertzian.RequestError, match="the branch was read from a file and has no model"):
        read.at(1.3)
    with pytest.raises(hertzian.RequestError, match="has no model"):
        read.resume(to=2.1)
    read.attach(duffing)
    assert read.at(1.3) == curve.at(1.3) and len(read.at(1.3)) == 3
    assert hertzian.Branch.read(path, duffing).at(1.3) == curve.at(1.3)
    [same] = hertzian.Branch.read_all(path)
    assert same == curve


def test_another_model_is_refused(curve, linear, tmp_path):
    path = tmp_path / "curve.json"
    curve.write(path)
    with pytest.raises(hertzian.RequestError, match="the branch is one of Duffing, and Linear"):
        hertzian.Branch.read(path, linear)


def test_files_that_are_none_are_refused(tmp_path):
    with pytest.raises(hertzian.FileError) as caught:
        hertzian.Branch.read(tmp_path / "missing.json")
    assert caught.value.kind == "file" and isinstance(caught.value, OSError)
    path = tmp_path / "old.json"
    path.write_text('{"branches": []}')
    with pytest.raises(hertzian.FileError, match="version 1"):
        hertzian.Branch.read(path)
    path.write_text('{"version": 2, "branches": []}')
    with pytest.raises(hertzian.FileError, match="there is no branch in it"):
        hertzian.Branch.read(path)
    # Where there is none, there is none.
    assert hertzian.Branch.read_all(path) == []
    assert len(hertzian.Diagram.read(path)) == 0
    assert hertzian.Diagram.read(path).to_svg().startswith("<svg")


def test_a_branch_is_kept_while_it_is_followed(duffing, tmp_path):
    path = tmp_path / "kept.json"
    branch = duffing.response(0.8, 2.0, harmonics=5, keep=path)
    assert hertzian.Branch.read(path) == branch
    with pytest.raises(hertzian.FileError):
        duffing.response(0.8, 2.0, harmonics=5, keep=tmp_path / "missing" / "kept.json")


@pytest.mark.skipif("HERTZIAN_PROGRAM" not in os.environ, reason="HERTZIAN_PROGRAM does not say where the program hertzian is")
def test_files_of_the_program_are_read(tmp_path, duffing):
    text, path = tmp_path / "duffing.txt", tmp_path / "branch.json"
    text.write_text(duffing.text)
    program = pathlib.Path(os.environ["HERTZIAN_PROGRAM"])
    options = ["--model", text, "--set", "drive=0.2", "--harmonics", "5", "--from", "0.8", "--to", "2.0", "--one-branch"]
    subprocess.run([program, "response", "--quiet", *options, "--json", path, "--svg", tmp_path / "branch.svg"], check=True)
    branch = hertzian.Branch.read(path, duffing)
    # The same computation, to the last bit, but for the time that it took.
    here = duffing.response(0.8, 2.0, harmonics=5)
    assert branch.points == here.points and branch.events == here.events
    assert branch.at(1.3) == here.at(1.3)
