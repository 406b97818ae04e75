"""Dock of Create 3 in Gazebo Classic: `libgazebo_ros_create_ir_opcode.so`, `libgazebo_ros_create_docking_status.so`.

The signals follow from the poses of the dock's emitter and of the robot's receiver, with the numbers of
irobot_create_gazebo_plugins. Nothing hides a signal.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

from simkit import ModelPlugin, Params, msgs
from simkit.extend import (
    Options,
    OptionsOf,
    find_named_link,
    number,
    publish_while_subscribed,
    publishes,
    text,
    without_effect,
)
from simkit.plugins.publish_on_demand import watch_while_subscribed

if TYPE_CHECKING:
    from simkit import Model, Pose
    from simkit.extend import SceneModel, SpecBuilder

OPCODE: Final = "irobot_create_msgs/msg/IrOpcode"
STATUS: Final = "irobot_create_msgs/msg/DockStatus"
_FORCE_FIELD, _GREEN, _RED = 161, 164, 168  # constants of IrOpcode
_BUOYS_VIEW: Final = math.radians(50)  # angle that both buoys cover together
_BUOY_SHARE: Final = 0.6  # of this angle, for each buoy
_BUOYS_RANGE, _HALO_RANGE = 1.0, 0.6096  # [m]
_DOCKED_DISTANCE, _DOCKED_ANGLE = 0.075, math.pi / 30  # [m, rad]

Polar = tuple[float, float]
"""Distance [m] and direction from the x axis [rad] in the plane of a frame."""


class CreateDockOptions(Options):
    """Options of both plugins."""

    robot_model_name: bool = without_effect()  # the robot is the model of the plugin
    receiver_link_name: str = text(None, required=True)
    dock_model_name: str = text("standard_dock")
    emitter_link_name: str = text("halo_link")


class CreateDockPlugin(ModelPlugin):
    """Base class of plugins that compare the pose of a receiver with the pose of a dock."""

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self._receiver = find_named_link(scene, "receiver_link_name", params)
        names = CreateDockOptions(params).read_all()
        self._dock, self._emitter = names.dock_model_name, names.emitter_link_name

    def places(self) -> tuple[Polar, Polar] | None:
        """Return the emitter seen from the receiver, and the receiver seen from the emitter; None without a dock."""
        dock = self.sim.models.get(self._dock)
        if dock is None:
            return None
        link = next((link for link in dock.scene.all_links() if link.name == self._emitter), None)
        if link is None:
            message = f"model {self._dock!r} has no link {self._emitter!r}, the emitter of the dock"
            self._once.warn("SK-PLUGIN-003", "emitter", message)
            return None
        receiver, emitter = self.sim.link(self._receiver).pose, self.sim.link(link.scoped).pose
        return _polar(receiver, emitter), _polar(emitter, receiver)


def _polar(frame: Pose, other: Pose) -> Polar:
    x, y, _ = frame.inverse().transform(other.position).tolist()
    return math.hypot(x, y), math.atan2(y, x)


class CreateIrOpcodeOptions(CreateDockOptions):
    """Options of `CreateIrOpcode`."""

    update_rate: float = number(31.0, "Hz", minimum=0)
    sensor_0_fov: float = number(1.0, "rad", minimum=0)
    sensor_0_range: float = number(1.0, "m", minimum=0)
    sensor_1_fov: float = number(1.0, "rad", minimum=0)
    sensor_1_range: float = number(1.0, "m", minimum=0)


class CreateIrOpcode(CreateDockPlugin):
    """Publishes `IrOpcode` on `~/out` for each infrared signal of the dock that one of two receivers sees.

    The receivers are the sensors 0 (all round) and 1 (front) of `<receiver_link_name>`, each with a field of view and a
    range. They see the force field within their range plus 0.61 m of the dock. In front of the dock, within their range
    plus 1 m, they see the green buoy on its right side and the red buoy on its left side, and both in the middle.
    """

    endpoints = (publishes("~/out", OPCODE),)
    options = OptionsOf(CreateIrOpcodeOptions)
    filenames = ("libgazebo_ros_create_ir_opcode.so",)

    def load(self, parent: Model, params: Params) -> None:
        options = self.options.read_all()
        self._receivers = (
            (options.sensor_0_fov, options.sensor_0_range),
            (options.sensor_1_fov, options.sensor_1_range),
        )
        self._out = self.advertise("~/out", OPCODE)
        publish_while_subscribed(self, self._out, options.update_rate, "publish")

    def signals(self) -> list[tuple[int, int]]:
        """Return the opcodes that are seen now, and the number of the sensor of each; the force field comes first."""
        places = self.places()
        if places is None:
            return []
        (distance, direction), (_, bearing) = places
        fields, buoys = [], []
        for sensor, (view, reach) in enumerate(self._receivers):
            if abs(direction) >= view / 2:
                continue
            if distance < reach + _HALO_RANGE:
                fields.append((_FORCE_FIELD, sensor))
            code = _buoys(bearing)
            if distance < reach + _BUOYS_RANGE and code:
                buoys.append((code, sensor))
        return fields + buoys

    def publish(self) -> None:
        """Publish the signals."""
        for opcode, sensor in self.signals():
            header = msgs.header(self.sim.time_ns, self._receiver.rsplit("::", 1)[-1])
            self._out.publish(msgs.make(OPCODE, header=header, opcode=opcode, sensor=sensor))


def _buoys(bearing: float) -> int:
    """Return the opcode of the buoys that shine in a direction from the emitter's x axis [rad]; 0 for none."""
    half, width = _BUOYS_VIEW / 2, _BUOY_SHARE * _BUOYS_VIEW
    code = _RED if half - width < bearing < half else 0
    return code | _GREEN if -half < bearing < width - half else code


