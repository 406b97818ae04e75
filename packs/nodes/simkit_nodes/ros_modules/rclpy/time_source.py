"""Time source of a node: `/clock` if the parameter `use_sim_time` is true."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from simkit_nodes.interfaces import ROS2
from simkit_nodes.qos import Qos
from simkit_nodes.ros_modules.rclpy.clock import ROSClock
from simkit_nodes.ros_modules.rclpy.parameter import Parameter
from simkit_nodes.ros_modules.rclpy.time import Time

if TYPE_CHECKING:
    from simkit_nodes.graph_topics import GraphSubscription
    from simkit_nodes.ros_modules.rclpy.node import Node

__all__ = ["CLOCK_TOPIC", "USE_SIM_TIME_NAME", "TimeSource"]

CLOCK_TOPIC = "/clock"
USE_SIM_TIME_NAME = "use_sim_time"


class TimeSource:
    """Time source of clocks.

    Args:
        node: node with the parameter `use_sim_time`.
    """

    def __init__(self, *, node: Node) -> None:
        self._node = node
        self._clocks: list[ROSClock] = []
        self._subscription: GraphSubscription | None = None
        self._is_active = False
        if not node.has_parameter(USE_SIM_TIME_NAME):
            node.declare_parameter(USE_SIM_TIME_NAME, False)
        parameter = node.get_parameter(USE_SIM_TIME_NAME)
        if parameter.type_ is Parameter.Type.BOOL:
            self.ros_time_is_active = bool(parameter.value)
        elif parameter.type_ is not Parameter.Type.NOT_SET:
            text = f"Invalid type for parameter '{USE_SIM_TIME_NAME}' {parameter.type_!r} should be bool"
            node.get_logger().error(text)
        node.add_on_set_parameters_callback(self._on_parameters)

    @property
    def ros_time_is_active(self) -> bool:
        """True if the clocks show the time of `/clock`."""
        return self._is_active

    @ros_time_is_active.setter
    def ros_time_is_active(self, enabled: bool) -> None:
        if enabled == self._is_active:
            return
        self._is_active = enabled
        for clock in self._clocks:
            clock._set_ros_time_is_active(enabled)
        if enabled:
            self._subscription = self._node._graph_node.subscribe(
                CLOCK_TOPIC,
                "rosgraph_msgs/msg/Clock",
                Qos(is_reliable=False, depth=1),
                on_message=self._on_clock,
            )
        else:
            self._unsubscribe()

    def _unsubscribe(self) -> None:
        subscription, self._subscription = self._subscription, None
        if subscription is not None:
            subscription.close()

    def attach_clock(self, clock: ROSClock) -> None:
        """Let a clock follow this time source.

        Raises:
            ValueError: the clock is of another kind.
        """
        if not isinstance(clock, ROSClock):
            raise ValueError("Only clocks with type ROS_TIME can be attached.")
        self._clocks.append(clock)
        clock._set_ros_time_is_active(self._is_active)

    def _on_clock(self) -> None:
        """Set the clocks after a message of `/clock` has arrived."""
        subscription = self._subscription
        received = None if subscription is None else subscription.take()
        if received is None:
            return
        graph = self._node._graph_node.graph
        for clock in self._clocks:
            if graph.has_simulated_time:
                clock._follow_host()
            else:
                stamp = received[0].clock
                clock.set_ros_time_override(Time(seconds=stamp.sec, nanoseconds=stamp.nanosec))
        if graph.has_simulated_time:
            self._unsubscribe()
        self._node._wake_executor()

    def _on_parameters(self, parameters: list[Any]) -> Any:
        successful, reason = True, ""
        for parameter in parameters:
            if parameter.name == USE_SIM_TIME_NAME:
                if parameter.type_ is Parameter.Type.BOOL:
                    self.ros_time_is_active = parameter.value
                else:
                    successful, reason = False, f"{USE_SIM_TIME_NAME} parameter set to something besides a bool"
                    self._node.get_logger().error(reason)
                break
        result = ROS2.message_class("rcl_interfaces/msg/SetParametersResult")
        return result(successful=successful, reason=reason)
