"""Makes the small robots importable in these tests, and the worlds of the tests of simkit's plugins."""

from __future__ import annotations

import sys
from pathlib import Path

FOLDER = Path(__file__).parent
WORLDS = FOLDER.parents[2] / "tests" / "plugins" / "worlds"
sys.path[:0] = [str(FOLDER), str(FOLDER / "worlds"), str(WORLDS)]
