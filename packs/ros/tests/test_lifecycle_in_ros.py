"""A lifecycle node of a plugin is managed by a node of ROS."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

pytestmark = pytest.mark.ros

BEACON = """
import simkit
from simkit.lifecycle import LifecycleNode

class Beacon(simkit.WorldPlugin):
    def load(self, sim, params):
        self.gain = self.declare("gain", 1.0)
        self.lifecycle = LifecycleNode(self)

    def on_activate(self, previous):
        return self.gain.value > 1.0
"""


def test_a_node_of_ros_manages_a_plugin(
    simkit_run: Callable[..., Any], ros_node: Callable[[str], Any], tmp_path: Path
) -> None:
    (tmp_path / "beacon.py").write_text(BEACON)
    (tmp_path / "w.sdf").write_text(
        '<sdf version="1.9"><world name="w"><plugin filename="beacon.py:Beacon" name="beacon"/></world></sdf>'
    )
    with simkit_run(str(tmp_path / "w.sdf"), "--rtf", "1", "--plugin-path", str(tmp_path)):
        found = ros_node("""
            from lifecycle_msgs.msg import Transition, TransitionEvent
            from lifecycle_msgs.srv import ChangeState, GetAvailableTransitions, GetState

            client = Client()
            events = client.hear("/beacon/transition_event", TransitionEvent)
            client.until(lambda: client.node.count_publishers("/beacon/transition_event"))

            def change(number):
                request = ChangeState.Request(transition=Transition(id=number))
                return client.call(ChangeState, "/beacon/change_state", request).success

            def is_heard():  # events before the two endpoints have found each other are lost
                return events or not (change(Transition.TRANSITION_CONFIGURE) and change(Transition.TRANSITION_CLEANUP))

            client.until(is_heard)
            changed = [change(Transition.TRANSITION_CONFIGURE), change(Transition.TRANSITION_ACTIVATE)]
            state = client.call(GetState, "/beacon/get_state").current_state
            found = client.call(GetAvailableTransitions, "/beacon/get_available_transitions").available_transitions
            changed.append(change(Transition.TRANSITION_INACTIVE_SHUTDOWN))
            client.until(lambda: events and events[-1].goal_state.label == "finalized")
            tell([changed, [state.id, state.label], [t.transition.label for t in found]])
        """)
    assert found == [[True, False, True], [2, "inactive"], ["cleanup", "activate", "shutdown"]]
