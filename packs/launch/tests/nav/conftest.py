"""Worlds of the tests of navigation, which these tests share."""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[3] / "navigation" / "tests" / "worlds"))
