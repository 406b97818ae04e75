"""The robotics course's solar sensor: `libsolar_sensor.so`, a model plugin that tells where a light stands."""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from simkit import msgs
from simkit.diagnostics import NOWHERE
from simkit.params import Params
from simkit.plugins.base import ModelPlugin
from simkit.plugins.lookups import find_light, find_link
from simkit.pose import Pose, Vector, quat_conjugate, quat_from_rpy, quat_multiply, quat_rotate

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.runtime import Light, Simulation
    from simkit.scene import SceneModel

IMU = "sensor_msgs/msg/Imu"
_LARGEST_NOISE = 1e100  # [rad]; beyond it the variance leaves the numbers


class SolarSensor(ModelPlugin):
    """Publishes the direction of a light, seen from a link, as the orientation of an `Imu` on `sunloin_imu`.

    The unit vector from the link's origin to the light, in the link's axes, plus `<xyz_offset>`, gives
    pitch = asin(-z) and yaw = atan2(y, x): the x axis of that orientation points at the light. `<rpy_offset>` turns
    the result afterwards.

    `<frame_name>` names the link and is the message's frame; `<body_name>` names the link where the frame is another;
    with neither it is the model's canonical link. `<gaussian_noise>` [rad] is the standard deviation of independent
    noise on roll, pitch and yaw, and its square stands on the diagonal of the covariance. `<update_rate>` [Hz], 0 is
    every step.
    """

    filenames = ("libsolar_sensor.so",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        frame, body = params.text("frame_name", ""), params.text("body_name", "")
        wanted = body or frame
        link = find_link(scene, wanted, params) if wanted else None
        self._link_name = link.scoped if link else scene.canonical_link
        self._frame = frame or self._link_name.rsplit("::", 1)[-1]
        self._xyz = _offset(params, "xyz_offset")
        self._rpy = _offset(params, "rpy_offset")
        self._noise = params.number("gaussian_noise", 0.0, minimum=0, maximum=_LARGEST_NOISE)
        self.after_step_rate = params.number("update_rate", 0.0, minimum=0)

    def load(self, parent: Any, params: Params) -> None:
        self._light = _light(self.sim, params)
        self._link = self.sim.link(self._link_name)
        self._turn = quat_from_rpy(*self._rpy)
        self._covariance = np.eye(3).reshape(9) * self._noise**2
        self._stream = self.random("gaussian_noise", 3) if self._noise > 0 else None
        geometry = ("geometry_msgs/msg/Quaternion", "geometry_msgs/msg/Vector3")
        self._types = (msgs.type_of(IMU), *(msgs.type_of(name) for name in geometry))
        self._index = 0
        self._readings = self.advertise("sunloin_imu", IMU)

    def after_step(self) -> None:
        self._index += 1  # counted whether read or not, so that who listens does not change the noise
        if self._light is None or not self._readings.wanted:
            return
        pose, light = self._link.pose, self._light.pose.position
        self._readings.publish_later(partial(self._message, self.sim.time_ns, self._index, pose, light))

    def _message(self, time_ns: int, index: int, pose: Pose, light: Vector) -> Any:
        roll, (pitch, yaw) = 0.0, self._angles(pose, light)
        if self._stream is not None:
            roll, pitch, yaw = (np.array((roll, pitch, yaw)) + self._noise * self._stream.normal(index)).tolist()
        orientation = quat_from_rpy(roll, pitch, yaw)
        if any(self._rpy):
            orientation = quat_multiply(self._turn, orientation)
        w, x, y, z = orientation.tolist()
        imu, quaternion, vector = self._types
        header = msgs.header(time_ns, self._frame)
        rest = self._covariance.copy(), vector(0.0, 0.0, 0.0), np.zeros(9), vector(0.0, 0.0, 0.0), np.zeros(9)
        return imu(header, quaternion(x, y, z, w), *rest)

    def _angles(self, pose: Pose, light: Vector) -> tuple[float, float]:
        """Pitch and yaw [rad] of the light in the link's axes."""
        towards = light - pose.position
        distance = math.sqrt(towards @ towards)
        seen = quat_rotate(quat_conjugate(pose.quaternion), towards / distance if distance > 0 else towards)
        x, y, z = (a + b for a, b in zip(seen.tolist(), self._xyz, strict=True))
        return math.asin(-max(-1.0, min(1.0, z))), math.atan2(y, x)


def _light(sim: Simulation, params: Params) -> Light | None:
    """The light that `<light_name>` names; None after an error that lists the lights, or a note for a bare model."""
    name = params.text("light_name", "")
    if name and not sim.lights and sim.world.where == NOWHERE:
        message = f"a bare model has no light {name!r}: no reading is published until it stands in a world that has it"
        params.diagnostics.note("SK-PLUGIN-009", message, params.where)
        return None
    if name:
        return find_light(sim, name, params)
    listed = ", ".join(repr(n) for n in sorted(sim.lights)) or "none"
    params.error("SK-PARAM-001", f"<{params.name}> needs <light_name>: the name of a light", f"lights are: {listed}")
    return None


def _offset(params: Params, name: str) -> tuple[float, float, float]:
    """`name`, or its older spelling with an s, which is said."""
    older = params.child(name + "s")
    if older is None or params.has(name):
        return params.vector3(name, (0.0, 0.0, 0.0))
    params.diagnostics.warning("SK-PARAM-004", f"<{older.name}> is an older spelling", older.where, f"write <{name}>")
    return params.vector3(name + "s", (0.0, 0.0, 0.0))
