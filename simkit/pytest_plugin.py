"""The pytest fixtures `simkit_world` and `sensor_regression`.

A world in one line, closed when the test ends:

    def test_it_rolls(simkit_world):
        sim = simkit_world("ramp.sdf", plugins=[Brake(force=2.0)])
        sim.run(1.0)
        assert sim.model("cart").pose.position[0] < 0.1

What its sensors give, compared with what they gave (`pytest --simkit-update-golden` keeps that beside the test):

    def test_the_scan_is_as_it_was(sensor_regression):
        sensor_regression("ramp.sdf", duration=3.0)

pytest imports this module at every start, whether a test asks for a world or not: so nothing heavy is imported here.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import pytest

from simkit.diagnostics import shorten

if TYPE_CHECKING:
    from collections.abc import Generator, Iterable

    from simkit.diagnostics import Diagnostic
    from simkit.runtime import Simulation
    from simkit.testing.golden.pytest_fixture import SensorRegression

_OPENED: Final = pytest.StashKey["list[_Opened]"]()
_GOLDEN: Final = pytest.StashKey["list[str]"]()
_REASON: Final = "updated by a test"
_LONGEST: Final = 40  # letters of a text of SDF that stand for it in a report


class WorldOpener:
    """Opens worlds for one test; what the fixture `simkit_world` gives.

    Args:
        folder: of the test's file; a world is looked for there first.
        opened: where each one that was opened, or could not be, is noted for the report of a failure.
        stack: closes them at the end of the test, the last one first.
    """

    def __init__(self, folder: Path, opened: list[_Opened], stack: ExitStack) -> None:
        self._folder, self._opened, self._stack = folder, opened, stack

    def __call__(self, source: str | os.PathLike[str], **options: Any) -> Simulation:
        """A world, ready to step; closed when the test ends.

        Args:
            source: a file (relative to the test's own folder, or to the working directory), the bare name of a world or
                model that comes with simkit, or a text of SDF or URDF.
            options: as of `simkit.load`: `plugins`, `seed`, `plugin_paths`, `resource_paths`, `strict`, …

        Raises:
            LoadError: with every problem of the input.
            PluginError: a plugin raised while it was loaded.
        """
        import simkit

        opened = _Opened(_label(source))
        self._opened.append(opened)
        try:
            sim = simkit.load(self._found(source), **options)
        except simkit.LoadError as error:
            opened.refused = list(error.diagnostics)
            raise
        opened.sim = sim
        self._stack.callback(sim.close)
        return sim

    def _found(self, source: str | os.PathLike[str]) -> str | os.PathLike[str]:
        """The file beside the test where there is one; else what was given."""
        if "<" in str(source):
            return source
        beside = self._folder / source
        return beside if beside.is_file() else source


class _Opened:
    """A world that a test opened.

    Attributes:
        sim: the simulation; None where the world could not be opened.
        refused: why it could not.
    """

    def __init__(self, label: str, sim: Simulation | None = None) -> None:
        self.label, self.sim = label, sim
        self.refused: list[Diagnostic] = []

    def text(self) -> str:
        """Where the run stood, and every diagnostic; empty where nothing can be said."""
        if self.sim is None:
            return _lines(self.refused)
        stood = f"stood at {self.sim.time:.6g} s, after {self.sim.tick} steps of {self.sim.timestep:g} s"
        return "\n".join(filter(None, (stood, _lines(self.sim.diagnostics))))


@pytest.fixture
def simkit_world(request: pytest.FixtureRequest) -> Iterator[WorldOpener]:
    """Opens worlds, `simkit_world("w.sdf", plugins=[MyPlugin(gain=2)])`, and closes them when the test ends.

    Takes a file, a bare name or a text of SDF, and every option of `simkit.load`. Where the test fails, its report says
    what loading the world approximated or ignored.
    """
    opened: list[_Opened] = request.node.stash.setdefault(_OPENED, [])
    with ExitStack() as stack:
        yield WorldOpener(request.path.parent, opened, stack)


@pytest.fixture
def sensor_regression(request: pytest.FixtureRequest) -> Iterator[SensorRegression]:
    """Compares what sensors give with a golden run beside the test, `golden/FILE/TEST`.

    `sensor_regression("w.sdf", duration=3.0)` runs a world or a scenario; of a simulation that the test steps by itself
    `with sensor_regression.of(sim): …` listens. A test without a golden run fails; `--simkit-update-golden` writes it.
    """
    from simkit.testing.golden.pytest_fixture import GoldenLocation, SensorRegression

    opened: list[_Opened] = request.node.stash.setdefault(_OPENED, [])
    options, file = request.config.option, request.path
    reason = (options.simkit_golden_reason or _REASON) if options.simkit_update_golden else None
    # the name with its parameters; a class keeps methods of one name apart
    name = request.node.name if request.cls is None else f"{request.cls.__qualname__}.{request.node.name}"
    place = GoldenLocation(
        file.parent / "golden" / file.stem,
        name,
        file.parent,
        request.node.nodeid,
        reason,
        options.simkit_bless_other_renderer,
        Path(options.simkit_report).absolute() if options.simkit_report else None,
    )
    request.node.stash[_GOLDEN] = place.done
    with ExitStack() as stack:

        def keep(sim: Simulation, label: str) -> None:
            opened.append(_Opened(label, sim))
            stack.callback(sim.close)

        yield SensorRegression(place, keep)


def pytest_addoption(parser: pytest.Parser) -> None:
    """What the command line may say of golden runs."""
    group = parser.getgroup("simkit", "simkit: sensor outputs under regression")
    group.addoption(
        "--simkit-update-golden",
        action="store_true",
        help="write the golden runs of sensor_regression that are missing or differ",
    )
    group.addoption("--simkit-golden-reason", metavar="TEXT", default="", help="why that is right; kept with them")
    group.addoption(
        "--simkit-bless-other-renderer",
        action="store_true",
        help="write them also where pictures were drawn by another renderer",
    )
    group.addoption("--simkit-report", metavar="DIR", default="", help="a page for each golden run that differs")


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item: pytest.Item) -> Generator[None, pytest.TestReport, pytest.TestReport]:
    """Adds to the report of a failure what there is to say about the worlds that the test opened."""
    report = yield
    if report.failed and report.when != "setup":
        for opened in item.stash.get(_OPENED, ()):
            text = opened.text()
            if text:
                report.sections.append((f"simkit {opened.label}", text))
    if report.when == "call" and _GOLDEN in item.stash and item.stash[_GOLDEN]:
        vars(report)["simkit_golden"] = item.stash[_GOLDEN]  # plain texts, which come through from workers of xdist
    return report


def pytest_terminal_summary(terminalreporter: Any) -> None:
    """Says which golden runs were written."""
    reports = [report for some in terminalreporter.stats.values() for report in some]
    lines = sorted(line for report in reports for line in getattr(report, "simkit_golden", ()))
    if lines:
        terminalreporter.section("simkit golden runs")
        for line in lines:
            terminalreporter.line(line)


def _label(source: str | os.PathLike[str]) -> str:

    text = " ".join(str(source).split())
    return shorten(text, _LONGEST) if "<" in text else text


def _lines(found: Iterable[Diagnostic]) -> str:
    return "\n".join(map(str, found))
