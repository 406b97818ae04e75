"""Lets the tests of this folder import its other modules, and the makers of wide SDF files."""

import faulthandler
import sys
from pathlib import Path

import pytest

for folder in ("fuzz", "loaders"):
    sys.path.insert(0, str(Path(__file__).parents[1] / folder))


@pytest.fixture(autouse=True)
def unlimited_time(request: pytest.FixtureRequest) -> None:
    """Let fuzz tests run longer than `faulthandler_timeout`; `Reader` limits the time of each input."""
    if request.node.get_closest_marker("fuzz"):
        faulthandler.cancel_dump_traceback_later()
