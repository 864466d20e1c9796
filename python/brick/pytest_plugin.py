"""pytest fixtures: a controller in the test's hand, and the port of one for host software under test (docs/python.md).

`brick_controller` is a brick.Controller; when its test fails, what the test did to it is done once more with a
waveform. `brick_port` is the number of a free TCP port of 127.0.0.1 with a controller behind it; its waveform is made
from the start, with --brick-wave. A test chooses its controller by a marker:

    @pytest.mark.brick(plant="dac8", setup="dac8", seed=7)

Markers of a test, its class and its module add up; of one argument the closest has its way.
"""

from __future__ import annotations

import hashlib
import inspect
import pathlib
import re
from collections.abc import Generator
from typing import Any

import pytest

from brick.controller import Controller
from brick.errors import BrickError
from brick.served import Served

_CHOSEN = inspect.signature(Controller)
_CALLS_ALONE = ("wall_limit",)  # what says nothing of a port
_LONGEST = 200  # characters of a test's name in that of a file
_WAVES = pytest.StashKey[pathlib.Path | None]()
_REPORT = pytest.StashKey[dict[str, bool]]()


def pytest_addoption(parser: pytest.Parser) -> None:
    group = parser.getgroup("brick")
    group.addoption("--brick-engine", metavar="ENGINE", help="rtl, systemc or lockstep (default: systemc)")
    group.addoption("--brick-seed", type=int, metavar="N", help="seed of controllers whose test chooses none")
    group.addoption("--brick-wave", metavar="DIR",
                    help="folder of waveforms; with it brick_port makes one from the start of each test")


def pytest_configure(config: pytest.Config) -> None:
    folder = config.getoption("--brick-wave")
    config.stash[_WAVES] = pathlib.Path(folder).absolute() if folder else None  # before a test goes elsewhere
    config.addinivalue_line("markers", "brick(board, plant, setup, engine, seed, options, ...): the controller of "
                                       "brick_controller and brick_port, arguments of brick.Controller")


@pytest.hookimpl(hookwrapper=True)  # not wrapper=True, which the pluggy of Debian 12 does not know
def pytest_runtest_makereport(item: pytest.Item) -> Generator[None, Any, None]:
    outcome = yield
    report = outcome.get_result()
    item.stash.setdefault(_REPORT, {})[report.when or ""] = report.failed


def _of_marker(marker: pytest.Mark) -> dict[str, Any]:
    try:
        return _CHOSEN.bind_partial(*marker.args, **marker.kwargs).arguments
    except TypeError as error:
        wrong = str(error)
    pytest.fail(f"marker brick: {wrong}; expected arguments of brick.Controller: {', '.join(_CHOSEN.parameters)}",
                pytrace=False)


def _arguments(request: pytest.FixtureRequest) -> dict[str, Any]:
    chosen: dict[str, Any] = {}
    for name in ("engine", "seed"):
        value = request.config.getoption(f"--brick-{name}")
        if value is not None:
            chosen[name] = value
    for marker in reversed(list(request.node.iter_markers("brick"))):  # the closest is the last
        chosen |= _of_marker(marker)
    return chosen


def _wave(request: pytest.FixtureRequest, temporary: pathlib.Path) -> pathlib.Path:
    """A name of its own for each test, whatever process of pytest-xdist runs it and whatever characters it has."""
    place = request.config.stash[_WAVES] or temporary
    place.mkdir(parents=True, exist_ok=True)
    name = request.node.nodeid
    digits = hashlib.sha256(name.encode(errors="surrogateescape")).hexdigest()[:8]
    readable = re.sub(r"[^\w.-]+", "-", name).strip("-")[:_LONGEST]
    return place.absolute() / f"{readable}-{digits}.fst"


@pytest.fixture
def brick_controller(request: pytest.FixtureRequest, tmp_path: pathlib.Path) -> Generator[Controller, None, None]:
    """A started controller, a new one for each test."""
    controller = Controller(**_arguments(request))
    try:
        yield controller
    finally:
        if not request.node.stash.get(_REPORT, {}).get("call"):
            controller.close()
        else:
            _replay(request, controller, _wave(request, tmp_path))


def _replay(request: pytest.FixtureRequest, controller: Controller, wave: pathlib.Path) -> None:
    try:
        controller.abandon()
        controller.replay(str(wave))
        said = f"its {len(controller.calls)} calls once more: waveform {wave}"
    except BrickError as error:
        said = f"its calls once more: {error}"
    request.node.add_report_section("call", "brick", said)
    print(f"brick_controller: {said}")


@pytest.fixture
def brick_port(request: pytest.FixtureRequest, tmp_path: pathlib.Path) -> Generator[int, None, None]:
    """The port of a started controller, which speaks the protocol of docs/ethernet.md; a new one for each test."""
    arguments = {name: value for name, value in _arguments(request).items() if name not in _CALLS_ALONE}
    if request.config.stash[_WAVES]:
        arguments.setdefault("wave", str(_wave(request, tmp_path)))
    with Served(**arguments) as served:
        yield served.port
    if "wave" in arguments:
        print(f"brick_port: waveform {arguments['wave']}")
