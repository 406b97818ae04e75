"""Effects of a pause on the code that keeps a world running, and on a script."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import simkit

BALL = """<sdf version="1.9"><world name="w"><gravity>0 0 -10</gravity><model name="ball"><pose>0 0 100 0 0 0</pose>
<link name="l"><inertial><mass>1</mass></inertial></link></model></world></sdf>"""


class PausesAt(simkit.WorldPlugin):
    """Pauses the world at a tick, in a hook before or after the step."""

    def __init__(self, tick: int, hook: str = "after_step") -> None:
        self.tick, self.hook = tick, hook

    def load(self, parent: Any, params: simkit.Params) -> None:
        self.after_step_rate = 50.0

    def before_step(self) -> None:
        if self.hook == "before_step" and self.sim.tick == self.tick:
            self.sim.paused = True

    def after_step(self) -> None:
        if self.hook == "after_step" and self.sim.tick == self.tick:
            self.sim.paused = True


def test_advance_stops_while_the_world_is_paused_and_continues_after_a_resume() -> None:
    with simkit.load(BALL) as sim:
        sim.control.pausing.advance(10)
        sim.paused = True
        sim.control.pausing.advance(10)
        assert (sim.tick, sim.paused) == (10, True)
        sim.paused = False
        sim.control.pausing.advance(10)
        assert (sim.tick, sim.paused) == (20, False)


def test_a_script_reaches_its_target_in_a_paused_world_which_stays_paused() -> None:
    with simkit.load(BALL) as sim:
        sim.paused = True
        sim.step(3)
        sim.run(0.007)
        assert (sim.tick, sim.paused) == (10, True)


def test_requested_steps_add_up_and_then_the_world_pauses() -> None:
    with simkit.load(BALL) as sim, sim.control.pausing.served():
        sim.control.pausing.step(5)
        sim.control.pausing.advance(2)
        assert (sim.tick, sim.paused, sim.control.pausing.is_stepping) == (2, False, True)
        sim.control.pausing.step(4)
        sim.control.pausing.advance(1000)
        assert (sim.tick, sim.paused) == (9, True)


def test_a_run_to_a_time_ends_at_the_first_tick_at_or_after_it() -> None:
    with simkit.load(BALL) as sim:
        sim.control.pausing.run_to(12_300_001)
        sim.control.pausing.advance(1000)
        assert (sim.tick, sim.paused) == (13, True)
        sim.control.pausing.run_to(20_000_000)
        sim.control.pausing.advance(1000)
        assert sim.tick == 20


def test_a_hook_that_pauses_ends_a_served_run_with_its_step() -> None:
    with simkit.load(BALL, plugins=[PausesAt(40)]) as sim:
        sim.control.pausing.advance(1000)
        assert (sim.tick, sim.paused) == (40, True)
    with simkit.load(BALL, plugins=[PausesAt(40, "before_step")]) as sim:
        sim.control.pausing.advance(1000)
        assert (sim.tick, sim.paused) == (41, True)  # the step of this hook is still made


def test_a_hook_that_pauses_does_not_stop_a_script() -> None:
    with simkit.load(BALL, plugins=[PausesAt(40)]) as sim:
        sim.run(0.1)
        assert (sim.tick, sim.paused) == (100, True)


def test_pauses_do_not_change_any_bit() -> None:
    with simkit.load(BALL) as straight, simkit.load(BALL, plugins=[PausesAt(40)]) as paused:
        straight.run(0.1)
        while paused.tick < 100:
            paused.control.pausing.advance(100 - paused.tick)
            paused.paused = False
        assert np.array_equal(straight.mj_data.qpos, paused.mj_data.qpos)
        assert np.array_equal(straight.mj_data.qvel, paused.mj_data.qvel)


def test_snapshots_and_reset_include_the_pause_state() -> None:
    with simkit.load(BALL) as sim:
        sim.step(5)
        sim.control.pausing.step(3)
        before = sim.snapshot()
        sim.paused = False
        sim.step(50)
        sim.restore(before)
        sim.control.pausing.advance(1000)
        assert (sim.tick, sim.paused) == (8, True)
        sim.reset()
        assert (sim.tick, sim.paused) == (0, False)


def test_on_change_reports_every_change_and_nothing_else() -> None:
    heard: list[bool] = []
    with simkit.load(BALL) as sim:
        sim.control.pausing.on_change(lambda: heard.append(sim.paused))
        sim.paused = True
        sim.paused = True
        sim.step(5)
        sim.paused = False
        assert heard == [True, False]


@pytest.mark.parametrize("begin", [0, 5])
def test_advance_returns_when_a_hook_resets(begin: int) -> None:
    class Again(simkit.WorldPlugin):
        after_step_rate = 100.0

        def load(self, parent: Any, params: simkit.Params) -> None:
            pass

        def after_step(self) -> None:
            self.sim.reset()

    with (
        simkit.load('<sdf version="1.9"><world name="w"/></sdf>', plugins=[Again()]) as sim,
        sim.control.pausing.served(),
    ):
        sim.step(begin)
        sim.control.pausing.advance(1000)
        assert sim.tick == 0
