"""Nodes that others configure, activate, deactivate and shut down.

States and transitions are those of `simkit.lifecycle`.
"""

from __future__ import annotations

from typing import Any, Final, NamedTuple

from simkit.lifecycle import FINALIZED, STATES, TRANSITIONS, UNCONFIGURED, Transition
from simkit_nodes.host import current_host
from simkit_nodes.interfaces import ROS2, ProgramMessage, interface_module
from simkit_nodes.ros_modules.rclpy.callback_groups import CallbackGroup
from simkit_nodes.ros_modules.rclpy.impl.implementation_singleton import RCLError
from simkit_nodes.ros_modules.rclpy.lifecycle.managed_entity import ManagedEntity, TransitionCallbackReturn
from simkit_nodes.ros_modules.rclpy.lifecycle.publisher import LifecyclePublisher
from simkit_nodes.ros_modules.rclpy.node import Node

__all__ = ["LifecycleNode", "LifecycleNodeMixin", "LifecycleState", "TransitionCallbackReturn"]

_CALLBACKS: Final = {
    "configuring": "on_configure",
    "cleaningup": "on_cleanup",
    "shuttingdown": "on_shutdown",
    "activating": "on_activate",
    "deactivating": "on_deactivate",
    "errorprocessing": "on_error",
}
"""Method that is called in a state of transition."""


class LifecycleState(NamedTuple):
    """State of a lifecycle node."""

    label: str
    state_id: int


