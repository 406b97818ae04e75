"""Fixtures of the plugin tests: shared small worlds, and whether a renderer is available."""

from __future__ import annotations

import sys
from pathlib import Path

for folder in ("plugins/worlds", "sensors"):
    sys.path.insert(0, str(Path(__file__).parents[1] / folder))
