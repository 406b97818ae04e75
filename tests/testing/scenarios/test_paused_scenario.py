"""A scenario ends with an error when its world is paused, because nothing can resume it."""

from __future__ import annotations

from pathlib import Path

import pytest

from simkit import InputError, RunSpec
from simkit.testing.scenarios.scenario_run import open_scenario, run_scenario

WORLD = '<sdf version="1.9"><world name="w"><plugin name="pauser" filename="pauser.py"/></world></sdf>'
PAUSER = """
from simkit import WorldPlugin

class Pauser(WorldPlugin):
    def load(self, parent, params):
        pass

    def before_step(self):
        if self.sim.time > 0.1:
            self.sim.control.paused = True
            self.sim.control.paused = RESULT
"""


def spec(folder: Path, result: bool) -> RunSpec:
    (folder / "pauser.py").write_text(PAUSER.replace("RESULT", str(result)))
    (folder / "w.sdf").write_text(WORLD)
    return RunSpec(str(folder / "w.sdf"), duration=0.5, options={"plugin_paths": [folder]})


def test_a_pause_that_nothing_ends_is_an_error_with_its_time(tmp_path: Path) -> None:
    scenario = spec(tmp_path, True)
    with (
        open_scenario(scenario) as sim,
        pytest.raises(InputError, match=r"SK-SCEN-009 the world was paused at t = 0\.102 s"),
    ):
        run_scenario(scenario, sim)


def test_a_world_that_is_resumed_in_the_same_step_runs_to_the_end(tmp_path: Path) -> None:
    scenario = spec(tmp_path, False)
    with open_scenario(scenario) as sim:
        assert run_scenario(scenario, sim).reason == "duration"
