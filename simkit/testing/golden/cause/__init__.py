"""Search for the cause of a difference between two runs: rerun the scenario and undo single changes.

The inputs are two records and their comparison. The result is an `Explanation`. The search has no list of known causes.
It tests every difference in the inputs within its time limit. It writes no files.
"""

from __future__ import annotations

from simkit.testing.golden.cause.explanation import explain, world_changes
from simkit.testing.golden.cause.rerun import rerun_scenario

__all__ = ["explain", "rerun_scenario", "world_changes"]
