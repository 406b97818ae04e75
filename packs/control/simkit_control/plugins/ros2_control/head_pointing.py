"""Head pointing: compute joint angles that point a head at a target, and the 3D point that a camera pixel shows."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import Pose, msgs
from simkit.elementary_functions import arcsin
from simkit.errors import InputError
from simkit.extend import Vector, did_you_mean
from simkit.linear_algebra import matmul, solve
from simkit.pose import IDENTITY

if TYPE_CHECKING:
    from simkit import Simulation
    from simkit.extend import SceneModel
    from simkit.msgs import CameraInfo

_GRID: Final = 25  # angles that are tried for each joint, before the best pair is refined
_STEPS: Final = 60
_WORLD: Final = ("world", "map")


@dataclass(frozen=True, slots=True, eq=False)
class HeadJoints:
    """Current state of two joints in series and of the frame that they turn; poses are in the world frame.

    Attributes:
        anchors: a point on each joint's axis, shape (2, 3) [m]; the joint nearer the base is first.
        axes: axes of the joints, unit vectors, shape (2, 3).
        angles: current angles of the joints [rad].
        lower, upper: limits [rad].
        frame: pose of the pointing frame.
        axis: pointing direction in the pointing frame, a unit vector.
    """

    anchors: Vector
    axes: Vector
    angles: Vector
    lower: Vector
    upper: Vector
    frame: Pose
    axis: Vector

    def error(self, angles: Vector, target: Vector) -> float:
        """Return the angle [rad] between the pointing direction at these joint angles and the direction to a target."""
        return float(self._errors(angles[None], target)[0])

    def aim(self, target: Vector) -> tuple[Vector, float]:
        """Find the joint angles within the limits that point best at a target [m].

        The best angles of a grid are refined by the damped Gauss-Newton method.

        Returns:
            Joint angles, shape (2,) [rad], and the remaining angle between pointing direction and target [rad].
        """
        low, high = np.maximum(self.lower, self.angles - np.pi), np.minimum(self.upper, self.angles + np.pi)
        grid = np.stack(np.meshgrid(*(np.linspace(a, b, _GRID) for a, b in zip(low, high, strict=True))), -1)
        candidates = np.concatenate([np.clip(self.angles, low, high)[None], grid.reshape(-1, 2)])
        errors = self._errors(candidates, target)
        angles = candidates[int(np.argmin(errors))]
        error, damping = float(errors.min()), 1e-6
        for _ in range(_STEPS):
            miss = self._direction_differences(angles[None], target)[0]
            step = 1e-6
            nudged = self._direction_differences(angles + step * np.eye(2), target)
            slope = ((nudged - miss) / step).T
            move = solve(matmul(slope.T, slope) + damping * np.eye(2), matmul(-slope.T, miss))
            new = np.clip(angles + move, low, high)
            better = self.error(new, target)
            if better < error - 1e-15:
                angles, error, damping = new, better, max(damping * 0.3, 1e-12)
            else:
                damping *= 10.0
            if damping > 1e6 or error < 1e-12:
                break
        return angles, error

    def _errors(self, angles: Vector, target: Vector) -> Vector:
        differences = self._direction_differences(angles, target)
        errors: Vector = 2.0 * arcsin(np.clip(np.linalg.norm(differences, axis=1) / 2.0, 0.0, 1.0))
        return errors

    def _direction_differences(self, angles: Vector, target: Vector) -> Vector:
        """Return direction to the target minus pointing direction (unit vectors), shape (k, 3), for angles (k, 2)."""
        turns = angles - self.angles
        points = np.repeat(self.frame.position[None], len(turns), 0)
        rays = np.repeat(self.frame.rotate(self.axis)[None], len(turns), 0)
        for joint in (1, 0):
            points = self.anchors[joint] + _rotate_vectors(
                points - self.anchors[joint], self.axes[joint], turns[:, joint]
            )
            rays = _rotate_vectors(rays, self.axes[joint], turns[:, joint])
        offsets = target - points
        lengths = np.linalg.norm(offsets, axis=1, keepdims=True)
        differences: Vector = offsets / np.maximum(lengths, 1e-12) - rays
        return differences


def _rotate_vectors(vectors: Vector, axis: Vector, angles: Vector) -> Vector:
    """Rotate each vector (k, 3) about an axis by its own angle (Rodrigues' formula)."""
    cos, sin = np.cos(angles)[:, None], np.sin(angles)[:, None]
    along = matmul(vectors, axis)[:, None]
    turned: Vector = vectors * cos + np.cross(axis, vectors) * sin + axis * along * (1.0 - cos)
    return turned


def frame_pose(sim: Simulation, model: str, name: str, extra_frames: Mapping[str, Pose] | None = None) -> Pose:
    """Return the current pose of a frame in the world.

    Args:
        sim: simulation to search in.
        model: scoped name of the model whose frames are searched first.
        name: name of a link, of a sensor's frame or of a frame in the file; a scoped name; `world` or `map`.
        extra_frames: poses of further frames by name.

    Raises:
        InputError: there is no such frame; the message has the closest name.
    """
    if name.lstrip("/") in _WORLD:
        return IDENTITY
    if extra_frames and name.lstrip("/") in extra_frames:
        return extra_frames[name.lstrip("/")]
    link, offset = frame_link(sim, model, name, (*_WORLD, *(extra_frames or ())))
    return sim.link(link).pose @ offset


def frame_link(sim: Simulation, model: str, name: str, extra_names: Sequence[str] = ()) -> tuple[str, Pose]:
    """Return the scoped name of the link that a frame is fixed to, and the pose of the frame in that link.

    Args:
        sim: simulation to search in.
        model: scoped name of the model whose frames are searched first.
        name: name as in `frame_pose`.
        extra_names: further names for the suggestion in the message.

    Raises:
        InputError: there is no such frame; the message has the closest name.
    """
    name = name.lstrip("/")
    models = [*(m for m in sim.models.values() if m.scoped == model), *sim.models.values()]
    names: list[str] = []
    for scene in (handle.scene for handle in models):
        for link in scene.all_links():
            if name in (link.name, link.scoped):
                return link.scoped, IDENTITY
            names.append(link.name)
    for scene in (handle.scene for handle in models):
        sensor_link = _sensor_frame(sim, scene, name, names)
        if sensor_link is not None:
            return sensor_link
    near = did_you_mean(name, dict.fromkeys([*names, *extra_names]))
    raise InputError(f"there is no frame {name!r}{near and '; ' + near}")


def is_moved_by_joint(sim: Simulation, link: str, joint: str) -> bool:
    """Check whether a joint moves a link, directly or through other joints; both names are scoped."""
    parents, body = sim.mj_model.body_parentid, int(sim.engine.names.link(link).body)
    turning = int(sim.mj_model.jnt_bodyid[sim.mj_model.dof_jntid[sim.engine.names.joint(joint).dofs[0]]])
    while body > 0 and body != turning:
        body = int(parents[body])
    return body == turning


def _sensor_frame(sim: Simulation, scene: SceneModel, name: str, names: list[str]) -> tuple[str, Pose] | None:
    for described in scene.all_sensors():
        if described.on_joint or not sim.contents.has_sensor(described.scoped):
            continue
        sensor = sim.sensor(described.scoped)
        optical = sensor.optical_frames()
        if name in (sensor.frame_id, *optical):
            return described.parent, sensor.scene.pose_link @ optical.get(name, IDENTITY)
        names += [sensor.frame_id, *optical]
    return None


def pixel_ray(camera_info: CameraInfo, u: float, v: float) -> Vector:
    """Return the point that a camera sees at a pixel, 1 m away along the optical axis; shape (3,) [m].

    Args:
        camera_info: `sensor_msgs/msg/CameraInfo` with K, and distortion of the `plumb_bob` model.
        u: column, 0 at the centre of the first pixel.
        v: row, 0 at the centre of the first pixel.

    Raises:
        InputError: K is not a valid camera matrix.
    """
    k = np.asarray(camera_info.k, dtype=float).reshape(3, 3)
    if not (np.isfinite(k).all() and k[0, 0] > 0.0 and k[1, 1] > 0.0):
        raise InputError(f"camera_info has fx = {k[0, 0]:g} and fy = {k[1, 1]:g}; both must be positive")
    distorted = np.array([(u - k[0, 2] - k[0, 1] * (v - k[1, 2]) / k[1, 1]) / k[0, 0], (v - k[1, 2]) / k[1, 1]])
    k1, k2, p1, p2, k3 = [*np.asarray(camera_info.d, dtype=float).tolist(), 0.0, 0.0, 0.0, 0.0, 0.0][:5]
    x, y = distorted
    for _ in range(20):  # converges, because the distortion is small
        r2 = x * x + y * y
        radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3))
        x = (distorted[0] - 2.0 * p1 * x * y - p2 * (r2 + 2.0 * x * x)) / radial
        y = (distorted[1] - 2.0 * p2 * x * y - p1 * (r2 + 2.0 * y * y)) / radial
    return np.array([x, y, 1.0])