class CreateDockingStatusOptions(CreateDockOptions):
    """Options of `CreateDockingStatus`."""

    update_rate: float = number(1.0, "Hz", minimum=0)


class CreateDockingStatus(CreateDockPlugin):
    """Publishes `DockStatus` on `~/out` at `<update_rate>`, and when it changes.

    The robot is docked if its receiver is within 0.075 m of the emitter and each faces the other within 6 degrees. The
    dock is visible if the robot's `libgazebo_ros_create_ir_opcode.so` sees a signal.
    """

    endpoints = (publishes("~/out", STATUS),)
    options = OptionsOf(CreateDockingStatusOptions)
    filenames = ("libgazebo_ros_create_docking_status.so",)
    _was_heard = False

    def load(self, parent: Model, params: Params) -> None:
        self._was_heard = False
        self._known: tuple[bool, bool] | None = None
        self._out = self.advertise("~/out", STATUS)
        watch_while_subscribed(self, [self._out], "publish_changes")
        publish_while_subscribed(self, self._out, self.options.update_rate, "publish")

    def status(self) -> tuple[bool, bool] | None:
        """Return whether the dock is visible, and whether the robot is docked; None without a dock."""
        places = self.places()
        if places is None:
            return None
        (distance, direction), (_, bearing) = places
        aligned = abs(direction) < _DOCKED_ANGLE and abs(bearing) < _DOCKED_ANGLE
        model_name = self.scoped.split("::")[0]
        plugins = (p for p in self.sim.engine.structure.all_plugins() if isinstance(p, CreateIrOpcode))
        is_visible = any(p.signals() for p in plugins if p.scoped.split("::")[0] == model_name)
        return is_visible, distance < _DOCKED_DISTANCE and aligned

    def begin(self) -> None:
        """Store the present status."""
        self._known = self.status()

    def publish_changes(self) -> None:
        """Publish the status if it has changed."""
        if self.status() != self._known:
            self.publish()

    def publish(self) -> None:
        """Publish the status, if there is a dock."""
        self._known = self.status()
        if self._known is not None:
            is_visible, is_docked = self._known
            header = msgs.header(self.sim.time_ns, "base_link")
            self._out.publish(msgs.make(STATUS, header=header, dock_visible=is_visible, is_docked=is_docked))
