"""Pytest configuration: makes the worlds of the core's tests of sensors importable."""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "tests" / "sensors"))
sys.path.insert(0, str(Path(__file__).resolve().parent))
