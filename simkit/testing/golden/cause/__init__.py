"""Where differences come from; it knows no list of causes."""

from __future__ import annotations

from simkit.testing.golden.cause.explanation import explain, world_changes
from simkit.testing.golden.cause.rerun import rerun_scenario

__all__ = ["explain", "rerun_scenario", "world_changes"]
