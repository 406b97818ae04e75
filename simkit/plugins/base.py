"""Base classes of plugins: Python classes attached to a world, a model, a visual or a sensor.

A plugin is a class with a `load` method; all other methods are optional:

    class Hello(WorldPlugin):
        filenames = ("libhello.so",)

        def load(self, parent, params):
            self.log.info("hello")
"""

from __future__ import annotations

import abc
from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Final, Literal, TypeVar, overload

from simkit.completion import Completed
from simkit.diagnostics import NOWHERE, Diagnostics, Where
from simkit.msgs.message_types import named_type
from simkit.params import Params
from simkit.plugins.attribute_state import copy_attributes, restore_attributes
from simkit.plugins.endpoints import Endpoint
from simkit.plugins.one_time_warnings import OneTimeWarnings
from simkit.plugins.options import Options
from simkit.plugins.ros_names import RosNames
from simkit.plugins.uncalled_methods import uncalled_methods
from simkit.plugins.unread_parameters import report_unread
from simkit.topic_logger import TopicLogger

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.deferred_response import DeferredResponse
    from simkit.msgs import Message
    from simkit.msgs.message_classes import ActionGoal, ServiceRequest
    from simkit.msgs.message_types import F, M, R
    from simkit.run_spec import PluginErrorPolicy
    from simkit.runtime import Model, Simulation, Visual
    from simkit.runtime.array_rules import PluginRule
    from simkit.runtime.communication.action_server import Action, GoalHandle
    from simkit.runtime.communication.parameter import Parameter
    from simkit.runtime.communication.publisher import Listener, Publisher
    from simkit.runtime.communication.service_server import Service
    from simkit.runtime.communication.subscription import Subscription
    from simkit.runtime.engine.random_streams import RandomStream
    from simkit.scene import ScenePlugin, SceneSensor
    from simkit.sensors.base import Sensor

T = TypeVar("T", bound="bool | int | float | str | tuple[float, ...]")

Hook = Literal["prepare", "reset", "before_step", "after_step", "close"]
ParentKind = Literal["world", "model", "visual", "sensor", "any"]

NEVER: Final = 1e-9
"""Rate of a paused hook [Hz]: once in thirty years."""


