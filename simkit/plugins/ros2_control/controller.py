"""Base class of controllers: it claims hardware interfaces and is updated at the controller manager's rate."""

from __future__ import annotations

import abc
import copy
import logging
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, ClassVar, TypeVar

from simkit.msgs.message_types import Message
from simkit.params import Params
from simkit.plugins.live_parameters import declare_at
from simkit.plugins.ros2_control.hardware_interfaces import InterfaceSelection
from simkit.plugins.shared_by_copies import SharedByCopies
from simkit.runtime.communication.parameter_server import Parameter

if TYPE_CHECKING:
    from simkit.plugins.base import Plugin
    from simkit.plugins.ros2_control.hardware import Hardware
    from simkit.runtime import Simulation
    from simkit.runtime.communication.action_server import Action, GoalHandle
    from simkit.runtime.communication.publisher import Listener, Publisher
    from simkit.runtime.communication.service_server import Service


Key = tuple[str, str]
# Callback of a subscriber, a service or an action.
Relay = Callable[..., Any]
Handle = TypeVar("Handle")


class ControllerEndpoints(SharedByCopies):
    """Topics, services and actions that the controllers of one name have opened.

    They stay open with the controller's name: one that is unloaded and loaded again, or configured again, finds them
    open, and what comes in meanwhile is dropped.

    Attributes:
        handlers: callbacks of the present controller, by the kind of endpoint and its name.
    """

    def __init__(self) -> None:
        self._handles: dict[Key, Any] = {}
        self.handlers: dict[Key, Relay] = {}

    def open(self, key: Key, make: Callable[[], Handle]) -> Handle:
        """Return the endpoint of that name, and make it where there is none yet."""
        if key not in self._handles:
            self._handles[key] = make()
        found: Handle = self._handles[key]
        return found

    def relay(self, key: Key, handler: Relay, absent: Relay = lambda *_: None) -> Relay:
        """Return a callback that calls the present handler of an endpoint: `handler` from now on, or else `absent`."""
        self.handlers[key] = handler
        return lambda *values: self.handlers.get(key, absent)(*values)

    def close(self) -> None:
        """Remove all handlers."""
        self.handlers = {}


T = TypeVar("T", bound="bool | int | float | str | tuple[float, ...]")


