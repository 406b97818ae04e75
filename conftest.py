"""What all tests stand on."""

from __future__ import annotations

import gc
import signal
from collections.abc import Iterator

import pytest

from simkit.garbage_collection import no_collection
from simkit.packs import shipped_packs
from simkit.plugins.discovery.left_out import LeftOutParts

if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    # A shell that begins the tests in the background has interrupts ignored, and a process that a test begins would
    # take that over: then no interrupt ends it.
    signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture(scope="session", autouse=True)
def _base_folder(tmp_path_factory: pytest.TempPathFactory) -> None:
    """Create the folder of all tests before a test changes the place of temporary files."""
    tmp_path_factory.getbasetemp()


@pytest.hookimpl(hookwrapper=True)
def pytest_collection() -> Iterator[None]:
    """Collect the tests without the garbage collector, which then never scans them.

    To collect 13 000 tests took 30 s of processor time in each process, and 20 s without the garbage collector.
    """
    with no_collection():
        yield
    gc.freeze()


def pytest_runtest_setup(item: pytest.Item) -> None:
    """Skip tests of the core with plugins of packs where only the core is installed."""
    if item.get_closest_marker("needs_packs") is not None and not shipped_packs():
        pytest.skip("the packs of simkit are not installed")


@pytest.fixture(autouse=True)
def _errors_of_parts_stop(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Let an error of a sensor or plugin stop the load, as with `strict`, so that the tests of errors read the error.

    A test with the marker `leaves_out` sees what a user sees: the world runs without the sensor or plugin.
    """
    if request.node.get_closest_marker("leaves_out") is None:
        create = LeftOutParts.__init__
        monkeypatch.setattr(LeftOutParts, "__init__", lambda self, **_: create(self, strict=True))
