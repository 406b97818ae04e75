"""What a plugin is: Python that hangs on a world, a model, a visual or a sensor and is called as the run goes.

Write a class with a `load` method; everything else is optional:

    class Hello(WorldPlugin):
        filenames = ("libhello.so",)

        def load(self, parent, params):
            self.log.info("hello")
"""

from __future__ import annotations

import abc
import copy
import logging
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Final, Literal, TypeVar

from simkit.diagnostics import NOWHERE, Diagnostics, Where
from simkit.params import Params
from simkit.plugins.endpoints import Endpoint
from simkit.plugins.options import Options
from simkit.plugins.ros_names import RosNames
from simkit.plugins.unread_parameters import report_unread

if TYPE_CHECKING:
    from simkit.compiler import ActuatorRef, SpecBuilder
    from simkit.run_spec import PluginErrorPolicy
    from simkit.runtime import Simulation
    from simkit.runtime.communication.action_server import Action, GoalHandle
    from simkit.runtime.communication.parameter_server import Parameter
    from simkit.runtime.communication.publisher import Listener, Publisher
    from simkit.runtime.communication.service_server import Service
    from simkit.runtime.communication.subscription import Subscription
    from simkit.runtime.engine.random_streams import RandomStream
    from simkit.scene import ScenePlugin
    from simkit.sensors.base import Sensor

T = TypeVar("T", bound="bool | int | float | str | tuple[float, ...]")

Hook = Literal["prepare", "reset", "before_step", "after_step", "close"]
ParentKind = Literal["world", "model", "visual", "sensor", "any"]

NEVER: Final = 1e-9
"""[Hz]; the rate of a hook that is not called for now: once in thirty years."""


