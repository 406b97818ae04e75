"""What it means that a world is paused: for who keeps it running, and for a script."""

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


def test_who_keeps_a_world_running_stands_still_while_it_is_paused_and_goes_on_when_it_is_resumed() -> None:
    with simkit.load(BALL) as sim:
        sim.control.pausing.advance(10)
        sim.paused = True
        sim.control.pausing.advance(10)
        assert (sim.tick, sim.paused) == (10, True)
        sim.paused = False
        sim.control.pausing.advance(10)
        assert (sim.tick, sim.paused) == (20, False)


def test_a_script_goes_as_far_as_it_says_and_the_world_is_as_paused_as_before() -> None:
    with simkit.load(BALL) as sim:
        sim.paused = True
        sim.step(3)
        sim.run(0.007)
        assert (sim.tick, sim.paused) == (10, True)


def test_steps_that_were_asked_for_are_done_and_add_up_and_then_it_pauses() -> None:
    with simkit.load(BALL) as sim, sim.control.pausing.served():
        sim.control.pausing.step(5)
        sim.control.pausing.advance(2)
        assert (sim.tick, sim.paused, sim.control.pausing.is_stepping) == (2, False, True)
        sim.control.pausing.step(4)
        sim.control.pausing.advance(1000)
        assert (sim.tick, sim.paused) == (9, True)


def test_a_run_to_a_time_ends_at_the_first_tick_that_is_not_before_it() -> None:
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
        assert (sim.tick, sim.paused) == (41, True)  # the step it was called for is done


def test_a_hook_that_pauses_does_not_keep_a_script_from_its_end() -> None:
    with simkit.load(BALL, plugins=[PausesAt(40)]) as sim:
        sim.run(0.1)
        assert (sim.tick, sim.paused) == (100, True)


def test_pauses_leave_no_trace_in_the_bits() -> None:
    with simkit.load(BALL) as straight, simkit.load(BALL, plugins=[PausesAt(40)]) as paused:
        straight.run(0.1)
        while paused.tick < 100:
            paused.control.pausing.advance(100 - paused.tick)
            paused.paused = False
        assert np.array_equal(straight.mj_data.qpos, paused.mj_data.qpos)
        assert np.array_equal(straight.mj_data.qvel, paused.mj_data.qvel)


def test_snapshots_and_reset_cover_it() -> None:
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


def test_who_watches_is_told_of_every_change_and_of_nothing_else() -> None:
    heard: list[bool] = []
    with simkit.load(BALL) as sim:
        sim.control.pausing.on_change(lambda: heard.append(sim.paused))
        sim.paused = True
        sim.paused = True
        sim.step(5)
        sim.paused = False
        assert heard == [True, False]


@pytest.mark.parametrize("begin", [0, 5])
def test_who_keeps_a_world_running_has_their_turn_when_a_hook_goes_back(begin: int) -> None:
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