class Controller(SharedByCopies, abc.ABC):
    """Base of all controllers.

    The controller manager makes it, then calls `configure` once, `activate` and `deactivate` as it is switched, and
    `update` at its rate while it is active. Between `activate` and `deactivate` the interfaces that it named are its
    own. What it writes stays until it writes again.

    Attributes:
        types: type names in YAML files that stand for this class
            (`joint_trajectory_controller/JointTrajectoryController`).
        name: the controller's, such as `arm_controller`.
        plugin: the plugin that hosts the controller manager.
        params: the controller's parameters from the YAML; an element for each key, `a.b` as the element b in a, a
            list as repeated elements (`[j.value for j in params.all("joints")]`).
        hardware: joints with their limits, mimics, and the tables of interfaces.
        states: the state interfaces it named, bound before `configure` returns to the manager.
        commands: the command interfaces it named, bound and claimed while it is active.
        update_rate: [Hz]; 0 for the manager's.
        log: a logger below `simkit`.
        endpoints: what it has opened; the manager gives it those of its name.
    """

    types: ClassVar[tuple[str, ...]] = ()

    name: str
    plugin: Plugin
    params: Params
    hardware: Hardware
    states: InterfaceSelection
    commands: InterfaceSelection
    update_rate: int = 0
    log: logging.Logger
    endpoints: ControllerEndpoints

    def __init__(self, name: str, plugin: Plugin, params: Params, hardware: Hardware) -> None:
        """Made by the controller manager.

        Args:
            name: the controller's.
            plugin: the host.
            params: its part of the YAML.
            hardware: what it may claim.
        """
        self.name, self.plugin, self.params, self.hardware = name, plugin, params, hardware
        self.log = logging.getLogger(f"simkit.plugins.ros2_control.{name}")
        self.endpoints = ControllerEndpoints()

    # ------------------------------------------------------------------ what a controller says and does

    @abc.abstractmethod
    def configure(self) -> None:
        """Reads `params`, opens topics, services, actions; a problem recorded in `params` keeps it unconfigured."""

    def command_interfaces(self) -> Sequence[str]:
        """List the interfaces that it writes, such as `arm_1_joint/position`; called after `configure`."""
        return ()

    def state_interfaces(self) -> Sequence[str]:
        """List the interfaces that it reads, such as `arm_1_joint/velocity`; called after `configure`."""
        return ()

    def activate(self) -> None:
        """Its interfaces are bound; takes up the present state."""

    def deactivate(self) -> None:
        """Ends goals and lets go; the interfaces are released afterwards. Joints stay where they are."""

    @abc.abstractmethod
    def update(self, now_ns: int, period: float) -> None:
        """Reads `states`, writes `commands`.

        Args:
            now_ns: simulated time [ns].
            period: time since the last update [s].
        """

    # ------------------------------------------------------------------ what it may use

    @property
    def sim(self) -> Simulation:
        """The simulation."""
        return self.plugin.sim

    def topic(self, name: str) -> str:
        """A name as the controller's node has it: `~/state` is `<namespace>/<controller>/state`."""
        return f"{self.name}/{name[2:]}" if name.startswith("~/") else name

    def advertise(self, topic: str, type_name: str, *, latched: bool = False) -> Publisher:
        """As `Plugin.advertise`, with the controller's node."""
        name = self.topic(topic)
        publisher: Publisher = self.endpoints.open(
            ("advertise", f"{name} {type_name}"), lambda: self.plugin.advertise(name, type_name, latched=latched)
        )
        return publisher

    def listen(self, topic: str, types: str | Sequence[str], callback: Callable[[Message], None]) -> Listener:
        """As `Plugin.listen`, with the controller's node."""
        name, key = self.topic(topic), ("listen", f"{self.topic(topic)} {types}")
        relay = self.endpoints.relay(key, callback)
        listener: Listener = self.endpoints.open(key, lambda: self.plugin.listen(name, types, relay))
        return listener

    def offer(self, service: str, type_name: str, handler: Callable[[Message], object]) -> Service:
        """As `Plugin.offer`, with the controller's node."""
        name, key = self.topic(service), ("offer", self.topic(service))
        relay = self.endpoints.relay(key, handler)
        opened: Service = self.endpoints.open(key, lambda: self.plugin.offer(name, type_name, relay))
        return opened

    def act(
        self,
        action: str,
        type_name: str,
        on_goal: Callable[[GoalHandle], None],
        on_cancel: Callable[[GoalHandle], bool | None] | None = None,
    ) -> Action:
        """As `Plugin.act`, with the controller's node."""
        name, key = self.topic(action), ("act", self.topic(action))
        relay = self.endpoints.relay(key, on_goal, lambda goal: goal.reject("the controller is not loaded"))
        cancel = on_cancel and self.endpoints.relay(("cancel", name), on_cancel)
        opened: Action = self.endpoints.open(key, lambda: self.plugin.act(name, type_name, relay, cancel))
        return opened

    def declare(
        self,
        name: str,
        default: T,
        *,
        minimum: float | None = None,
        maximum: float | None = None,
        choices: Sequence[T] = (),
        description: str = "",
        on_change: Callable[[T], None] | None = None,
    ) -> Parameter[T]:
        """A live parameter of the controller's node, as `Plugin.declare`; its first value is the YAML's.

        Args:
            name: its name; `gains.arm_1_joint.p` is p in arm_1_joint in gains.
            default: its value where the YAML says nothing; its type is the parameter's.
            minimum, maximum: bounds of a number.
            choices: what is allowed, where that is a list.
            description: what it is, with its unit.
            on_change: called with a new value, between two steps.
        """
        plugin, params = self.plugin, self.params
        *blocks, last = name.split(".")
        for block in blocks:
            params = params.block(block)
        own, model, sim = f"{plugin.ros.namespace}/{self.name}", plugin.scoped.partition("::")[0], plugin.sim
        parameter = Parameter(
            sim.communication.live_parameters.node_of(plugin, own, f"/{model}/{self.name}"),
            name,
            default,
            minimum=minimum,
            maximum=maximum,
            choices=choices,
            description=description,
            on_change=on_change and sim.engine.faults.guard(plugin, f"its callback for parameter {name!r}", on_change),
            owner=plugin,
        )
        return declare_at(plugin, parameter, params, last)

    def get_state(self) -> dict[str, object]:
        """A copy of every attribute it gave itself; handles and publishers stand for themselves.

        What cannot be copied is left out and told once (SK-PLUGIN-006).
        """
        own = {k: v for k, v in vars(self).items() if k not in _OWN_ATTRIBUTES}
        memo: dict[int, object] = {id(self): self}
        try:
            return copy.deepcopy(own, memo)
        except Exception:  # noqa: BLE001 - a foreign object may raise anything when copied
            return dict(self._copy_attributes(own, memo))

    def set_state(self, state: Mapping[str, object]) -> None:
        """Back to a state from `get_state`; what could not be copied stays as it is."""
        uncopied = vars(self).get("_uncopied", ())
        for key in [k for k in vars(self) if k not in _OWN_ATTRIBUTES and k not in state and k not in uncopied]:
            delattr(self, key)
        vars(self).update(copy.deepcopy(dict(state), {id(self): self}))

    def _copy_attributes(self, own: Mapping[str, object], memo: dict[int, object]) -> Iterator[tuple[str, object]]:
        """Copies of the attributes that can be copied."""
        uncopied: set[str] = vars(self).setdefault("_uncopied", set())
        for key, value in own.items():
            try:
                yield key, copy.deepcopy(value, memo)
            except Exception as error:  # noqa: BLE001 - as above
                if key not in uncopied:
                    uncopied.add(key)
                    message = f"controller {self.name!r}: attribute {key!r} cannot be copied"
                    message = f"{message}, snapshots and reset leave it as it is: {error}"
                    self.sim.engine.reports.warning("SK-PLUGIN-006", message, self.params.where)


_OWN_ATTRIBUTES = frozenset(
    ("name", "plugin", "params", "hardware", "states", "commands", "log", "endpoints", "_uncopied")
)


class OneTimeWarnings(SharedByCopies):
    """Reports of a controller that are made once each; a handle, without state that a reset forgets."""

    def __init__(self, controller: Controller) -> None:
        self._controller = controller
        self._reported: set[str] = set()

    def warn(self, code: str, what: str, message: str, hint: str = "") -> None:
        """A warning at the controller's place in the YAML, once for each `what`."""
        if what in self._reported:
            return
        self._reported.add(what)
        controller = self._controller
        controller.sim.engine.reports.warning(
            code, f"controller {controller.name!r}: {message}", controller.params.where, hint
        )