class Plugin(abc.ABC):
    """Base of all plugins; derive from `WorldPlugin`, `ModelPlugin`, `VisualPlugin` or `SensorPlugin`.

    A hook that a class does not override costs nothing. Hooks run on the grid of simulated time: with a rate of
    r Hz at the first step at or after k/r, k = 1, 2, …; with None or 0 at every step.

    Attributes:
        filenames: library names in files that stand for this class (`libgazebo_ros_diff_drive.so`).
        names: gz class names that do (`gz::sim::systems::DiffDrive`).
        parent_kind: what it may hang on; the base classes set it. Several kinds where the file may choose.
        lets_sleep: whether a model that it hangs on may sleep while it rests: nobody could tell by this plugin.
        option_types: classes of options that it reads, besides that of its `options`; see `simkit.plugins.options`.
        endpoints: its topics, services and actions where `load` does not name them literally.
        before_step_rate, after_step_rate: [Hz]; set in the class, or on the instance in `load`.
        on_error: "stop": what it raises stops the run; "disable": the run goes on without it. `<simkit:on_error>` in
            the file goes over it, and what `simkit.load` is told over both. None is "stop".
        sim: the simulation.
        name: the plugin's name in the file.
        scoped: the entity it hangs on (empty for the world).
        params: its parameters.
        where: file and line.
        ros: topic names after `<namespace>` and `<remapping>`.
        log: a logger below `simkit`.
    """

    filenames: ClassVar[tuple[str, ...]] = ()
    names: ClassVar[tuple[str, ...]] = ()
    parent_kind: ClassVar[ParentKind | tuple[ParentKind, ...]]
    lets_sleep: ClassVar[bool] = False
    option_types: ClassVar[tuple[type[Options], ...]] = ()
    endpoints: ClassVar[tuple[Endpoint, ...]] = ()
    drives: ClassVar[bool] = False  # whether it moves joints of its model; on a static one it is left out
    reads_parameter_files: ClassVar[bool] = False  # whether it reads those of `params_files`

    before_step_rate: float | None = None
    after_step_rate: float | None = None
    on_error: PluginErrorPolicy | None = None

    _failed: tuple[str, Exception] | None = None  # what it raised before there was a simulation, and where
    _actuators: tuple[ActuatorRef, ...] = ()  # servos and motors that its `prepare` added
    _order: tuple[object, ...] = ()  # where it stands among all plugins
    plugin_paths: tuple[Path, ...] = ()  # folders whose Python the user allows
    _source: ScenePlugin | None = None
    sim: Simulation
    name: str = ""
    scoped: str = ""
    params: Params
    where: Where = NOWHERE
    ros: RosNames
    log: logging.Logger

    def __init__(self, **values: Any) -> None:
        """A plugin made in Python.

        Args:
            values: its parameters, as a file would give them: `MyPlugin(gain=2.0, topic="out")`. Dicts are blocks,
                lists repeated elements, tuples the numbers of one.
        """
        self._values = values

    # ------------------------------------------------------------------ what a user writes

    def prepare(self, scene: Any, params: Params, builder: SpecBuilder) -> None:
        """Before the model is compiled: check names, add actuators and sites through `builder`.

        Args:
            scene: the resolved entity: `SceneWorld`, `SceneModel`, `SceneVisual` or `SceneSensor`.
            params: the plugin's parameters; problems recorded here stop the load like any other.
            builder: the door to the MuJoCo spec.
        """

    @abc.abstractmethod
    def load(self, parent: Any, params: Params) -> None:
        """Once, when everything is built: read parameters, open topics, find links and joints.

        Args:
            parent: the `Simulation`, `Model`, `Visual` or `Sensor` it hangs on.
            params: the plugin's parameters, to be read by type and default.
        """

    def reset(self) -> None:
        """Back at t = 0; the plugin's attributes are already what they were after `load`."""

    def before_step(self) -> None:
        """Before a physics step: commands."""

    def after_step(self) -> None:
        """After a physics step: readings."""

    def close(self) -> None:
        """When the simulation closes."""

    # ------------------------------------------------------------------ what a user calls

    def advertise(self, topic: str, type_name: str, *, latched: bool = False) -> Publisher:
        """A publisher on `topic` (expanded and remapped as in ROS), of a type such as `nav_msgs/msg/Odometry`."""
        with self.sim.communication.bus.owned_by(self):
            return self.sim.communication.bus.advertise(self.ros.topic(topic), type_name, latched=latched)

    def listen(self, topic: str, types: str | Sequence[str], callback: Callable[[Any], object]) -> Listener:
        """Calls `callback(message)` between two steps for each message on `topic`; the first type is the listed one."""
        name = self.ros.topic(topic)
        guarded = self.sim.engine.faults.guard(self, f"its callback for {name!r}", callback)
        with self.sim.communication.bus.owned_by(self):
            kinds = (types,) if isinstance(types, str) else types
            return self.sim.communication.bus.listen(name, kinds, guarded)

    def subscribe(
        self, topic: str, callback: Callable[[Any], None] | None = None, keep: int | None = None
    ) -> Subscription:
        """Receives what others publish on `topic` (expanded and remapped as in ROS), at the moment they do.

        To be used for readings; what comes in as a command is for `listen`, which takes it between two steps.

        Args:
            topic: its name.
            callback: called with each message.
            keep: how many of the newest messages `.messages` has.
        """
        name = self.ros.topic(topic)
        guarded = callback and self.sim.engine.faults.guard(self, f"its callback for {name!r}", callback)
        with self.sim.communication.bus.owned_by(self):
            return self.sim.subscribe(name, guarded, keep)

    def offer(self, service: str, type_name: str, handler: Callable[[Any], Any]) -> Service:
        """Opens a service (its name expanded and remapped as in ROS), of a type such as `std_srvs/srv/Trigger`.

        Args:
            service: its name.
            type_name: its type.
            handler: given the request, gives the response: a message, a dict of its fields, or None for all zero.
        """
        with self.sim.communication.bus.owned_by(self):
            return self.sim.offer(self.ros.topic(service), type_name, handler)

    def act(
        self,
        action: str,
        type_name: str,
        on_goal: Callable[[GoalHandle], None],
        on_cancel: Callable[[GoalHandle], bool | None] | None = None,
    ) -> Action:
        """Opens an action of a type such as `control_msgs/action/FollowJointTrajectory`.

        Args:
            action: its name, expanded and remapped as in ROS.
            type_name: its type.
            on_goal: called with each goal between two steps. It may `reject` it; else it is being worked on, until
                a hook ends it with `succeed`, `abort` or `canceled`; `publish_feedback` tells how far it is.
            on_cancel: called with a goal that is to be cancelled; gives False to go on. Without it, nothing is.
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
        choices: Sequence[T] = (),
        description: str = "",
        element: str | None = None,
        on_change: Callable[[T], None] | None = None,
    ) -> Parameter[T]:
        """A live parameter, which may be changed while the simulation runs; to be called in `load`.

        Args:
            name: its name, such as `p_gain`.
            default: its value where the file says nothing; its type is the parameter's: bool, int, float, str, or a
                tuple of numbers.
            minimum, maximum: bounds of a number (of each of several).
            choices: what is allowed, where that is a list.
            description: what it is, with its unit.
            element: the element of the file that holds its first value; of the same name unless given.
            on_change: called with a new value, between two steps.

        Returns:
            The parameter, whose `value` is always the present one.
        """
        from simkit.plugins.live_parameters import declare_at
        from simkit.runtime.communication.parameter_server import Parameter

        own = f"{self.ros.namespace}/{self.name}"
        otherwise = "/" + "/".join(filter(None, (*self.scoped.split("::"), self.name)))
        # a model has several of one class under one name: then the plugin itself says what tells them apart
        otherwise = getattr(self, "node", otherwise)
        node = self.sim.communication.live_parameters.node_of(self, otherwise if "::" in self.name else own, otherwise)
        if on_change is not None:
            on_change = self.sim.engine.faults.guard(self, f"its callback for parameter {name!r}", on_change)
        parameter = Parameter(
            node,
            name,
            default,
            minimum=minimum,
            maximum=maximum,
            choices=choices,
            description=description,
            on_change=on_change,
            owner=self,
        )
        return declare_at(self, parameter, self.params, element or name)

    def random(self, channel: str, width: int = 1) -> RandomStream:
        """This plugin's own random stream: `.normal(index)` has `width` numbers that depend on seed, name and index."""
        owner = f"{self.scoped}::{self.name}" if self.scoped else self.name
        return self.sim.engine.streams.stream(owner, channel, width)

    @property
    def period(self) -> float:
        """Step of the physics [s]."""
        return float(self.sim.timestep)

    # ------------------------------------------------------------------ what the simulation calls

    @property
    def source(self) -> ScenePlugin | None:
        """The plugin as the file has it; None for one made in Python."""
        return self._source

    @source.setter
    def source(self, plugin: ScenePlugin | None) -> None:
        """Gives the instance its name, place and parameters; done before `prepare`."""
        if plugin is not None and not hasattr(plugin, "params"):
            raise AttributeError("`source` is the plugin as the file has it; give an attribute of yours another name")
        self._source = plugin
        if plugin is None:
            self.hand_over(Diagnostics())
            return
        self._describe(plugin.name, plugin.scoped, plugin.params, plugin.where)

    def hand_over(self, diagnostics: Diagnostics, scoped: str = "") -> None:
        """Gives an instance made in Python its name, place and parameters; done before `prepare`.

        Args:
            diagnostics: where problems of its parameters go.
            scoped: what it hangs on; empty for the world.
        """
        self._source = None
        params = Params.from_dict(vars(self).get("_values", {}), "plugin", diagnostics)
        self._describe(self.name or type(self).__name__, scoped, params, NOWHERE)

    def _describe(self, name: str, scoped: str, params: Params, where: Where) -> None:
        self.name, self.scoped, self.params, self.where = name, scoped, params, where
        self.ros = RosNames.from_params(self.params, self.name)
        if self.params.has("on_error"):
            from simkit.runtime.engine.plugin_faults import PLUGIN_ERROR_POLICIES

            self.on_error = "disable" if self.params.choice("on_error", PLUGIN_ERROR_POLICIES) == "disable" else "stop"
        self.log = logging.getLogger(f"simkit.plugins.{self.name}")

    def report_unread(self) -> None:
        """Warns about what the file says and the plugin did not read; done after `load`."""

        report_unread(self.params, f"plugin {self.name!r}", getattr(self, "system", self) or self)

    def _setup(self, sim: Simulation, source: ScenePlugin | None = None) -> None:
        """Ties the instance to its simulation; done before `load`."""
        self.sim = sim
        if source is not None or not hasattr(self, "params"):
            self.source = source

    @classmethod
    def has_hook(cls, hook: Hook) -> bool:
        """Whether the class overrides an optional hook."""
        return getattr(cls, hook) is not getattr(Plugin, hook)

    def get_state(self) -> dict[str, Any]:
        """A copy of every attribute the plugin gave itself; handles and publishers stand for themselves.

        An attribute that cannot be copied is left out and reported once (SK-PLUGIN-006); override this method and
        `set_state` to keep it.
        """
        own = {k: v for k, v in vars(self).items() if k not in _OWNED}
        memo: dict[int, object] = {id(self): self}
        try:
            return copy.deepcopy(own, memo)
        except Exception:  # noqa: BLE001 - a foreign object may raise anything when copied
            return self._state_by_attribute(own)

    def set_state(self, state: Mapping[str, Any]) -> None:
        """Back to a state from `get_state`; attributes made since are dropped, uncopied ones stay as they are."""
        uncopied = vars(self).get("_uncopied", set())
        for key in [k for k in vars(self) if k not in _OWNED and k not in state and k not in uncopied]:
            delattr(self, key)
        vars(self).update(copy.deepcopy(dict(state), {id(self): self}))

    def _state_by_attribute(self, own: dict[str, object]) -> dict[str, Any]:
        memo: dict[int, object] = {id(self): self}
        state, uncopied = {}, set()
        for key, value in own.items():
            try:
                state[key] = copy.deepcopy(value, memo)
            except Exception as error:  # noqa: BLE001 - as above
                uncopied.add(key)
                if key not in vars(self).get("_uncopied", set()):
                    uncopyable = f"plugin {self.name!r}: attribute {key!r} cannot be copied"
                    message = f"{uncopyable}, snapshots and reset leave it as it is: {error}"
                    self.sim.engine.reports.warning(
                        "SK-PLUGIN-006", message, self.where, "override get_state and set_state"
                    )
        self._uncopied = uncopied
        return state

    def _remember_loaded(self) -> None:
        """After `load`: an attribute that cannot be copied is reported now and not at the first snapshot."""
        self.get_state()

    def __deepcopy__(self, memo: dict[int, object]) -> Plugin:
        return self


_OWNED = frozenset(
    ("sim", "name", "scoped", "params", "where", "ros", "log", "_source", "_uncopied", "_values")  # noqa: RUF005
    + ("_actuators", "_failed", "_order", "_read_options", "plugin_paths")
)


class WorldPlugin(Plugin):
    """Hangs on the world; `load` gets the `Simulation`, `prepare` the `SceneWorld`."""

    parent_kind = "world"


class ModelPlugin(Plugin):
    """Hangs on a model; `load` gets the `Model`, `prepare` the `SceneModel`."""

    parent_kind = "model"


class VisualPlugin(Plugin):
    """Hangs on a visual; `load` gets the `Visual`, `prepare` the `SceneVisual`."""

    parent_kind = "visual"


class SensorPlugin(Plugin):
    """Hangs on a sensor; `load` gets the `Sensor`, `prepare` the `SceneSensor`."""

    parent_kind = "sensor"

    def refuse(self, sensor: Sensor, wanted: str) -> None:
        """Reports that it hangs on a sensor of another type than the one it is for."""
        message = f"plugin {self.name!r} is for a sensor of type {wanted}, this is {sensor.kind!r}"
        self.params.error("SK-PLUGIN-003", message)
