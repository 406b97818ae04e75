"""Flippers and rotating lidar of Absolem and MARV, robots of the SubT challenge.

Parameters, topics and formulas are those of `flipper_control_plugin.cpp` and `laser_rotate_plugin.cpp` of osrf/subt.
"""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING, Final

from simkit import Params
from simkit.extend import Options, OptionsOf, listens, number, text
from simkit.msgs import valid_topic
from simkit.plugins.joints.joint_commands import DOUBLE, JointCommander
from simkit.plugins.one_time_warnings import are_usable

if TYPE_CHECKING:
    from simkit import Model
    from simkit.extend import SceneModel, SpecBuilder
    from simkit.msgs import Float64

_JOINT: Final = "/model/{model}/joint/{joint_name}"
_DEFAULTS: Final = (0.5, 30.0)  # velocity [rad/s] and torque [N·m] of a joint without limits
_STILL: Final = 1e-3  # speed below which the lidar stops [rad/s]


class FlipperControlOptions(Options):
    """Options of `FlipperControl`."""

    joint: str = text(None, element="joint_name", required=True)
    fastest: float = number(0.0, "rad/s", element="max_velocity", minimum=0.0, maximum=1e6)
    torque: float = number(0.0, "N·m", element="max_torque", minimum=0.0, maximum=1e9)
    gain: float = number(20.0, "1/s", element="position_correction_gain", minimum=0.0, maximum=1e9)
    tolerance: float = number(math.pi / 180, "rad", element="position_correction_tolerance", minimum=0.0)
    topic_velocity: str = text(element="topic_vel")
    topic_position: str = text(element="topic_pos_abs")
    topic_change: str = text(element="topic_pos_rel")
    topic_fastest: str = text(element="topic_pos_max_vel")
    topic_torque: str = text(element="topic_max_torque")


class FlipperControl(JointCommander):
    """Moves a flipper at a velocity (`cmd_vel` [rad/s]), to a position (`cmd_pos` [rad]) or by an angle.

    The topics are below `/model/<model>/joint/<joint_name>`; the angle is on `cmd_pos_rel` [rad]. A flipper that stops
    holds its position: it moves at `<position_correction_gain>` times the error, at most at `<max_velocity>` and at the
    last `cmd_pos_max_vel`. `cmd_max_torque` limits the torque [N·m], up to `<max_torque>`.
    """

    endpoints = tuple(
        listens(f"{_JOINT}/{name}", DOUBLE, named_by=(element,))
        for name, element in (
            ("cmd_vel", "topic_vel"),
            ("cmd_pos", "topic_pos_abs"),
            ("cmd_pos_rel", "topic_pos_rel"),
            ("cmd_pos_max_vel", "topic_pos_max_vel"),
            ("cmd_max_torque", "topic_max_torque"),
        )
    )
    options = OptionsOf(FlipperControlOptions)  # type: ignore[assignment]  # it has no PID
    filenames = ("flipper_control_plugin",)
    names = ("cras::FlipperControlPlugin",)
    actuator_field = "velocity"
    target_element = "initial_velocity"
    _by_velocity = True

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self.options.read_all()
        super().prepare(scene, params, builder)

    def _listen(self, parent: Model, params: Params) -> None:
        options, base = self.options, f"/model/{parent.name}/joint/{self._first_name}"
        axis = self.axes[0]
        limits = axis.velocity_limit, axis.effort_limit
        given = (options.fastest, params.has("max_velocity")), (options.torque, params.has("max_torque"))
        self._fastest, self._torque = (
            min(limit, value if is_given else default if math.isinf(limit) else limit)
            for limit, (value, is_given), default in zip(limits, given, _DEFAULTS, strict=True)
        )
        self._held: float | None = 0.0
        self._change: float | None = None
        self._slower = math.inf
        self._target = 0.0
        callbacks = (
            ("cmd_vel", options.topic_velocity, self._on_velocity),
            ("cmd_pos", options.topic_position, self._on_position),
            ("cmd_pos_rel", options.topic_change, self._on_change),
            ("cmd_pos_max_vel", options.topic_fastest, self._on_fastest),
            ("cmd_max_torque", options.topic_torque, self._on_torque),
        )
        for name, topic, callback in callbacks:
            self.listen(valid_topic(topic or f"{base}/{name}"), DOUBLE, partial(self._on_number, callback))

    def _on_number(self, callback: object, message: Float64) -> None:
        value = float(message.data)
        if are_usable(value):
            callback(value)  # type: ignore[operator]
        else:
            self._once.left_out("finite", f"the command {value} is ignored; expected a finite number up to 1e10")

    def _on_velocity(self, velocity: float) -> None:
        stops = self._target != 0.0 and velocity == 0.0
        self._held, self._target = self.axes[0].position if stops else None, velocity

    def _on_position(self, position: float) -> None:
        self._held = position

    def _on_change(self, change: float) -> None:
        self._held = self.axes[0].position + change

    def _on_fastest(self, fastest: float) -> None:
        self._slower = abs(fastest)

    def _on_torque(self, torque: float) -> None:
        self.axes[0].joint.effort_limit = max(0.0, min(torque, self._torque))

    def command(self) -> None:
        velocity = self._target
        if self._held is not None:
            error = self._held - self.axes[0].position
            velocity = self.options.gain * error if abs(error) > self.options.tolerance else 0.0
            velocity = max(-self._slower, min(self._slower, velocity))
        self.turn(max(-self._fastest, min(self._fastest, velocity)))


class LaserRotateOptions(Options):
    """Options of `LaserRotate`."""

    joint: str = text("laser_j", element="joint_name")
    topic: str = text()
    limit: float = number(1.618994, "rad", element="rotation_angular_limit", minimum=0.0, maximum=1e6)
    fastest: float = number(1.2, "rad/s", element="max_velocity", minimum=0.0, maximum=1e6)
    first: float = number(0.0, "rad/s", element="initial_velocity", minimum=-1e6, maximum=1e6)


class LaserRotate(JointCommander):
    """Turns a lidar back and forth within ± `<rotation_angular_limit>`, at the speed of `cmd_vel` [rad/s].

    The topic is `/model/<model>/joint/<joint_name>/cmd_vel` or `<topic>`; a negative speed stops the lidar.
    """

    endpoints = (listens(f"{_JOINT}/cmd_vel", DOUBLE, named_by=("topic",)),)
    options = OptionsOf(LaserRotateOptions)  # type: ignore[assignment]  # it has no PID
    filenames = ("laser_rotate_plugin",)
    names = ("cras::LaserRotatePlugin",)
    actuator_field = "velocity"
    target_element = "initial_velocity"
    _by_velocity = True

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self.options.read_all()
        super().prepare(scene, params, builder)

    def _listen(self, parent: Model, params: Params) -> None:
        self._sign = 1.0
        topic = self.options.topic or f"/model/{parent.name}/joint/{self._first_name}/cmd_vel"
        self.listen(valid_topic(topic), DOUBLE, self._on_command)

    def command(self) -> None:
        options, position = self.options, self.axes[0].position
        if position >= options.limit:
            self._sign = -1.0
        elif position <= -options.limit:
            self._sign = 1.0
        speed = min(max(0.0, self._target), options.fastest)
        self.turn(self._sign * speed if speed >= _STILL else 0.0)
