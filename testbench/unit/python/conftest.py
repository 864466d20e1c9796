"""Fixtures of the tests of the package."""

import signal

import brick
import pytest
from support import Alarm


@pytest.fixture(scope="module")
def moving():
    with brick.Controller(plant="dac8", setup="dac8") as controller:
        yield controller


@pytest.fixture
def alarm():
    def ring(number, frame):
        raise Alarm

    before = signal.signal(signal.SIGALRM, ring)
    yield lambda seconds: signal.setitimer(signal.ITIMER_REAL, seconds)
    signal.setitimer(signal.ITIMER_REAL, 0)
    signal.signal(signal.SIGALRM, before)
