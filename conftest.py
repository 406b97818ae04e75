"""What all tests stand on."""

from __future__ import annotations

import signal

import pytest

from simkit.packs import shipped_packs

if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    # A shell that begins the tests in the background has interrupts ignored, and a process that a test begins would
    # take that over: then no interrupt ends it.
    signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture(scope="session", autouse=True)
def _base_folder(tmp_path_factory: pytest.TempPathFactory) -> None:
    """Create the folder of all tests before a test changes the place of temporary files."""
    tmp_path_factory.getbasetemp()


def pytest_runtest_setup(item: pytest.Item) -> None:
    """Skip tests of the core with plugins of packs where only the core is installed."""
    if item.get_closest_marker("needs_packs") is not None and not shipped_packs():
        pytest.skip("the packs of simkit are not installed")
