"""Lifecycle nodes of programs: `rclpy.lifecycle`."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from textwrap import dedent

import pytest

import simkit

RunProgram = Callable[..., list[str]]

TALKER = dedent(
    """
    import rclpy
    from rclpy.lifecycle import LifecycleNode, LifecycleState, TransitionCallbackReturn
    from std_msgs.msg import String

    class Talker(LifecycleNode):
        def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
            self.get_logger().info(f"configure from {state.label} {state.state_id}")
            self.publisher = self.create_lifecycle_publisher(String, "chatter", 10)
            self.timer = self.create_timer(0.1, lambda: self.publisher.publish(String(data="hello")))
            return TransitionCallbackReturn.SUCCESS

        def on_activate(self, state):
            self.get_logger().info("activate")
            return super().on_activate(state)

        def on_cleanup(self, state):
            raise ValueError("no way back")

        def on_error(self, state):
            self.get_logger().info(f"error from {state.label}")
            return TransitionCallbackReturn.SUCCESS

        def on_shutdown(self, state):
            return TransitionCallbackReturn.FAILURE

    rclpy.init()
    node = Talker("talker")
    """
)


def change(sim: simkit.Simulation, label: str) -> bool:
    responses: list[bool] = []
    sim.call(
        "/talker/change_state",
        {"transition": {"label": label}},
        on_done=lambda call: responses.append(call.response.success),
    )
    sim.run(0.05)
    return responses[0]


@pytest.mark.slow
def test_a_manager_configures_and_activates_a_lifecycle_node(sim: simkit.Simulation, tmp_path: Path) -> None:
    file = tmp_path / "talker.py"
    file.write_text(TALKER + "rclpy.spin(node)\n")
    node = sim.add_node(file)
    heard = sim.subscribe("/chatter")
    events = sim.subscribe("/talker/transition_event")
    sim.run(0.1)
    assert not change(sim, "activate")  # it is not configured
    assert change(sim, "configure")
    sim.run(0.5)
    assert not heard.messages  # its publisher is silent until the node is active
    assert change(sim, "activate")
    sim.run(0.5)
    assert len(heard.messages) >= 4
    assert change(sim, "deactivate")
    assert not change(sim, "cleanup")
    assert node.error is None
    goals = [event.goal_state.label for event in events.messages]
    assert goals[:4] == ["configuring", "inactive", "activating", "active"]
    assert goals[-3:] == ["cleaningup", "errorprocessing", "unconfigured"]
    texts = [line.split("]: ", 1)[1] for line in node.log]
    assert texts[:2] == ["configure from unconfigured 1", "activate"]
    assert texts[-2:] == ["on_cleanup raised ValueError('no way back')", "error from inactive"]


def test_a_node_changes_its_own_state(run_program: RunProgram) -> None:
    texts = run_program(
        TALKER
        + dedent(
            """
            log = node.get_logger()
            log.info(f"{node.trigger_configure()} {node.trigger_activate()}")
            log.info(f"{node.publisher.is_activated}")
            log.info(f"{node.trigger_shutdown()} {node._state_id}")
            try:
                node.trigger_activate()
            except Exception as error:
                log.info(str(error).split(":")[0])
            """
        )
    )
    assert [text for text in texts if "activate" not in text[:8]][1:] == [
        "TransitionCallbackReturn.SUCCESS TransitionCallbackReturn.SUCCESS",
        "True",
        "TransitionCallbackReturn.FAILURE 4",
        "No transition matching activate found for state finalized",
        "Failed to trigger lifecycle state machine transition",
    ]


def test_a_method_can_depend_on_the_state(run_program: RunProgram) -> None:
    texts = run_program(
        """
        import rclpy
        from rclpy.lifecycle import Node, SimpleManagedEntity
        rclpy.init()
        node = Node("a", enable_communication_interface=False)
        class Motor(SimpleManagedEntity):
            @SimpleManagedEntity.when_enabled
            def turn(self):
                node.get_logger().info("turns")
            @SimpleManagedEntity.when_enabled(when_not_enabled=lambda: node.get_logger().info("off"))
            def stop(self):
                node.get_logger().info("stops")
        motor = Motor()
        node.add_managed_entity(motor)
        for step in (None, node.trigger_configure, node.trigger_activate):
            if step:
                step()
            motor.turn()
            motor.stop()
        """
    )
    assert texts == ["off", "off", "turns", "stops"]
