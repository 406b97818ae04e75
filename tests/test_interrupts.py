"""Interrupts are never lost and leave nothing half done, wherever they arrive."""

from __future__ import annotations

import signal
import threading
from typing import Any

import mujoco
import pytest

import simkit
from simkit.interrupts import defer_interrupts
from simkit.runtime.engine.control_callback import call_before_forces

EMPTY = '<sdf version="1.9"><world name="w"/></sdf>'


def test_a_deferred_interrupt_is_raised_after_the_block_and_the_handler_is_the_same_as_before() -> None:
    before, reached = signal.getsignal(signal.SIGINT), []

    def interrupt() -> None:
        with defer_interrupts() as received:
            signal.raise_signal(signal.SIGINT)
            reached.append(len(received))

    with pytest.raises(KeyboardInterrupt):
        interrupt()
    assert reached == [1]
    assert signal.getsignal(signal.SIGINT) is before


def test_nested_blocks_raise_the_interrupt_after_the_outer_one() -> None:
    reached = []
    with pytest.raises(KeyboardInterrupt), defer_interrupts():  # noqa: PT012 - the block defers
        with defer_interrupts():
            signal.raise_signal(signal.SIGINT)
        reached.append("after the inner block")
    assert reached


def test_an_interrupt_in_a_function_that_the_engine_calls_is_raised_after_the_pass() -> None:
    model = mujoco.MjModel.from_xml_string(
        "<mujoco><worldbody><body><freejoint/><geom size='1'/></body></worldbody></mujoco>"
    )
    data, calls = mujoco.MjData(model), []
    mujoco.set_mjcb_control(lambda model, data: signal.raise_signal(signal.SIGINT))
    try:
        with pytest.raises(KeyboardInterrupt), call_before_forces(data, lambda: calls.append(1)):
            mujoco.mj_forward(model, data)
    finally:
        mujoco.set_mjcb_control(None)
    assert calls == [1]


def test_a_simulation_can_run_on_after_an_interrupt_at_the_start_of_a_run() -> None:
    class InterruptedEvent(threading.Event):
        def clear(self) -> None:
            super().clear()
            signal.raise_signal(signal.SIGINT)

    with simkit.load(EMPTY) as sim:
        loop: Any = sim.engine.loop
        idle, loop._idle = loop._idle, InterruptedEvent()
        with pytest.raises(KeyboardInterrupt):
            sim.run(1.0)
        loop._idle = idle
        sim.run(0.5)
        assert sim.time == pytest.approx(0.5)