class LifecycleNodeMixin(ManagedEntity):
    """States, transitions and services of a lifecycle node; to be combined with `Node`.

    An exception in a callback is logged, and `on_error` is called.

    Args:
        enable_communication_interface: False for no services and no topic of the lifecycle.
        callback_group: callback group of the services; None for the default one of the node.
    """

    def __init__(
        self: Any, *, enable_communication_interface: bool = True, callback_group: CallbackGroup | None = None
    ) -> None:
        self._state_id = UNCONFIGURED
        self._managed_entities: dict[ManagedEntity, None] = {}  # a dictionary keeps the order
        self._transition_events = None
        if not enable_communication_interface:
            return
        event = ROS2.message_class("lifecycle_msgs/msg/TransitionEvent")
        self._transition_events = self.create_publisher(event, "~/transition_event", 10)
        for name, type_name, callback in (
            ("change_state", "ChangeState", self._on_change_state),
            ("get_state", "GetState", self._on_get_state),
            ("get_available_states", "GetAvailableStates", self._on_get_available_states),
            ("get_available_transitions", "GetAvailableTransitions", self._on_get_available_transitions),
            ("get_transition_graph", "GetAvailableTransitions", self._on_get_transition_graph),
        ):
            service = getattr(interface_module("lifecycle_msgs.srv", ROS2), type_name)
            self.create_service(service, f"~/{name}", callback, callback_group=callback_group)

    # ------------------------------------------------------------------ transitions

    def trigger_configure(self) -> TransitionCallbackReturn:
        """Configure the node.

        Raises:
            RCLError: the transition is not possible in the present state; so do the other functions.
        """
        return self._change("configure")

    def trigger_cleanup(self) -> TransitionCallbackReturn:
        """Undo the configuration of the node."""
        return self._change("cleanup")

    def trigger_shutdown(self) -> TransitionCallbackReturn:
        """Shut down the node."""
        return self._change("shutdown")

    def trigger_activate(self) -> TransitionCallbackReturn:
        """Activate the node."""
        return self._change("activate")

    def trigger_deactivate(self) -> TransitionCallbackReturn:
        """Deactivate the node."""
        return self._change("deactivate")

    def _transition(self, request: str | int) -> Transition | None:
        """Return the transition with a label or a number that is possible now."""
        possible = (t for t in TRANSITIONS if t.start == self._state_id <= FINALIZED)
        return next((t for t in possible if request in (t.label, t.id)), None)

    def _change(self: Any, request: str | int) -> TransitionCallbackReturn:
        transition = self._transition(request)
        if transition is None:
            self.get_logger().warning(f"No transition matching {request} found for state {STATES[self._state_id]}")
            raise RCLError("Failed to trigger lifecycle state machine transition: Transition is not registered.")
        previous = LifecycleState(STATES[self._state_id], self._state_id)
        self._enter(transition)
        result: TransitionCallbackReturn = self._call(previous)
        self._leave(result)
        if result is TransitionCallbackReturn.ERROR:
            self._leave(self._call(previous))
        return result

    def _call(self: Any, previous: LifecycleState) -> TransitionCallbackReturn:
        name = _CALLBACKS[STATES[self._state_id]]
        try:
            result = getattr(self, name)(previous)
        except Exception as error:  # noqa: BLE001 - of the program; rclpy goes on with `on_error`, too
            self.get_logger().error(f"{name} raised {error!r}")
            return TransitionCallbackReturn.ERROR
        if not isinstance(result, TransitionCallbackReturn):
            raise AttributeError(f"{type(result).__name__!r} object has no attribute 'to_label'")
        return result

    def _leave(self, result: TransitionCallbackReturn) -> None:
        self._enter(next(t for t in TRANSITIONS if t.start == self._state_id and t.label == result.to_label()))

    def _enter(self: Any, transition: Transition) -> None:
        self._state_id = transition.goal
        if self._transition_events is not None:
            event = self._transition_events.msg_type(timestamp=current_host().now_ns())
            _fill(event, transition)
            self._transition_events.publish(event)

    # ------------------------------------------------------------------ callbacks of transitions

    def add_managed_entity(self, entity: ManagedEntity) -> None:
        """Add an object that is informed about transitions.

        Raises:
            TypeError: the object is not a `ManagedEntity`.
        """
        if not isinstance(entity, ManagedEntity):
            raise TypeError("Expected a rclpy.lifecycle.ManagedEntity instance.")
        self._managed_entities[entity] = None

    def _inform(self, name: str, state: LifecycleState) -> TransitionCallbackReturn:
        """Call a function of all managed objects until one does not succeed."""
        for entity in list(self._managed_entities):
            result = getattr(entity, name)(state)
            if not isinstance(result, TransitionCallbackReturn):
                raise TypeError(
                    f"{name}() return value of class {type(entity)} should be `TransitionCallbackReturn`.\n"
                    f"Instance of the class that caused the failure: {entity}"
                )
            if result is not TransitionCallbackReturn.SUCCESS:
                return result
        return TransitionCallbackReturn.SUCCESS

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Inform the managed objects, as all callbacks of transitions do if they are not overridden."""
        return self._inform("on_configure", state)

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Inform the managed objects."""
        return self._inform("on_cleanup", state)

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Inform the managed objects."""
        return self._inform("on_shutdown", state)

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Inform the managed objects."""
        return self._inform("on_activate", state)

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Inform the managed objects."""
        return self._inform("on_deactivate", state)

    def on_error(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Inform the managed objects."""
        return self._inform("on_error", state)

    def create_lifecycle_publisher(self: Any, *args: Any, **kwargs: Any) -> LifecyclePublisher:
        """Create a publisher that publishes only while the node is active; see `Node.create_publisher`."""
        if "publisher_class" in kwargs:
            raise TypeError("create_publisher() got an unexpected keyword argument 'publisher_class'")
        publisher: LifecyclePublisher = self.create_publisher(*args, **kwargs, publisher_class=LifecyclePublisher)
        self._managed_entities[publisher] = None
        return publisher

    def destroy_lifecycle_publisher(self: Any, publisher: LifecyclePublisher) -> bool:
        """Destroy a publisher; return False if it is not one of this node."""
        self._managed_entities.pop(publisher, None)
        return self.destroy_publisher(publisher)  # type: ignore[no-any-return]

    # ------------------------------------------------------------------ services

    def _on_change_state(self, request: ProgramMessage, response: ProgramMessage) -> Any:
        label = request.transition.label
        if label and self._transition(label) is None:
            response.success = False
        else:
            response.success = self._change(label or request.transition.id) is TransitionCallbackReturn.SUCCESS
        return response

    def _on_get_state(self, request: ProgramMessage, response: ProgramMessage) -> Any:
        response.current_state.id, response.current_state.label = self._state_id, STATES[self._state_id]
        return response

    def _on_get_available_states(self, request: ProgramMessage, response: ProgramMessage) -> Any:
        state = ROS2.message_class("lifecycle_msgs/msg/State")
        response.available_states = [state(id=number, label=label) for number, label in STATES.items()]
        return response

    def _on_get_available_transitions(self, request: ProgramMessage, response: ProgramMessage) -> Any:
        possible = [t for t in TRANSITIONS if t.start == self._state_id]
        response.available_transitions = [_description(t) for t in possible]
        return response

    def _on_get_transition_graph(self, request: ProgramMessage, response: ProgramMessage) -> Any:
        response.available_transitions = [_description(t) for t in TRANSITIONS]
        return response


def _fill(message: ProgramMessage, transition: Transition) -> None:
    """Write a transition to a `TransitionEvent` or a `TransitionDescription`."""
    message.transition.id, message.transition.label = transition.id, transition.label
    for state, number in ((message.start_state, transition.start), (message.goal_state, transition.goal)):
        state.id, state.label = number, STATES[number]


def _description(transition: Transition) -> Any:
    description = ROS2.message_class("lifecycle_msgs/msg/TransitionDescription")()
    _fill(description, transition)
    return description


class LifecycleNode(LifecycleNodeMixin, Node):
    """Node that others configure, activate, deactivate and shut down.

    Args:
        node_name: name, without the namespace.
        enable_communication_interface: False for no services and no topic of the lifecycle.
        kwargs: further arguments of `Node`.
    """

    def __init__(self, node_name: str, *, enable_communication_interface: bool = True, **kwargs: Any) -> None:
        Node.__init__(self, node_name, **kwargs)
        LifecycleNodeMixin.__init__(self, enable_communication_interface=enable_communication_interface)
