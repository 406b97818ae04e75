"""Base class of controllers: it claims hardware interfaces and is updated at the controller manager's rate."""

from __future__ import annotations

import abc
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, ClassVar, TypeVar

from simkit import Params
from simkit.extend import SharedByCopies
from simkit.msgs import Message
from simkit.plugins.attribute_state import copy_attributes, restore_attributes
from simkit.plugins.live_parameters import declare_at, descend
from simkit.plugins.one_time_warnings import OneTimeWarnings
from simkit.runtime.communication.parameter import Parameter
from simkit.topic_logger import TopicLogger
from simkit_control.plugins.ros2_control.hardware_interfaces import InterfaceSelection

if TYPE_CHECKING:
    from simkit import Plugin, Publisher, Simulation
    from simkit.extend import GoalHandle
    from simkit.runtime.communication.action_server import Action
    from simkit.runtime.communication.publisher import Listener
    from simkit.runtime.communication.service_server import Service
    from simkit_control.plugins.ros2_control.hardware import Hardware


Key = tuple[str, str]
# Callback of a subscriber, a service or an action.
Relay = Callable[..., Any]
Handle = TypeVar("Handle")


class ControllerEndpoints(SharedByCopies):
    """Topics, services and actions that the controllers of one name have opened.

    The endpoints stay open after a controller is unloaded. A controller of the same name that is loaded or configured
    again uses the same endpoints. Messages that arrive in the meantime are dropped.

    Attributes:
        handlers: callbacks of the current controller, by the kind and the name of the endpoint.
        is_active: function that checks whether the current controller is active, if a manager has set it.
    """

    def __init__(self) -> None:
        self._handles: dict[Key, Any] = {}
        self.handlers: dict[Key, Relay] = {}
        self.is_active: Callable[[], bool] | None = None

    def open(self, key: Key, make: Callable[[], Handle]) -> Handle:
        """Return the endpoint of a key; create it if it does not exist yet."""
        if key not in self._handles:
            self._handles[key] = make()
        handle: Handle = self._handles[key]
        return handle

    def relay(self, key: Key, handler: Relay, absent: Relay = lambda *_: None) -> Relay:
        """Set the handler of an endpoint; return a callback that calls the current handler, or `absent` without one."""
        self.handlers[key] = handler
        return lambda *values: self.handlers.get(key, absent)(*values)

    def close(self) -> None:
        """Remove all handlers."""
        self.handlers = {}


T = TypeVar("T", bound="bool | int | float | str | tuple[float, ...]")


