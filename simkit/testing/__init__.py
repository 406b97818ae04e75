"""Complete runs: specify, check, record, compare and repeat them.

The inputs are a run specification (`simkit.RunSpec`) or a running simulation. The results are check results, records
and reference runs. Observing a simulation does not change any bit of it. Only the command line and packs import this
package. The names below are for users' scripts.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from simkit.lazy_names import lazy_attributes

if TYPE_CHECKING:
    from simkit.testing.conditions import Watch
    from simkit.testing.golden.bag_scenario import check_recorded_files, recorded_scenario
    from simkit.testing.golden.cause import explain
    from simkit.testing.golden.check import check_golden, golden_scenario
    from simkit.testing.golden.compare.runs import compare
    from simkit.testing.golden.store import write_golden
    from simkit.testing.run_record.left_out import count_left_out, log_left_out, newly_left_out
    from simkit.testing.run_record.run_recorder import record_run
    from simkit.testing.scenarios.scenario_run import open_scenario, run_scenario

__all__ = [
    "Watch",
    "check_golden",
    "check_recorded_files",
    "compare",
    "count_left_out",
    "explain",
    "golden_scenario",
    "log_left_out",
    "newly_left_out",
    "open_scenario",
    "record_run",
    "recorded_scenario",
    "run_scenario",
    "write_golden",
]

_MODULES = {
    "simkit.testing.conditions": ("Watch",),
    "simkit.testing.golden.bag_scenario": ("check_recorded_files", "recorded_scenario"),
    "simkit.testing.golden.cause": ("explain",),
    "simkit.testing.golden.check": ("check_golden", "golden_scenario"),
    "simkit.testing.golden.compare.runs": ("compare",),
    "simkit.testing.golden.store": ("write_golden",),
    "simkit.testing.run_record.left_out": ("count_left_out", "log_left_out", "newly_left_out"),
    "simkit.testing.run_record.run_recorder": ("record_run",),
    "simkit.testing.scenarios.scenario_run": ("open_scenario", "run_scenario"),
}

if not TYPE_CHECKING:  # hidden from type checkers, so that they report unknown names
    __getattr__, __dir__ = lazy_attributes(__name__, _MODULES)
