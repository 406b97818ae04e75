"""Makes the worlds of the tests of simkit's plugins importable."""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[3] / "tests" / "plugins" / "worlds"))
