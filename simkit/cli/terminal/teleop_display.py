"""Text lines for keyboard driving: speed, pose and the nearest obstacle."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final, cast

import numpy as np
import numpy.typing as npt

from simkit.bridges.teleop import Teleop
from simkit.pose import Pose, quat_rotate

if TYPE_CHECKING:
    from simkit.runtime import Link, Model, Simulation
    from simkit.sensors.base import Sensor

Vector = npt.NDArray[np.float64]
_DRIVE_HELP: Final = "w/x faster/slower   a/d left/right   s stop   q/z all speeds ±10 %"
_HOLONOMIC_HELP: Final = "w/x faster/slower   a/d left/right   j/l sideways   s stop   q/z all ±10 %"
_RUN_HELP: Final = "space pause   n step   Ctrl-C ends"
_SCAN: Final = "sensor_msgs/msg/LaserScan"


class DriverLine:
    """Status lines of the robot that a `Teleop` drives. Reading them changes nothing in the simulation.

    Args:
        sim: loaded simulation.
        teleop: keyboard driving.
    """

    def __init__(self, sim: Simulation, teleop: Teleop) -> None:
        self._sim, self._teleop = sim, teleop

    def lines(self) -> list[str]:
        """Return the status line, the requested speeds and the keys."""
        keys = self._teleop.target.key_help or (_HOLONOMIC_HELP if self._teleop.target.sideways else _DRIVE_HELP)
        return [self.text(), self.requested(), keys, _RUN_HELP]

    def text(self) -> str:
        """Return speed, pose and nearest obstacle, as far as they are known."""
        model = self._model()
        if model is None:
            return f"driving {self._teleop.target.topic}"
        pose = model.pose
        yaw = math.degrees(float(pose.rpy[2]))
        x, y = (round(value, 2) + 0.0 for value in pose.position[:2])  # no "-0.00"
        position = f"x {x:.2f}  y {y:.2f}  {round(yaw)}°"
        parts = [self._speed_text(*_velocity(model, pose)), position, self._obstacle_text(model, pose)]
        return "   ".join(part for part in parts if part)

    def requested(self) -> str:
        """Return the requested speeds, or the error of the last command."""
        teleop = self._teleop
        if teleop.fault:
            return teleop.fault
        return f"requested {self._speed_text(*teleop.speeds)}" + (
            ", stopped after the key timeout" if teleop.is_expired else ""
        )

    def _speed_text(self, ahead: float, left: float, turn: float) -> str:
        sideways = f", {left:.2f} m/s left" if self._teleop.target.sideways else ""
        return f"{ahead:.2f} m/s{sideways}, {turn:.2f} rad/s"

    def _model(self) -> Model | None:
        """Return the model of the driven robot, while it exists."""
        name = self._teleop.target.model
        if not name:
            return None
        try:
            return self._sim.model(name)
        except KeyError:
            return None

    def _obstacle_text(self, model: Model, base: Pose) -> str:
        """Return distance and direction of the nearest obstacle in the robot's lidar scans; empty without a lidar."""
        readings = [
            near
            for sensor in self._sim.contents.sensors.values()
            if sensor.scoped.startswith(f"{model.scoped}::") and (near := nearest_reading(sensor)) is not None
        ]
        if not readings:
            return ""
        distance, direction, pose, least = min(readings, key=lambda reading: reading[0])
        if distance == math.inf:
            return "nothing near"
        reach = least if distance == -math.inf else distance
        point = pose.position + _rotate(pose, reach * np.array([math.cos(direction), math.sin(direction), 0.0]))
        offset = _rotate(base.inverse(), point - base.position)
        side = _side_text(math.degrees(math.atan2(offset[1], offset[0])))
        if distance == -math.inf:
            return f"nearest below {least:.2f} m, {side}"
        return f"nearest {distance:.2f} m, {side}"


def nearest_reading(sensor: Sensor) -> tuple[float, float, Pose, float] | None:
    """Return the shortest reading of a lidar; None for other sensors and before the first scan.

    Returns:
        Range [m] (infinite if no obstacle is in range, minus infinite if an obstacle is too near), angle about the
        sensor's z axis [rad], pose of the sensor, and its shortest range [m].
    """
    scan = sensor.latest
    if scan is None or getattr(scan, "__msgtype__", "") != _SCAN:
        return None
    ranges = np.asarray(scan.ranges, dtype=float)
    ranges = np.where(np.isnan(ranges), math.inf, ranges)
    if ranges.size == 0:
        return None
    index = int(ranges.argmin())
    step = float(scan.angle_increment)
    beams = round((scan.angle_max - scan.angle_min) / step) + 1 if step else 1  # beams of one layer
    return float(ranges[index]), scan.angle_min + index % beams * step, sensor.pose, float(scan.range_min)


def _velocity(model: Model, pose: Pose) -> tuple[float, float, float]:
    """Return forward speed, speed to the left [m/s] and yaw rate [rad/s], in the model's heading."""
    link = next(iter(model.links.values()), None)
    canonical = model.scene.canonical_link
    for element in model.everything():
        if element.scoped == canonical:
            link = cast("Link", element)
    if link is None:
        return 0.0, 0.0, 0.0
    yaw = float(pose.rpy[2])
    arm = pose.position - link.pose.position
    vx, vy, _ = (float(v) for v in link.linear_velocity + np.cross(link.angular_velocity, arm))
    ahead, left = vx * math.cos(yaw) + vy * math.sin(yaw), vy * math.cos(yaw) - vx * math.sin(yaw)
    values = (ahead, left, float(link.angular_velocity[2]))
    return tuple(0.0 if abs(v) < 0.005 else v for v in values)  # type: ignore[return-value]  # no "-0.00"


def _rotate(pose: Pose, vector: Vector) -> Vector:
    return quat_rotate(pose.quaternion, vector)


def _side_text(degrees: float) -> str:
    if abs(degrees) < 10:
        return "ahead"
    if abs(degrees) > 170:
        return "behind"
    return f"{abs(degrees):.0f}° {'left' if degrees > 0 else 'right'}"
