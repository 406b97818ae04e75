"""Import path for the test worlds of plugins, sensors, controllers and motions."""

from __future__ import annotations

import sys
from pathlib import Path

TESTS = Path(__file__).parents[2]
for folder in ("plugins/worlds", "sensors", "testing/certify"):
    sys.path.insert(0, str(TESTS / folder))
for folder in ("control/tests", "control/tests/worlds", "motion/tests/worlds", "navigation/tests/worlds"):
    sys.path.insert(0, str(TESTS.parent / "packs" / folder))