def pixel_goal(
    camera_info: CameraInfo,
    pixel: Sequence[float],
    *,
    distance: float = 1.0,
    min_duration: float = 0.5,
    max_velocity: float = 1.0,
) -> dict[str, object]:
    """Make a goal of `control_msgs/action/PointHead` that turns the camera towards the point at a pixel.

        info = sim.subscribe("/head_front_camera/rgb/camera_info")
        sim.run(0.1)
        goal = pixel_goal(info.latest, (320, 100))
        sim.send_goal("/head_controller/point_head_action", goal)

    Args:
        camera_info: message of the camera; its `header.frame_id` is the camera's optical frame.
        pixel: column and row.
        distance: distance of the target along the optical axis [m]; its effect is small if the camera is near the neck.
        min_duration: shortest duration of the head's motion [s].
        max_velocity: velocity limit of the head's joints [rad/s].

    Raises:
        InputError: K in `camera_info` is not a valid camera matrix.
    """
    x, y, z = (float(value) for value in pixel_ray(camera_info, *pixel) * distance)
    frame = camera_info.header.frame_id
    return {
        "target": {"header": {"frame_id": frame}, "point": {"x": x, "y": y, "z": z}},
        "pointing_axis": {"x": 0.0, "y": 0.0, "z": 1.0},
        "pointing_frame": frame,
        "min_duration": msgs.duration(round(min_duration * 1e9)),
        "max_velocity": max_velocity,
    }
