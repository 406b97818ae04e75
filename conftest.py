"""What all tests stand on."""

from __future__ import annotations

import signal

import pytest

if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    # A shell that begins the tests in the background has interrupts ignored, and a process that a test begins would
    # take that over: then no interrupt ends it.
    signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture(scope="session", autouse=True)
def _base_folder(tmp_path_factory: pytest.TempPathFactory) -> None:
    """Create the folder of all tests before a test changes the place of temporary files."""
    tmp_path_factory.getbasetemp()
