"""Import path for the test worlds of plugins, sensors, controllers and motions."""

from __future__ import annotations

import sys
from pathlib import Path

TESTS = Path(__file__).parents[2]
for folder in ("plugins/worlds", "sensors", "plugins/ros2_control", "plugins/play_motion", "testing/certify"):
    sys.path.insert(0, str(TESTS / folder))
sys.path.insert(0, str(TESTS.parent / "packs" / "navigation" / "tests" / "worlds"))
