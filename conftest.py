"""What all tests stand on."""

from __future__ import annotations

import gc
import os
import signal
import sys
import tempfile
from collections.abc import Iterator

import pytest

from simkit.garbage_collection import no_collection
from simkit.packs import shipped_packs
from simkit.plugins.discovery.left_out import LeftOutParts

if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    # A shell that begins the tests in the background has interrupts ignored, and a process that a test begins would
    # take that over: then no interrupt ends it.
    signal.signal(signal.SIGINT, signal.default_int_handler)

# Containers often set this variable. Then each process that a test begins compiles all of simkit, which doubles its
# time, and each run rewrites the assertions of all tests again, which takes 15 s of 26 s of the collection.
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
sys.dont_write_bytecode = False


@pytest.fixture(scope="session", autouse=True)
def _own_folders(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Give the tests of this process, and the processes that they start, a folder of their own for sockets.

    Otherwise a client without the name of a simulation also finds those of other test processes of the same user.
    The folder of all tests is created before, because it is in the folder of temporary files. The path is short: that
    of a socket has room for about 100 bytes.
    """
    tmp_path_factory.getbasetemp()
    if os.name != "posix":
        yield
        return
    place = tempfile.TemporaryDirectory(prefix="sk", dir="/tmp", ignore_cleanup_errors=True)
    with place as folder, pytest.MonkeyPatch.context() as patch:
        for name in ("XDG_RUNTIME_DIR", "TMPDIR"):
            patch.setenv(name, folder)
        patch.setattr(tempfile, "tempdir", None)
        patch.delenv("SIMKIT_SIM", raising=False)
        yield


@pytest.fixture(scope="session", autouse=True)
def _empty_present_folder(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Run the tests in an empty folder, which stays empty.

    A world of text and a node of a package search packages around the present folder. In a checkout this search lists
    900 folders for each simulation, and those of other checkouts beside it.
    """
    folder = tmp_path_factory.mktemp("present_folder")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        yield
    assert list(folder.iterdir()) == [], "a test wrote files to the present folder"


@pytest.hookimpl(hookwrapper=True)
def pytest_collection() -> Iterator[None]:
    """Collect the tests without the garbage collector, which then never scans them.

    To collect 13 000 tests took 30 s of processor time in each process, and 20 s without the garbage collector. While
    the tests run, it begins after 10 000 new objects: with 700 (Python's default), it took 9 % of the time.
    """
    with no_collection():
        yield
    gc.freeze()
    gc.set_threshold(10_000, 10, 10)


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
