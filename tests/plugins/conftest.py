"""Lets the tests here share their small worlds, and know whether there is a renderer."""

from __future__ import annotations

import sys
from pathlib import Path

for folder in ("plugins/worlds", "sensors"):
    sys.path.insert(0, str(Path(__file__).parents[1] / folder))
