"""Turns of tasks: which thread makes the steps, and what it may change."""

from __future__ import annotations

import _thread
from collections.abc import Callable, Iterator
from pathlib import Path
from textwrap import dedent

import numpy as np
import pytest

import simkit
from simkit import Simulation, SimulationDiverged
from simkit.runtime.engine.step_loop import StepLoop
from simkit_nodes import lock_step
from simkit_nodes.programs import NodeProgram

Add = Callable[..., NodeProgram]

FALLING = """<sdf version="1.9"><world name="w">
  <model name="ground"><static>true</static><link name="l"><collision name="c"><geometry><plane/></geometry></collision>
  </link></model>
  <model name="box"><pose>0 0 0.3 0.1 0.2 0</pose><link name="l"><inertial auto="true"/><collision name="c">
    <density>100</density><geometry><box><size>0.2 0.1 0.1</size></box></geometry></collision></link></model>
</world></sdf>"""
LOOP = """
    import time, rclpy
    from std_msgs.msg import Float64
    rclpy.init()
    node = rclpy.create_node("{name}")
    publisher = node.create_publisher(Float64, "/{name}", 10)
    node.create_subscription(Float64, "/{other}", lambda message: print(time.time(), message.data), 10)
    while rclpy.ok():
        publisher.publish(Float64(data=time.time()))
        rclpy.spin_once(node, timeout_sec=0)
        time.sleep({pause})
"""


@pytest.fixture
def step_threads(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Identifiers of the threads that have made steps for waiting programs, in the order of the steps."""
    threads: list[int] = []
    original = StepLoop.advance_physics

    def advance(loop: StepLoop, target: int) -> bool:
        has_stepped = True  # also if the step raises
        try:
            has_stepped = original(loop, target)
        finally:
            if has_stepped:
                threads.append(_thread.get_ident())
        return has_stepped

    monkeypatch.setattr(StepLoop, "advance_physics", advance)
    return threads


@pytest.fixture
def falling() -> Iterator[Simulation]:
    """Simulation of a box that falls onto the ground, with steps of 1 ms."""
    with simkit.load(FALLING) as sim:
        yield sim


def test_steps_in_the_threads_of_programs_change_no_bit(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, step_threads: list[int]
) -> None:
    def run(limit: int) -> tuple[bytes, list[list[str]]]:
        monkeypatch.setattr(lock_step, "_MOST_PLAIN_STEPS", limit)
        with simkit.load(FALLING) as sim:
            nodes = []
            for name, other, pause in (("a", "b", 1e-9), ("b", "a", 0.003), ("c", "a", 0.02)):
                file = tmp_path / f"{name}.py"
                file.write_text(dedent(LOOP).format(name=name, other=other, pause=pause))
                nodes.append(sim.add_node(file))
            sim.run(0.4)
            data = sim.engine.mj_data
            return data.qpos.tobytes() + data.qvel.tobytes(), [list(node.log) for node in nodes]

    without = run(0)
    assert not step_threads and all(without[1])
    assert run(16) == without
    assert step_threads and _thread.get_ident() not in step_threads


def test_a_step_in_the_thread_of_a_program_that_diverges_raises_for_the_caller_of_run(
    falling: Simulation, step_threads: list[int]
) -> None:
    def push() -> None:
        import time

        time.sleep(0.01)
        falling.link("box::l").set_velocity([1e200, 0, 0])
        time.sleep(1e-9)

    node = falling.add_node(push, name="push")
    with pytest.raises(SimulationDiverged):
        falling.run(1.0)
    assert step_threads and step_threads[-1] != _thread.get_ident()
    assert falling.tick == 11 and not node.done and node.error is None


def test_settings_of_numpy_in_a_program_do_not_reach_the_steps(
    falling: Simulation, monkeypatch: pytest.MonkeyPatch
) -> None:
    settings: list[str] = []
    original = StepLoop.advance_physics

    def advance(loop: StepLoop, target: int) -> bool:
        settings.append(np.geterr()["under"])
        return original(loop, target)

    def strict() -> None:
        import time

        np.seterr(under="raise")
        for _ in range(10):
            time.sleep(0.001)
            assert np.geterr()["under"] == "raise"

    monkeypatch.setattr(StepLoop, "advance_physics", advance)
    node = falling.add_node(strict, name="strict")
    falling.run(0.02)
    assert node.done and node.error is None and set(settings) == {"ignore"}


def test_a_program_that_computes_for_ever_after_the_turn_of_another_one_is_ended(
    sim: Simulation, add_program: Add
) -> None:
    first = add_program("import time\nfor _ in range(200): time.sleep(0.001)\nprint('first')", "first.py")
    second = add_program(
        """
        import time
        time.sleep(0.1)
        while True:
            pass
        """,
        "second.py",
        limit=0.2,
    )
    third = add_program("import time\nfor _ in range(200): time.sleep(0.001)\nprint('third')", "third.py")
    sim.run(0.3)
    assert "computes for more than 0.2 s" in str(second.error) and second.done
    assert (first.log, third.log) == (["first"], ["third"]) and sim.time == pytest.approx(0.3)


def test_programs_that_wait_for_the_same_time_run_in_the_order_of_their_creation(sim: Simulation) -> None:
    order: list[str] = []
    for name in "abc":
        sim.add_node(_recorder(order, name), name=name)
    sim.run(0.01)
    assert "".join(order) == "abc" * 3


def _recorder(order: list[str], name: str) -> Callable[[], None]:
    def record() -> None:
        import time

        for _ in range(3):
            order.append(name)
            time.sleep(0.001)

    return record
