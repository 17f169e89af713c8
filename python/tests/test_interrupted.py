"""Ctrl-C, callbacks, and the interpreter's lock."""

import signal
import threading
import time

import numpy as np
import pytest

import hertzian


@pytest.fixture
def long():
    """A basin that takes minutes."""
    model = hertzian.Model("TwoWells(x) { param drive = 0.3; ddot(x) + 0.1*dot(x) - x + x^3 = drive*cos(omega*t); }")
    axes = [hertzian.Axis(entry, -2.0, 2.0, cells=300) for entry in ["x", "dot(x)"]]
    return lambda **options: model.basin(*axes, omega=1.2, **options)


def interrupted_after(seconds):
    """Ctrl-C after some time."""
    timer = threading.Timer(seconds, signal.raise_signal, [signal.SIGINT])
    timer.daemon = True
    timer.start()
    return timer


def test_ctrl_c_keeps_what_was_computed(long):
    interrupted_after(0.3)
    started = time.monotonic()
    with pytest.raises(KeyboardInterrupt) as caught:
        long()
    assert time.monotonic() - started < 20.0
    basins = caught.value.result
    assert not basins.complete
    assert basins.fates.shape == (300, 300)
    assert np.all(basins.fates[basins.fates < 0] >= hertzian.Fate.UNKNOWN)
    assert basins.count(hertzian.Fate.UNKNOWN) > 0


def test_ctrl_c_keeps_a_branch_that_is_resumed_to_the_same_bits(duffing):
    def slowly(progress):
        if progress.done == 8:
            signal.raise_signal(signal.SIGINT)
        if progress.done >= 8:
            time.sleep(0.2)

    with pytest.raises(KeyboardInterrupt) as caught:
        duffing.response(0.8, 2.0, harmonics=5, progress=slowly)
    part = caught.value.result
    whole = duffing.response(0.8, 2.0, harmonics=5)
    assert part.stopped.kind == "interrupted"
    assert 8 <= len(part) < len(whole)
    assert part.resume().points == whole.points


def test_ctrl_c_before_there_is_a_result(one_sided):
    # What a handler raises ends a computation, whatever it is.
    class Alarm(Exception):
        pass

    def handler(number, frame):
        raise Alarm

    before = signal.signal(signal.SIGINT, handler)
    try:
        timer = interrupted_after(0.05)
        with pytest.raises(Alarm) as caught:
            while timer.is_alive() or not timer.finished.is_set():
                one_sided.history([0.0, 0.0], omega=1.0, periods=200_000, samples=1)
        times, states = caught.value.result or (np.zeros(0), np.zeros((0, 2)))
        assert len(times) == len(states)
    finally:
        signal.signal(signal.SIGINT, before)


def test_a_callback_sees_progress_and_stops(duffing):
    seen = []

    def callback(progress):
        seen.append((progress.stage, progress.done))
        if progress.stage == "branch":
            assert progress.point.value == progress.value
            assert progress.point.measured("x:rms") > 0.0
        return progress.done < 10 or progress.stage != "branch"

    branch = duffing.response(0.8, 2.0, harmonics=5, progress=callback)
    assert branch.stopped.kind == "interrupted" and len(branch) == 10
    assert seen[-1] == ("branch", 10)


def test_what_a_callback_raises_goes_on_with_what_was_computed(duffing):
    def callback(progress):
        if progress.done == 5:
            raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough") as caught:
        duffing.response(0.8, 2.0, harmonics=5, progress=callback)
    assert len(caught.value.result) == 5
    with pytest.raises(TypeError, match="argument 'progress' must be callable"):
        duffing.response(0.8, 2.0, progress=3)


def test_other_threads_run_meanwhile(long):
    counted = 0
    ended = threading.Event()

    def count():
        nonlocal counted
        while not ended.is_set():
            counted += 1
            time.sleep(0.002)

    thread = threading.Thread(target=count)
    thread.start()
    # One call, without a callback that would release the lock.
    interrupted_after(0.5)
    with pytest.raises(KeyboardInterrupt):
        before = counted
        long()
    while_computing = counted - before
    ended.set()
    thread.join()
    assert while_computing > 20


def test_models_are_followed_in_threads(duffing):
    def follow(drive, results):
        model = hertzian.Model(duffing.text, drive=drive)
        results[drive] = model.response(0.8, 1.2, harmonics=3)

    results = {}
    threads = [threading.Thread(target=follow, args=(drive, results)) for drive in [0.1, 0.2]]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert results[0.2] == results[0.2] and results[0.1] != results[0.2]
    assert results[0.2].points == duffing.response(0.8, 1.2, harmonics=3).points
