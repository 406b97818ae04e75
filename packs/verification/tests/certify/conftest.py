"""Import path for the test worlds of plugins, sensors, controllers and motions."""

from __future__ import annotations

import sys
from pathlib import Path

ROOT = Path(__file__).parents[4]
sys.path.insert(0, str(Path(__file__).parent))
for folder in ("plugins/worlds", "sensors"):
    sys.path.insert(0, str(ROOT / "tests" / folder))
for folder in (
    "control/tests",
    "control/tests/worlds",
    "water_and_air/tests",
    "motion/tests/worlds",
    "navigation/tests/worlds",
):
    sys.path.insert(0, str(ROOT / "packs" / folder))
