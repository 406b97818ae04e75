"""`simkit run` stands still while its world is paused, and goes on when something lets it."""

from __future__ import annotations

from typing import Any

import pytest

import simkit
from simkit.cli.run_loop import RunLoop
from simkit.cli.terminal.verbosity import given_verbosity
from simkit.recording.command_script import Commands

BALL = '<sdf version="1.9"><world name="w"><model name="ball"><link name="l"/></model></world></sdf>'


class Quiet:
    """Nobody has pressed Ctrl-C."""

    exit_code = 0


def control(sim: simkit.Simulation, **fields: Any) -> None:
    assert sim.call("/world/w/control", {"world_control": fields}).success


def test_it_waits_for_a_service_and_then_comes_to_its_end(capfd: pytest.CaptureFixture[str]) -> None:
    ticks: list[int] = []
    with simkit.load(BALL) as sim:

        def watch() -> None:
            ticks.append(sim.tick)
            if len(ticks) == 3:
                control(sim, multi_step=5, pause=True)
            if len(ticks) == 5:
                control(sim, pause=False)

        sim.paused = True
        with given_verbosity(quiet=True, verbose=False):  # nobody would know that it waits
            assert RunLoop(sim, Commands(sim, []), Quiet(), [watch]).run(0.05)  # type: ignore[arg-type]
        assert ticks[:3] == [0, 0, 0]
        assert ticks[3:5] == [5, 5]
        assert ticks[-1] == sim.tick == 50
        assert not sim.control.pausing.is_served
    assert capfd.readouterr().err.count("paused at t=0 s until a service resumes it") == 1


def test_the_newest_pace_counts_and_the_user_overrides_the_world() -> None:
    with simkit.load(BALL) as sim:
        sim.call("/world/w/set_physics", {"max_update_rate": 10_000.0})  # of 1 ms: ten times real time
        RunLoop(sim, Commands(sim, []), Quiet(), [])  # type: ignore[arg-type]
        assert sim.control.pausing.pace == 10.0
        RunLoop(sim, Commands(sim, []), Quiet(), [], rtf=2.0)  # type: ignore[arg-type]
        assert sim.control.pausing.pace == 2.0
        sim.call("/world/w/set_physics", {"max_update_rate": 10_000.0})
        assert sim.control.pausing.pace == 10.0
