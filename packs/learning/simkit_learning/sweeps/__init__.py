"""Sweeps: many runs of a world with different parameters and seeds, in parallel, and one table of their results.

import simkit

table = simkit.sweep("turtlebot3_world", {"turtlebot3.self_collide": [True, False]}, seeds=3, duration=1.0)
print(table)
"""

from __future__ import annotations

from simkit_learning.sweeps.result_table import read_table
from simkit_learning.sweeps.sweep import run_sweep, sweep
from simkit_learning.sweeps.sweep_spec import SweepSpec

__all__ = ["SweepSpec", "read_table", "run_sweep", "sweep"]
