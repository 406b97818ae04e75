"""Joint encoders: position in counts, and velocity from the counts or measured."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, ClassVar

import mujoco
import numpy as np

from simkit import msgs
from simkit.compiler import Compiled, SpecBuilder
from simkit.params import Params
from simkit.pose import Vector
from simkit.runtime.handles.joint_mechanics import joint_position, joint_velocity
from simkit.sensors.base import Product, Sensor
from simkit.sensors.noise import NoiseModel, quantise, read_noise

TYPE = "sensor_msgs/msg/JointState"
_ROTARY_TYPES = ("revolute", "continuous", "universal", "revolute2", "ball", "screw")
_LINEAR_TYPES = ("prismatic", "planar")
_WIDTHS = {"universal": 2, "revolute2": 2, "ball": 3, "planar": 3}

CountMark = tuple[int, Vector, int, Any]  # time [ns], position, sample, and the sample's position noise


@dataclass(frozen=True, slots=True)
class EncoderOptions:
    """The `<encoder>` block, which is simkit's own.

    Attributes:
        resolution: size of a position count [rad or m]; 0 disables the rounding of positions.
        absolute: True for the joint's position, False for the change of position since the start.
        from_counts: True computes the velocity from the counts, False uses the velocity of the joint.
        window: shortest time [s] between the two counts that give a velocity; 0 is one sample.
        velocity_resolution: size of a velocity count [rad/s or m/s]; 0 disables the rounding of velocities.
        position_noise, velocity_noise: noise on every axis before the rounding [rad and rad/s, or m and m/s].
    """

    resolution: float
    absolute: bool
    from_counts: bool
    window: float
    velocity_resolution: float
    position_noise: NoiseModel
    velocity_noise: NoiseModel


@dataclass(frozen=True, slots=True)
class JointReading:
    """Positions [rad or m] and velocities [rad/s or m/s], one number per degree of freedom."""

    position: Vector
    velocity: Vector


class Encoder(Sensor["msgs.JointState"]):
    """Joint encoder, `encoder` (`<sensor type="custom" gz:type="encoder">`), under a joint: its position and velocity.

    The measured position is the true position with noise, rounded to the nearest count. The velocity is computed from
    two counts, as in a drive without a velocity sensor. With `from_counts` false, it is the joint's velocity with its
    own noise and resolution. `truth` is not rounded.
    """

    kinds = ("encoder",)
    example = "<encoder><counts_per_revolution>4096</counts_per_revolution></encoder>"
    belongs_to = ("joint",)
    options: EncoderOptions

    def read_options(self, params: Params) -> EncoderOptions:
        block = params.block("encoder")
        resolution = block.number("resolution", 0.0, minimum=0)
        if block.has("counts_per_revolution"):
            counts = block.number("counts_per_revolution", 1.0, minimum=1)
            if block.has("resolution"):
                block.error("SK-PARAM-002", "found <resolution> and <counts_per_revolution>; expected one of them")
            resolution = 2 * math.pi / counts
        velocity = block.block("velocity")
        return EncoderOptions(
            resolution=resolution,
            absolute=block.boolean("absolute", True),
            from_counts=velocity.choice("source", ("counts", "joint"), "counts") == "counts",
            window=velocity.number("window", 0.0, minimum=0, maximum=60.0),
            velocity_resolution=velocity.number("resolution", 0.0, minimum=0),
            position_noise=read_noise(block.block("position")),
            velocity_noise=read_noise(velocity),
        )

    def describe(self) -> dict[str, object]:
        """Return the resolution and the kind of position."""
        return {"encoder": {"resolution": self.options.resolution, "absolute": self.options.absolute}}

    def build(self, builder: SpecBuilder) -> None:
        joint = builder.names.joints.get(self.scene.parent)
        if joint is None:  # the joint was left out for an error that is already reported
            return
        where = self.scene.where
        if joint.type not in (*_ROTARY_TYPES, *_LINEAR_TYPES):
            message = f"sensor {self.scoped!r}: an encoder cannot measure a {joint.type} joint"
            self.diagnostics.error("SK-SENSOR-051", message, where, "move it to a joint that turns or slides")
        elif joint.type in _LINEAR_TYPES and self.scene.params.block("encoder").has("counts_per_revolution"):
            message = (
                f"sensor {self.scoped!r}: <counts_per_revolution> is invalid on a {joint.type} joint, which slides"
            )
            self.diagnostics.error("SK-SENSOR-051", message, where, "use <resolution> in metres")

    def prepare(self) -> None:
        options, joint = self.options, self.sim.engine.names.joint(self.scene.parent)
        width = _WIDTHS.get(joint.type, 1)
        self._names = [joint.scene.name] if width == 1 else [f"{joint.scene.name}[{i}]" for i in range(width)]
        self._is_ball = joint.type == "ball"
        self._joint, self._width = joint, width
        self._start = np.zeros(width) if options.absolute else self._position_in(self.sim.mj_data)
        self._step = np.full(width, options.resolution)
        self._velocity_step = np.full(width, options.velocity_resolution)
        self._position_noise = self._make_noise([options.position_noise] * width, "position")
        self._velocity_noise = self._make_noise([options.velocity_noise] * width, "velocity")
        self._history: CountHistory | None = None
        if options.from_counts:
            # registered after the noise, because a sample's noise must be known before the sample's position is read
            self._history = self.register_noise(CountHistory(self, round(options.window * 1e9)))

    def bind(self, compiled: Compiled) -> None:
        super().bind(compiled)
        self._joint = compiled.names.joint(self.scene.parent)
        if not self._joint.dofs:
            message = f"sensor {self.scoped!r} reads zero: the links of joint {self._joint.scoped!r} never move"
            self.diagnostics.warning("SK-SENSOR-050", message, self.scene.where)

    def products(self) -> dict[str, Product]:
        return {"encoder": Product(TYPE, self._message_of)}

    def measure(self, model: mujoco.MjModel, data: mujoco.MjData) -> JointReading:
        position = self._position_in(data)
        velocity = joint_velocity(self._joint, data) if self._joint.dofs else np.zeros(self._width)
        return JointReading(position if self.options.absolute else self.change(self._start, position), velocity)

    def perturb(self, reading: JointReading, index: int) -> JointReading:
        velocity = reading.velocity
        if self._history is not None:
            position, velocity = self._history.position_and_velocity()
        else:
            position = self._count_position(reading.position, index)
        if not self._velocity_noise.is_silent:
            velocity = self._velocity_noise.apply(velocity, index)
        return JointReading(position, quantise(velocity, self._velocity_step))

    def mark(self, index: int) -> CountMark:
        """Store the state of this tick, so that `read` can compute the position of sample `index` later."""
        position = self._position_in(self.sim.mj_data)
        return self.sim.time_ns, position, index, self._position_noise.state

    def read(self, mark: CountMark) -> Vector:
        """Return the position of a mark, in counts."""
        _, position, index, state = mark
        noise = self._position_noise
        current_state, noise.state = noise.state, state
        counted = self._count_position(position if self.options.absolute else self.change(self._start, position), index)
        noise.state = current_state
        return counted

    def change(self, before: Vector, after: Vector) -> Vector:
        """Return the change between two positions; for a ball joint, the rotation vector between the two attitudes."""
        if not self._is_ball:
            return after - before
        first, second, turn = np.empty(4), np.empty(4), np.empty(3)
        unit = np.array((1.0, 0.0, 0.0, 0.0))
        first[:], second[:] = unit, unit
        mujoco.mju_quatIntegrate(first, before, 1.0)
        mujoco.mju_quatIntegrate(second, after, 1.0)
        mujoco.mju_subQuat(turn, second, first)
        return turn

    def _position_in(self, data: mujoco.MjData) -> Vector:
        return joint_position(self._joint, data) if self._joint.dofs else np.zeros(self._width)

    def _count_position(self, position: Vector, index: int) -> Vector:
        if not self._position_noise.is_silent:
            position = self._position_noise.apply(position, index)
        return quantise(position, self._step)

    def _message_of(self, reading: JointReading, time_ns: int) -> msgs.JointState:
        header = msgs.header(time_ns, self.frame_id)
        # own arrays for each message, because a subscriber may keep or change them
        values = reading.position.copy(), reading.velocity.copy(), np.zeros(0)
        return msgs.JointState(header, list(self._names), *values)


class CountHistory:
    """Last counts of an encoder, saved and restored with each sample like the state of its noise.

    Args:
        encoder: encoder that the counts belong to.
        window: shortest time [ns] between the two counts that give a velocity.

    Attributes:
        state: marks that are still needed, the newest last; replaced and never modified.
    """

    evolves: ClassVar[bool] = True

    def __init__(self, encoder: Encoder, window: int) -> None:
        self._encoder, self._window = encoder, window
        self.state: tuple[CountMark, ...] = ()

    def position_and_velocity(self) -> tuple[Vector, Vector]:
        """Return the newest position, and the mean velocity since the oldest stored position.

        The velocity is 0 if only one position is stored.
        """
        first, last = self.state[0], self.state[-1]
        position = self._encoder.read(last)
        if first is last:
            return position, np.zeros(len(position))
        return position, self._encoder.change(self._encoder.read(first), position) / ((last[0] - first[0]) * 1e-9)

    def evolve(self, index: int, dt: float) -> None:
        """Add the mark of sample `index`, and remove marks that are too old for the window."""
        mark = self._encoder.mark(index)
        now, marks = mark[0], (*self.state, mark)
        first = max((k for k in range(len(marks) - 1) if now - marks[k][0] >= self._window), default=0)
        self.state = marks[first:]

    def restart(self) -> None:
        self.state = ()

    def set_interval(self, interval: float) -> None:
        """Do nothing: the marks contain their own times."""