class Controller(SharedByCopies, abc.ABC):
    """Base class of all controllers.

    The controller manager creates a controller and calls `configure` once. The manager calls `activate` and
    `deactivate` when the controller is switched, and `update` at the update rate while the controller is active. From
    `activate` to `deactivate` the controller has claimed the interfaces in `command_interfaces`. A written value stays
    until the controller writes again.

    Attributes:
        types: type names in YAML files that select this class
            (`joint_trajectory_controller/JointTrajectoryController`).
        name: name of the controller, such as `arm_controller`.
        plugin: plugin that hosts the controller manager.
        params: parameters of the controller from the YAML file: an element for each key, `a.b` as the element b in a, a
            list as repeated elements (`[j.value for j in params.all("joints")]`).
        hardware: joints with their limits and mimic relations, and the tables of interfaces.
        states: interfaces in `state_interfaces`, available after `configure`.
        commands: interfaces in `command_interfaces`, available after `configure`, claimed while the controller is
            active.
        update_rate: update rate [Hz]; 0 for the manager's update rate.
        remappings: source and target of the remapping rules that only this controller has.
        log: logger below `simkit`.
        endpoints: topics, services and actions; the manager keeps them for the next controller of the same name.
    """

    types: ClassVar[tuple[str, ...]] = ()

    name: str
    plugin: Plugin
    params: Params
    hardware: Hardware
    states: InterfaceSelection
    commands: InterfaceSelection
    update_rate: int = 0
    remappings: Sequence[tuple[str, str]] = ()
    log: TopicLogger
    endpoints: ControllerEndpoints

    def __init__(self, name: str, plugin: Plugin, params: Params, hardware: Hardware) -> None:
        """Initialise a controller; the controller manager calls this.

        Args:
            name: name of the controller.
            plugin: plugin that hosts the controller manager.
            params: parameters of the controller's node.
            hardware: joints and sensors that the controller may use.
        """
        self.name, self.plugin, self.params, self.hardware = name, plugin, params, hardware
        self.log = TopicLogger(f"simkit_control.plugins.ros2_control.{name}", plugin, f"{plugin.ros.namespace}/{name}")
        self.endpoints = ControllerEndpoints()

    # ------------------------------------------------------------------ methods that a controller implements

    @abc.abstractmethod
    def configure(self) -> None:
        """Read `params`, and open topics, services and actions; an error in `params` prevents the configuration."""

    def command_interfaces(self) -> Sequence[str]:
        """List the command interfaces to claim, such as `arm_1_joint/position`; called after `configure`."""
        return ()

    def state_interfaces(self) -> Sequence[str]:
        """List the state interfaces to read, such as `arm_1_joint/velocity`; called after `configure`."""
        return ()

    def activate(self) -> None:
        """Start from the current state; the interfaces are bound and claimed before this call."""

    def deactivate(self) -> None:
        """End goals; the interfaces are released after this call, and joints stay where they are."""

    @abc.abstractmethod
    def update(self, now_ns: int, period: float) -> None:
        """Read `states` and write `commands`.

        Args:
            now_ns: simulated time [ns].
            period: time since the last update [s].
        """

    # ------------------------------------------------------------------ methods that a controller calls

    @property
    def sim(self) -> Simulation:
        """Simulation that the plugin belongs to."""
        return self.plugin.sim

    def one_time_warnings(self) -> OneTimeWarnings:
        """Create a reporter of warnings with the controller's name and its line in the parameter file."""
        return OneTimeWarnings(self.plugin, f"controller {self.name!r}", self.params.where)

    def topic(self, name: str) -> str:
        """Return a name in the controller's node: `~/state` becomes `<controller>/state`."""
        return self.plugin.ros.topic_of_node(name, self.name, self.remappings)

    def advertise(self, topic: str, type_name: str, *, latched: bool = False) -> Publisher:
        """Create a publisher, like `Plugin.advertise`, in the controller's node."""
        name = self.topic(topic)
        publisher: Publisher = self.endpoints.open(
            ("advertise", f"{name} {type_name}"), lambda: self.plugin.advertise(name, type_name, latched=latched)
        )
        return publisher

    def listen(self, topic: str, types: str | Sequence[str], callback: Callable[[Message], None]) -> Listener:
        """Create a subscriber, like `Plugin.listen`, in the controller's node."""
        name, key = self.topic(topic), ("listen", f"{self.topic(topic)} {types}")
        relay = self.endpoints.relay(key, callback)
        listener: Listener = self.endpoints.open(key, lambda: self.plugin.listen(name, types, relay))
        listener.is_ready = self.endpoints.is_active
        return listener

    def offer(self, service: str, type_name: str, handler: Callable[[Message], object]) -> Service:
        """Create a service, like `Plugin.offer`, in the controller's node."""
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
        """Create an action server, like `Plugin.act`, in the controller's node."""
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
        """Declare a live parameter of the controller's node, like `Plugin.declare`; the YAML file sets its first value.

        Args:
            name: parameter name; dots separate the levels of the YAML file, as in `gains.arm_1_joint.p`.
            default: value if the YAML file has none; its type is the type of the parameter.
            minimum: lower bound of a number.
            maximum: upper bound of a number.
            choices: allowed values, if the parameter has a fixed list of them.
            description: meaning of the parameter, with its unit.
            on_change: callback for a new value, called between two steps.
        """
        plugin = self.plugin
        params, last = descend(self.params, name)
        node_name, model, sim = f"{plugin.ros.namespace}/{self.name}", plugin.scoped.partition("::")[0], plugin.sim
        parameter = Parameter(
            sim.communication.node_of(plugin, node_name, f"/{model}/{self.name}"),
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
        """Return a copy of every attribute that the controller set; handles and publishers are not duplicated.

        An attribute that cannot be copied is omitted and reported once (SK-PLUGIN-006).
        """
        return copy_attributes(self, _OWN_ATTRIBUTES, self._report_uncopied)

    def set_state(self, state: Mapping[str, object]) -> None:
        """Restore a state from `get_state`; attributes that could not be copied keep their values."""
        restore_attributes(self, _OWN_ATTRIBUTES, state)

    def _report_uncopied(self, attribute: str, error: Exception) -> None:
        message = f"controller {self.name!r}: attribute {attribute!r} cannot be copied"
        message = f"{message}, so snapshots and reset do not change it: {error}"
        self.sim.engine.reports.warning("SK-PLUGIN-006", message, self.params.where)


_OWN_ATTRIBUTES = frozenset(
    ("name", "plugin", "params", "hardware", "states", "commands", "remappings", "log", "endpoints", "_uncopied")
)
