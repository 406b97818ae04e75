"""Pytest fixtures `simkit_world` and `sensor_regression`.

A test opens a world in one line; the fixture closes it when the test ends:

    def test_it_rolls(simkit_world):
        sim = simkit_world("ramp.sdf", plugins=[Brake(force=2.0)])
        sim.run(1.0)
        assert sim.model("cart").pose.position[0] < 0.1

A test compares sensor outputs with a golden run; `pytest --simkit-update-golden` writes it beside the test:

    def test_the_scan_is_as_it_was(sensor_regression):
        sensor_regression("ramp.sdf", duration=3.0)

pytest imports this module at every start, even if no test opens a world. Therefore the module imports nothing heavy.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Final, Unpack

import pytest

from simkit.diagnostics import shorten
from simkit.number_text import counted
from simkit.run_fields import LoadArguments

if TYPE_CHECKING:
    from collections.abc import Generator, Iterable

    from simkit.diagnostics import Diagnostic
    from simkit.runtime import Simulation
    from simkit.testing.golden.pytest_fixture import SensorRegression

_OPENED: Final = pytest.StashKey["list[_Opened]"]()
_GOLDEN: Final = pytest.StashKey["list[str]"]()
_REASON: Final = "updated by a test"
_LONGEST: Final = 40  # characters of an SDF text that a report shows as its name


class WorldOpener:
    """Function object of the fixture `simkit_world`; opens worlds for one test.

    Args:
        folder: folder of the test file; worlds are searched there first.
        opened: list that receives every world, with the diagnostics of a failed load, for the report of a failed test.
        stack: closes the worlds at the end of the test, the last world first.
    """

    def __init__(self, folder: Path, opened: list[_Opened], stack: ExitStack) -> None:
        self._folder, self._opened, self._stack = folder, opened, stack

    def __call__(self, source: str | os.PathLike[str], **options: Unpack[LoadArguments]) -> Simulation:
        """Open a world that is ready to step; it is closed when the test ends.

        Args:
            source: file (relative to the test's folder or to the working directory), bare name, or text of SDF or URDF.
                A bare name selects a world or model that is shipped with simkit.
            options: options of `simkit.load`: `plugins`, `seed`, `plugin_paths`, `resource_paths`, `strict`, …

        Raises:
            LoadError: the input has errors; the exception lists all of them.
            PluginError: a plugin raised while it was loaded.
        """
        import simkit

        opened = _Opened(_label(source))
        self._opened.append(opened)
        try:
            sim = simkit.load(self._resolve(source), **options)
        except simkit.LoadError as error:
            opened.refused = list(error.diagnostics)
            raise
        opened.sim = sim
        self._stack.callback(sim.close)
        return sim

    def _resolve(self, source: str | os.PathLike[str]) -> str | os.PathLike[str]:
        """Return the path of the file in the test's folder if it exists, else the source unchanged."""
        if "<" in str(source):
            return source
        beside = self._folder / source
        return beside if beside.is_file() else source


class _Opened:
    """World that a test opened.

    Attributes:
        sim: the simulation; None if the world could not be loaded.
        refused: diagnostics of a failed load.
    """

    def __init__(self, label: str, sim: Simulation | None = None) -> None:
        self.label, self.sim = label, sim
        self.refused: list[Diagnostic] = []

    def text(self) -> str:
        """Return the progress of the run and every diagnostic."""
        if self.sim is None:
            return _lines(self.refused)
        progress = (
            f"stopped at {self.sim.time:.6g} s, after {counted(self.sim.tick, 'step')} of {self.sim.timestep:g} s"
        )
        return "\n".join(filter(None, (progress, _lines(self.sim.diagnostics))))


@pytest.fixture
def simkit_world(request: pytest.FixtureRequest) -> Iterator[WorldOpener]:
    """Open worlds, `simkit_world("w.sdf", plugins=[MyPlugin(gain=2)])`, and close them when the test ends.

    The fixture accepts a file, a bare name or SDF text, and every option of `simkit.load`. The report of a failed test
    lists everything that the load approximated or ignored.
    """
    opened: list[_Opened] = request.node.stash.setdefault(_OPENED, [])
    with ExitStack() as stack:
        yield WorldOpener(request.path.parent, opened, stack)


@pytest.fixture
def sensor_regression(request: pytest.FixtureRequest) -> Iterator[SensorRegression]:
    """Compare sensor outputs with a golden run beside the test, `golden/FILE/TEST`.

    `sensor_regression("w.sdf", duration=3.0)` runs a world or a scenario. `with sensor_regression.of(sim): …` observes
    a simulation that the test itself steps. A test without a golden run fails; `--simkit-update-golden` writes it.
    """
    from simkit.testing.golden.pytest_fixture import GoldenLocation, SensorRegression

    opened: list[_Opened] = request.node.stash.setdefault(_OPENED, [])
    options, file = request.config.option, request.path
    reason = (options.simkit_golden_reason or _REASON) if options.simkit_update_golden else None
    # the test's name with its parameters, and with its class, because two classes may have methods of one name
    name = request.node.name if request.cls is None else f"{request.cls.__qualname__}.{request.node.name}"
    location = GoldenLocation(
        file.parent / "golden" / file.stem,
        name,
        file.parent,
        request.node.nodeid,
        reason,
        options.simkit_bless_other_renderer,
        Path(options.simkit_report).absolute() if options.simkit_report else None,
    )
    request.node.stash[_GOLDEN] = location.done
    with ExitStack() as stack:

        def keep(sim: Simulation, label: str) -> None:
            opened.append(_Opened(label, sim))
            stack.callback(sim.close)

        yield SensorRegression(location, keep)


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the command-line options for golden runs."""
    group = parser.getgroup("simkit", "simkit: sensor outputs under regression")
    group.addoption(
        "--simkit-update-golden",
        action="store_true",
        help="write the golden runs of sensor_regression that are missing or differ",
    )
    group.addoption(
        "--simkit-golden-reason", metavar="TEXT", default="", help="reason of the update; stored with the golden runs"
    )
    group.addoption(
        "--simkit-bless-other-renderer",
        action="store_true",
        help="write golden runs even if another renderer drew their images",
    )
    group.addoption(
        "--simkit-report", metavar="DIR", default="", help="write a report page for each golden run that differs"
    )


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item: pytest.Item) -> Generator[None, pytest.TestReport, pytest.TestReport]:
    """Add the state and diagnostics of the opened worlds to the report of a failure."""
    report = yield
    if report.failed and report.when != "setup":
        for opened in item.stash.get(_OPENED, ()):
            text = opened.text()
            if text:
                report.sections.append((f"simkit {opened.label}", text))
    if report.when == "call" and _GOLDEN in item.stash and item.stash[_GOLDEN]:
        vars(report)["simkit_golden"] = item.stash[_GOLDEN]  # plain texts, which workers of pytest-xdist can send
    return report


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """List the golden runs that were written."""
    reports = [report for some in terminalreporter.stats.values() for report in some]
    lines = sorted(line for report in reports for line in getattr(report, "simkit_golden", ()))
    if lines:
        terminalreporter.section("simkit golden runs")
        for line in lines:
            terminalreporter.line(line)


def _label(source: str | os.PathLike[str]) -> str:
    text = " ".join(str(source).split())
    return shorten(text, _LONGEST) if "<" in text else text


def _lines(diagnostics: Iterable[Diagnostic]) -> str:
    return "\n".join(map(str, diagnostics))
