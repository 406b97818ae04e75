"""Where differences come from; it knows no list of causes."""

from __future__ import annotations

from simkit.golden.cause.again import rerun_scenario
from simkit.golden.cause.explanation import explain, world_changes

__all__ = ["explain", "rerun_scenario", "world_changes"]
