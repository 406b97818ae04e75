"""Find the change that a difference between two runs comes from, by running again with single changes undone.

Two records and their comparison enter, an `Explanation` leaves. It knows no list of causes: what differs in the inputs
is tried out, as long as the time allows. No file is written.
"""

from __future__ import annotations

from simkit.testing.golden.cause.explanation import explain, world_changes
from simkit.testing.golden.cause.rerun import rerun_scenario

__all__ = ["explain", "rerun_scenario", "world_changes"]
