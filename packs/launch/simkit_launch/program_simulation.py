"""Simulation around a known program, its parameters of ROS 1, and its command line without the arguments for ROS."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from simkit_nodes.host import current_host
from simkit_nodes.ros1_parameters import parameter_server

if TYPE_CHECKING:
    from simkit import Simulation


def current_simulation() -> Simulation:
    """Return the simulation around the present program.

    Raises:
        SystemExit: the program runs in a process of its own.
    """
    simulation = current_host().simulation
    if simulation is None:
        sys.exit("this program changes a simulation, so it only runs within one: simkit run WORLD --node …")
    return simulation


def ros1_parameter(node: str, name: str) -> Any:
    """Return the value of a parameter of ROS 1 for a node; None without one.

    Args:
        node: full name of the node.
        name: name of the parameter; the innermost namespace around the node that has it counts, after its own.
    """
    server = parameter_server(current_host())
    private = f"{node}/{name.lstrip('/')}"
    found = private if not name.startswith("/") and server.has(private) else server.search(node, name)
    return server.get(found) if found is not None and server.has(found) else None


def skip_early_messages(subscription: Any, period_ns: Callable[[], int]) -> None:
    """Skip messages of the simulation that come before a period is over, before they are made and wake the program.

    A hand-over costs 0.1 ms, and plugins publish joint states in every step. Nothing is skipped on a topic with
    several publishers, because their messages may be about different joints.

    Args:
        subscription: subscription of `rclpy`.
        period_ns: function that returns the period [ns].
    """
    host, due, topic = current_host(), [0], subscription.topic_name
    simulation = host.simulation
    bus = None if simulation is None else simulation.communication.bus
    alone = [(-1, False)]  # revision of the bus, and whether the topic has one publisher then

    def has_one_publisher() -> bool:
        revision = -2 if bus is None else bus.revision
        if alone[0][0] != revision:
            alone[0] = revision, len(host.graph.outside.publishers(topic)) == 1
        return alone[0][1]

    def accepts() -> bool:
        if not has_one_publisher():
            return True
        now = host.now_ns()
        if now < due[0]:
            return False
        due[0] = now + period_ns()
        return True

    subscription._graph_subscription.accepts = accepts


def report_second_joint_states(node: str, topic: str) -> bool:
    """Report once that plugins publish joint states on the topic of a node, too; return whether they do.

    Args:
        node: name of the node.
        topic: topic of the joint states.
    """
    simulation = current_host().simulation
    if simulation is None:
        return True
    ends = simulation.communication.bus.endpoints(topic)
    owner = next((end.owner for _, end, _, kind in ends if kind == "publishes" and end.owner is not None), None)
    relays = [relay for relay in simulation.communication.bus.relays if relay.target == topic]
    if owner is None and not relays:
        return False
    text = f"{node} and the simulation both publish on {topic!r}, so the robot's transforms jump between two states"
    hint = f"start {node} without a simulation only, or give it `source_list` and another name of the topic"
    simulation.engine.reports.warning("SK-LAUNCH-063", text, hint=hint)
    return True


def report_other_world(node: str, world: str) -> bool:
    """Report that a program names another world than that of the run, which it then gets; return whether it does.

    Args:
        node: name of the node.
        world: name of the world that it names.
    """
    simulation = current_simulation()
    if world == simulation.world.name:
        return False
    text = f"the world {world!r} is named, such as by {node}, but the run has {simulation.world.name!r}, which is taken"
    hint = f"start the world {world!r}, or name {simulation.world.name!r}; with Gazebo, the program would wait"
    reports = simulation.engine.reports
    if not any(each.code == "SK-LAUNCH-060" and each.message.startswith(f"the world {world!r}") for each in reports):
        reports.warning("SK-LAUNCH-060", text, hint=hint)
    return True
