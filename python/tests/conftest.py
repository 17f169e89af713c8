"""Models that the tests share. Exact values come from an independent computation: the closed-form flow between switches in 80-bit
arithmetic for the exponent one (see the fields that they are quoted from)."""

import signal

import pytest

import hertzian

#: The oscillator of Wang, Zhang, Ying and Pang (2021) for the exponent one.
ONE_SIDED = """
OneSided(x) {
    /// damping ratio
    param zeta in 0.0..;
    /// normal load
    param load;
    /// excitation amplitude
    param drive;
    law contact(gap) { gap > 0 => 2*zeta*dot(gap) + gap, else => 0 }
    ddot(x) + contact(x) = drive*cos(omega*t) + load;
    /// twice the speed
    output speed = 2*dot(x);
}
"""

#: Known in closed form: the amplitude is drive/|4 - omega^2 + 2 i zeta omega|.
LINEAR = "Linear(x) { param zeta = 0.1; param drive = 3; ddot(x) + 2*zeta*dot(x) + 4*x = drive*cos(omega*t); }"

DUFFING = "Duffing(x) { param drive; ddot(x) + 0.1*dot(x) + x + x^3 = drive*cos(omega*t); }"


@pytest.fixture(autouse=True)
def ctrl_c():
    """What a shell begins in the background ignores Ctrl-C, and Python with it; the tests that send it themselves do not."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.fixture
def one_sided():
    return hertzian.Model(ONE_SIDED, zeta=0.032, load=1.0, drive=0.1)


@pytest.fixture
def linear():
    return hertzian.Model(LINEAR)


@pytest.fixture
def duffing():
    return hertzian.Model(DUFFING, drive=0.2)


@pytest.fixture(scope="session")
def fold_branch():
    """Around the upper fold of figure 5a of that paper, where the branch turns back."""
    model = hertzian.Model(ONE_SIDED, zeta=0.032, load=1.0, drive=0.1)
    return model.response(0.9, 1.0)


@pytest.fixture(scope="session")
def curve():
    """The response of a Duffing oscillator, by five harmonics."""
    return hertzian.Model(DUFFING, drive=0.2).response(0.8, 2.0, harmonics=5)