class Plugin(Completed, abc.ABC):
    """Base class of all plugins; derive from `WorldPlugin`, `ModelPlugin`, `VisualPlugin` or `SensorPlugin`.

    A hook that a class does not override takes no time. A hook with a rate of r Hz runs at the first step at or after
    the simulated times k/r, for k = 1, 2, …; with a rate of None or 0 it runs at every step.

    Attributes:
        filenames: library names in files that select this class (`libgazebo_ros_diff_drive.so`).
        names: gz class names that select this class (`gz::sim::systems::DiffDrive`).
        parent_kind: kind, or kinds, of entities that the plugin can be attached to; derived base classes set it.
        lets_sleep: true if the model may sleep at rest without an effect on what the plugin reads or does.
        option_types: classes of options in addition to the class of `options`; see `simkit.plugins.options`.
        only_publishes: true if the plugin only publishes or waits for requests; a batch of environments then leaves its
            hooks out. The attribute does not hold for derived classes.
        endpoints: topics, services and actions whose names are not literals in `load`.
        before_step_rate, after_step_rate: rates of these hooks [Hz]; set in the class, or on the instance in `load`.
        on_error: "stop" ends the run after an exception in the plugin; "disable" continues without the plugin.
            `<simkit:on_error>` in the file overrides this attribute, and the argument of `simkit.load` overrides both.
            None is "stop".
        sim: simulation.
        name: name of the plugin in the file.
        scoped: scoped name of the entity that the plugin is attached to (empty for the world).
        params: parameters of the plugin.
        where: file and line of the plugin.
        ros: names as in a ROS node, with `<namespace>` and `<remapping>`.
        log: logger of the plugin, a child of the logger `simkit`.
    """

    _internal_names = frozenset(
        (
            *("code_objects", "drives", "get_loaded_state", "hand_over", "has_hook", "importing"),
            *("join_simulation", "node_names", "only_publishes", "plugin_paths", "reads_parameter_files"),
            *("report_unread", "take_source"),
        )
    )

    filenames: ClassVar[tuple[str, ...]] = ()
    names: ClassVar[tuple[str, ...]] = ()
    parent_kind: ClassVar[ParentKind | tuple[ParentKind, ...]] = "any"
    lets_sleep: ClassVar[bool] = False
    only_publishes: ClassVar[bool] = False
    option_types: ClassVar[tuple[type[Options], ...]] = ()
    endpoints: ClassVar[tuple[Endpoint, ...]] = ()
    drives: ClassVar[bool] = False  # true if the plugin moves joints; it is then ignored in a static model
    reads_parameter_files: ClassVar[bool] = False  # true if the plugin reads the run's parameter files

    before_step_rate: float | None = None
    after_step_rate: float | None = None
    on_error: PluginErrorPolicy | None = None

    plugin_paths: tuple[Path, ...] = ()  # folders whose Python modules the user allows
    _source: ScenePlugin | None = None
    sim: Simulation
    name: str = ""
    scoped: str = ""
    params: Params
    where: Where = NOWHERE
    ros: RosNames
    log: TopicLogger

    def __init__(self, **values: object) -> None:
        """Create a plugin in Python instead of in a file.

        Args:
            values: parameters as in a file: `MyPlugin(gain=2.0, topic="out")`. Dicts are blocks, lists are repeated
                elements, tuples are the numbers of one element.
        """
        self._values = values

    # ------------------------------------------------------------------ hooks that a plugin's author writes

    def prepare(self, scene: Any, params: Params, builder: SpecBuilder) -> None:
        """Check names and add actuators and sites through `builder`, before the model is compiled.

        Args:
            scene: scene object of the parent: `SceneWorld`, `SceneModel`, `SceneVisual` or `SceneSensor`.
            params: parameters of the plugin; an error that is reported through them stops the load.
            builder: builder of the MuJoCo spec.
        """

    @abc.abstractmethod
    def load(self, parent: Any, params: Params, /) -> None:
        """Read parameters, open topics and find links and joints; called once, when the simulation is complete.

        Args:
            parent: `Simulation`, `Model`, `Visual` or `Sensor` that the plugin is attached to.
            params: parameters of the plugin; each read names the type and a default.
        """

    def reset(self) -> None:
        """React to a reset to t = 0; the plugin's attributes already have the values that they had after `load`."""

    def before_step(self) -> None:
        """Write commands before a physics step."""

    def after_step(self) -> None:
        """Read the state after a physics step."""

    def close(self) -> None:
        """Release resources when the simulation closes."""

    def array_rule(self) -> PluginRule | None:
        """Return what the plugin does in many simulations at once, which a batch of environments needs.

        The method does not hold for derived classes. Without it, a world with the plugin's hooks is not batched.

        Raises:
            CannotBatchError: the plugin cannot be computed as arrays with its present options.
        """
        return None

    # ------------------------------------------------------------------ methods that a plugin's author calls

    @overload
    def advertise(self, topic: str, type_name: type[M], *, latched: bool = False) -> Publisher[M]: ...

    @overload
    def advertise(self, topic: str, type_name: str, *, latched: bool = False) -> Publisher[Any]: ...

    def advertise(self, topic: str, type_name: str | type, *, latched: bool = False) -> Publisher[Any]:
        """Open a publisher; `topic` is expanded and remapped as in ROS.

        Args:
            topic: name of the topic.
            type_name: type, such as `nav_msgs/msg/Odometry` or `msgs.Odometry`.
            latched: send the last message to a later subscriber (transient local).
        """
        type_name = named_type(type_name)
        with self.sim.communication.bus.owned_by(self):
            return self.sim.communication.bus.advertise(self.ros.topic(topic), type_name, latched=latched)

    @overload
    def listen(self, topic: str, types: type[M], callback: Callable[[M], object]) -> Listener: ...

    @overload
    def listen(self, topic: str, types: str | Sequence[str], callback: Callable[[Message], object]) -> Listener: ...

    def listen(self, topic: str, types: str | type | Sequence[str], callback: Callable[[Message], object]) -> Listener:
        """Call `callback(message)` between two steps for each message on `topic`; it may have any of the `types`."""
        types = named_type(types) if isinstance(types, type) else types
        name = self.ros.topic(topic)
        guarded = self.sim.engine.faults.guard(self, f"its callback for {name!r}", callback)
        with self.sim.communication.bus.owned_by(self):
            kinds = (types,) if isinstance(types, str) else types
            return self.sim.communication.bus.listen(name, kinds, guarded)

    @overload
    def subscribe(
        self, topic: str, callback: Callable[[M], None] | None = None, keep: int | None = None, *, type: type[M]
    ) -> Subscription[M]: ...

    @overload
    def subscribe(
        self, topic: str, callback: Callable[[Message], None] | None = None, keep: int | None = None
    ) -> Subscription[Any]: ...

    def subscribe(
        self,
        topic: str,
        callback: Callable[[Message], None] | None = None,
        keep: int | None = None,
        *,
        type: type | None = None,
    ) -> Subscription[Any]:
        """Receive each message on a topic at the moment of its publication.

        Use this method for sensor readings. Use `listen` for commands: its callbacks run between two steps.

        Args:
            topic: name of the topic, expanded and remapped as in ROS.
            callback: function called with each message.
            keep: number of the newest messages to store in `.messages`.
            type: class that the messages must have, such as `msgs.LaserScan`; None for any.
        """
        name = self.ros.topic(topic)
        guarded = callback and self.sim.engine.faults.guard(self, f"its callback for {name!r}", callback)
        with self.sim.communication.bus.owned_by(self):
            subscription = self.sim.communication.subscribe(name, guarded, keep, "stop", type)
        subscription.owner = self  # one that is removed with its model receives nothing
        return subscription

    @overload
    def offer(
        self,
        service: str,
        type_name: type[ServiceRequest[M, R]],
        handler: Callable[[M], R | Mapping[str, object] | DeferredResponse | None],
    ) -> Service: ...

    @overload
    def offer(self, service: str, type_name: str, handler: Callable[[Message], object]) -> Service: ...

    def offer(self, service: str, type_name: str | type, handler: Callable[[Message], object]) -> Service:
        """Open a service.

        Args:
            service: name of the service, expanded and remapped as in ROS.
            type_name: type of the service, such as `std_srvs/srv/Trigger`, or the class of its requests.
            handler: function from the request to the response: a message, a dict of fields, or None for all zeros.
        """
        with self.sim.communication.bus.owned_by(self):
            return self.sim.communication.services.offer(self.ros.topic(service), type_name, handler)

    @overload
    def act(
        self,
        action: str,
        type_name: type[ActionGoal[M, R, F]],
        on_goal: Callable[[GoalHandle[M]], None],
        on_cancel: Callable[[GoalHandle[M]], bool | None] | None = None,
    ) -> Action: ...

    @overload
    def act(
        self,
        action: str,
        type_name: str,
        on_goal: Callable[[GoalHandle], None],
        on_cancel: Callable[[GoalHandle], bool | None] | None = None,
    ) -> Action: ...

    def act(
        self,
        action: str,
        type_name: str | type,
        on_goal: Callable[[GoalHandle], None],
        on_cancel: Callable[[GoalHandle], bool | None] | None = None,
    ) -> Action:
        """Open an action of a type such as `control_msgs/action/FollowJointTrajectory`.

        Args:
            action: name of the action, expanded and remapped as in ROS.
            type_name: type of the action, or the class of its goals.
            on_goal: function called between two steps with each new goal; it may call the goal's `reject`. An accepted
                goal is active until a hook calls the goal's `succeed`, `abort` or `canceled`. A hook may report
                progress with `publish_feedback`.
            on_cancel: function called with a goal that a client cancels; it returns False to continue the goal. Without
                a function, every goal continues.
        """
        with self.sim.communication.bus.owned_by(self):
            return self.sim.communication.actions.act(self.ros.topic(action), type_name, on_goal, on_cancel)

    def declare(
        self,
        name: str,
        default: T,
        *,
        minimum: float | None = None,
        maximum: float | None = None,
        choices: Sequence[object] = (),
        description: str = "",
        element: str | None = None,
        on_change: Callable[[T], None] | None = None,
    ) -> Parameter[T]:
        """Declare a live parameter, which may change while the simulation runs; call this method in `load`.

        Args:
            name: name of the parameter, such as `p_gain`.
            default: value if the file has none. Values have its type: bool, int, float, str or tuple of numbers.
            minimum: lower bound of the number, or of each number of a tuple.
            maximum: upper bound of the number, or of each number of a tuple.
            choices: allowed values; empty for no restriction.
            description: meaning of the parameter, with its unit.
            element: element with the first value; `name` by default. `a.b` is the element `<b>` in the block `<a>`.
            on_change: function called with a new value, between two steps.

        Returns:
            The parameter; its attribute `value` is always the current value.
        """
        from simkit.plugins.live_parameters import declare_at, find_first_value
        from simkit.runtime.communication.parameter import Parameter

        if on_change is not None:
            on_change = self.sim.engine.faults.guard(self, f"its callback for parameter {name!r}", on_change)
        parameter = Parameter(
            self.sim.communication.node_of_plugin(self),
            name,
            default,
            minimum=minimum,
            maximum=maximum,
            choices=choices,
            description=description,
            on_change=on_change,
            owner=self,
        )
        return declare_at(self, parameter, *find_first_value(self, name, element or name))

    def random(self, channel: str, width: int = 1) -> RandomStream:
        """Return a random stream of this plugin.

        The stream's `normal(index)` returns `width` numbers. They depend only on seed, plugin, `channel` and `index`.
        """
        owner = f"{self.scoped}::{self.name}" if self.scoped else self.name
        return self.sim.engine.streams.stream(owner, channel, width)

    @property
    def period(self) -> float:
        """Physics step [s]."""
        return float(self.sim.timestep)

    # ------------------------------------------------------------------ methods that the simulation calls

    @property
    def source(self) -> ScenePlugin | None:
        """Description of the plugin in the file; None for a plugin created in Python."""
        return self._source

    @source.setter
    def source(self, _: object) -> None:
        raise AttributeError("`source` is the plugin's description in the file; rename your own attribute")

    def take_source(self, source: ScenePlugin, plugin_paths: Sequence[Path] = ()) -> None:
        """Set the name, location and parameters from the file; done before `prepare`.

        Args:
            source: description of the plugin in the file.
            plugin_paths: folders whose Python modules the user allows.
        """
        self._source, self.plugin_paths = source, tuple(plugin_paths)
        self._describe(source.name, source.scoped, source.params, source.where)

    def hand_over(self, diagnostics: Diagnostics, scoped: str = "") -> None:
        """Set the name, location and parameters of an instance created in Python; done before `prepare`.

        Args:
            diagnostics: collector of problems with the parameters.
            scoped: scoped name of the entity that the plugin is attached to; empty for the world.
        """
        self._source = None
        params = Params.from_dict(vars(self).get("_values", {}), "plugin", diagnostics)
        self._describe(self.name or type(self).__name__, scoped, params, NOWHERE)

    def _describe(self, name: str, scoped: str, params: Params, where: Where) -> None:
        self.name, self.scoped, self.params, self.where = name, scoped, params, where
        self.ros = RosNames.from_params(self.params, self.name)
        self.ros.scoped = scoped
        if self.params.has("on_error"):
            from simkit.runtime.engine.plugin_faults import PLUGIN_ERROR_POLICIES

            self.on_error = "disable" if self.params.choice("on_error", PLUGIN_ERROR_POLICIES) == "disable" else "stop"
        self.log = TopicLogger(f"simkit.plugins.{self.name}", self)

    def _set_before_step_rate(self, rate: float | None) -> None:
        """Change the rate of `before_step` [Hz] from now on."""
        if rate != self.before_step_rate:
            self.before_step_rate = rate
            self.sim.engine.reschedule()

    def _set_after_step_rate(self, rate: float | None) -> None:
        """Change the rate of `after_step` [Hz] from now on."""
        if rate != self.after_step_rate:
            self.after_step_rate = rate
            self.sim.engine.reschedule()

    @property
    def node_names(self) -> tuple[str, ...]:
        """Full names of the nodes whose parameters the plugin has."""
        return (f"{self.ros.namespace}/{self.ros.node}",)

    def report_unread(self) -> None:
        """Warn about elements of the file that the plugin did not read and look-alikes of hooks; done after `load`."""
        report_unread(self.params, f"plugin {self.name!r}", self.code_objects()[0])
        if not self.reads_parameter_files:
            self.ros.arguments.report_unused(f"plugin {self.name!r}", self.params.diagnostics)
        for method, hook in uncalled_methods(type(self)):
            if not self.has_hook(hook):
                message = f"plugin {self.name!r}: simkit does not call {method}"
                help_text = f"rename it to {hook}, if it shall run at each step"
                self.params.diagnostics.warning("SK-PLUGIN-013", message, self.where, help_text)

    def join_simulation(self, sim: Simulation) -> None:
        """Connect the instance to its simulation; done before `load`."""
        self.sim, self._once = sim, OneTimeWarnings(self)
        if self._source is not None:
            self.take_source(self._source, self.plugin_paths)
        elif not hasattr(self, "params"):
            self.hand_over(Diagnostics())

    def code_objects(self) -> tuple[object, ...]:
        """Return the objects with code of the plugin's author; the first one reads the parameters."""
        return (self,)

    def importing(self) -> AbstractContextManager[None]:
        """Return a context in which the modules of the plugin's author can be imported."""
        return nullcontext()

    @classmethod
    def has_hook(cls, hook: Hook) -> bool:
        """Check whether the class overrides an optional hook."""
        return getattr(cls, hook) is not getattr(Plugin, hook)

    def get_state(self) -> dict[str, object]:
        """Return a copy of every attribute that the plugin has set; handles and publishers are not copied.

        An attribute that cannot be copied is left out and reported once (SK-PLUGIN-006). Override this method and
        `set_state` to store such an attribute.
        """
        return copy_attributes(self, _OWNED, self._report_uncopied)

    def set_state(self, state: Mapping[str, object]) -> None:
        """Restore a state from `get_state`; later attributes are deleted, except those that cannot be copied."""
        restore_attributes(self, _OWNED, state)

    def _report_uncopied(self, attribute: str, error: Exception) -> None:
        message = f"plugin {self.name!r}: attribute {attribute!r} cannot be copied"
        message = f"{message}; snapshots and reset do not change it: {error}"
        self.sim.engine.reports.warning("SK-PLUGIN-006", message, self.where, "override get_state and set_state")

    def get_loaded_state(self) -> dict[str, object]:
        """Return the state after `load`, and report attributes that cannot be copied."""
        return self.get_state()

    def __repr__(self) -> str:
        name = f"{self.scoped}::{self.name}" if self.scoped else self.name
        return f"<{type(self).__name__} {name!r}>"

    def __deepcopy__(self, memo: dict[int, object]) -> Plugin:
        return self


