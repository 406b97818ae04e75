"""Finger joints coupled to one motor like a tendon: PAL's `libgazebo_underactuated_finger.so`."""

from __future__ import annotations

import math
import weakref
from collections.abc import Callable
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit.number_text import counted
from simkit.params import Params
from simkit.plugins.base import ModelPlugin
from simkit.plugins.find_entities import find_joint
from simkit.plugins.options import Options, OptionsOf, block, blocks, number, text, texts
from simkit.runtime.engine.physics_step import CONTROL

if TYPE_CHECKING:
    import mujoco

    from simkit.compiler import ActuatorRef, SpecBuilder
    from simkit.runtime import Model
    from simkit.scene import SceneJoint, SceneModel

_NOISE: Final = 0.02
"""Smallest change of the motor's position that moves the joints, as in Gazebo [rad]."""

_GAINS: Final = ("p", "i", "d", "i_max", "i_min")


class UnderactuatedFingerPidGainsOptions(Options):
    """Options in the `<pid_gains>` block."""

    p: float = number(0.0)
    i: float = number(0.0)
    d: float = number(0.0)
    i_max: float = number(0.0)
    i_min: float = number(0.0)


class UnderactuatedFingerVirtualJointOptions(Options):
    """Options in the `<virtualJoint>` block."""

    name: tuple[str, ...] = texts(required=True)
    scale_factor: float = number(1.0, required=True)
    pid_gains: UnderactuatedFingerPidGainsOptions = block(UnderactuatedFingerPidGainsOptions)


class UnderactuatedFingerOptions(Options):
    """Options of `UnderactuatedFinger`."""

    actuated_joint: str = text(element="actuatedJoint", required=True)
    virtual_joint: tuple[UnderactuatedFingerVirtualJointOptions, ...] = blocks(
        UnderactuatedFingerVirtualJointOptions, element="virtualJoint"
    )


class UnderactuatedFinger(ModelPlugin):
    """Moves each `<virtualJoint>` to the position of `<actuatedJoint>` divided by `<scale_factor>`, within its limits.

    A new position of the motor is used only if it differs by more than 0.02 rad from the last position that was used. A
    joint with a complete set of `<pid_gains>` (`p`, `i`, `d`, `i_max`, `i_min`) is controlled by that PID. Gazebo sets
    the position of all other joints at once, regardless of contacts. In simkit a servo moves these joints within their
    effort limits.
    """

    options = OptionsOf(UnderactuatedFingerOptions)
    filenames = ("libgazebo_underactuated_finger.so",)
    drives = True

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        _ = self.options.actuated_joint
        motor = params.child("actuatedJoint")
        joint = None if motor is None else _joint_with_one_axis(scene, motor)
        self._motor = "" if joint is None else joint.scoped
        self._servos: list[tuple[str, float, ActuatorRef]] = []
        self._loops: list[tuple[str, float, tuple[float, ...]]] = []
        if not self.options.virtual_joint:
            params.error("SK-PARAM-001", f"plugin {self.name!r} needs a <virtualJoint>")
        for virtual_joint in self.options.virtual_joint:
            self._add_joint(virtual_joint, scene, builder)

    def _add_joint(
        self, options: UnderactuatedFingerVirtualJointOptions, scene: SceneModel, builder: SpecBuilder
    ) -> None:
        """Add a servo or a PID for one finger joint."""
        options.params.text("name", required=True)
        named = options.params.child("name")
        joint = None if named is None else _joint_with_one_axis(scene, named)
        scale = options.scale_factor
        if scale == 0.0:
            options.params.error("SK-PARAM-002", "found <scale_factor> 0; expected any other number")
        gains = self._gains(options.pid_gains)
        if joint is None or scale == 0.0:
            return
        if gains is not None:
            self._loops.append((joint.scoped, scale, gains))
            return
        ref = builder.add_position_servo(joint.scoped, max_effort=math.inf, owner=self.name)
        self._servos.append((joint.scoped, scale, ref))

    def _gains(self, options: UnderactuatedFingerPidGainsOptions) -> tuple[float, ...] | None:
        """Return the gains of the joint's PID; None if the set is incomplete, which Gazebo ignores as well."""
        if not options.is_given:
            return None
        block = options.params
        missing = [name for name in _GAINS if not block.has(name)]
        gains = options.p, options.i, options.d, options.i_max, options.i_min
        if not missing:
            return gains
        message = f"<pid_gains> without {', '.join(f'<{name}>' for name in missing)} is ignored; a servo is used"
        block.diagnostics.warning("SK-PLUGIN-047", message, block.where, "add <p>, <i>, <d>, <i_max> and <i_min>")
        return None

    def load(self, parent: Model, params: Params) -> None:
        sim = self.sim
        self._actuated = sim.joint(self._motor)
        self._counts = float(self._actuated.position)
        joints = [sim.joint(scoped) for scoped, *_ in (*self._servos, *self._loops)]
        self._moved = joints
        self._scale = np.array([scale for _, scale, _ in (*self._servos, *self._loops)])
        self._low = np.array([float(joint.lower) for joint in joints])
        self._high = np.array([float(joint.upper) for joint in joints])
        self._targets = np.clip(self._counts / self._scale, self._low, self._high)
        self._sums = np.zeros(len(self._loops))
        self._errors = np.zeros(len(self._loops))
        self._gain = np.array([gains for *_, gains in self._loops]).reshape(-1, len(_GAINS)).T
        # weak reference to the engine's model that the servo ids belong to
        self._seen: Callable[[], mujoco.MjModel | None] = _no_model

    def before_step(self) -> None:
        now, physics = float(self._actuated.position), self.sim.engine.physics
        is_new = physics.model is not self._seen()
        if is_new:  # the first step, or the first step after a model was added or removed
            self._seen = weakref.ref(physics.model)
            self._ids = np.array([self.sim.engine.names.actuator(ref) for *_, ref in self._servos], np.intp)
        if is_new or abs(self._counts - now) > _NOISE:
            if abs(self._counts - now) > _NOISE:
                self._counts = now
            self._targets = np.clip(self._counts / self._scale, self._low, self._high)
            physics.data.ctrl[self._ids] = self._targets[: len(self._servos)]
            physics.changed(CONTROL)
        if self._loops:
            self._push(physics.model.opt.timestep)

    def _push(self, step: float) -> None:
        """Apply the efforts of the PIDs as ROS's control_toolbox computes them: only the integral term is bounded."""
        first = len(self._servos)
        joints = self._moved[first:]
        error = self._targets[first:] - np.array([float(joint.position) for joint in joints])
        p, i, d, top, bottom = self._gain
        self._sums = self._sums + error * step
        integral_terms = np.minimum(np.maximum(i * self._sums, bottom), top)
        efforts = p * error + integral_terms + d * (error - self._errors) / step
        self._errors = error
        for joint, effort in zip(joints, efforts.tolist(), strict=True):
            joint.set_effort(effort)


def _no_model() -> None:
    """Return None, like a weak reference to a deleted model."""


def _joint_with_one_axis(scene: SceneModel, named: Params) -> SceneJoint | None:
    """Return the joint that an element names; None after an error if the joint is missing or has several axes."""
    joint = find_joint(scene, named.value, named) if named.value else None
    if joint is not None and len(joint.axes) != 1:
        named.error(
            "SK-PLUGIN-003", f"joint {joint.name!r} has {counted(len(joint.axes), 'axis', 'axes')}; expected one"
        )
        return None
    return joint
