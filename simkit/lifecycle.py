"""Lifecycle nodes, as in ROS 2: nodes that are configured, activated, deactivated and shut down by others.

    class Driver(simkit.WorldPlugin):
        def load(self, parent, params):
            self.lifecycle = LifecycleNode(self)

        def on_activate(self, previous):
            self.log.info("from %s", previous)

States and transitions are those of `rcl_lifecycle`; https://design.ros2.org/articles/node_lifecycle.html.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any, Final, NamedTuple, Protocol

from simkit.argument_checks import check_text
from simkit.errors import SimkitError
from simkit.in_process import InProcess
from simkit.msgs.topic_names import absolute_name

if TYPE_CHECKING:
    from simkit.msgs import Message

_PRIMARY: Final = ("unknown", "unconfigured", "inactive", "active", "finalized")
_CHANGING: Final = ("configuring", "cleaningup", "shuttingdown", "activating", "deactivating", "errorprocessing")
STATES: Final = dict(enumerate(_PRIMARY)) | dict(enumerate(_CHANGING, 10))
"""Labels of the states by their number in `lifecycle_msgs/msg/State`."""
UNCONFIGURED, INACTIVE, ACTIVE, FINALIZED, ERROR_PROCESSING = 1, 2, 3, 4, 15


class Transition(NamedTuple):
    """Transition between two states, with its number and label in `lifecycle_msgs/msg/Transition`."""

    id: int
    label: str
    start: int
    goal: int

    def description(self) -> dict[str, object]:
        """Return the fields of a `lifecycle_msgs/msg/TransitionDescription`."""
        transition = {"id": self.id, "label": self.label}
        return {"transition": transition, "start_state": state(self.start), "goal_state": state(self.goal)}


def _attempt(number: int, label: str, starts: dict[int, int], during: int, ends: tuple[int, ...]) -> list[Transition]:
    """Return the transitions of one request: into a state of transition, and out of it at success, failure or error.

    Args:
        number: number of success; those of failure and error follow.
        label: label of the request.
        starts: states in which the request is possible, by the numbers of its transitions.
        during: state of the transition.
        ends: states after success, failure and error.
    """
    names = ("transition_success", "transition_failure", "transition_error")
    begun = [Transition(begin, label, start, during) for begin, start in starts.items()]
    ended = zip(range(number, number + 3), names, ends, strict=True)
    return begun + [Transition(end_number, name, during, end) for end_number, name, end in ended]


TRANSITIONS: Final = (
    *_attempt(10, "configure", {1: UNCONFIGURED}, 10, (INACTIVE, UNCONFIGURED, ERROR_PROCESSING)),
    *_attempt(20, "cleanup", {2: INACTIVE}, 11, (UNCONFIGURED, INACTIVE, ERROR_PROCESSING)),
    *_attempt(30, "activate", {3: INACTIVE}, 13, (ACTIVE, INACTIVE, ERROR_PROCESSING)),
    *_attempt(40, "deactivate", {4: ACTIVE}, 14, (INACTIVE, ACTIVE, ERROR_PROCESSING)),
    *_attempt(50, "shutdown", {5: UNCONFIGURED, 6: INACTIVE, 7: ACTIVE}, 12, (FINALIZED, FINALIZED, ERROR_PROCESSING)),
    *_attempt(60, "", {}, ERROR_PROCESSING, (UNCONFIGURED, FINALIZED, FINALIZED)),
)
"""All transitions, in the order of ROS 2."""


class LifecycleStates(dict[str, int]):
    """States of the lifecycle nodes of a simulation, by node; part of its snapshots."""

    def get_state(self) -> dict[str, int]:
        """Return a copy."""
        return dict(self)

    def set_state(self, states: dict[str, int]) -> None:
        """Restore a copy; a node that was opened later is unconfigured, as at its beginning."""
        self.update({node: states.get(node, UNCONFIGURED) for node in self})


class _Endpoint(Protocol):
    def close(self) -> None: ...


class LifecycleHost(Protocol):
    """Plugin, simulation or client of a running simulation."""

    def offer(self, name: str, type_name: str, handler: Callable[[Message], object], /) -> _Endpoint:
        """Open a service."""

    def advertise(self, topic: str, type_name: str, /) -> Any:
        """Open a topic for publishing."""


class LifecycleNode(InProcess):
    """Node with the services and the states of a ROS 2 lifecycle node.

    A transition calls `on_configure`, `on_activate`, `on_deactivate`, `on_cleanup` or `on_shutdown` with the label of
    the state before. The callback returns False if the transition has failed; the state is then the one before, after a
    shutdown `finalized`. If it raises, `on_error` is called. If that exists and does not return False, the state is
    `unconfigured`. Otherwise it is `finalized`, and without `on_error` the exception goes on, as in any callback.

    Args:
        host: plugin, simulation, or client of a running simulation.
        node: name of the node; None for the node of the plugin or client.
        callbacks: object with these callbacks, all optional; None for the host.

    Attributes:
        node: absolute name of the node.

    Raises:
        ServiceError: a lifecycle node of that name exists; a client raises a LiveError.
    """

    def __init__(self, host: LifecycleHost, node: str | None = None, callbacks: object = None) -> None:
        communication: Any = getattr(getattr(host, "sim", host), "communication", None)
        self._states: dict[str, int] = {} if communication is None else communication.lifecycle_states
        if node is None:
            node = communication.node_of_plugin(host) if hasattr(host, "sim") else getattr(host, "info", {}).get("node")
        check_text(node, "node")
        self._host, self._callbacks = host, host if callbacks is None else callbacks
        self.node = absolute_name(str(node))
        services: dict[str, Callable[[Message], object]] = {
            "ChangeState": lambda request: {"success": self._request(request.transition)},
            "GetState": lambda _: {"current_state": state(self._state)},
            "GetAvailableStates": lambda _: {"available_states": [state(number) for number in STATES]},
            "GetAvailableTransitions": lambda _: _described([t for t in TRANSITIONS if self._is_possible(t)]),
            "GetTransitionGraph": lambda _: _described(TRANSITIONS),
        }
        self._endpoints: list[_Endpoint] = []
        try:
            for name, handler in services.items():
                snake = "".join(f"_{c.lower()}" if c.isupper() else c for c in name).lstrip("_")
                kind = "GetAvailableTransitions" if name == "GetTransitionGraph" else name
                self._endpoints.append(host.offer(f"{self.node}/{snake}", f"lifecycle_msgs/srv/{kind}", handler))
        except SimkitError:
            for endpoint in self._endpoints:
                endpoint.close()
            raise
        self._events = host.advertise(f"{self.node}/transition_event", "lifecycle_msgs/msg/TransitionEvent")
        self._endpoints.append(self._events)
        self._states[self.node] = UNCONFIGURED

    @property
    def state(self) -> str:
        """Label of the present state, such as `inactive`."""
        return STATES[self._state]

    @property
    def is_active(self) -> bool:
        """True in the state `active`."""
        return self._state == ACTIVE

    def change(self, transition: str) -> bool:
        """Make a transition, such as `configure`; return True if it succeeded.

        It returns False if the transition is not possible in the present state, or if its callback has failed.
        """
        possible = next((t for t in TRANSITIONS if t.label == transition and self._is_possible(t)), None)
        return possible is not None and self._make(possible)

    def close(self) -> None:
        """Close the services and the topic of the node."""
        for endpoint in self._endpoints:
            endpoint.close()
        self._endpoints.clear()
        self._states.pop(self.node, None)

    # ------------------------------------------------------------------ transitions

    @property
    def _state(self) -> int:
        return self._states.get(self.node, UNCONFIGURED)

    def _is_possible(self, transition: Transition) -> bool:
        """Check whether a transition can be requested now. During another transition, none can be."""
        return transition.start == self._state <= FINALIZED

    def _request(self, wanted: Message) -> bool:
        """Make the transition with a label, or with a number if there is no label, as ROS 2 does."""
        if wanted.label:
            return self.change(wanted.label)
        possible = next((t for t in TRANSITIONS if t.id == wanted.id and self._is_possible(t)), None)
        return possible is not None and self._make(possible)

    def _make(self, transition: Transition) -> bool:
        previous = self._enter(transition)
        try:
            succeeded = self._call(f"on_{transition.label}", previous)
        except Exception as error:  # noqa: BLE001 - `_process` raises it again if the node does not handle it
            self._leave(2)
            self._process(error)
            return False
        self._leave(0 if succeeded else 1)
        return succeeded

    def _process(self, error: Exception) -> None:
        """Call `on_error` after an exception of a callback; raise the exception if there is no such callback."""
        if not callable(getattr(self._callbacks, "on_error", None)):
            self._leave(1)
            raise error
        self._report(error)
        try:
            recovered = self._call("on_error", STATES[ERROR_PROCESSING])
        except Exception:
            self._leave(2)
            raise
        self._leave(0 if recovered else 1)

    def _report(self, error: Exception) -> None:
        log = getattr(self._host, "log", None) or getattr(getattr(self._host, "engine", None), "log", None)
        if log is not None:
            log.error("%s: the callback of a transition raised %r", self.node, error)

    def _call(self, name: str, previous: str) -> bool:
        callback = getattr(self._callbacks, name, None)
        return not callable(callback) or callback(previous) is not False

    def _leave(self, outcome: int) -> None:
        """Make the transition out of a state of transition: 0 after success, 1 after a failure, 2 after an error."""
        self._enter([t for t in TRANSITIONS if t.start == self._state][outcome])

    def _enter(self, transition: Transition) -> str:
        """Change the state, and publish the transition; return the label of the state before."""
        previous, self._states[self.node] = self.state, transition.goal
        now = getattr(getattr(self._host, "sim", self._host), "time_ns", 0)
        self._events.publish({"timestamp": now, **transition.description()})
        return previous

    def __repr__(self) -> str:
        return f"<LifecycleNode {self.node!r}: {self.state}>"


def state(number: int) -> dict[str, object]:
    """Return the fields of a `lifecycle_msgs/msg/State`."""
    return {"id": number, "label": STATES[number]}


def _described(transitions: Iterable[Transition]) -> dict[str, object]:
    return {"available_transitions": [t.description() for t in transitions]}