_OWNED = frozenset(
    ("sim", "name", "scoped", "params", "where", "ros", "log", "_source", "_uncopied", "_values")  # noqa: RUF005
    + ("_once", "_read_options", "plugin_paths")
)


class WorldPlugin(Plugin):
    """Plugin of the world: `prepare` receives a `SceneWorld`, `load` the `Simulation`."""

    parent_kind = "world"

    if TYPE_CHECKING:  # a base class beside this one may have the method

        @abc.abstractmethod
        def load(self, parent: Simulation, params: Params, /) -> None: ...


class ModelPlugin(Plugin):
    """Plugin of a model: `prepare` receives a `SceneModel`, `load` the `Model`."""

    parent_kind = "model"

    if TYPE_CHECKING:  # a base class beside this one may have the method

        @abc.abstractmethod
        def load(self, parent: Model, params: Params, /) -> None: ...


class VisualPlugin(Plugin):
    """Plugin of a visual: `prepare` receives a `SceneVisual`, `load` the `Visual`."""

    parent_kind = "visual"

    if TYPE_CHECKING:  # a base class beside this one may have the method

        @abc.abstractmethod
        def load(self, parent: Visual, params: Params, /) -> None: ...


class SensorPlugin(Plugin):
    """Plugin of a sensor: `prepare` receives a `SceneSensor`, `load` the `Sensor`."""

    parent_kind = "sensor"

    @classmethod
    def complete(cls, sensor: SceneSensor, params: Params) -> SceneSensor:  # noqa: ARG003 - for overrides
        """Return the sensor with the elements that its plugin has in place of it; called before the sensor is made.

        Args:
            sensor: sensor as read from the file.
            params: the `<plugin>`.
        """
        return sensor

    def refuse(self, sensor: Sensor, required_kind: str) -> None:
        """Report that the plugin is attached to a sensor of the wrong type."""
        message = f"plugin {self.name!r} needs a sensor of type {required_kind}; this sensor is {sensor.kind!r}"
        self.params.error("SK-PLUGIN-003", message)
