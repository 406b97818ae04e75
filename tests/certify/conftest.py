"""Lets the tests here share their worlds with those of plugins, sensors, controllers and motions."""

from __future__ import annotations

import sys
from pathlib import Path

for folder in ("plugins", "sensors", "control", "motion", "certify"):
    sys.path.insert(0, str(Path(__file__).parents[1] / folder))
