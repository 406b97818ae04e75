"""Doors and lifts of Open-RMF: `libdoor.so`, `liblift.so` and `libregister_component.so` of rmf_simulation."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from simkit import Params, Plugin, msgs
from simkit.extend import NEVER, OptionsOf, SceneModel, listens, publish_while_subscribed, publishes
from simkit_open_rmf.plugins.door_motion import OPEN, DoorMotion, DoorOptions, Leaf, read_leaves
from simkit_open_rmf.plugins.lift_motion import (
    LIFT_STATE,
    Floor,
    LiftDescription,
    LiftMotion,
    LiftOptions,
    read_lift,
)

if TYPE_CHECKING:
    from simkit.extend import SpecBuilder

DOOR_REQUEST: Final = "rmf_door_msgs/msg/DoorRequest"
DOOR_STATE: Final = "rmf_door_msgs/msg/DoorState"
LIFT_REQUEST: Final = "rmf_lift_msgs/msg/LiftRequest"
_RATE: Final = 1.0  # rate of the states [Hz]
_DOOR_TOPICS: Final = (listens("/door_requests", DOOR_REQUEST), publishes("/door_states", DOOR_STATE))
_LIFT_TOPICS: Final = (listens("/lift_requests", LIFT_REQUEST), publishes("/lift_states", LIFT_STATE))


class RmfBuildingPlugin(Plugin):
    """Base class of doors and lifts of a model."""

    parent_kind = ("model", "world")
    drives = True
    _door: DoorMotion | None = None
    _lift: LiftMotion | None = None
    _leaves: tuple[Leaf, ...] = ()
    _described_lift: LiftDescription | None = None
    _door_params: Params | None = None
    _lift_params: Params | None = None
    _has_door_topics = True

    def prepare(self, scene: Any, params: Params, builder: SpecBuilder) -> None:
        if isinstance(scene, SceneModel):  # a plugin of the world has no parameters
            self.read(params)
            if self._door_params is not None:
                self._leaves = read_leaves(scene, self._door_params, builder, self.name)
            if self._lift_params is not None:
                self._described_lift = read_lift(scene, self._lift_params, builder, self.name)

    def read(self, params: Params) -> None:
        """Set the elements that describe a door or a lift."""

    def load(self, parent: Any, params: Params) -> None:
        self.before_step_rate = NEVER
        if self._leaves and self._door_params is not None:
            options = DoorOptions(self._door_params).read_all()
            self._door = DoorMotion(parent.name, self._leaves, options, self.sim)
            if self._has_door_topics:
                self.listen("/door_requests", DOOR_REQUEST, self._on_door)
                self._door_states = self.advertise("/door_states", DOOR_STATE)
                publish_while_subscribed(self, self._door_states, _RATE, "publish_door")
            self._begin(self._door.is_active)
        if self._described_lift is not None and self._lift_params is not None:
            lift, limits = self._described_lift, LiftOptions(self._lift_params).read_all()
            self.sim.joint(lift.joint).set_position(lift.floors[lift.initial].elevation)
            self._lift = LiftMotion(parent.name, lift, limits, self.sim)
            self.listen("/lift_requests", LIFT_REQUEST, self._on_lift)
            self._lift_states = self.advertise("/lift_states", LIFT_STATE)
            publish_while_subscribed(self, self._lift_states, _RATE, "publish_lift")
        self._control()

    @property
    def door(self) -> DoorMotion | None:
        """Door of the model; None for a lift or a plugin of the world."""
        return self._door

    @property
    def lift(self) -> LiftMotion | None:
        """Lift of the model; None for a door or a plugin of the world."""
        return self._lift

    # ------------------------------------------------------------------ commands

    def _on_door(self, message: msgs.DoorRequest) -> None:
        if self._door is not None and message.door_name == self._door.name:
            self.command_door(OPEN if message.requested_mode.value == OPEN else 0)

    def command_door(self, mode: int) -> None:
        """Open or close the door from the next step on."""
        if self._door is not None:
            self._door.command(mode)
            self._begin(self._door.is_active)

    def _on_lift(self, message: msgs.LiftRequest) -> None:
        if self._lift is not None and message.lift_name == self._lift.name:
            reason = self._lift.request(message)
            if reason:
                self._once.left_out(reason, reason)
            self._begin(self._lift.is_active)

    def _begin(self, is_active: bool) -> None:
        if is_active:
            self._set_before_step_rate(None)

    # ------------------------------------------------------------------ motion

    def before_step(self) -> None:
        """Move the references of the joints by one step; when the door or the lift has arrived, the calls end."""
        door, lift = self._door, self._lift
        before = (None if door is None else door.mode, None if lift is None else self._lift_summary(lift))
        if door is not None:
            door.step(self.period)
        if lift is not None:
            lift.step(self.period, self._doors_at, self._command_doors)
        self._control()
        if door is not None and door.mode != before[0] and self._has_door_topics:
            self.publish_door()
        if lift is not None and self._lift_summary(lift) != before[1]:
            self.publish_lift()
        if not (door is not None and door.is_active) and not (lift is not None and lift.is_active):
            self._set_before_step_rate(NEVER)

    def _control(self) -> None:
        for motion in (self._door, self._lift):
            for servo, reference in () if motion is None else motion.references:
                self.sim.engine.set_control(servo, reference)

    def _plugins_at(self, floor: Floor) -> list[RmfBuildingPlugin]:
        plugins = self.sim.engine.structure.all_plugins()
        door_plugins = (p for p in plugins if isinstance(p, RmfBuildingPlugin) and p.door is not None)
        return [plugin for plugin in door_plugins if plugin.door is not None and plugin.door.name in floor.doors]

    def _doors_at(self, floor: Floor) -> list[DoorMotion]:
        return [plugin.door for plugin in self._plugins_at(floor) if plugin.door is not None]

    def _command_doors(self, floor: Floor, mode: int) -> None:
        for plugin in self._plugins_at(floor):
            plugin.command_door(mode)

    # ------------------------------------------------------------------ states

    def _lift_summary(self, lift: LiftMotion) -> tuple[object, ...]:
        state = lift.state(0, self._doors_at)
        return (*(getattr(state, name) for name in _COMPARED),)

    def publish_door(self) -> None:
        """Publish the state of the door."""
        if self._door is not None and self._door_states.wanted:
            mode = {"value": self._door.mode}
            now = msgs.time(self.sim.time_ns)
            self._door_states.publish(
                msgs.make(DOOR_STATE, door_time=now, door_name=self._door.name, current_mode=mode)
            )

    def publish_lift(self) -> None:
        """Publish the state of the lift."""
        if self._lift is not None and self._lift_states.wanted:
            self._lift_states.publish(self._lift.state(self.sim.time_ns, self._doors_at))


_COMPARED: Final = ("current_floor", "destination_floor", "door_state", "motion_state", "session_id")


class RmfDoor(RmfBuildingPlugin):
    """Opens and closes a door with one or two leaves by requests on `/door_requests`.

    `<door>` names the joints; a left joint is closed at its upper limit, a right joint at its lower limit. The leaves
    accelerate with `<a_nom_door>` up to `<v_max_door>` and stop within `<dx_min_door>` of the limit. The state is
    published on `/door_states` once a second and when it changes. In the world, the plugin has no effect, because in
    simkit each door moves itself.
    """

    endpoints = _DOOR_TOPICS
    options = OptionsOf(DoorOptions)
    filenames = ("libdoor.so",)

    def read(self, params: Params) -> None:
        self._door_params = params


class RmfLift(RmfBuildingPlugin):
    """Moves a cabin between floors by requests on `/lift_requests`, and opens and closes the doors of the floor.

    The cabin moves only while the doors of its floor are closed. At the requested floor the doors get the requested
    state. A request during a motion is ignored. The state is published on `/lift_states` once a second and when it
    changes. In the world, the plugin has no effect, because in simkit each lift moves itself.
    """

    endpoints = _LIFT_TOPICS
    options = OptionsOf(LiftOptions)
    filenames = ("liblift.so",)

    def read(self, params: Params) -> None:
        self._lift_params = params


class RmfComponents(RmfBuildingPlugin):
    """Makes its model a door or a lift, described in a `<component>` with the name `Door` or `Lift`.

    The parameters are those of `libdoor.so` and `liblift.so`. Without `<ros_interface>`, a door has no topics: it is
    the door of a lift.
    """

    endpoints = (*_DOOR_TOPICS, *_LIFT_TOPICS)
    option_types = (DoorOptions, LiftOptions)
    filenames = ("libregister_component.so",)

    def read(self, params: Params) -> None:
        for component in params.all("component"):
            name = component.attribute("name")
            if name == "Door":
                self._door_params = component
                self._has_door_topics = component.boolean("ros_interface", False)
            elif name == "Lift":
                self._lift_params = component
            elif name == "Chargers":
                component.mark_all_read()
            else:
                message = f"found <component name={name!r}>; expected Door, Lift or Chargers"
                component.error("SK-PARAM-002", message)
