"""Fixtures of the plugin tests: shared small worlds."""

from __future__ import annotations

import sys
from pathlib import Path

sys.path[:0] = [str(Path(__file__).parent), str(Path(__file__).parent / "worlds")]
