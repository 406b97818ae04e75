"""Fixtures of the plugin tests: shared small worlds."""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent / "worlds"))
sys.path.insert(0, str(Path(__file__).parent / "classic"))
